#!/usr/bin/env python3
"""The lump of the palpation scene is felt and found, by pressing 4 mm deep here and there: `hapticd trace`.

Usage: feel_the_lump.py HAPTICD CONFIG     prints one line per case; exit 1 when one is off.
"""
import csv
import math
import os
import sys
import tempfile

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "support"))
from e2e import check, finish, program

hapticd, CONFIG = program(sys.argv[1]), os.path.abspath(sys.argv[2])
SCENE = os.path.join(CONFIG, "scenes", "soft-palpation.yaml")
LUMP = (0.018, -0.009)


def pressed(folder, x, y):
    """Force [N] at the first row deeper than 4 mm, pressed from above at 0.15 m/s."""
    probe, out = os.path.join(folder, "probe.csv"), os.path.join(folder, "out.csv")
    with open(probe, "w", encoding="utf-8") as file:
        file.write("t,x,y,z\n")
        for i in range(300):
            file.write(f"{1e-3 * i:.3f},{x},{y},{0.06 - 1.5e-4 * i:.6f}\n")
    hapticd("trace", SCENE, "--probe", probe, "--out", out, check=True)
    with open(out, encoding="utf-8") as file:
        for row in csv.DictReader(file):
            if float(row["depth"]) > 0.004:
                return math.hypot(*(float(row[axis]) for axis in ("fx", "fy", "fz")))
    return math.nan


with tempfile.TemporaryDirectory() as work:
    lump = pressed(work, *LUMP)
    away = [pressed(work, x, y) for x, y in ((-0.03, 0.02), (-0.03, -0.02), (0, 0.02), (-0.02, 0))]
    check("on the lump the force is four times that elsewhere", lump > 4 * max(away), (lump, away))
    check("elsewhere it is the same everywhere", max(away) < 1.1 * min(away), away)
    grid = [(x, y) for x in (-0.03, -0.01, 0.01, 0.02, 0.03) for y in (-0.02, -0.01, 0, 0.01, 0.02)]
    found = max(grid, key=lambda place: pressed(work, *place))
    told = hapticd("check", SCENE)
    check("the scene passes its own stability check", told.returncode == 0 and "warning" not in told.stdout, told.stdout)
    check("pressing every 10 mm finds it", math.dist(found, LUMP) < 0.005, found)
finish()
