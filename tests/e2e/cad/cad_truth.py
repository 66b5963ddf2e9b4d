#!/usr/bin/env python3
"""CAD files through `hapticd import` and `hapticd trace`, against closed forms of their distances.

Usage: cad_truth.py HAPTICD MAKE_PARTS     prints one line per case; exit 1 when one is off.
Every case imports a file, traces random points outside and in fresh contact, and compares depth, foot and normal.
"""
import csv
import json
import math
import os
import random
import subprocess
import sys
import tempfile

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "support"))
from e2e import LONG, check, finish, program

HAPTICD, MAKE_PARTS = sys.argv[1:3]
run = program(HAPTICD, timeout=800)
MM = 1e-3
HOLES = 58 if LONG else 24  # a row of the plate, see make_parts.cpp
folder = tempfile.mkdtemp(prefix="hapticd-cad-")
join = lambda name: os.path.join(folder, name)


# Distances to closed bodies, negative inside [mm].
def box(lo, hi):
    def distance(p):
        d = [max(a - x, x - b) for x, a, b in zip(p, lo, hi)]
        return math.hypot(*[max(x, 0) for x in d]) + min(max(d), 0)
    return distance


def turned(profile):
    """A body about z by its half-plane (r, z)."""
    return lambda p: profile(math.hypot(p[0], p[1]), p[2])


def rectangle(r, z0, z1):
    return lambda x, z: box([-r, z0], [r, z1])([x, z])


def segment(p, a, b):
    ab, ap = [y - x for x, y in zip(a, b)], [y - x for x, y in zip(a, p)]
    t = min(max(sum(x * y for x, y in zip(ab, ap)) / sum(x * x for x in ab), 0), 1)
    return math.hypot(*[y - t * x for x, y in zip(ab, ap)])


def polygon(corners):
    """A polygon's distance in its plane, negative inside."""
    def distance(p):
        edges = list(zip(corners, corners[1:] + corners[:1]))
        inside = False
        for a, b in edges:
            if (a[1] > p[1]) != (b[1] > p[1]) and p[0] < a[0] + (p[1] - a[1]) / (b[1] - a[1]) * (b[0] - a[0]):
                inside = not inside
        nearest = min(segment(p, a, b) for a, b in edges)
        return -nearest if inside else nearest
    return distance


def prism(profile, z0, z1):
    def distance(p):
        d, e = profile(p[:2]), max(z0 - p[2], p[2] - z1)
        return math.hypot(max(d, 0), max(e, 0)) + min(max(d, e), 0)
    return distance


def cone(p):
    return polygon([(-10, 0), (10, 0), (0, 20)])((math.hypot(p[0], p[1]), p[2]))


def three_quarters(p):
    """The cylinder of 10 mm without its fourth quarter of the turn: arcs, and the two flat sides of the gap."""
    def profile(q):
        a = math.atan2(q[1], q[0]) % (2 * math.pi)
        r = math.hypot(*q)
        sides = min(segment(q, (0, 0), (10, 0)), segment(q, (0, 0), (0, -10)))
        if a <= 1.5 * math.pi:
            return r - 10 if r > 10 else -min(10 - r, sides)
        return sides
    return prism(profile, 0, 20)(p)


def plate(p):
    """Outside of the plate above its holes, and in the bores."""
    profile = box([0, 0], [100, 100])(p[:2])
    i, j = (min(max(round((p[k] - 4) / 1.6), 0), last) for k, last in ((0, HOLES - 1), (1, HOLES - 2)))
    hole = 0.6 - math.hypot(p[0] - 4 - 1.6 * i, p[1] - 4 - 1.6 * j)
    return prism(lambda _: max(profile, hole), 0, 5)(p)


def spline_hole(p):
    return prism(lambda q: max(box([-20, -20], [20, 20])(q), 5 - math.hypot(*q)), 0, 5)(p)


def sheet(curve, z0, z1, samples=4000):
    """Distance to a curve (x, y) swept along z, never negative, by samples and a golden search between them."""
    def distance(p):
        at = lambda t: math.dist(curve(t), p[:2])
        best = min(range(samples + 1), key=lambda i: at(i / samples))
        a, b = max(best - 1, 0) / samples, min(best + 1, samples) / samples
        for _ in range(100):
            c, d = b - 0.618033988749895 * (b - a), a + 0.618033988749895 * (b - a)
            a, b = (a, d) if at(c) < at(d) else (c, b)
        return math.hypot(at((a + b) / 2), max(z0 - p[2], p[2] - z1, 0))
    return distance


def imported(name, *arguments):
    """Imports a file and returns the report."""
    part = join(name.replace(".", "_") + ".hpart")
    code, out, err = run("import", join(name), "-o", part, "--json", *arguments)
    if not check(f"{name} is imported", code == 0, out + err):
        finish()
    return part, json.loads(out)


def trace(part, points, parameters=None, fresh=True):
    """One row a point [mm]; if fresh, the probe is far away between two of them, so that every contact is new."""
    far = 10 * max(abs(x) for p in points for x in p) + 1000
    rows = [q for p in points for q in ([far, far, far], p)] if fresh else points
    scene = {"hapticd": 1, "models": [{"name": "part", "plugin": "nurbs_rigid", "parameters": {"geometry": part, "stiffness": 1000, **(parameters or {})}}]}
    with open(join("scene.yaml"), "w") as out:
        json.dump(scene, out)
    with open(join("probe.csv"), "w") as out:
        out.write("t,x,y,z\n")
        out.writelines(f"{i * 1e-3!r}," + ",".join(repr(x * MM) for x in q) + "\n" for i, q in enumerate(rows))
    done = subprocess.run([HAPTICD, "trace", join("scene.yaml"), "--probe", join("probe.csv"), "--out", join("out.csv")], capture_output=True, text=True, timeout=600)
    if done.returncode != 0:
        raise RuntimeError(done.stderr)
    with open(join("out.csv")) as file:
        return [{k: (v if k == "model" else float(v)) for k, v in row.items()} for row in csv.DictReader(file)][1 if fresh else 0::2 if fresh else 1]


def near(distance, lo, hi, count, inside, outside):
    """Random points of a box of which the distance is between -inside and outside."""
    source = random.Random(7)
    points = []
    while len(points) < count:
        p = [source.uniform(a, b) for a, b in zip(lo, hi)]
        if -inside <= distance(p) <= outside:
            points.append(p)
    return points


def compare(name, part, distance, points, tolerance=1e-9, signed=True):
    rows = trace(part, points)
    depth = foot = side = 0.0
    for p, row in zip(points, rows):
        d = distance(p) * MM
        depth = max(depth, abs(-row["depth"] - d) if signed else abs(abs(row["depth"]) - d))
        q = [row["p" + a] for a in "xyz"]
        foot = max(foot, abs(math.dist(q, [x * MM for x in p]) - abs(d)))
        if signed and abs(d) > 1e-9:  # outward, from the foot to a probe outside
            way = [x * MM - y for x, y in zip(p, q)]
            n = [row["n" + a] for a in "xyz"]
            side = max(side, math.dist([x / d for x in way], n))
    good = depth <= tolerance and foot <= tolerance and side <= max(1e-5, 1e4 * tolerance)
    check(f"{name}: depth {depth:.2g} m, foot {foot:.2g} m, normal {side:.2g}", good, f"allowed {tolerance:g} m")


def closed(name, distance, lo, hi, inside=0.4, outside=8, count=1500, tolerance=1e-9):
    part, told = imported(name)
    check(f"{name}: nothing is lost", not told["losses"], told["losses"])
    compare(name, part, distance, near(distance, lo, hi, count, inside, outside), tolerance)
    return told


def info(part):
    return json.loads(run("part", "info", part, "--json")[1])


def solids():
    block = box([-20, -15, -10], [20, 15, 10])
    told = closed("box.step", block, [-30] * 3, [30] * 3)
    check("a box has 6 planes and 12 edges", told["face_kinds"] == {"plane": 6} and told["edges"] == 12, told)
    closed("inch.step", box([0] * 3, [25.4] * 3), [-10] * 3, [35] * 3)
    check("an inch is an inch", imported("inch.step")[1]["unit"] == "in")
    closed("cylinder.step", turned(rectangle(10, 0, 20)), [-15, -15, -5], [15, 15, 25])
    closed("mirrored.brep", turned(rectangle(10, -20, 0)), [-15, -15, -25], [15, 15, 5])
    told = closed("inside_out.brep", turned(rectangle(10, 0, 20)), [-15, -15, -5], [15, 15, 25])
    closed("sphere.step", lambda p: math.hypot(*p) - 20, [-25] * 3, [25] * 3)
    closed("cone.step", cone, [-15, -15, -5], [15, 15, 25])
    closed("torus.step", turned(lambda r, z: math.hypot(r - 20, z) - 5), [-30, -30, -8], [30, 30, 8])
    closed("three_quarters.step", three_quarters, [-14, -14, -4], [14, 14, 24])
    bracket = prism(polygon([(0, 0), (40, 0), (40, 10), (10, 10), (10, 40), (0, 40)]), 0, 10)
    told = closed("bracket.step", bracket, [-8, -8, -8], [48, 48, 18])
    told = closed("coplanar.step", box([0] * 3, [40, 10, 10]), [-8] * 3, [48, 18, 18])
    closed("spline_hole.step", spline_hole, [-25, -25, -5], [25, 25, 10])
    told = closed("plate.step", plate, [3, 3, -2], [36, 36, 7], inside=0.05, outside=2)
    holes = HOLES * (HOLES - 1)
    check(f"the plate has {holes} holes", told["face_kinds"] == {"cylinder": holes, "plane": 6}, told)
    check("it was not checked for ever", "more than 200 loops" in " ".join(told["steps"]), told["steps"])


def on_axes_and_poles():
    """Points where parameters end: axes, poles, centres."""
    part, _ = imported("sphere.step")
    ball = lambda p: math.hypot(*p) - 20
    compare("straight above and below the poles", part, ball, [[0, 0, s * h] for s in (-1, 1) for h in (19.9, 20.1, 25)])
    rows = trace(part, [[0, 0, 0], [1e-9, 0, 0]])
    check("at the centre it is 20 mm deep", all(abs(r["depth"] - 0.02) < 1e-9 for r in rows), rows)
    part, _ = imported("cone.step")
    compare("above the apex", part, cone, [[0, 0, z] for z in (20.001, 21, 30)] + [[1e-6, 0, 20.5]])
    part, _ = imported("cylinder.step")
    compare("on the axis", part, turned(rectangle(10, 0, 20)), [[0, 0, z] for z in (-3, 0.2, 19.8, 23)])


def disguised():
    told = closed("spline_box.step", box([-20, -15, -10], [20, 15, 10]), [-30] * 3, [30] * 3)
    check("spline faces of a box are planes", told["face_kinds"] == {"plane": 6} and told["recognised"] == 6, told["face_kinds"])
    told = closed("spline_cylinder.step", turned(rectangle(10, 0, 20)), [-15, -15, -5], [15, 15, 25])
    check("those of a cylinder too", told["face_kinds"] == {"cylinder": 1, "plane": 2}, told["face_kinds"])


def quarter_ball(p):
    """Distance to a quarter of a ball of 20 mm, y and z positive."""
    x, y, z = p
    if min(y, z) <= 0 and math.hypot(x, max(y, 0), max(z, 0)) <= 20:
        return math.hypot(min(y, 0), min(z, 0))
    if y >= 0 and z >= 0:
        r = math.hypot(*p) - 20
        return r if r > 0 else max(r, -y, -z)
    flat = math.hypot(x, max(y, 0), max(z, 0))  # beyond the rim, outside of a flat side
    return math.hypot(flat - 20, min(y, 0), min(z, 0))


def to_the_poles():
    """Edges that end where the sphere that a spline is has its poles."""
    closed("spline_quarter.brep", quarter_ball, [-24, -4, -4], [24, 24, 24], outside=4, count=3000, tolerance=2e-9)
    part, _ = imported("spline_quarter.brep")
    compare("near both ends of the edges", part, quarter_ball, near(quarter_ball, [-23, -0.5, -0.5], [-18, 3, 3], 800, 0.4, 3), 2e-9)


def sheets():
    loose, told = imported("loose.brep")
    check("six loose faces are sewn to a solid", info(loose)["bodies"][0]["kind"] == "solid" and "sewn" in " ".join(told["steps"]), told)
    block = box([-20, -15, -10], [20, 15, 10])
    compare("loose.brep", loose, block, near(block, [-30] * 3, [30] * 3, 500, 0.4, 8))
    part, told = imported("box.iges")
    check("a box of IGES is closed", info(part)["bodies"][0]["closed"], told)
    compare("box.iges", part, block, near(block, [-30] * 3, [30] * 3, 500, 0.4, 8))
    hollow = lambda p: max(box([0] * 3, [40] * 3)(p), -box([10] * 3, [30] * 3)(p))
    told = closed("loose_cavity.brep", hollow, [-5] * 3, [45] * 3)
    check("a closed shell in another one is its cavity", "1 solid with 1 cavity" in " ".join(told["steps"]), told["steps"])
    hole = turned(rectangle(5, -100, 100))
    plate_and_pin = lambda p: min(max(box([0] * 3, [40, 40, 10])(p), -hole([p[0] - 20, p[1] - 20, p[2]])),
                                  turned(rectangle(5, 10, 20))([p[0] - 20, p[1] - 20, p[2]]))
    told = closed("pin_on_rim.iges", plate_and_pin, [10, 10, 1], [30, 30, 22], outside=3, tolerance=2e-8)
    check("parts of IGES that touch do not grow together", told["bodies"] == 2 and "2 solids" in " ".join(told["steps"]), told)
    for name, curve, lo, hi in (
            ("trough.brep", lambda t: (20 * t - 10, (20 * t - 10)**2 / 10), [-14, -4, 1], [14, 14, 19]),
            ("shell_off.brep", lambda t: (12 * math.cos(t * math.pi / 2), 12 * math.sin(t * math.pi / 2)), [1, 1, 1], [16, 16, 19])):
        part, told = imported(name)
        distance = sheet(curve, 0, 20)
        check(f"{name} is open", not info(part)["bodies"][0]["closed"])
        compare(name, part, distance, near(distance, lo, hi, 150, 0, 4), 2e-9, signed=False)
    distance = lambda p: min(segment((p[0], p[2]), (0, 0), (s * 10, 10)) for s in (-1, 1))
    for name, what in (("roof.brep", "over the crease of one face"), ("roof_of_degree_20.brep", "over a crease of too high a degree")):
        part, _ = imported(name)
        compare(what, part, distance, near(distance, [-5, 1, -3], [5, 19, 6], 300, 0, 3), signed=False)


def without_volume():
    """Two faces on one another have no inside: a force from behind one of them would pull the probe in."""
    cap = lambda p: abs(math.hypot(*p) - 10) if p[2] > 0 else math.hypot(math.hypot(p[0], p[1]) - 10, p[2])
    for name in ("no_volume.brep", "no_volume_shell.brep"):
        part, told = imported(name)
        check(f"{name} is told", "1 face lies on another one" in " ".join(told["warnings"]), told)
        check(f"{name} is no solid", info(part)["bodies"][0]["kind"] == "shell", info(part)["bodies"])
        compare(name, part, cap, near(cap, [-12, -12, 1], [12, 12, 13], 300, 0, 3), signed=False)
        for way, path in ((1, range(130, 60, -1)), (-1, range(70, 130))):
            rows = trace(part, [[0, 0, z / 10] for z in path], fresh=False)
            pushes = [way * r["fz"] for r in rows if r["contact"]]
            check(f"{name} pushes back {'from above' if way > 0 else 'from below'}", pushes and min(pushes) >= 0, rows)


def assemblies():
    part, told = imported("assembly.step")
    what = info(part)
    names = [i["name"] for i in what["instances"]]
    check("names of the assembly and its instances", names == ["pair", "left", "right"], names)
    check("one body, twice", len(what["bodies"]) == 1 and told["instances"] == 2 and what["bodies"][0]["name"] == "block", what["bodies"])
    both = lambda p: min(box([0] * 3, [10] * 3)(p), box([30, 0, 0], [40, 10, 10])(p))
    compare("both instances", part, both, near(both, [-5] * 3, [45, 15, 15], 800, 0.4, 5))
    right = box([30, 0, 0], [40, 10, 10])
    points = near(right, [20, -5, -5], [45, 15, 15], 300, 0.4, 5)
    rows = trace(part, points, {"instance": "right"})
    check("one of them alone", all(abs(-r["depth"] - right(p) * MM) < 1e-9 for p, r in zip(points, rows)))


def check_only():
    code, out, err = run("import", join("box.step"), "--check")
    check("--check says what would be lost", code == 0 and "nothing was lost" in out and "6 faces in 1 body" in out, out + err)
    code, out, err = run("import", join("box.step"), "-o", join("box.yaml"))
    check("a part has its ending", code == 2 and "expected a name that ends in .hpart" in err, err)


subprocess.run([MAKE_PARTS, folder], check=True, timeout=300)
for part_of_the_test in (check_only, solids, on_axes_and_poles, disguised, to_the_poles, sheets, without_volume, assemblies):
    part_of_the_test()
finish()
