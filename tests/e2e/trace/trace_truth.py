#!/usr/bin/env python3
"""`hapticd trace` against closed forms: spheres, a plane and a box, standing, turned, and moving on a path.

Usage: trace_truth.py HAPTICD TEST_PLUGINS     prints one line per case; exit 1 when one is off.
Each case writes a scene, a model and a probe path, runs the program as a user would, and compares every row.
"""
import csv
import json
import math
import os
import sys
import tempfile

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "support"))
from e2e import check, finish, program, write
import traced

HAPTICD, TEST_PLUGINS = sys.argv[1:3]


def sphere(radius):
    """Nine by five points, rational, poles on y; the textbook surface of revolution."""
    s = math.sqrt(0.5)
    circle = [(1, 0, 1), (1, 1, s), (0, 1, 1), (-1, 1, s), (-1, 0, 1), (-1, -1, s), (0, -1, 1), (1, -1, s), (1, 0, 1)]
    meridian = [(0, -1, 1), (1, -1, s), (1, 0, 1), (1, 1, s), (0, 1, 1)]
    points, weights = [], []
    for cz, cx, wu in circle:  # u turns about y so that Su x Sv points outward
        for rho, y, wv in meridian:
            points.append([radius * rho * cx, radius * y, radius * rho * cz])
            weights.append(wu * wv)
    return {"name": "sphere", "degree": [2, 2], "knots": [[0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4], [0, 0, 0, 1, 1, 2, 2, 2]],
            "points": points, "weights": weights}


def trace(surfaces, samples, **keys):
    return traced.trace(HAPTICD, surfaces, samples, **keys)[0]


def writes_the_models_that_are_asked_for():
    with tempfile.TemporaryDirectory() as folder:
        write(folder, "ball.json", json.dumps({"format": "hapticd-model/1", "surfaces": [sphere(0.05)]}))
        scene = write(folder, "scene.yaml", "hapticd: 1\nmodels:\n" + "".join(
            f"  - {{name: {name}, plugin: nurbs_rigid, pose: {{position: [{x}, 0, 0]}}, parameters: {{geometry: ball.json}}}}\n"
            for name, x in (("left", -0.06), ("middle", 0), ("right", 0.06))))
        probe, out = write(folder, "probe.csv", "t,x,y,z\n0,0,0.06,0\n0.001,0,0.06,0\n"), os.path.join(folder, "out.csv")
        for words, names in (((), {"left", "middle", "right"}), (("--models", "right,left"), {"left", "right"}), (("--models", "middle"), {"middle"})):
            code, _, err = program(HAPTICD)("trace", scene, "--probe", probe, "--out", out, *words)
            told = {row["model"] for row in csv.DictReader(open(out))} if code == 0 else err
            check(f"{' '.join(words) or 'no --models'}: these models are written", told == names, told)
        code, _, err = program(HAPTICD)("trace", scene, "--probe", probe, "--out", out, "--models", "centre")
        check("a model that is none is named", code == 2 and 'no model "centre"' in err and "middle" in err, err)


def says_why_a_model_is_silenced():
    """The plugin answers what is no number; a trace that went on without a word would be taken for good."""
    with tempfile.TemporaryDirectory() as folder:
        scene = write(folder, "scene.yaml", "hapticd: 1\nmodels:\n  - {name: bad, plugin: misbehaving}\n")
        probe = write(folder, "probe.csv", "t,x,y,z\n" + "".join(f"{i * 1e-3},0,0.01,0\n" for i in range(100)))
        done = program(HAPTICD, dict(os.environ, HAPTICD_PLUGIN_PATH=TEST_PLUGINS))("trace", scene, "--probe", probe, "--out", os.path.join(folder, "out.csv"))
    check("a silenced model is told", done.returncode == 1 and "model bad" in done.stderr and "silenced" in done.stderr, done)


def vec(row, prefix):
    return [row[prefix + axis] for axis in "xyz"]


def norm(v):
    return math.sqrt(sum(x * x for x in v))


def report(name, worst, tolerance):
    check(name, worst <= tolerance, f"worst {worst:.3g} m, allowed {tolerance:.3g}")


def walk(radius_of, ticks=3000, dt=1e-3):
    """A path that winds over a sphere, at a distance given by time."""
    for i in range(ticks):
        t = i * dt
        a, b, r = 2.1 * t + 0.3, 1.2 * math.sin(1.7 * t), radius_of(t)
        yield [t, r * math.cos(b) * math.sin(a), r * math.sin(b), r * math.cos(b) * math.cos(a)]


def worst_of(values):
    """The largest, or not-a-number if any is: max() alone would lose it."""
    values = list(values)
    return math.nan if any(math.isnan(v) for v in values) else max(values)


def check_sphere(name, radius, rows, result, tolerance, center=lambda t: (0, 0, 0)):
    errors = []
    for sample, row in zip(rows, result):
        rel = [p - c for p, c in zip(sample[1:], center(sample[0]))]
        r = norm(rel)
        depth = radius - r
        n = [x / r for x in rel]
        foot = [c + radius * x for c, x in zip(center(sample[0]), n)]
        errors.append(abs(row["depth"] - depth))
        errors.append(norm([a - b for a, b in zip(vec(row, "p"), foot)]))
        errors.append(norm([a - b for a, b in zip(vec(row, "n"), n)]) * radius)
        force = [1000 * max(depth, 0) * x for x in n]
        errors.append(norm([a - b for a, b in zip(vec(row, "f"), force)]) / 1000)
        errors.append(0 if row["contact"] == (1 if depth > 0 else 0) or abs(depth) < 1e-9 else math.inf)
    report(name, worst_of(errors), tolerance)


def spheres(R=0.05):
    rows = list(walk(lambda t: R - 0.001 + 0.0015 * math.sin(9 * t)))
    check_sphere("sphere, in and out of contact", R, rows, trace([sphere(R)], rows), 1e-9)

    rows = list(walk(lambda t: R + 0.03 * (1 + math.sin(2 * t))))
    check_sphere("sphere from up to 60 mm outside", R, rows, trace([sphere(R)], rows), 1e-6)

    rows = [[i * 1e-3, 0, 0.0495, -0.02 + i * 4e-5] for i in range(1000)]
    # where the parameterisation is singular the tolerance of a tick is that of the step that leaves the pole
    check_sphere("straight across the pole", R, rows, trace([sphere(R)], rows), 1e-5)

    center = (0.2, -0.1, 0.05)
    rows = [[r[0]] + [x + c for x, c in zip(r[1:], center)] for r in walk(lambda t: R - 0.001)]
    q = [0.5, -0.5, 0.5, 0.5]
    moved = trace([sphere(R)], rows, pose={"position": list(center), "orientation": q})
    check_sphere("sphere moved and turned", R, rows, moved, 1e-9, lambda t: center)

    at = lambda t: (0.1 * t, 0.05 * t, 0)
    rows = [[r[0]] + [x + c for x, c in zip(r[1:], at(r[0]))] for r in walk(lambda t: R - 0.001)]
    path = [[0, 0, 0, 0, 1, 0, 0, 0], [4, 0.4, 0.2, 0, math.cos(1), 0, math.sin(1), 0]]
    moving = trace([sphere(R)], rows, path=path)
    check_sphere("sphere moving and turning on a path", R, rows, moving, 1e-9, at)

    rows = [[i * 1e-3, 0, 0, R + 0.01 + 4e-4 * i] for i in range(1000)]
    for name, keys in (("that stands", {}), ("on a path", {"path": [[0, 0, 0, 0, 1, 0, 0, 0], [1, 1e-9, 0, 0, 1, 0, 0, 0]]})):
        far = trace([sphere(R)], rows, **keys)
        errors = [0 if math.isnan(r["depth"]) else abs(r["depth"] - R + s[3]) for s, r in zip(rows, far)]
        report(f"a model {name} leaves no foot behind", worst_of(errors) if math.isnan(far[-1]["depth"]) else math.inf, 1e-6)


def out_of_reach(R=0.05):
    """A model that the tip left by a jump has no foot, so none that is not proved."""
    rows = trace([sphere(R)], [[i * 1e-3, 0, 0, R + (0.01 if i < 3 else 0.4)] for i in range(40)])
    away = [r["status"] for r in rows if math.isnan(r["depth"])]
    check("a model out of reach is not degraded", len(away) > 20 and set(away) == {0}, away)


def bad_samples(R=0.05):
    rows = list(walk(lambda t: R - 0.001))
    for bad in (700, 701, 1500):
        rows[bad] = [rows[bad][0], math.nan, 0, math.inf]
    result = trace([sphere(R)], rows)
    quiet = all(norm(vec(result[i], "f")) == 0 and result[i]["status"] < 0 for i in (700, 701, 1500))
    report("not-a-number samples give no force and a status", 0 if quiet else math.inf, 0)
    good = [i for i in range(len(rows)) if i not in (700, 701, 1500)]
    check_sphere("and every other sample is traced", R, [rows[i] for i in good], [result[i] for i in good], 1e-9)

    rows = list(walk(lambda t: R - 0.001, 400)) + [[0.4 + i * 1e-3, 0, 0, -0.0495] for i in range(200)]
    result = trace([sphere(R)], rows)
    check_sphere("found again within 5 ms of a teleport", R, rows[406:], result[406:], 1e-9)


def boxes(h=0.04):
    box = traced.block([-h] * 3, [h] * 3)
    rows = [[i * 1e-3, 0.03 * math.sin(i * 5e-3), 0.03 * math.cos(i * 3.3e-3), h - 0.001] for i in range(2000)]
    result = trace(box, rows)
    report("box face: depth and straight force", worst_of(abs(r["depth"] - 0.001) + norm([a - b for a, b in zip(vec(r, "f"), [0, 0, 1.0])]) / 1000 for r in result), 1e-9)

    def outside(p):
        return norm([max(abs(x) - h, 0) for x in p])
    rows = [[i * 1e-3, (h + 0.004) * math.cos(i * 4e-3) * 1.2, (h + 0.004) * math.sin(i * 4e-3) * 1.2, 0.01] for i in range(3140)]
    result = trace(box, rows)
    errors = [abs(outside(s[1:]) + r["depth"]) for s, r in zip(rows, result) if outside(s[1:]) > 1e-6]
    report("round the outside of a box, over its edges", worst_of(errors), 1e-6)


spheres()
out_of_reach()
bad_samples()
boxes()
writes_the_models_that_are_asked_for()
says_why_a_model_is_silenced()
finish()
