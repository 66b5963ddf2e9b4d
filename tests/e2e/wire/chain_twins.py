#!/usr/bin/env python3
"""Every chain, and the delta, that `device new` writes has a twin that can be run: flat ones, ones with more joints than directions, ones whose middle is stretched out.

Usage: chain_twins.py HAPTICD SOURCE_DIR       exit 1 when one is off
"""
import json
import os
import re
import sys
import tempfile

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "support"))
from e2e import check, finish, program

HAPTICD, SOURCE = sys.argv[1:3]
SPHERE = os.path.join(SOURCE, "config/scenes/sphere.yaml")
RIGHT = "1.5707963"
run = program(HAPTICD)

with tempfile.TemporaryDirectory() as folder:
    arm, twin, report = (os.path.join(folder, name) for name in ("arm.yaml", "arm-twin.yaml", "report.json"))

    def remove():
        for file in (arm, twin, report):
            if os.path.exists(file):
                os.remove(file)

    def new(*options, change=None):
        remove()
        code, out, err = run("device", "new", "arm", "-o", arm, "--no-questions", *options)
        assert code == 0, err
        if change:
            text = open(arm).read()
            assert change[0] in text, change[0]
            open(arm, "w").write(text.replace(*change))
        return out

    middle = ("    # limits: [[-1, 1], ...]", "    limits: [[-1, 1], [-2, 2], [-2, 2]]  #")
    for name, options, change in (("three parallel axes", ("--kind", "chain"), None),
                                  ("three axes with a turning base", ("--kind", "chain", "--twists", f"{RIGHT},0,0"), None),
                                  ("limits whose middle is stretched out", ("--kind", "chain", "--twists", f"{RIGHT},0,0"), middle),
                                  ("two parallel axes", ("--kind", "chain", "--joints", "2"), None),
                                  ("six axes", ("--kind", "chain", "--joints", "6", "--lengths", "0,0.25,0.05,0.2,0,0.05",
                                                "--twists", f"{RIGHT},0,{RIGHT},-{RIGHT},{RIGHT},0"), None)):
        new(*options, change=change)
        code, out, err = run("device", "twin", arm, "-o", twin)
        check(f"{name}: the twin is written", code == 0 and "then:" in out, (out, err))
        code, out, err = run("run", SPHERE, "--device", twin, "--for", "2", "--virtual-time", "--report", report)
        told = json.load(open(report)) if os.path.exists(report) else {}
        touched = told.get("models", {}).get("sphere", {}).get("contact_ticks", 0)
        check("and presses the sphere", code == 0 and touched > 200 and told["faults"] == [], (touched, out[-1200:], err, open(twin).read()))

    # What an arm sends as floating-point numbers has no counts, and a hand that presses needs no axis of strokes.
    new("--kind", "chain", "--joints", "2")
    text = open(arm).read().replace("type: i16, scale: 0.000314159265, wraps: true", "type: f32, scale: 1").replace("joint: 2, at: 4", "joint: 2, at: 6")
    text = re.sub(r"size: \d+", "size: 12", text, count=1)
    open(arm, "w").write(re.sub(r"button: 1, bit_offset: \d+", "button: 1, at: 11", text))
    run("device", "twin", arm, "-o", twin)
    code, out, err = run("check", twin)
    check("a twin is not warned of itself", code == 0 and "hand.axis" not in out and "joint.counts" not in out, (out, err, open(twin).read()))

    # Nobody said what its motors sustain: the Premium's 1.4 N are not theirs.
    new("--kind", "phantom")
    run("device", "twin", arm, "-o", twin)
    text = open(twin).read()
    lines = [line for line in text.splitlines() if not line.startswith("hand:")]
    pressed = "\n".join(lines) + "\nhand: {script: press, radius: 0.04, rise: 0.003, rate: 1, center: [0, 0, -0.09]}\n"
    for given, warns in (("", False), (", continuous_force: 1.4", True)):
        open(twin, "w").write(pressed.replace("device: {rate: 1000", "device: {rate: 1000" + given))
        code, out, err = run("run", SPHERE, "--device", twin, "--for", "8", "--virtual-time")
        check(f"a twin's heat is judged by its own number{given}", code == 0 and ("sustains 1.4 N (device.continuous_force)" in err) == warns
              and ("sustains" in err) == warns, (out, err))

    new("--kind", "chain", "--joints", "1")
    code, out, err = run("device", "twin", arm, "-o", twin)
    ran = run("run", SPHERE, "--device", twin, "--for", "1", "--virtual-time")
    check("the twin of one axis, which cannot press along a line, runs", code == 0 and (ran[0] == 0 or "hand" not in ran[2]), (out, err, ran))

    out = new("--kind", "chain", "--twists", f"{RIGHT},0,0", change=("# mount: {position: [0, 0, 0]", "mount: {position: [0, 0, 3]"))
    code, out, err = run("device", "twin", arm, "-o", twin)
    check("a twin whose hand is out of reach is not recommended", code == 1 and "then:" not in out and "which the arm cannot reach" in err and "fix: correct mount in" in err, (out, err))
    out = new("--kind", "delta")
    code, twin_out, err = run("device", "twin", arm, "-o", twin)
    ran = run("run", SPHERE, "--device", twin, "--for", "2", "--virtual-time", "--report", report)
    touched = json.load(open(report))["models"]["sphere"]["contact_ticks"] if os.path.exists(report) else 0
    check("a delta has one, too", code == 0 and "device twin" in out and ran[0] == 0 and touched > 200, (twin_out, err, ran, touched))
    check("that the tip rests in front of the origin is said of a phantom alone",
          "here the resting tip is" not in open(arm).read() and (new("--kind", "phantom"), "here the resting tip is" in open(arm).read())[1])
finish()
