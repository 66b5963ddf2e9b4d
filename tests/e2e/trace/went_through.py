#!/usr/bin/env python3
"""`hapticd trace` of bodies that are carried over a hand that rests: once the hand is behind a body, it is not pulled along.

Usage: went_through.py HAPTICD     prints one line per case; exit 1 when one is off.
"""
import os
import sys
import tempfile

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "support"))
from e2e import check, finish, program, write
from traced import block, quad, trace

HAPTICD = sys.argv[1]
HELD = 0.1  # m; without an arm, no contact that is deeper is held beyond the far side
SPEED = 0.2  # m/s


def carried(surfaces, parameters=None):
    """Carries a model along x over a probe at the origin, from 0.2 m before it to 0.2 m beyond."""
    path = [(t, -0.2 + SPEED * t, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0) for t in (0.0, 2.0)]
    return trace(HAPTICD, surfaces, [(1e-3 * i, 0.0, 0.0, 0.0) for i in range(2001)], parameters, path)[0]


def pushes(name, rows, thickness):
    """@param thickness [m] way of the body from its first to its last touch of the probe"""
    felt = [row for row in rows if row["fx"] != 0]
    way = SPEED * (felt[-1]["t"] - felt[0]["t"]) if felt else 0
    check(f"{name} pushes along its way alone", felt and min(row["fx"] for row in felt) > 0)
    check(f"{name} is let go", abs(way - max(thickness, HELD)) < 2e-3, f"pushed along {1e3 * way:.1f} mm")


def slabs(folder, thick):
    """Imports a part: a slab that ends at x = 0, and another one 0.3 m behind it, which the hand never meets."""
    corners = [(x, y, z) for x in (-thick, 0.0) for y in (-0.03, 0.03) for z in (-0.03, 0.03)]
    faces = [(1, 2, 4, 3), (5, 7, 8, 6), (1, 5, 6, 2), (3, 4, 8, 7), (1, 3, 7, 5), (2, 6, 8, 4)]
    text = "".join(f"v {x - away} {y} {z}\n" for away in (0.0, 0.3) for x, y, z in corners)
    text += "".join("f " + " ".join(str(at + 8 * i) for at in face) + "\n" for i in (0, 1) for face in faces)
    mesh, part = write(folder, "slabs.obj", text), os.path.join(folder, "slabs.hpart")
    code, _, err = program(HAPTICD)("import", mesh, "--scale", "1", "-o", part)
    assert code == 0, err
    return part


for thick in (0.004, 0.08, 0.12):
    slab = block([-thick, -0.03, -0.03], [0.0, 0.03, 0.03])
    pushes(f"a slab of {1e3 * thick:g} mm", carried(slab), thick)
    for radius in (0.002, 0.01):
        pushes(f"a slab of {1e3 * thick:g} mm against a ball of {1e3 * radius:g} mm", carried(slab, {"tip_radius": radius}), thick + 2 * radius)
    with tempfile.TemporaryDirectory() as folder:
        part = slabs(folder, thick)
        for radius in (0.0, 0.01):
            rows = carried([], {"geometry": part, "tip_radius": radius})
            pushes(f"a part of slabs of {1e3 * thick:g} mm, a tip of {1e3 * radius:g} mm", rows, thick + 2 * radius)
pushes("a sheet", carried([quad([0.0, -0.03, -0.03], [0, 0.06, 0], [0, 0, 0.06], "sheet")], {"sides": "both"}), 0)

# A body whose path jumps leaves the probe at once, 60 mm away. Its surface gave back what was pressed, so nobody is blamed.
slab, x = block([-0.08, -0.03, -0.03], [0.0, 0.03, 0.03]), ((0.0, -0.01), (1.0, 0.008), (1.001, -0.06), (2.0, -0.06))
samples, path = [(1e-3 * i, 0.0, 0.0, 0.0) for i in range(2001)], [(t, at, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0) for t, at in x]
rows = trace(HAPTICD, slab, samples, None, path)[0]
check("a slab that jumps away pushed until then", abs(max(row["fx"] for row in rows) - 8) < 0.1 and rows[-1]["fx"] == 0)
finish()
