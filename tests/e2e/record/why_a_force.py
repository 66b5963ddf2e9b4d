#!/usr/bin/env python3
"""`hapticd explain RECORDING` says why the greatest force, or with --at that of another time, is what it is: the models, friction,
and what the limits took away.

Usage: why_a_force.py HAPTICD SOURCE     prints one line per case; exit 1 when one is off.
"""
import csv
import math
import os
import re
import subprocess
import sys
import tempfile

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "support"))
from e2e import check, finish

HAPTICD, SOURCE = sys.argv[1], sys.argv[2]
LIMIT = 1.5  # N
ARM = f"""hapticd-device: 1
module: simulated
name: weak
mount: {{position: [0, 0, 0.09]}}
limits: {{force: {LIMIT}}}
"""
# The hand strokes the sphere deeper than the arm can push; two models in one place share the press.
SCENE = f"""hapticd: 1
device: weak.yaml
hand: {{script: stroke, center: [0, 0, -0.09], normal: [0, 0, 1], radius: 0.044, rate: 0.5}}
models:
  - {{name: rough, plugin: nurbs_rigid, parameters: {{geometry: {SOURCE}/config/models/sphere.yaml, stiffness: 400, friction_static: 0.6, friction_dynamic: 0.5}}}}
  - {{name: smooth, plugin: nurbs_rigid, parameters: {{geometry: {SOURCE}/config/models/sphere.yaml, stiffness: 200, damping: 2}}}}
"""
NUMBER = r"([-+.e\d]+)"


def hapticd(*arguments):
    done = subprocess.run([HAPTICD, *arguments], cwd=folder, capture_output=True, text=True, timeout=100)
    return done.returncode, done.stdout, done.stderr


def rows(name):
    return list(csv.DictReader(open(os.path.join(folder, "tables", name))))


def size(row, prefix):
    return math.sqrt(sum(float(row[prefix + axis]) ** 2 for axis in "xyz"))


def near(text, truth):
    return abs(float(text) - truth) <= 6e-3 * abs(truth) + 1e-3


def explained(tick, text):
    """The lines of one tick against its rows in the tables."""
    t, of_arm = float(tick["t"]), re.search(rf"weak got {NUMBER} N .* at {NUMBER} s\n", text)
    check(f"{t:g} s: the force that the arm got", of_arm and near(of_arm[1], size(tick, "arm0_sent_f")) and near(of_arm[2], t), text)
    for name in ("rough", "smooth"):
        row = next(row for row in contacts if row["tick"] == tick["tick"] and model[row["model"]] == name)
        line = re.search(rf"  {name}: {NUMBER} N .*, {NUMBER} mm deep at feature (\d+)(.*)", text)
        check(f"{t:g} s: {name} with its depth and feature", line and near(line[1], size(row, "f")) and near(line[2], 1e3 * float(row["depth"]))
              and line[3] == row["feature"], text)
        out = sum(float(row["f" + axis]) * float(row["n" + axis]) for axis in "xyz")
        along = math.sqrt(max(size(row, "f") ** 2 - out ** 2, 0))
        parts = re.search(rf"; {NUMBER} N of it out of the surface, {NUMBER} N along it", line[4] if line else "")
        check(f"{t:g} s: {name} along the surface", (parts and near(parts[1], out) and near(parts[2], along)) if along > 2e-3 else not parts, text)
    asked = re.search(rf"  together they ask for {NUMBER} N .*, which the limits", text)
    differ = math.dist(*([float(tick[prefix + axis]) for axis in "xyz"] for prefix in ("arm0_f", "arm0_sent_f")))
    if abs(differ - 1e-3) > 1e-4:
        check(f"{t:g} s: what the limits took away", near(asked[1], size(tick, "arm0_f")) if asked and differ > 1e-3 else not asked, text)


with tempfile.TemporaryDirectory() as folder:
    open(os.path.join(folder, "weak.yaml"), "w").write(ARM)
    open(os.path.join(folder, "scene.yaml"), "w").write(SCENE)
    code, out, err = hapticd("run", "scene.yaml", "--for", "4", "--virtual-time", "--record", "run.h5")
    check("a run", code == 0, out + err)
    hapticd("export", "run.h5", "--csv", "tables")
    ticks, contacts = rows("ticks.csv"), rows("contacts.csv")
    model = {row["model"]: row["name"] for row in rows("models.csv")}
    code, out, err = hapticd("explain", "run.h5")
    greatest = max(ticks, key=lambda row: size(row, "arm0_sent_f"))
    check("the limit is reached", LIMIT * 0.99 < size(greatest, "arm0_sent_f") <= LIMIT * 1.000001, str(size(greatest, "arm0_sent_f")))
    explained(greatest, out[out.index("greatest force"):])
    for at in ("1.5", "2.4995", "3"):
        code, out, err = hapticd("explain", "run.h5", "--at", at)
        explained(next(row for row in ticks if float(row["t"]) >= float(at)), out)
        check(f"--at {at} tells of nothing else", code == 0 and out.startswith("force\n") and "events" not in out, out + err)
    code, out, err = hapticd("explain", "run.h5", "--at", "0")
    check("before the hand is there", code == 0 and "weak got 0 N" in out and "no model is touched, and no program pushes" in out, out + err)
    for at in ("4.5", "-1", "nan"):
        code, out, err = hapticd("explain", "run.h5", "--at", at)
        check(f"--at {at} is refused", code == 2 and out == "" and "expected a time of the recording, 0 to 3.999 s" in err, out + err)
    code, out, err = hapticd("explain", "scene.yaml", "--at", "1")
    check("a scene has no times", code == 2 and "scene.yaml: is no recording, and --at is a time of a recording" in err, out + err)

finish()
