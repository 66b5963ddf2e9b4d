#!/usr/bin/env python3
"""Path files of the simulated hand are judged before a run, and a run says what kept the hand from following.

Usage: hand_paths.py HAPTICD SOURCE     prints one line per case; exit 1 when one is off.
"""
import json
import os
import sys
import tempfile

import h5py
import numpy

HAPTICD, SOURCE = sys.argv[1], sys.argv[2]
sys.path.insert(0, os.path.join(SOURCE, "tests", "support"))
from e2e import check, finish, program

SCENE = """hapticd: 1
device: {source}/config/devices/simulated-premium15.yaml
hand: {{script: path, tremor: 0, wander: 0{path}}}
models:
  - name: ball
    plugin: nurbs_rigid
    parameters: {{geometry: {source}/config/models/sphere.yaml, stiffness: 800}}
"""
BROKEN = {
    "time that does not grow": ("t,x,y,z\n0,0,0,0\n1,0,0,0\n1,0,0,0\n", "path.csv:4:"),
    "another header": ("t,x,y\n0,0,0\n", "path.csv:1:"),
    "a header of one": ("x\n0\n", "path.csv:1:"),
    "an empty file": ("", "path.csv:"),
    "what is no number": ("t,x,y,z\n0,0,0,0\n1,nan,0,0\n", "path.csv:3:"),
    "too few columns": ("t,x,y,z\n0,0,0,0\n1,0,0\n", "path.csv:3:"),
}


def judged(folder, ask):
    scene, path = os.path.join(folder, "scene.yaml"), os.path.join(folder, "path.csv")
    with open(scene, "w") as file:
        file.write(SCENE.format(source=SOURCE, path=", path: path.csv"))
    for name, (text, place) in BROKEN.items():
        with open(path, "w") as file:
            file.write(text)
        code, out, err = ask("check", scene)
        check(f"check refuses {name}", code == 2 and place in out, (code, out, err))
    for name, last, word in (("out of reach", "-3", "does not reach it"), ("behind a stop", "-0.095", "does not reach it")):
        with open(path, "w") as file:
            file.write(f"t,x,y,z\n0,0,0.02,0\n1,-0.04,0,{last}\n")
        code, out, err = ask("check", scene)
        check(f"check warns of a row {name}", code == 0 and word in out and "path.csv:3:1: hand.path: warning: at t = 1 s" in out, (code, out, err))
    with open(path, "w") as file:
        file.write("t,x,y,z\n0,0,0.02,0\n1,0,0.01,0\n")
    code, out, err = ask("check", scene)
    check("and of no good row", code == 0 and "does not reach" not in out, (code, out, err))
    bare = os.path.join(folder, "bare.yaml")
    with open(bare, "w") as file:
        file.write(SCENE.format(source=SOURCE, path=""))
    code, out, _ = ask("check", bare)
    check("a script without its file is refused", code == 2 and "hand.path names no file" in out, (code, out))


def stopped(folder, ask):
    scene, path, report = (os.path.join(folder, name) for name in ("scene.yaml", "path.csv", "report.json"))
    with open(path, "w") as file:
        file.write("t,x,y,z\n0,0,0.06,0\n1,-0.04,0.06,-0.095\n3,-0.04,0.06,-0.095\n")
    code, out, err = ask("run", scene, "--for", "3", "--virtual-time", "--report", report)
    check("the summary names the joint at its stop", code == 0 and "joint 3 (q2) stood at the end of its range" in out, (out, err))
    with open(report) as file:
        stops = json.load(file)["stops"]
    check("and the report counts the ticks", 500 < stops["simulated Premium 1.5"]["q2"] < 3000, stops)


def ramped(folder, ask):
    """The hand sinks in while the force ramps out at the end: that depth is nothing of the model."""
    recording, report = os.path.join(folder, "run.h5"), os.path.join(folder, "report.json")
    code, out, err = ask("run", os.path.join(SOURCE, "config", "scenes", "sphere.yaml"), "--for", "1.3", "--virtual-time",
                         "--record", recording, "--report", report)
    with open(report) as file:
        model = json.load(file)["models"]["sphere"]
    with h5py.File(recording) as file:
        ticks, contacts = file["ticks"][:], file["contacts"][:]
    pushed = ticks["tick"][ticks["arm0_fault"] == 0]
    depth = lambda which: contacts["depth"][which & (contacts["depth"] > 0)].max() * 1e3
    within = numpy.isin(contacts["tick"], pushed)
    check("the run ends while the hand is inside", code == 0 and depth(~within) > depth(within) * 1.02, (out, err))
    check("the report's depth leaves the ramp at the end out", abs(model["penetration_mm"]["max"] - depth(within)) < 1e-6,
          (model, depth(within), depth(~within)))
    check("as its ticks do", model["contact_ticks"] == (within & (contacts["depth"] > 0)).sum(), model)


with tempfile.TemporaryDirectory(dir="/dev/shm") as scratch:
    environment = dict(os.environ, RUNTIME_DIRECTORY=scratch, STATE_DIRECTORY=scratch)
    ask = program(HAPTICD, environment)
    judged(scratch, ask)
    stopped(scratch, ask)
    ramped(scratch, ask)
finish()
