#!/usr/bin/env python3
"""`hapticd trace` against thin walls: a contact pushes back to the side that it was entered from.

Usage: thin_walls.py HAPTICD     prints one line per case; exit 1 when one is off.
"""
import math
import os
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "support"))
from e2e import check, finish
from traced import STIFFNESS, block, trace

HAPTICD = sys.argv[1]
NEAREST, HELD = 0, 2  # the column status


def press(thick, points, parameters=None):
    """Traces points over a plate whose top is at z = 0."""
    return trace(HAPTICD, block([-0.05, -0.05, -thick], [0.05, 0.05, 0]), [(i * 1e-3, *p) for i, p in enumerate(points)], parameters)


def line(a, b, speed, dt=1e-3):
    """Points from a to b at a speed [m/s]."""
    count = max(1, round(math.dist(a, b) / (speed * dt)))
    return [tuple(p + (q - p) * i / count for p, q in zip(a, b)) for i in range(count + 1)]


def presses(points, rows):
    """Largest error [N] of the force of a wall that pushes up from z = 0, however deep."""
    return max(max(abs(r["fz"] - STIFFNESS * max(0.0, -p[2])), abs(r["fx"]), abs(r["fy"])) for p, r in zip(points, rows))


def walls():
    points = line((0.01, 0.02, 0.003), (0.01, 0.02, -0.009), 0.05)
    rows, _ = press(0.004, points)
    check("a plate of 4 mm never pushes out of its far side", presses(points, rows) < 1e-6, presses(points, rows))
    check("the trace says held where the far side is nearer",
           all(r["status"] == (HELD if p[2] < -0.002 - 1e-9 else NEAREST) for p, r in zip(points, rows)
               if abs(p[2] + 0.002) > 1e-6))
    for thick, speed in ((0.004, 2), (0.001, 2), (0.0003, 0.5), (0.001, 10)):
        for height in (0.0031, 0.0042, 0.0057):
            points = line((0.01, 0.02, height), (0.012, 0.021, -0.03), speed)
            rows, _ = press(thick, points)
            check(f"a plate of {1e3 * thick:g} mm entered at {speed} m/s from {1e3 * height:g} mm",
                   presses(points, rows) < 1e-6, presses(points, rows))


def edges():
    points = line((0.04, 0, 0.002), (0.04, 0, -0.006), 0.1) + line((0.04, 0, -0.006), (0.07, 0, -0.006), 0.1)
    rows, _ = press(0.004, points)
    free = [r for p, r in zip(points, rows) if p[0] > 0.05 + 1e-9]
    felt = [(p, r) for p, r in zip(points, rows) if p[0] < 0.05 - 1e-9]
    check("beyond a convex edge the contact is released", all(r["contact"] == 0 and r["fz"] == 0 for r in free))
    check("and held as far as the edge", presses([p for p, _ in felt], [r for _, r in felt]) < 1e-6)


def starts():
    still = [(0.01, 0.02, -0.003)] * 3
    rows, _ = press(0.004, still)
    check("a start inside begins at the nearest face", abs(rows[-1]["fz"] + 1.0) < 1e-6, rows[-1]["fz"])
    lost = line((0, 0, 0.002), (0, 0, -0.003), 0.1)
    rows, _ = press(0.004, lost + [(math.nan, 0, 0)] + [(0, 0, -0.003)] * 3)
    check("so does what follows a lost sample", abs(rows[len(lost) - 1]["fz"] - 3) < 1e-6 and
           abs(rows[-1]["fz"] + 1.0) < 1e-6, rows[-1]["fz"])


def settings():
    points = line((0.01, 0.02, 0.003), (0.01, 0.02, -0.0039), 0.05)
    rows, _ = press(0.004, points, {"contact_hysteresis": 0})
    good = all(abs(r["depth"] - min(-p[2], p[2] + 0.004)) < 1e-9 and r["status"] == NEAREST for p, r in zip(points, rows))
    check("contact_hysteresis 0: the nearest face always", good)
    rows, _ = press(0.004, points, {"contact_hysteresis": 0.001})
    changed = [-p[2] for p, r in zip(points, rows) if r["fz"] < 0]
    check("contact_hysteresis 1 mm: until another face is nearer by that", changed and abs(changed[0] - 0.0025) < 1e-4)
    former, said = press(0.004, points, {"hold": 0.001})
    check("hold is the former name of contact_hysteresis", former == rows)
    check("and says so", "contact_hysteresis" in said, said)


walls()
edges()
starts()
settings()
finish()
