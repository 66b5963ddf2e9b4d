#!/usr/bin/env python3
"""`hapticd trace` against thin walls: a contact pushes back to the side that it was entered from.

Usage: thin_walls.py HAPTICD     prints one line per case; exit 1 when one is off.
"""
import csv
import json
import math
import os
import subprocess
import sys
import tempfile

HAPTICD = sys.argv[1]
STIFFNESS = 1000
NEAREST, DEGRADED, HELD = 0, 1, 2  # the column status
failures = 0


def report(name, good, what=""):
    global failures
    failures += not good
    print(f"{'ok' if good else 'FAILED':6} {name} {'' if good else what}")


def quad(corner, side_u, side_v, name):
    add = lambda a, b: [x + y for x, y in zip(a, b)]
    return {"name": name, "degree": [1, 1], "knots": [[0, 0, 1, 1], [0, 0, 1, 1]],
            "points": [corner, add(corner, side_v), add(corner, side_u), add(add(corner, side_u), side_v)]}


def plate(thick, half=0.05):
    """Top at z = 0, bottom at z = -thick."""
    h, d = half, 2 * half
    return [quad([-h, -h, 0], [d, 0, 0], [0, d, 0], "top"), quad([h, -h, -thick], [-d, 0, 0], [0, d, 0], "bottom"),
            quad([h, -h, 0], [0, 0, -thick], [0, d, 0], "right"), quad([-h, -h, -thick], [0, 0, thick], [0, d, 0], "left"),
            quad([-h, h, 0], [d, 0, 0], [0, 0, -thick], "far"), quad([-h, -h, -thick], [d, 0, 0], [0, 0, thick], "near")]


def trace(surfaces, points, parameters=None, dt=1e-3):
    with tempfile.TemporaryDirectory() as folder:
        join = lambda name: os.path.join(folder, name)
        with open(join("model.json"), "w") as out:
            json.dump({"format": "hapticd-model/1", "surfaces": surfaces}, out)
        model = {"name": "wall", "plugin": "nurbs_rigid",
                 "parameters": {"geometry": "model.json", "stiffness": STIFFNESS, **(parameters or {})}}
        with open(join("scene.yaml"), "w") as out:
            json.dump({"hapticd": 1, "models": [model]}, out)
        with open(join("probe.csv"), "w") as out:
            out.write("t,x,y,z\n")
            out.writelines(f"{i * dt!r},{x!r},{y!r},{z!r}\n" for i, (x, y, z) in enumerate(points))
        done = subprocess.run([HAPTICD, "trace", join("scene.yaml"), "--probe", join("probe.csv"), "--out", join("out.csv")],
                              capture_output=True, text=True)
        if done.returncode != 0:
            raise RuntimeError(f"exit {done.returncode}: {done.stderr}")
        with open(join("out.csv")) as file:
            rows = [{k: (v if k == "model" else float(v)) for k, v in row.items()} for row in csv.DictReader(file)]
        assert len(rows) == len(points)
        return rows, done.stderr


def line(a, b, speed, dt=1e-3):
    """Points from a to b at a speed [m/s]."""
    count = max(1, round(math.dist(a, b) / (speed * dt)))
    return [tuple(p + (q - p) * i / count for p, q in zip(a, b)) for i in range(count + 1)]


def presses(points, rows):
    """Largest error [N] of the force of a wall that pushes up from z = 0, however deep."""
    return max(max(abs(r["fz"] - STIFFNESS * max(0.0, -p[2])), abs(r["fx"]), abs(r["fy"])) for p, r in zip(points, rows))


def walls():
    points = line((0.01, 0.02, 0.003), (0.01, 0.02, -0.009), 0.05)
    rows, _ = trace(plate(0.004), points)
    report("a plate of 4 mm never pushes out of its far side", presses(points, rows) < 1e-6, presses(points, rows))
    report("the trace says held where the far side is nearer",
           all(r["status"] == (HELD if p[2] < -0.002 - 1e-9 else NEAREST) for p, r in zip(points, rows)
               if abs(p[2] + 0.002) > 1e-6))
    for thick, speed in ((0.004, 2), (0.001, 2), (0.0003, 0.5), (0.001, 10)):
        for height in (0.0031, 0.0042, 0.0057):
            points = line((0.01, 0.02, height), (0.012, 0.021, -0.03), speed)
            rows, _ = trace(plate(thick), points)
            report(f"a plate of {1e3 * thick:g} mm entered at {speed} m/s from {1e3 * height:g} mm",
                   presses(points, rows) < 1e-6, presses(points, rows))


def edges():
    points = line((0.04, 0, 0.002), (0.04, 0, -0.006), 0.1) + line((0.04, 0, -0.006), (0.07, 0, -0.006), 0.1)
    rows, _ = trace(plate(0.004), points)
    free = [r for p, r in zip(points, rows) if p[0] > 0.05 + 1e-9]
    felt = [(p, r) for p, r in zip(points, rows) if p[0] < 0.05 - 1e-9]
    report("beyond a convex edge the contact is released", all(r["contact"] == 0 and r["fz"] == 0 for r in free))
    report("and held as far as the edge", presses([p for p, _ in felt], [r for _, r in felt]) < 1e-6)


def starts():
    still = [(0.01, 0.02, -0.003)] * 3
    rows, _ = trace(plate(0.004), still)
    report("a start inside begins at the nearest face", abs(rows[-1]["fz"] + 1.0) < 1e-6, rows[-1]["fz"])
    lost = line((0, 0, 0.002), (0, 0, -0.003), 0.1)
    rows, _ = trace(plate(0.004), lost + [(math.nan, 0, 0)] + [(0, 0, -0.003)] * 3)
    report("so does what follows a lost sample", abs(rows[len(lost) - 1]["fz"] - 3) < 1e-6 and
           abs(rows[-1]["fz"] + 1.0) < 1e-6, rows[-1]["fz"])


def settings():
    points = line((0.01, 0.02, 0.003), (0.01, 0.02, -0.0039), 0.05)
    rows, _ = trace(plate(0.004), points, {"contact_hysteresis": 0})
    good = all(abs(r["depth"] - min(-p[2], p[2] + 0.004)) < 1e-9 and r["status"] == NEAREST for p, r in zip(points, rows))
    report("contact_hysteresis 0: the nearest face always", good)
    rows, _ = trace(plate(0.004), points, {"contact_hysteresis": 0.001})
    changed = [-p[2] for p, r in zip(points, rows) if r["fz"] < 0]
    report("contact_hysteresis 1 mm: until another face is nearer by that", changed and abs(changed[0] - 0.0025) < 1e-4)
    former, said = trace(plate(0.004), points, {"hold": 0.001})
    report("hold is the former name of contact_hysteresis", former == rows)
    report("and says so", "contact_hysteresis" in said, said)


walls()
edges()
starts()
settings()
sys.exit(1 if failures else 0)
