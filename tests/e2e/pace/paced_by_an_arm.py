#!/usr/bin/env python3
"""servo.pace: device. The samples of an arm drive the loop, at its rate; a run of it replays bit for bit; the force is what
the clock would give.

Usage: paced_by_an_arm.py HAPTICD CONFIG     prints one line per case; exit 1 when one is off.
"""
import json
import os
import sys
import tempfile

import h5py
import numpy as np

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "support"))
from e2e import check, finish, program

HAPTICD, CONFIG = sys.argv[1], sys.argv[2]
hapticd = program(HAPTICD, together=True)


def write(path, text):
    with open(path, "w") as file:
        file.write(text)
    return path


def scene(folder, name, pace, rate):
    arm = open(os.path.join(CONFIG, "devices", "simulated-premium15.yaml")).read()
    device = write(os.path.join(folder, name + "-arm.yaml"),
                   arm.replace("parameters:\n", f"parameters:\n  device: {{rate: {rate}}}\n"))
    sphere = os.path.join(CONFIG, "models", "teapot.yaml")
    return write(os.path.join(folder, name + ".yaml"),
                 f"hapticd: 1\nservo: {{rate: 1000, pace: {pace}}}\ndevice: {device}\nmodels:\n  - name: teapot\n"
                 f"    plugin: nurbs_rigid\n    parameters: {{geometry: {sphere}, stiffness: 800}}\n")


def run(folder, name, pace, rate, *options):
    file, report = os.path.join(folder, name + ".h5"), os.path.join(folder, name + ".json")
    code, told = hapticd("run", scene(folder, name, pace, rate), "--for", "2", "--record", file, "--report", report,
                         *options)
    check(name + ": runs", code == 0, told)
    code, replayed = hapticd("replay", file)
    check(name + ": replays with every bit the same", code == 0, replayed)
    with h5py.File(file) as recording:
        ticks = np.sort(recording["ticks"][:], order="tick")
    return json.load(open(report)), ticks, told


def main(folder):
    _, clock, _ = run(folder, "clock", "clock", 1000, "--virtual-time")
    report, ticks, _ = run(folder, "same-rate", "device", 1000, "--virtual-time")
    check("at the servo's rate the arm drives what the clock drives",
          len(ticks) == len(clock) and np.array_equal(ticks["arm0_sent_fx"], clock["arm0_sent_fx"]), len(ticks))
    report, ticks, told = run(folder, "half-rate", "device", 500, "--virtual-time")
    check("an arm of half the rate drives half the ticks", abs(len(ticks) - 1000) <= 2, len(ticks))
    check("  each with a new sample", np.all(np.diff(ticks["arm0_sequence"].astype(np.int64)) == 1))
    check("  as long as its period is", np.allclose(ticks["dt"][1:], 2e-3, rtol=1e-9), ticks["dt"][:4])
    check("  and the run warns that the scene says otherwise", "servo.rate" in told and "drive the loop" in told, told)
    report, ticks, _ = run(folder, "slow", "device", 100, "--virtual-time")
    check("a very slow arm holds no tick longer than two and a half periods", ticks["dt"].max() < 2.6e-3, ticks["dt"].max())
    report, ticks, _ = run(folder, "real-time", "device", 1000)
    check("in real time every tick of it has a new sample",
          len(ticks) > 100 and np.all(np.diff(ticks["arm0_sequence"].astype(np.int64)) >= 1), len(ticks))
    check("  and nothing is allocated", report["servo_allocations"] == 0, report["servo_allocations"])


with tempfile.TemporaryDirectory() as scratch:
    main(scratch)
finish()
