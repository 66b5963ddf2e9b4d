#!/usr/bin/env python3
"""`hapticd trace` with method: dpt far from a surface, beyond the centres of its curvature: there its steps lead away from the foot.

Usage: dpt.py HAPTICD SOURCE_DIR     prints one line per case; exit 1 when one is off.
"""
import math
import os
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "support"))
from e2e import check, finish
from traced import STIFFNESS, trace

HAPTICD, SOURCE = sys.argv[1:]
TICKS = 4000


def way():
    """A way round an axis, up and down, near to it and away from it."""
    for i in range(TICKS):
        a = 2 * math.pi * i / TICKS
        r = 0.05 + 0.02 * math.sin(5 * a)
        yield 1e-3 * i, r * math.cos(a), -0.04 + 0.08 * i / TICKS, r * math.sin(a)


for model in ("goblet", "torus", "sphere", "cylinder", "teapot"):
    newton, dpt = ([(r["contact"], (r["fx"], r["fy"], r["fz"]), r["depth"]) for r in
                    trace(HAPTICD, [], list(way()), {"geometry": f"{SOURCE}/config/models/{model}.yaml", "method": method})[0]]
                   for method in ("newton", "dpt"))
    near = 2e-4  # m; a foot of dpt lags behind
    outside = [d for n, d in zip(newton, dpt) if n[2] < -near]
    check(f"{model}: outside there is no force", all(math.hypot(*force) < STIFFNESS * near for _, force, _ in outside),
          max(math.hypot(*force) for _, force, _ in outside))
    inside = [(n, d) for n, d in zip(newton, dpt) if n[2] > near]
    check(f"{model}: inside there is a force", all(d[0] == 1 for _, d in inside), sum(d[0] != 1 for _, d in inside))
finish()
