#!/usr/bin/env python3
"""Tests the test arm `rig`: its page must have what the daemon sends, during a run and after the daemon was killed.

Usage: rig_test.py HAPTICD RIG.so     prints one line per check; the exit code is 1 if one fails
"""
import os
import signal
import subprocess
import sys
import tempfile
import time

here = os.path.dirname(os.path.abspath(__file__))
sys.path[:0] = [here, os.path.join(here, "..")]
from e2e import check, finish
from rig import CLOSED, OPENED, Rig, STARTED, STOPPED

HAPTICD, MODULE = (os.path.abspath(argument) for argument in sys.argv[1:3])
SPHERE = os.path.join(here, "..", "..", "..", "config", "models", "sphere.yaml")


def run(folder, arm, *more):
    scene = os.path.join(folder, "scene.yaml")
    with open(scene, "w") as out:
        out.write("hapticd: 1\nmodels:\n  - {name: ball, plugin: nurbs_rigid, pose: {position: [0, -0.05, 0]}, "
                  f"parameters: {{geometry: {SPHERE}, stiffness: 500}}}}\n")
    environment = dict(os.environ, HAPTICD_PLUGIN_PATH=os.path.dirname(MODULE), STATE_DIRECTORY=folder)
    return subprocess.Popen([HAPTICD, "run", scene, "--device", arm.device, "--allow-non-rt", *more], env=environment,
                            stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)


with tempfile.TemporaryDirectory() as folder:
    arm = Rig(folder)
    daemon = run(folder, arm)
    check("a force comes", arm.wait_for_force())
    time.sleep(0.3)
    check("it is the sphere's: 2 mm of 500 N/m", abs(arm.force()[1] - 1) < 0.05, arm.force())
    daemon.send_signal(signal.SIGTERM)
    daemon.wait(20)
    kinds = [entry.kind for entry in arm.entries()]
    check("opened, started, stopped and closed in this order", [k for k in kinds if k != 2] == [OPENED, STARTED, STOPPED, CLOSED],
          [k for k in kinds if k != 2])
    check("no torque after the end", not arm.motors_on())
    check("times never run back", all(a.time_ns <= b.time_ns for a, b in zip(arm.entries(), arm.entries()[1:])))

with tempfile.TemporaryDirectory() as folder:
    arm = Rig(folder, position="[0, 0.5, 0]")
    daemon = run(folder, arm)
    arm.page()
    check("far from the sphere nothing pushes", not arm.wait_for_force(3))
    arm.move(0, -0.004, 0)
    daemon.send_signal(signal.SIGKILL)
    daemon.wait(20)
    check("the page outlives a daemon that is killed", arm.count() > 2, arm.count())
finish()
