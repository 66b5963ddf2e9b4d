#!/usr/bin/env python3
"""What a run says of forces that the hand did not get: cut by a limit, kept away by a fault that comes again, or not enabled.
And of an arm that swings.

Usage: faults_of_a_run.py HAPTICD SOURCE     prints one line per case; exit 1 when one is off.
"""
import json
import os
import re
import subprocess
import sys
import tempfile
import time

HAPTICD, SOURCE = sys.argv[1], sys.argv[2]
sys.path.insert(0, os.path.join(SOURCE, "tests", "support"))
from e2e import check, finish, program, until

SCENE = os.path.join(SOURCE, "config", "scenes", "sphere.yaml")
ARM = """hapticd-device: 1
module: simulated
name: arm
mount: {{position: [0, 0, 0.09]}}
limits: {{force: 2, {0}}}
hand: {{pressed: [[1, 2]], script: press, radius: 0.05, rise: 0.01, rate: 2, center: [0, 0, -0.09]}}
"""


def arm(folder, limits):
    file = os.path.join(folder, "arm.yaml")
    with open(file, "w", encoding="utf-8") as out:
        out.write(ARM.format(limits))
    return file


def virtual(folder, ask, limits):
    report = os.path.join(folder, "report.json")
    _, out, _ = ask("run", SCENE, "--device", arm(folder, limits), "--virtual-time", "--for", "3", "--report", report)
    with open(report, encoding="utf-8") as text:
        found = json.load(text)
    return out, found, found["models"]["sphere"], found["limits"]["arm"]


def cut_by_a_limit(folder, ask):
    out, _, model, sent = virtual(folder, ask, "ramp_in: 0.2")
    check("the model asks for more than the limit", model["force_n"]["max"] > 2, model["force_n"])
    check("the report has what the hand got", 1.5 < sent["sent_max_n"] < 2 + 1e-9 and sent["faults"] == 0, sent)
    check("so has the summary", f"the hand got {sent['sent_max_n']:.2f} N at most" in out, out)


def kept_away_by_a_fault(folder, ask):
    out, report, model, sent = virtual(folder, ask, "velocity: 0.05")
    check("a fault that stays", sent["faults"] == 1 and sent["fault_ticks"] > 0.5 * report["ticks"], sent)
    check("ticks without force are no contact", model["contact_ticks"] + sent["fault_ticks"] <= report["ticks"], (model, sent))
    check("the force is that of other ticks", model["force_n"]["max"] < 6, model["force_n"])
    check("the summary tells of the fault and its time", "faults of arm: 1 in this run" in out and "left out" in out, out)


def not_enabled(folder, ask):
    """The button of the hand is down from 1 s to 2 s of 3."""
    out, report, model, sent = virtual(folder, ask, "enable: {button: 0}")
    off = sent["not_enabled_ticks"]  # the last 20 ms belong to the end of the run
    check("without the button there is no force", 1950 < off <= 2000 and sent["faults"] == 0, sent)
    check("nor a contact", 100 < model["contact_ticks"] <= report["ticks"] - off, (model, sent))
    check("the summary tells for how long", f"enable switch of arm: off for {off / 1000:.2f} s" in out and "left out" in out, out)
    out, _, model, sent = virtual(folder, ask, "ramp_in: 0.2")
    check("an arm without a switch is always enabled", sent["not_enabled_ticks"] == 0 and "enable switch" not in out, (sent, out))


def swings(folder, ask):
    """Compliance control is not stable at a low rate, and the bounds on stiffness do not know this."""
    report, scene = os.path.join(folder, "report.json"), os.path.join(folder, "compliance.yaml")
    with open(os.path.join(SOURCE, "config/scenes/compliance.yaml"), encoding="utf-8") as text:
        shipped = text.read().replace("../", os.path.join(SOURCE, "config", ""))
    for rate, damping, told in ((100, 20, True), (300, 20, True), (1500, 20, False), (100, 200, False), (300, 60, False)):
        with open(scene, "w", encoding="utf-8") as text:
            text.write(shipped.replace("damping: 20", f"damping: {damping}"))
        _, out, _ = ask("run", scene, "--virtual-time", "--for", "10", "--rate", f"{rate}", "--report", report)
        with open(report, encoding="utf-8") as text:
            (found,) = json.load(text)["limits"].values()
        check(f"a run at {rate} Hz with a damping of {damping} says whether its arm swings", (found["swing_hz"] > 12) == told
              and (f"not stable at {rate} Hz: take a higher rate, or more admittance.damping" in out) == told, (found, out))


def told_by_a_recording(folder, ask):
    file = os.path.join(folder, "run.h5")
    ask("run", SCENE, "--device", arm(folder, "velocity: 0.05"), "--virtual-time", "--for", "1", "--record", file)
    code, out, err = ask("explain", file)
    check("explain tells of the fault in words", code == 0 and "limits.velocity (measured: 0.05" in out and "1000 ticks" in out
          and "sphere was touched 1 time\n" in out, (code, out, err))
    check("ticks of a fault are no contact there either", "touched\n" not in out, out)
    pressed = os.path.join(folder, "button.h5")
    ask("run", os.path.join(SOURCE, "config/scenes/button.yaml"), "--virtual-time", "--for", "4", "--record", pressed)
    code, out, err = ask("explain", pressed)
    check("and of touches and clicks apart", re.search(r"button was touched \d+ times?, and clicked \d*[24680] times \(in or out\)\n", out), out)
    with open(file, "r+b") as damaged:
        damaged.truncate(300)
    code, out, err = ask("explain", file)
    check("explain refuses what is left of a file", code == 2 and file in out + err, (code, out, err))


def cleared_in_vain(folder, environment, ask):
    """The tip is always too fast: each clear is followed by the same fault, at once."""
    report = os.path.join(folder, "report.json")
    run = subprocess.Popen([HAPTICD, "run", SCENE, "--device", arm(folder, "velocity: 1e-4"), "--report", report],
                           env=environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    check("it runs", until(lambda: "too fast" in ask("ctl", "status")[1] or "faster" in ask("ctl", "status")[1], 30))
    for _ in range(3):
        code, out, err = ask("ctl", "clear")
        check("a clear that does not help says why", code == 1 and "a fault is there again" in out + err and
              "limits.velocity" in out + err, (code, out, err))
        time.sleep(0.1)
    ask("ctl", "stop")
    out, err = run.communicate(timeout=30)
    with open(report, encoding="utf-8") as text:
        sent = json.load(text)["limits"]["arm"]
    check("each fault is in the log", sent["faults"] >= 4 and err.count("error: fault:") == sent["faults"], (sent, err))
    check("so is each clear", err.count("the fault is over") == sent["faults"] - 1, (sent, err))
    check("the summary counts them", f"faults of arm: {sent['faults']} in this run" in out, out)


with tempfile.TemporaryDirectory() as place:
    settings = dict(os.environ, RUNTIME_DIRECTORY=place, STATE_DIRECTORY=os.path.join(place, "state"))
    cut_by_a_limit(place, program(HAPTICD, settings))
    kept_away_by_a_fault(place, program(HAPTICD, settings))
    not_enabled(place, program(HAPTICD, settings))
    swings(place, program(HAPTICD, settings))
    told_by_a_recording(place, program(HAPTICD, settings))
    cleared_in_vain(place, settings, program(HAPTICD, settings))
finish()
