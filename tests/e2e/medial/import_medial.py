#!/usr/bin/env python3
"""Known shapes are recovered from their triangles: torus, capsule, ellipsoid, cube, branching body, box; what cannot be
reached or is of odd size is warned of; bad input is refused.

Usage: import_medial.py HAPTICD CONFIG     prints one line per case; exit 1 when one is off.
"""
import itertools
import math
import os
import re
import resource
import signal
import struct
import subprocess
import sys
import tempfile

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "support"))
from e2e import LONG, check, finish, program

HAPTICD, CONFIG = sys.argv[1], sys.argv[2]
hapticd = program(HAPTICD, together=True)
FEWER = [] if LONG else ["--samples", "6000"]  # 20,000 unless given, which take three times as long


def save(name, text):
    with open(name, "w", encoding="utf-8") as file:
        file.write(text)
    return name


def obj(points, faces):
    return "".join(f"v {x:.9f} {y:.9f} {z:.9f}\n" for x, y, z in points) + "".join(
        "f " + " ".join(str(i + 1) for i in face) + "\n" for face in faces)


def turned(rows, columns, at, closed):
    """A surface of rows (closed or between two poles) and closed columns."""
    points = [at(i, j) for i in range(rows) for j in range(columns)]
    faces = []
    for i in range(rows if closed else rows - 1):
        for j in range(columns):
            k, l = (i + 1) % rows, (j + 1) % columns
            faces.append([i * columns + j, k * columns + j, k * columns + l, i * columns + l])
    if not closed:
        low, high = at(0, None), at(rows - 1, None)
        points += [low, high]
        for j in range(columns):
            l = (j + 1) % columns
            faces.append([len(points) - 2, j, l])
            faces.append([len(points) - 1, (rows - 1) * columns + l, (rows - 1) * columns + j])
    return points, faces


def torus(big, small, n=96, m=48):
    def at(i, j):
        a, b = 2 * math.pi * i / n, 2 * math.pi * j / m
        return ((big + small * math.cos(b)) * math.cos(a), (big + small * math.cos(b)) * math.sin(a),
                small * math.sin(b))
    return obj(*turned(n, m, at, True))


def capsule(length, radius, n=40, m=40):
    def at(i, j):
        a = math.pi * (i + 1) / (n + 1)
        z = (length if i >= n // 2 else 0) - radius * math.cos(a)
        if j is None:
            return (0, 0, -radius if i == 0 else length + radius)
        b = 2 * math.pi * j / m
        return (radius * math.sin(a) * math.cos(b), radius * math.sin(a) * math.sin(b), z)
    # a row every 2 mm along the cylinder would do; two rings at the ends do as well: quads may be long
    return obj(*turned(n, m, at, False))


def box(x, y, z):
    points = [(x * i, y * j, z * k) for i in (0, 1) for j in (0, 1) for k in (0, 1)]
    return obj(points, [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]])


def read(file):
    spheres, edges, triangles = [], [], []
    for line in open(file, encoding="utf-8"):
        words = line.split()
        if words[0] == "v":
            spheres.append([float(w) for w in words[1:]])
        elif words[0] == "e":
            edges.append([int(w) for w in words[1:]])
        elif words[0] == "f":
            triangles.append([int(w) for w in words[1:]])
    return spheres, edges, triangles


def told(text):
    """Spheres, parts, and the two distances in m that the program reports."""
    found = re.search(r"(\d+) spheres, (\d+) edges, (\d+) triangles, (\d+) part", text)
    there = re.search(r"at most ([\d.]+) mm from the body", text)
    back = re.search(r"the body at most ([\d.]+) mm", text)
    return int(found[1]), int(found[4]), 1e-3 * float(there[1]), 1e-3 * float(back[1])


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


def tissue(folder):
    """The stiffness of a layer of tissue under a flat tip, by the formula of deformable.md: kappa is 1 on a thick layer."""
    young, poisson, tip = 10e3, .45, .003
    code, text = hapticd("import", "--medial", os.path.join(folder, "capsule.obj"), os.path.join(folder, "tissue.yaml"), "--young", f"{young}",
                         "--poisson", f"{poisson}", "--thickness", "1", *FEWER)
    check("tissue is imported", code == 0, text)
    scene = save(os.path.join(folder, "scene.yaml"), "hapticd: 1\nmodels:\n  - {name: body, plugin: mat_deformable, "
                 f"parameters: {{geometry: tissue.yaml, probe_radius: {tip}}}}}\n")
    code, text = hapticd("explain", scene)
    said = re.search(r"felt ([\d.]+) N/m 1 mm deep.*young for a flat tip of radius 3 mm", text)
    expected = 2 * young * tip / (1 - poisson**2)
    check("it is felt as stiff as the formula says", said and abs(float(said[1]) / expected - 1) < .01, (expected, text))


def place(folder):
    """A mesh far off, in millimetres and with z up comes to the hand as a part does."""
    points, faces = capsule(.06, .01), os.path.join(folder, "far.obj")
    moved = "".join(f"v {float(x) * 1e3 + 300} {float(y) * 1e3 - 40} {float(z) * 1e3 + 7}\n" if kind == "v" else line + "\n"
                    for line in points.splitlines() for kind, x, y, z in [(line.split() + [""] * 4)[:4]])
    out = os.path.join(folder, "far.ma")
    spheres = {}
    for name, options in (("centred", ["--scale", "0.001", "--center"]), ("fitted", ["--fit", "0.04", "--center"]), ("turned", ["--scale", "0.001", "--center", "--up", "z"])):
        code, text = hapticd("import", "--medial", save(faces, moved), "-o", out, *options, *FEWER)
        check(f"a mesh far off is imported and {name}", code == 0, text)
        spheres[name] = read(out)[0]
    ends = {name: [max(s[k] for s in all) for k in range(3)] for name, all in spheres.items()}
    middle = {name: [(max(s[k] for s in all) + min(s[k] for s in all)) / 2 for k in range(3)] for name, all in spheres.items()}
    check("its middle is the origin", all(abs(m) < 1e-3 for one in middle.values() for m in one), middle)
    check("its length is along the axis that it had", ends["centred"][2] > .02 > 5e-3 > abs(ends["centred"][1])
          and ends["turned"][1] > .02 > 5e-3 > abs(ends["turned"][2]), ends)
    check("it has the size that was asked for", abs(ends["fitted"][2] + max(s[3] for s in spheres["fitted"]) - .02) < 1e-3, ends)


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


def cells(axis, spacing):
    """The cells of a grid whose middles are inside the body."""
    spheres, edges, triangles = axis
    solid = []
    for a, b in edges:
        solid += [[(1 - t / 8) * u + t / 8 * v for u, v in zip(spheres[a], spheres[b])] for t in range(9)]
    for a, b, c in triangles:
        for i in range(7):
            for j in range(7 - i):
                s, t = i / 6, j / 6
                solid.append([(1 - s - t) * u + s * v + t * w for u, v, w in zip(spheres[a], spheres[b], spheres[c])])
    inside = set()
    for *place, r in solid:
        ranges = [range(int(math.floor((q - r) / spacing)), int(math.ceil((q + r) / spacing)) + 1) for q in place]
        inside.update(cell for cell in itertools.product(*ranges) if math.dist([c * spacing for c in cell], place) <= r)
    return inside


def fill(inside):
    """Adds cells until none touches another by an edge or corner alone."""
    changed = True
    while changed:
        changed = False
        for cell in list(inside):
            for d in ((1, 1, 0), (1, -1, 0), (1, 0, 1), (1, 0, -1), (0, 1, 1), (0, 1, -1)):
                other = tuple(c + e for c, e in zip(cell, d))
                if other not in inside:
                    continue
                axes = [m for m in range(3) if d[m]]
                one, two = (tuple(c + (d[m] if m == axis else 0) for m, c in enumerate(cell)) for axis in axes)
                if one not in inside and two not in inside:
                    inside.add(one)
                    changed = True


def cubes(axis, spacing):
    """The surface of the little cubes whose middles are inside the body: stairs of `spacing`."""
    inside = cells(axis, spacing)
    fill(inside)
    points, index, faces = [], {}, []

    def corner(p):
        if p not in index:
            index[p] = len(points)
            points.append(tuple((q - .5) * spacing for q in p))
        return index[p]

    for cell in inside:
        for m, side in ((0, 0), (0, 1), (1, 0), (1, 1), (2, 0), (2, 1)):
            beside = list(cell)
            beside[m] += 1 if side else -1
            if tuple(beside) in inside:
                continue
            base = list(cell)
            base[m] += side
            square = []
            for da, db in ((0, 0), (1, 0), (1, 1), (0, 1)):
                p = list(base)
                p[(m + 1) % 3] += da
                p[(m + 2) % 3] += db
                square.append(corner(tuple(p)))
            faces.append(square if side else square[::-1])
    return obj(points, faces)


def ellipsoid(a, b, c, n=60, m=60):
    def at(i, j):
        t = math.pi * (i + 1) / (n + 1)
        if j is None:
            return (0, 0, -c if i == 0 else c)
        f = 2 * math.pi * j / m
        return (a * math.sin(t) * math.cos(f), b * math.sin(t) * math.sin(f), -c * math.cos(t))
    return obj(*turned(n, m, at, False))


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


def cracked(text):
    """The same surface as CAD programs write it: each face with points of its own, which differ by rounding, and every
    seventh face turned round."""
    points = [[float(c) for c in line.split()[1:]] for line in text.splitlines() if line[0] == "v"]
    faces = [[int(i) - 1 for i in line.split()[1:]] for line in text.splitlines() if line[0] == "f"]
    lines, count = [], 0
    for n, face in enumerate(faces):
        for i in face:
            lines.append("v " + " ".join(repr(c + n % 3 * 1e-12) for c in points[i]))
        corners = [count + k + 1 for k in range(len(face))]
        lines.append("f " + " ".join(map(str, corners[::-1] if n % 7 == 0 else corners)))
        count += len(face)
    return "\n".join(lines) + "\n"


def repairFirst(folder):
    """What is repaired for a part is repaired for a soft body as well."""
    mesh, out = save(os.path.join(folder, "cracked.obj"), cracked(torus(.05, .012, 24, 12))), os.path.join(folder, "cracked.ma")
    code, text = hapticd("import", "--medial", mesh, "--tolerance", "0.002", out, *FEWER)
    check("a surface with cracks of rounding and turned faces is imported", code == 0, text)
    check("and what was repaired is told", "points were joined" in text and "triangles were reversed" in text, text)


def refuse(folder):
    def refused(name, text, expected, *more):
        code, said = hapticd("import", "--medial", save(os.path.join(folder, name), text),
                             os.path.join(folder, "out.ma"), *more)
        check(f"{name} is refused with its reason", code == 2 and expected in said, said)

    refused("open.obj", obj([(0, 0, 0), (1, 0, 0), (0, 1, 0)], [[0, 1, 2]]), "expected a closed surface")
    refused("bad.obj", "v 0 0 zero\n", "bad.obj:1: 'v 0 0 zero' is not a point")
    refused("index.obj", "v 0 0 0\nf 1 2 3\n", "index.obj:2: the face names the point '2'; expected 1 to 1")
    refused("empty.stl", "solid nothing\nendsolid\n", "no triangles")
    refused("what.ply", "ply\n", "the header has no end")
    refused("what.txt", "OFF\n", "expected .obj, .stl, .ply")
    code, said = hapticd("import", "--medial", os.path.join(folder, "none.obj"), os.path.join(folder, "out.ma"))
    check("a file that is not there is refused", code == 2 and "none.obj" in said, said)
    code, said = hapticd("import", "--medial", os.path.join(folder, "open.obj"), os.path.join(folder, "out.txt"))
    check("an output of another kind is refused", code == 2 and ".ma or .yaml" in said, said)
    code, said = hapticd("import", "--medial", os.path.join(folder, "open.obj"), os.path.join(folder, "out.ma"), "--mass", "0.1")
    check("a material for a file without materials is refused", code == 2 and "--mass has no effect" in said and "ends in .yaml" in said, said)
    for body in (save(os.path.join(folder, "body.ma"), "1 0 0\nv 0 0 0 0.01\n"), os.path.join(folder, "open.obj")):
        code, said = hapticd("import", "--calibrate", save(os.path.join(folder, "presses.csv"), "x,y,z,depth,force\n0,0,0.01,0.001,0.1\n"), body,
                             "-o", os.path.join(folder, "fitted.yaml"))
        check(f"{os.path.basename(body)} is not fitted, and what would be is told", code == 2 and "--medial MESH.stl -o BODY.yaml" in said, said)
    code, said = hapticd("import", "--medial", os.path.join(folder, "open.obj"), os.path.join(folder, "out.yaml"), "--poisson", "0.4")
    check("Poisson's ratio alone is refused", code == 2 and "--young" in said, said)
    code, said = hapticd("import", "--medial", os.path.join(folder, "open.obj"), os.path.join(folder, "out.yaml"), "--young", "10e3")
    check("a modulus without the thickness of the layer is refused", code == 2 and "--thickness" in said, said)


def fullDisk(folder):
    """No file may grow, as on a full disk: a body that was made before stays, and nothing incomplete is left."""
    def full():
        signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
        resource.setrlimit(resource.RLIMIT_FSIZE, (0, 0))

    name = save(os.path.join(folder, "small.obj"), box(0.03, 0.02, 0.01))
    for kept, out in (("# made before\n", "kept.ma"), (None, "new.ma"), (None, "new.yaml")):
        file = os.path.join(folder, out)
        if kept:
            save(file, kept)
        done = subprocess.run([HAPTICD, "import", "--medial", name, file, "--samples", "1000"], stdout=subprocess.PIPE,
                              stderr=subprocess.PIPE, text=True, timeout=300, preexec_fn=full)
        check(f"{out}: a full disk is told", done.returncode == 1 and "cannot be written: File too large" in done.stderr, done)
        check(f"{out}: is as before", (open(file).read() if os.path.exists(file) else None) == kept)
    check("nothing else is left", not [n for n in os.listdir(folder) if n.endswith(".part")], os.listdir(folder))


with tempfile.TemporaryDirectory() as work:
    for case in (recoverTorus, recoverCapsule, tissue, place, recoverEllipsoid, recoverCube, recoverBranches, recoverNurbs, recoverBox, repairFirst, refuse, fullDisk):
        case(work)
finish()
