#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Shows what a ramp would spare a hand of which a model lets go: a plate presses against a simulated hand that holds still,
and then leaves it within 1, 10, 20 or 50 ms. Prints how fast the tip becomes afterwards.

usage: letting_go.py HAPTICD SOURCE
"""
import csv
import os
import subprocess
import sys
import tempfile

HAPTICD, SOURCE = (os.path.abspath(argument) for argument in sys.argv[1:3])
PRESSED, LET_GO = 0.0275, 1.5  # m: 17 mm of way of the hand, 10 mm of depth; s
SCENE = f"""hapticd: 1
device: {SOURCE}/config/devices/simulated-premium15.yaml
hand: {{script: hold, center: [0, 0, -0.09], radius: 0}}
models:
  - name: plate
    plugin: nurbs_rigid
    motion: kinematic
    path: plate.csv
    parameters: {{geometry: {SOURCE}/config/models/box.yaml, stiffness: 800}}
"""


def run(folder, leaves):
    """@param leaves [s] in which the plate goes out of the hand @return [N] the force before, [m/s] the speed afterwards"""
    way = ((0, -0.02), (1, PRESSED), (LET_GO, PRESSED), (LET_GO + leaves, 0), (LET_GO + leaves + 0.1, -0.1))
    with open(os.path.join(folder, "plate.csv"), "w") as out:
        out.write("t,x,y,z,qw,qx,qy,qz\n" + "".join(f"{t},{x - 0.05},0,0,1,0,0,0\n" for t, x in way))
    scene, recording, ticks = (os.path.join(folder, name) for name in ("plate.yaml", "run.h5", "ticks.csv"))
    with open(scene, "w") as out:
        out.write(SCENE)
    quiet = {"check": True, "stdout": subprocess.DEVNULL}
    subprocess.run([HAPTICD, "run", scene, "--virtual-time", "--for", "2", "--log-level", "error", "--record", recording], **quiet)
    subprocess.run([HAPTICD, "export", recording, "--csv", ticks, "--stream", "ticks"], **quiet)
    with open(ticks) as rows:
        seen = [{key: float(row[key]) for key in ("t", "arm0_x", "arm0_sent_fx")} for row in csv.DictReader(rows)]
    os.remove(recording)
    force = max(row["arm0_sent_fx"] for row in seen)
    over = range(5, len(seen) - 5)
    speed = max(abs(seen[i + 2]["arm0_x"] - seen[i - 2]["arm0_x"]) / 4e-3 for i in over if seen[i]["t"] > LET_GO)
    return force, speed


with tempfile.TemporaryDirectory() as folder:
    for leaves in (0.001, 0.01, 0.02, 0.05):
        force, speed = run(folder, leaves)
        mass = 0.075  # kg, an arm that nobody holds
        print(f"{1e3 * leaves:4.0f} ms: {force:.2f} N go, the tip of the hand becomes {speed:.2f} m/s fast; without a hand "
              f"the arm would become {force * leaves / 2 / mass:.2f} m/s fast")
