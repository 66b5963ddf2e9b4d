#!/usr/bin/env python3
"""`hapticd trace` of a tip with a radius: it feels the surface on which its centre is when the ball just touches.

Usage: ball.py HAPTICD     prints one line per case; exit 1 when one is off.
"""
import math
import os
import random
import sys
import tempfile

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "support"))
from e2e import check, finish, program, write
from traced import STIFFNESS, block, quad, trace

HAPTICD = sys.argv[1]
RADIUS = 0.003  # m
BLOCK = block([-0.05, -0.05, -0.05], [0.05, 0.05, 0])  # its top is at z = 0
WALL = block([0.02, -0.05, -0.02], [0.06, 0.05, 0.05])


def roll(surfaces, points, parameters=None, **keys):
    samples = [(i * 1e-3, *p) for i, p in enumerate(points)]
    return trace(HAPTICD, surfaces, samples, {"tip_radius": RADIUS, **(parameters or {})}, **keys)[0]


def line(a, b, count=200):
    return [tuple(p + (q - p) * i / count for p, q in zip(a, b)) for i in range(count + 1)]


def worst(rows, wanted):
    """Largest error [N] of the forces."""
    return max(math.dist((r["fx"], r["fy"], r["fz"]), force) for r, force in zip(rows, wanted))


def about_block(p):
    """Force on a ball about p by the formula of a block with round edges. p is outside of it."""
    nearest = [min(max(x, low), high) for x, low, high in zip(p, (-0.05, -0.05, -0.05), (0.05, 0.05, 0))]
    away = math.dist(p, nearest)
    return [STIFFNESS * max(RADIUS - away, 0) * (x - y) / away for x, y in zip(p, nearest)]


def convex():
    around = [(0.05 + 0.002 * math.sin(a), 0.01, 0.002 * math.cos(a)) for a in (1e-3 * i for i in range(-500, 2000))]
    rows = roll(BLOCK, around)
    check("around a sharp edge the force turns and keeps its size", worst(rows, map(about_block, around)) < 1e-4)
    chance, p, walk = random.Random(3), [0.0505, 0.0505, 0.002], []
    while len(walk) < 3000:
        q = [x + chance.gauss(0, 1e-4) - 0.01 * (x - y) for x, y in zip(p, (0.0505, 0.0505, 0.001))]
        if max(q[0] - 0.05, q[1] - 0.05, q[2]) > 5e-4:
            p = q
            walk.append(tuple(p))
    rows = roll(BLOCK, walk)
    off = sorted(worst([r], [about_block(p)]) for r, p in zip(rows, walk))
    check("so about a corner, wherever the tip goes", off[-30] < 1e-3 and off[-1] < 0.1, (off[-30], off[-1]))
    check("the ball touches in many of these ticks", sum(r["contact"] for r in rows) > 1000)


def begins_in_a_slot():
    slot = block([-0.05, -0.05, -0.02], [-0.002, 0.05, 0]) + block([0.002, -0.05, -0.02], [0.05, 0.05, 0])
    out = line((2e-4, 0, -0.015), (2e-4, 0, 0.004), 2000)
    rows = roll(slot, out)
    steps = [math.dist(*((r["fx"], r["fy"], r["fz"]) for r in pair)) for pair in zip(rows, rows[1:])]
    check("a ball that began in a slot that is too narrow comes out without a blow", max(steps) < 0.1, max(steps))
    rows = roll(slot, out + line(out[-1], (0.02, 0, 0.004)) + line((0.02, 0, 0.004), (0.02, 0, 0.001)))
    check("and is felt from then on", abs(rows[-1]["fz"] - STIFFNESS * 0.002) < 1e-6, rows[-1]["fz"])


def concave():
    points = line((0.01, 0, 0.01), (0.0185, 0, 0.001)) + line((0.0185, 0, 0.001), (0.0185, 0.01, -0.002))
    rows = roll(BLOCK + WALL, points)
    wanted = [[-STIFFNESS * max(x - 0.02 + RADIUS, 0), 0, STIFFNESS * max(RADIUS - z, 0)] for x, _, z in points]
    check("in the corner of a wall both faces push", worst(rows, wanted) < 1e-4, worst(rows, wanted))
    left, right = block([-0.05, -0.05, -0.05], [-0.002, 0.05, 0]), block([0.002, -0.05, -0.05], [0.05, 0.05, 0])
    points = line((3e-4, 0, 0.006), (3e-4, 0, -0.004))
    height = math.sqrt(RADIUS ** 2 - 0.002 ** 2)
    rows = roll(left + right, points)
    check("a ball of 6 mm stays above a slot of 4 mm", abs(rows[-1]["fz"] - STIFFNESS * (height + 0.004)) < 1e-3, rows[-1]["fz"])
    points = line((3e-4, 0, 0.006), (3e-4, 0, -0.02))
    check("a ball of 3 mm goes in", all(r["contact"] == 0 for r in roll(left + right, points, {"tip_radius": 0.0015})))


def groove():
    """A groove of 20 degrees, and a ball that is drawn along it, pressed 1 mm down."""
    d, x = 0.03, 0.03 * math.tan(math.radians(10))
    walls = [quad([-x, d, 0.05], [x, -d, 0], [0, 0, -0.1], "left"), quad([0, 0, 0.05], [x, d, 0], [0, 0, -0.1], "right")]
    rest = RADIUS / math.sin(math.radians(10))
    points = line((0, rest + 0.002, 0), (0, rest - 0.001, 0), 300)
    points += [(2e-5 * math.sin(0.01 * i), rest - 0.001, 1e-5 * i) for i in range(1, 1000)]
    rows = roll(walls, points, {"texture": {"amplitude": 1e-5, "wavelength": 0.002}})[310:]
    check("of two walls that push alike, the same one counts in each tick", len({r["feature"] for r in rows}) == 1)
    jump = max(math.dist((a["fx"], a["fy"], a["fz"]), (b["fx"], b["fy"], b["fz"])) for a, b in zip(rows, rows[1:]))
    check("so bumps do not make the force flicker", jump < 1e-3, jump)


def shells():
    sheet = [quad([-0.05, -0.05, 0], [0.1, 0, 0], [0, 0.1, 0], "sheet")]
    for side in (1, -1):
        points = line((0, 0, side * 0.006), (0, 0, side * -0.004))
        wanted = [[0, 0, side * STIFFNESS * max(RADIUS - side * z, 0)] for _, _, z in points]
        check(f"a sheet keeps a ball on the side {side:+d}", worst(roll(sheet, points, {"sides": "both"}), wanted) < 1e-6)
    around = [(0.05 + 0.002 * math.sin(a), 0, 0.002 * math.cos(a)) for a in (1e-3 * i for i in range(0, 3141))]
    wanted = [[STIFFNESS * 1e-3 * math.sin(a), 0, STIFFNESS * 1e-3 * math.cos(a)] for a in (1e-3 * i for i in range(0, 3141))]
    check("its free rim is round", worst(roll(sheet, around, {"sides": "both"}), wanted) < 1e-4)


def states():
    points = line((0, 0, 0.006), (0, 0, 0.001))
    rows = roll(BLOCK, points + [(math.nan, 0, 0)] + [(0, 0, 0.001)] * 60)
    check("a lost sample gives no force", rows[len(points)]["fz"] == 0)
    check("and then the ball is where the tip is", abs(rows[-1]["fz"] - 2) < 1e-9, rows[-1]["fz"])
    rows = roll(BLOCK, [(0, 0, 0.01)] * 200, path=[(0, 0, 0, 0, 1, 0, 0, 0), (0.1, 0, 0, 0.009, 1, 0, 0, 0), (0.2, 0, 0, 0.009, 1, 0, 0, 0)])
    check("a block that comes to a ball pushes it", abs(rows[-1]["fz"] - 2) < 1e-9, rows[-1]["fz"])
    rows = roll(BLOCK, line((0, 0, 0.006), (0, 0, -0.006)))
    check("deeper than the radius the contact is held", all(r["status"] == (2 if r["depth"] > RADIUS + 1e-9 else 0) for r in rows
                                                           if abs(r["depth"] - RADIUS) > 1e-9))
    rows = roll(BLOCK, [(0, 0, 0.01)] * 3)
    check("the depth outside is minus the gap", abs(rows[0]["depth"] + 0.007) < 1e-12, rows[0]["depth"])


def boxes(*corners):
    """The text of an OBJ file with a box from each pair of corners."""
    faces, text = ((0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)), ""
    for number, (low, high) in enumerate(corners):
        text += f"o box{number}\n" + "".join(f"v {x} {y} {z}\n" for x in (low[0], high[0]) for y in (low[1], high[1]) for z in (low[2], high[2]))
        text += "".join("f " + " ".join(str(8 * number + i + 1) for i in face) + "\n" for face in faces)
    return text


def bodies_that_touch():
    """A block stands on a plate. A point that presses on the plate is below the block, a small ball rests against both."""
    points = line((0, 0, 0.005), (0, 0, -0.001)) + line((0, 0, -0.001), (0.03, 0, -0.001), 1000)
    radius = 2e-4
    with tempfile.TemporaryDirectory() as folder:
        write(folder, "two.obj", boxes(((-0.05, -0.05, -0.05), (0.05, 0.05, 0)), ((0.02, -0.05, 0), (0.05, 0.05, 0.03))))
        part = os.path.join(folder, "two.hpart")
        code, _, err = program(HAPTICD)("import", os.path.join(folder, "two.obj"), "--scale", "1", "-o", part)
        check("two boxes are a part", code == 0, err)
        rows = roll([], points, {"geometry": part, "tip_radius": radius})
    wanted = [[-STIFFNESS * max(x - 0.02 + radius, 0), 0, STIFFNESS * max(radius - z, 0)] for x, _, z in points]
    check("a small ball on a plate is stopped by the block that stands on it", worst(rows, wanted) < 1e-3, worst(rows, wanted))


def search():
    points = line((0, 0, 0.06), (0, 0, 0.01), 1000)
    rows = roll(BLOCK, points, {"tip_radius": 0.05}, servo={"activation_radius": 0.01, "hysteresis": 0.005})
    wanted = [[0, 0, STIFFNESS * max(0.05 - z, 0)] for _, _, z in points]
    check("a ball that is larger than the activation radius touches when it should", worst(rows, wanted) < 1e-6, worst(rows, wanted))
    corner = [quad([0, 0, -0.2], [0, 0, 0.4], [0.3, 0, 0], "floor"), quad([0, 0, -0.2], [0, 0.3, 0], [0, 0, 0.4], "wall")]
    points = line((0.05, 0.01, 0), (0.05, -0.04, 0)) + line((0.05, -0.04, 0), (-0.02, -0.04, 0))
    rows = roll(corner, points, servo={"activation_radius": 0.01, "hysteresis": 0.002})
    wanted = [[STIFFNESS * max(RADIUS - x, 0), STIFFNESS * max(RADIUS - y, 0), 0] for x, y, _ in points]
    check("a ball pressed deeper than the activation radius meets a wall on its way", worst(rows, wanted) < 1e-6, worst(rows, wanted))


convex()
concave()
groove()
bodies_that_touch()
begins_in_a_slot()
shells()
states()
search()
finish()
