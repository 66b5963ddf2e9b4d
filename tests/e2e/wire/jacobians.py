#!/usr/bin/env python3
"""Forces and torques at the tip of each arm that ships become joint torques with the right sign and size, joint by joint: they are compared with
differences of the tip that the same program computes.

Usage: jacobians.py HAPTICD SOURCE_DIR       exit 1 when one is off
"""
import glob
import os
import random
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "support"))
from e2e import check, finish
from wire import fed, table_of

run = fed(sys.argv[1], "device", "kinematics")
STEP = 1e-5  # [rad]


def turned(a, b):
    """The small rotation [rad] from the unit quaternion a to b: twice the vector part of b times the conjugate of a."""
    (aw, ax, ay, az), (w, x, y, z) = a, b
    sign = 1 if aw * w + ax * x + ay * y + az * z > 0 else -1
    return [2 * sign * v for v in (-w * ax + x * aw - y * az + z * ay, -w * ay + y * aw - z * ax + x * az, -w * az + z * aw - x * ay + y * ax)]


def names(arm):
    """The names of its joints, as a wrong header makes the program tell them."""
    code, out, err = run(arm, "--joints", "-", given=b"none\n0\n")
    return err.split("expected ")[1].split(" or ")[0].strip().split(",")


random.seed(7)
arms = sorted(glob.glob(os.path.join(sys.argv[2], "config", "devices", "*.yaml")))
check("there are arms", len(arms) >= 8, arms)
for arm in arms:
    joints = names(arm)
    at = [random.uniform(0.2, 0.6) for _ in joints]
    wrench = [random.uniform(-1, 1) for _ in range(6)]
    rows = [at] + [[q + (STEP * sign if i == j else 0) for i, q in enumerate(at)] for j in range(len(joints)) for sign in (1, -1)]
    text = ",".join([*joints, "fx", "fy", "fz", "tx", "ty", "tz"]) + "\n" + "".join(",".join(map(repr, row + wrench)) + "\n" for row in rows)
    code, out, err = run(arm, "--joints", "-", given=text.encode())
    table = table_of(out)
    if not check(f"{os.path.basename(arm)}: has a row for each pose", len(table) == len(rows), (code, err)):
        continue
    tips = [[float(row[axis]) for axis in "xyz"] for row in table]
    turns = [[float(row[part]) for part in ("qw", "qx", "qy", "qz")] for row in table]
    for j, name in enumerate(joints):
        after, before = 1 + 2 * j, 2 + 2 * j
        moved = [(a - b) / (2 * STEP) for a, b in zip(tips[after], tips[before])] + [v / (2 * STEP) for v in turned(turns[before], turns[after])]
        expected = sum(m * w for m, w in zip(moved, wrench))
        check(f"{os.path.basename(arm)}: the torque of {name} is that of the wrench", abs(float(table[0]["tau" + name[1:]]) - expected) < 1e-8,
              (table[0], expected))
finish()
