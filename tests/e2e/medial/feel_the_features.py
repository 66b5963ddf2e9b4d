#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The scenes of config/scenes/soft show what their first lines say, in virtual time, and a heavy body may swing.

Usage: feel_the_features.py HAPTICD CONFIG     prints one line per case; exit 1 when one is off.
"""
import csv
import math
import os
import re
import sys
import tempfile

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "support"))
import soft_runs
from e2e import check, finish, program

HAPTICD, SCENES = sys.argv[1], os.path.join(os.path.abspath(sys.argv[2]), "scenes", "soft")
hapticd = program(HAPTICD)
STIFFNESS = 200  # N/m, of soft-plate.yaml


def scene(name):
    return os.path.join(SCENES, name)


def size(row):
    return math.dist((0, 0, 0), row["force"])


def stiffest(rows, start, end):
    """[N/m] greatest force over depth, from 2 mm on."""
    return max(soft_runs.along(r) / r["depth"] for r in rows if start < r["t"] < end and r["depth"] > 0.002)


def met(rows, start):
    """[m] depth below the contour at rest at which the surface is met, of the press after `start`."""
    return next(r["depth"] for r in rows if r["t"] > start and size(r) > 0.02)


def relaxation():
    [rows] = soft_runs.run(HAPTICD, scene("relaxation.yaml"), 6)
    held = soft_runs.at(rows, 1.95)
    check("a held press feels the stiffness of the file", abs(soft_runs.along(held) / held["depth"] / STIFFNESS - 1) < 0.05,
          (soft_runs.along(held), held["depth"]))
    check("a fast press feels more", stiffest(rows, 0.5, 0.7) > 1.4 * STIFFNESS, stiffest(rows, 0.5, 0.7))
    soon, late = met(rows, 2.15), met(rows, 4.5)
    check("soon after, the hand meets the dent", soon > 3 * late and soon > 5e-4, (soon, late))


def twoHands():
    first, second = soft_runs.run(HAPTICD, scene("two-hands.yaml"), 6)
    felt = lambda rows, t: soft_runs.along(soft_runs.at(rows, t)) / soft_runs.at(rows, t)["depth"]
    check("alone, a hand feels the stiffness of the file", abs(felt(first, 1.9) / STIFFNESS - 1) < 0.05, felt(first, 1.9))
    check("beside another it feels less", felt(first, 3.8) < 0.75 * STIFFNESS and felt(second, 3.8) < 0.75 * STIFFNESS,
          (felt(first, 3.8), felt(second, 3.8)))
    check("when the first has gone, the second feels all of it", abs(felt(second, 5.8) / STIFFNESS - 1) < 0.05,
          felt(second, 5.8))


def mesh():
    [rows] = soft_runs.run(HAPTICD, scene("mesh.yaml"), 6)
    sides = [sum(size(r) > 0.1 and sign * r["tip"][0] > 0.008 for r in rows) for sign in (-1, 1)]
    check("both fingers are felt", min(sides) > 100, sides)
    jump = max(math.dist(a["force"], b["force"]) for a, b in zip(rows, rows[1:]))
    check("no tick changes the force by a fifth of the greatest", jump < 0.2 * max(map(size, rows)), jump)


BODY = """format: hapticd-model/2
medial:
  points: [[[-0.03, -0.03, 0], [-0.03, 0.03, 0]], [[0.03, -0.03, 0], [0.03, 0.03, 0]]]
  radius: 0.01
  stiffness: 3000
  damping: 0.5
  mass: 0.5
"""
SCENE = """hapticd: 1
models:
  - {name: heavy, plugin: mat_deformable, parameters: {geometry: body.yaml, dynamics: felt}}
"""


def swingsBack():
    """The force grows at a hand that holds still. The daemon took that for a fault of the plugin and silenced it."""
    with tempfile.TemporaryDirectory() as folder:
        file = lambda name: os.path.join(folder, name)
        depth = lambda t: 0.004 * min(1, max(0, (t - 0.1) / 0.04))
        path = "".join(f"{0.001 * i:.3f},0,0,{0.0101 - depth(0.001 * i):.9f}\n" for i in range(1000))
        for name, text in (("body.yaml", BODY), ("scene.yaml", SCENE), ("path.csv", "t,x,y,z\n" + path)):
            with open(file(name), "w", encoding="utf-8") as out:
                out.write(text)
        told = hapticd("trace", file("scene.yaml"), "--probe", file("path.csv"), "--out", file("out.csv"))
        check("a heavy body that swings back is not silenced", told.returncode == 0, told.stderr)
        with open(file("out.csv"), encoding="utf-8") as out:
            force = [float(row["fz"]) for row in csv.DictReader(out)]
        least, most = min(force[150:]), max(force[500:])
        check("it left the hand and came back", most > 5 and least < 0.3 * most, (least, most))


def undamped():
    """A mass that nothing damps swings against the contact spring, and the force that is held for a tick makes it worse."""
    with tempfile.TemporaryDirectory() as folder:
        def told(command, damping):
            for name, text in (("body.yaml", BODY.replace("damping: 0.5", f"damping: {damping}").replace("mass: 0.5", "mass: 0.01")),
                               ("scene.yaml", SCENE)):
                with open(os.path.join(folder, name), "w", encoding="utf-8") as out:
                    out.write(text)
            done = hapticd(command, os.path.join(folder, "scene.yaml"))
            return done.stdout + done.stderr
        warned = " ".join(told("check", 0).split())
        found = re.search(r"it is not passive on any arm; give it a damping of at least ([0-9.]+) N s/m", warned)
        check("a mass without damping is warned of, with what would do", found, warned)
        enough = found.group(1) if found else "1"
        check("with that damping there is no warning", "undamped" not in told("check", enough), told("check", enough))
        needed = re.search(r"contact spring 9000 N/m, passive on an arm that damps ([0-9.]+) N s/m", " ".join(told("explain", 3).split()))
        check("explain knows what an arm must damp", needed and abs(float(needed.group(1)) - 5.07) < 0.02, told("explain", 3))


relaxation()
twoHands()
mesh()
swingsBack()
undamped()
for name in ("relaxation.yaml", "two-hands.yaml", "mesh.yaml"):
    told = hapticd("check", scene(name))
    check(f"{name} is checked without a warning", told.returncode == 0 and "warning" not in told.stdout, told.stdout)
finish()
