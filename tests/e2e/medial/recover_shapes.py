#!/usr/bin/env python3
"""Known shapes are recovered from their triangles: torus, capsule, ellipsoid, cube, branching body, box, and from NURBS.

Usage: recover_shapes.py HAPTICD CONFIG     prints one line per case; exit 1 when one is off.
"""
import math
import os
import struct
import sys
import tempfile

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "support"))
from bodies import box, capsule, cubes, ellipsoid, read, told, torus
from e2e import LONG, check, finish, program, write

HAPTICD, CONFIG = sys.argv[1], sys.argv[2]
hapticd = program(HAPTICD, together=True)
FEWER = [] if LONG else ["--samples", "6000"]  # 20,000 unless given, which take three times as long


def save(name, text):
    return write(*os.path.split(name), text)


def recoverTorus(folder):
    out = os.path.join(folder, "torus.ma")
    code, text = hapticd("import", "--medial", save(os.path.join(folder, "torus.obj"), torus(.05, .012)),
                         "--tolerance", "0.001", out, *FEWER)
    check("a torus is imported", code == 0, text)
    spheres, edges, triangles = read(out)
    off = max(abs(math.hypot(x, y) - .05) + abs(z) + abs(r - .012) for x, y, z, r in spheres)
    check("its spheres lie near its circle with its radius: errors together below a fifth of the tolerance", off < 2e-4, f"{off}")
    degree = [sum(i in e for e in edges) for i in range(len(spheres))]
    check("its axis is one closed loop without slabs", not triangles and set(degree) == {2}, f"{degree} {triangles}")
    count, parts, there, back = told(text)
    check("its surface is within the tolerance", parts == 1 and there <= 1e-3 and back <= (2e-3 if LONG else 2.5e-3), text)


def recoverCapsule(folder):
    out, tolerance = os.path.join(folder, "capsule.yaml"), 5e-4 if LONG else 1e-3
    code, text = hapticd("import", "--medial", save(os.path.join(folder, "capsule.obj"), capsule(.06, .01)),
                         "--tolerance", f"{tolerance}", "-o", out, "--stiffness", "250", *FEWER)
    check("a capsule is imported to YAML", code == 0, text)
    count, parts, there, back = told(text)
    check("its surface is within the tolerance", parts == 1 and there <= tolerance and back <= 3 * tolerance, text)
    written = open(out, encoding="utf-8").read()
    check("the material is written", "stiffness: 250" in written, written[-200:])
    scene = save(os.path.join(folder, "scene.yaml"), "hapticd: 1\nmodels:\n  - {name: body, plugin: mat_deformable, "
                 "parameters: {geometry: capsule.yaml}}\n")
    probe = save(os.path.join(folder, "probe.csv"), "t,x,y,z\n" + "".join(
        f"{1e-3 * k:.3f},{.012 - 2e-5 * k:.9f},0,0.03\n" for k in range(200)))
    code, text = hapticd("trace", scene, "--probe", probe, "--out", os.path.join(folder, "trace.csv"))
    rows = [line.split(",") for line in open(os.path.join(folder, "trace.csv"), encoding="utf-8")]
    depth = float(rows[-1][rows[0].index("depth")])
    check("it is felt where its surface was", code == 0 and abs(depth - (.01 - .00802)) < 3e-4, f"{depth} {text}")


def recoverEllipsoid(folder):
    """Its axis is a sheet. A tolerance below what the samples can tell is warned of, with what was reached."""
    mesh = save(os.path.join(folder, "ellipsoid.obj"), ellipsoid(.03, .02, .012))
    out = os.path.join(folder, "ellipsoid.ma")
    code, text = hapticd("import", "--medial", mesh, "--tolerance", "0.0005", out, *FEWER)
    check("an ellipsoid is imported", code == 0, text)
    if code == 0:
        count, parts, there, back = told(text)
        check("it is within the tolerance, without a warning", parts == 1 and there <= 5e-4 and "warning" not in text, text)
    save(mesh, ellipsoid(.03, .02, .012, 12, 12))
    code, text = hapticd("import", "--medial", mesh, "--tolerance", "0.00001", out, *FEWER)
    check("more than can be reached is warned of with both figures", code == 0 and
          "warning: the body and the surface differ by up to 0." in text and "--tolerance allows only 0.01 mm" in text, text)
    check("and with a number of samples that may help", f"such as --samples {4 * int(FEWER[1] if FEWER else 20000)}, or" in text, text)


def recoverCube(folder):
    mesh = save(os.path.join(folder, "cube.obj"), box(.06, .06, .06))
    out = os.path.join(folder, "cube.ma")
    code, text = hapticd("import", "--medial", mesh, "--tolerance", "0.001" if LONG else "0.002", out, *FEWER)
    check("a cube is imported", code == 0, text)
    if code == 0:
        count, parts, there, back = told(text)
        check("it is one body, off by 3 mm at its corners at most", parts == 1 and there <= 3e-3, text)
        check("and its size is told", "0.06 x 0.06 x 0.06 m" in text and "arm reaches" not in text, text)
    code, text = hapticd("import", "--medial", save(os.path.join(folder, "house.obj"), torus(50, 12, 16, 8)), out, *FEWER)
    check("124 m are warned of with the cure", code == 0 and "than an arm reaches" in text and "--scale 0.001" in text, text)
    scene = save(os.path.join(folder, "house.yaml"), "hapticd: 1\nmodels:\n  - {name: body, plugin: mat_deformable, "
                 "parameters: {geometry: cube.ma}}\n")
    code, text = hapticd("explain", scene)
    check("and when it is loaded", code == 0 and "lengths must be in m" in text, text)
    code, text = hapticd("import", "--medial", save(mesh, box(.02, .02, .02)), "--tolerance", "0.01", "--angle", "180", out, *FEWER)
    check("too wide an angle is named", code == 1 and "a smaller --angle" in text, text)


def recoverBranches(folder):
    """From the shipped branching body: its own triangles, drawn and read again."""
    out = os.path.join(folder, "branch.ma")
    mesh = os.path.join(folder, "branch.obj")
    spacing = .0019
    axis = read(os.path.join(CONFIG, "models", "branch.ma"))
    save(mesh, cubes(axis, spacing))
    code, text = hapticd("import", "--medial", mesh, "--tolerance", "0.0025", "--angle", "75", out, *FEWER)
    check("a branching body is imported", code == 0, text)
    if code == 0:
        count, parts, there, back = told(text)
        check("it is one body within 4 mm of its steps of 1.9 mm", parts == 1 and there <= 4e-3 and back <= 5e-3, text)


def recoverNurbs(folder):
    out = os.path.join(folder, "nurbs.ma")
    code, text = hapticd("import", "--medial", os.path.join(CONFIG, "models", "torus.yaml"), "--tolerance", "0.001", out, *FEWER)
    check("a NURBS torus is imported", code == 0, text)
    if code == 0:
        count, parts, there, back = told(text)
        check("it is within the tolerance", parts == 1 and there <= 1e-3, text)
    if LONG:
        recoverSlowly(out)


def recoverSlowly(out):
    code, text = hapticd("import", "--medial", os.path.join(CONFIG, "models", "goblet.yaml"), "--tolerance", "0.002", out, *FEWER)
    check("a NURBS goblet is imported, or refused with what is wrong", code == 0 or "expected" in text, text)
    code, text = hapticd("import", "--medial", os.path.join(CONFIG, "models", "torus.yaml"), "--tolerance", "0.0001", out, *FEWER)
    check("a torus within 0.1 mm is one", code == 0 and told(text)[1] == 1 and told(text)[2] <= 1e-4, text)


def recoverBox(folder):
    """Binary STL; its axis is a sheet with walls toward the edges, which a wide angle leaves out."""
    name = os.path.join(folder, "box.stl")
    corners = [line.split()[1:] for line in box(.08, .06, .02).splitlines() if line[0] == "v"]
    faces = [[int(i) - 1 for i in line.split()[1:]] for line in box(.08, .06, .02).splitlines() if line[0] == "f"]
    triangles = [t for f in faces for t in ([f[0], f[1], f[2]], [f[0], f[2], f[3]])]
    with open(name, "wb") as file:
        file.write(b"box".ljust(80) + struct.pack("<I", len(triangles)))
        for t in triangles:
            file.write(struct.pack("<3f", 0, 0, 0))
            for i in t:
                file.write(struct.pack("<3f", *(1000 * float(c) for c in corners[i])))
            file.write(b"\0\0")
    out = os.path.join(folder, "box.ma")
    code, text = hapticd("import", "--medial", name, "--scale", "0.001", "--tolerance", "0.0015", out, *FEWER)
    check("a box in millimetres is imported from binary STL", code == 0, text)
    if code == 0:
        count, parts, there, back = told(text)
        check("its faces are within 1.5 tolerances, slabs among its parts",
              there <= 2.25e-3 and parts == 1 and len(read(out)[2]) > 10, text)


with tempfile.TemporaryDirectory() as work:
    for case in (recoverTorus, recoverCapsule, recoverEllipsoid, recoverCube, recoverBranches, recoverNurbs, recoverBox):
        case(work)
finish()
