#!/usr/bin/env python3
"""A soft body takes its stiffness from presses of another solid: `hapticd import --calibrate`.

Usage: calibrate.py HAPTICD CONFIG     prints one line per case; exit 1 when one is off.
"""
import csv
import math
import os
import re
import sys
import tempfile

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "support"))
from e2e import check, finish, program

HAPTICD, CONFIG = sys.argv[1], os.path.abspath(sys.argv[2])
hapticd = program(HAPTICD, together=True)
WIDTH, HEIGHT, RADIUS, COUNT = 0.08, 0.06, 0.01, 9
REACH = 0.006  # [m] of the shear of a stand-in whose dents are those of the points and of this; the contact spring takes a third of a press


def solid(x, y):
    """[N/m] A smooth stand-in for a measured solid."""
    return 167 + 60 * math.exp(-(x * x + y * y) / (2 * 0.008 ** 2)) + 500 * x


def body(folder):
    points = [[[WIDTH * (i / (COUNT - 1) - 0.5), HEIGHT * (j / (COUNT - 1) - 0.5), 0.002 * math.sin(i)]
               for j in range(COUNT)] for i in range(COUNT)]
    name = os.path.join(folder, "body.yaml")
    with open(name, "w", encoding="utf-8") as out:
        out.write("format: hapticd-model/1\nname: pad\nmedial:\n  points:\n" + "".join(f"    - {row}\n" for row in points) +
                  f"  radius: {RADIUS}\n  stiffness: 99\n  damping: 0.5\n  mass: 0.01\n")
    return name


def answers(folder, places, depth=5e-4):
    name = os.path.join(folder, "answers.csv")
    with open(name, "w", encoding="utf-8") as out:
        out.write("# of a solid\nx,y,z,depth,force\n")
        for x, y in places:
            out.write(f"{x},{y},0.013,{depth},{depth * solid(x, y)}\n")
    return name


def felt(folder, file, x, y):
    """[N/m] Force along z over depth of a slow press, by `hapticd trace`."""
    scene, probe, out = (os.path.join(folder, name) for name in ("scene.yaml", "probe.csv", "trace.csv"))
    with open(scene, "w", encoding="utf-8") as text:
        text.write(f"hapticd: 1\nmodels:\n  - name: pad\n    plugin: mat_deformable\n    parameters: {{geometry: {file}, "
                   "dynamics: off}\n".replace("off}", '"off"}'))
    with open(probe, "w", encoding="utf-8") as text:
        text.write("t,x,y,z\n" + "".join(f"{1e-3 * i:.3f},{x},{y},{0.0135 - 1e-5 * i:.6f}\n" for i in range(600)))
    code, said = hapticd("trace", scene, "--probe", probe, "--out", out)
    check(f"the body is traced at {1e3 * x:.0f}, {1e3 * y:.0f} mm", code == 0, said)
    with open(out, encoding="utf-8") as file_:
        for row in csv.DictReader(file_):
            if float(row["depth"]) > 4e-4:
                force = [float(row[axis]) for axis in ("fx", "fy", "fz")]
                return math.hypot(*force) / float(row["depth"])
    return math.nan


with tempfile.TemporaryDirectory() as work:
    out = os.path.join(work, "fitted.yaml")
    places = [(1e-2 * i, 1e-2 * j) for i in range(-3, 4) for j in range(-2, 3)]
    given, told = body(work), answers(work, places)
    code, text = hapticd("import", "--calibrate", told, given, out)
    check("a body is calibrated", code == 0 and "35 places within" in text, text)
    worst = float(text.split("within ")[1].split(" %")[0]) if code == 0 else math.nan
    check("its force is that of the solid within 5 % at all places", worst < 5, text)
    off = [felt(work, out, x, y) / solid(x, y) - 1 for x, y in ((0, 0), (0.01, -0.01), (-0.03, 0.02))]
    check("a probe feels it", max(map(abs, off)) < 0.05, off)
    between = [felt(work, out, x, y) / solid(x, y) - 1 for x, y in ((0.005, 0.005), (0.015, -0.005), (-0.025, 0.015))]
    check("and nearly so between the places", max(map(abs, between)) < 0.15, between)
    with open(out, encoding="utf-8") as file:
        lines = file.read()
    check("what it does not fit it keeps", "name: " in lines and "  mass: 0.01" in lines and "hapticd-model/2" in lines, lines[:400])
    dents = os.path.join(work, "dents.csv")
    with open(dents, "w", encoding="utf-8") as file:
        file.write("x,y,z,x2,y2,z2,dent\n")
        for spacing, across in ((WIDTH / (COUNT - 1), (1, 0)), (HEIGHT / (COUNT - 1), (0, 1))):
            for r in (0.008, 0.012, 0.016):
                share = 2 / 3 * math.exp(-0.5 * r * r / (2 * spacing ** 2 / 3 + REACH ** 2))
                file.write(f"0,0,0.013,{r * across[0]},{r * across[1]},0.013,{share}\n")
    code, text = hapticd("import", "--calibrate", told, "--dents", dents, given, out)
    found = re.search(r"shear_reach ([\d.e-]+) m, dent at 6 places within ([\d.]+)", text)
    check("its shear is fitted to dents", code == 0 and found and abs(float(found[1]) / REACH - 1) < 0.2 and
          float(found[2]) < 0.15, text)
    off = [felt(work, out, x, y) / solid(x, y) - 1 for x, y in ((0, 0), (0.01, -0.01))]
    check("and leaves the stiffness", max(map(abs, off)) < 0.05, off)
    with open(out, encoding="utf-8") as file:
        lines = file.read()
    check("the file has it, and its mass still", "shear_reach: " in lines and "  mass: 0.01" in lines, lines[:400])
    with open(dents, "a", encoding="utf-8") as file:
        file.write("0,0,0.013,0.2,0,0.013,0.5\n")
    code, text = hapticd("import", "--calibrate", told, "--dents", dents, given, out)
    check("a dent beside the body is named", code == 0 and "(0.2, 0, 0.013) m" in text, text)
    mesh, unwritten = os.path.join(work, "mesh.yaml"), os.path.join(work, "unwritten.yaml")
    with open(mesh, "w", encoding="utf-8") as file:
        file.write("format: hapticd-model/1\nmedial:\n  vertices: [[-0.03, 0, 0, 0.01], [0.03, 0, 0, 0.01]]\n  edges: [[0, 1]]\n"
                   "  stiffness: 100\n")
    code, text = hapticd("import", "--calibrate", told, "--dents", dents, mesh, unwritten)
    check("dents of a mesh are refused before anything is written", code == 2 and "rings" in text and not
          os.path.exists(unwritten), (code, text))
    with open(dents, "w", encoding="utf-8") as file:
        file.write("x,y,z,x2,y2,z2,dent\n0,0,0,0,0,0,1.5\n")
    code, text = hapticd("import", "--calibrate", told, "--dents", dents, given, out)
    check("a dent deeper than the press is refused", code == 2 and "between -1 and 1" in text, (code, text))
    for wrong, why in (("x,y,z,depth,force\n0,0,0,0,1\n", "above 0"), ("x,y\n1,2\n", "x,y,z,depth,force")):
        with open(told, "w", encoding="utf-8") as file:
            file.write(wrong)
        code, text = hapticd("import", "--calibrate", told, given, out)
        check(f"{wrong[:6]!r}... is refused with its reason", code == 2 and why in text, (code, text))
finish()
