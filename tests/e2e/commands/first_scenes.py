#!/usr/bin/env python3
"""`hapticd import --scene`: the scene that it writes has nothing to warn of, and its hand presses what was imported.

Usage: first_scenes.py HAPTICD SOURCE [MAKE_PARTS]     CAD files are made by MAKE_PARTS; without it they are left out
"""
import json
import math
import os
import re
import subprocess
import sys
import tempfile

HAPTICD, SOURCE = sys.argv[1], sys.argv[2]
MAKE_PARTS = sys.argv[3] if len(sys.argv) > 3 else None
sys.path.insert(0, os.path.join(SOURCE, "tests", "support"))
from e2e import check, finish, program, write

run = program(HAPTICD)
folder = tempfile.mkdtemp(prefix="hapticd-first-scenes-")
join = lambda *names: os.path.join(folder, *names)


def obj(points, faces):
    return "".join("v %.9g %.9g %.9g\n" % tuple(p) for p in points) + "".join(
        "f " + " ".join(str(i + 1) for i in face) + "\n" for face in faces)


def box(a, b, c, at=(0, 0, 0), without=()):
    points = [(at[0] + x * a, at[1] + y * b, at[2] + z * c) for x in (0, 1) for y in (0, 1) for z in (0, 1)]
    sides = {"-x": (0, 1, 3, 2), "+x": (4, 6, 7, 5), "-y": (0, 4, 5, 1), "+y": (2, 3, 7, 6), "-z": (0, 2, 6, 4), "+z": (1, 5, 7, 3)}
    return obj(points, [side for name, side in sides.items() if name not in without])


def stl(text):
    """The same triangles as an ASCII STL."""
    points, lines = [], ["solid part"]
    for kind, *rest in (line.split() for line in text.splitlines()):
        if kind == "v":
            points.append(" ".join(rest))
            continue
        corner = [points[int(i) - 1] for i in rest]
        for k in range(1, len(corner) - 1):
            lines += ["facet normal 0 0 0", "outer loop", *(f"vertex {p}" for p in (corner[0], corner[k], corner[k + 1])), "endloop", "endfacet"]
    return "\n".join(lines + ["endsolid part"]) + "\n"


def egg(rows=24, columns=48):
    """A closed ellipsoid of 100 x 60 x 50 mm."""
    at = lambda i, j: [r * f for r, f in zip((0.05, 0.03, 0.025), (
        math.sin(math.pi * i / rows) * math.cos(2 * math.pi * j / columns), math.cos(math.pi * i / rows),
        math.sin(math.pi * i / rows) * math.sin(2 * math.pi * j / columns)))]
    points = [at(i, j) for i in range(1, rows) for j in range(columns)] + [at(0, 0), at(rows, 0)]
    faces = []
    for j in range(columns):
        k = (j + 1) % columns
        faces += [(i * columns + j, i * columns + k, (i + 1) * columns + k, (i + 1) * columns + j) for i in range(rows - 2)]
        faces += [(len(points) - 2, k, j), (len(points) - 1, (rows - 2) * columns + j, (rows - 2) * columns + k)]
    return obj(points, faces)


def presses(scene):
    """Whether `check` is clean, and whether a run of 5 s presses the model. Returns the text of the scene."""
    name = os.path.basename(scene)
    code, out, err = run("check", scene)
    check(f"{name}: check has nothing to say", code == 0 and out.strip() == f"{scene}: ok" and err == "", out + err)
    code, out, err = run("run", scene, "--virtual-time", "--for", "5", "--report", join("report.json"))
    with open(join("report.json")) as file:
        model, = json.load(file)["models"].values()
    check(f"{name}: a run presses the model", code == 0 and model["force_n"]["max"] > 0.1 and model["contact_ticks"] > 1000, (code, out + err))
    return open(scene).read()


def made(source, out, *arguments):
    """Imports a file and presses it. Returns the text of the scene and what the import printed."""
    scene = join(os.path.splitext(out)[0] + "-scene.yaml")
    code, told, err = run("import", source, "-o", join(out), "--scene", scene, *arguments)
    check(f"{out}: is imported, and the last line runs it", code == 0 and told.splitlines()[-1].strip() == f"hapticd run {scene} --view", told + err)
    return presses(scene), told + err


def meshes():
    text, told = made(write(folder, "cube.obj", box(0.05, 0.05, 0.05)), "cube.hpart")
    check("a cube: model, geometry, place", all(word in text for word in (
        "name: cube\n", "plugin: nurbs_rigid", "geometry: cube.hpart", "50 x 50 x 50 mm", "position: [-0.025, -0.025, 0]")) and "warning" not in told, text + told)
    check("it is closed, and one part", "sides:" not in text and "instance:" not in text, text)
    made(write(folder, "brick.stl", stl(box(80, 40, 20, at=(1000, 0, -500)))), "brick.hpart", "--scale", "0.001")
    for name, size in (("rod", (0.01, 0.01, 0.2)), ("floor", (0.1, 0.002, 0.1)), ("wall", (0.002, 0.1, 0.1)), ("foil", (0.1, 0.1, 0.0003))):
        text, _ = made(write(folder, name + ".obj", box(*size)), name + ".hpart")
        check(f"{name}: is as stiff as its walls need and the arm can", f"stiffness: {1100 if min(size) == 0.002 else 800}" in text, text)
    for name, sides in (("tube", ("-z", "+z")), ("trough", ("+y", "-z", "+z")), ("tray", ("+z",)), ("sheet", ("-x", "+x", "-y", "+y", "-z")),
                        ("under", ("-x", "+x", "-y", "+y", "+z")), ("shelf", ("-x", "+x", "-y", "-z", "+z"))):
        text, _ = made(write(folder, name + ".obj", box(0.06, 0.02, 0.05, without=sides)), name + ".hpart")
        check(f"{name}: is open, so it has both sides", "sides: both" in text, text)
    made(write(folder, "tilted.obj", obj([(0, 0, 0), (0.1, 0, 0), (0.1, 0.1, 0.1), (0, 0.1, 0.1)], [(0, 1, 2, 3)])), "tilted.hpart")


def model_files():
    patch = "1\n1 1\n0 0 0\n{}\n{}\n4 2 0\n"
    for name, middle in (("front", ("0 2 0", "4 0 0")), ("back", ("4 0 0", "0 2 0"))):
        text, _ = made(write(folder, name + ".bpt", patch.format(*middle)), name + ".yaml", "--fit", "0.1")
        check(f"a patch that shows its {name}", ("sides: both" in text) == (name == "back"), text)
    made(os.path.join(SOURCE, "config", "models", "teapot.bpt"), "teapot.json", "--up", "z", "--fit", "0.13")


def soft_bodies():
    mesh = write(folder, "egg.obj", egg())
    text, _ = made(mesh, "egg.ma", "--medial", "--samples", "3000")
    check("a medial mesh gets its material from the scene", "plugin: mat_deformable" in text and "\n      stiffness: 400" in text, text)
    check("and is felt as it moves", "dynamics: felt: the force includes" in run("explain", join("egg-scene.yaml")).stdout, text)
    text, told = made(mesh, "egg-body.yaml", "--medial", "--samples", "3000", "--mass", "0.02")
    check("a model file has its own", "plugin: mat_deformable" in text and "\n      stiffness:" not in text, text)
    check("it is felt as it moves, and the import says so", "dynamics: felt: the force includes" in run("explain", join("egg-body-scene.yaml")).stdout
          and "felt: 300 N/m, and as it moves 0.5 N s/m and 20 g for each sphere" in told, told)
    _, told = made(write(folder, "tile.obj", box(0.06, 0.006, 0.04)), "tile.yaml", "--medial", "--tolerance", "0.0002")  # of hundreds of spheres
    check("a body of many spheres is not heavier than metal", 0 < float(re.search(r"([\d.]+) g for each sphere", told)[1]) < 10, told)
    code, out, err = run("import", mesh, "--medial", "-o", join("still.yaml"), "--samples", "3000", "--mass", "0", "--damping", "0")
    check("without mass and damping it is felt at rest, and the import says so", code == 0 and "as a body at rest" in out, out + err)
    presses_again(join("still.yaml"), "mat_deformable", "dynamics: off: the body follows")


def quoted(name):
    return "'" + name.replace("'", "'\\''") + "'"


def presses_again(model, plugin, explained=""):
    """A scene for a model that was imported before, as the import advises."""
    scene = os.path.splitext(model)[0] + " again.yaml"  # a name that a shell must get in quotes
    code, out, err = run("import", model, "--scene", scene)
    check(f"{os.path.basename(model)}: a scene is made later", code == 0 and out.splitlines()[-1].strip() == f"hapticd run {quoted(scene)} --view", out + err)
    check("for its plugin", f"plugin: {plugin}\n" in presses(scene) and explained in run("explain", scene).stdout)


def scenes_of_models():
    code, out, err = run("import", join("cube.obj"), "-o", join("later's.hpart"))
    part = quoted(join("later's.hpart"))
    check("an import without a scene says how to see and feel the part", code == 0 and f"hapticd view {part}  " in out and
          f"hapticd import {part} --scene SCENE.yaml" in out, out + err)
    presses_again(join("later's.hpart"), "nurbs_rigid")
    code, out, err = run("import", join("later's.hpart"), "--scene", join("b.yaml"), "--fit", "0.1")
    check("a part that is made keeps its size", code == 2 and "import again" in err and not os.path.exists(join("b.yaml")), out + err)
    code, out, err = run("import", write(folder, "bad.hpart", "no part"), "--scene", join("b.yaml"))
    check("what is no part gets no scene", code == 2 and "bad.hpart" in err and not os.path.exists(join("b.yaml")), out + err)


def odd_sizes():
    for name, size, fix in (("hall", 10, "--fit 0.15, or --scale 0.015"), ("crumb", 0.003, "--fit 0.15, or --scale 50")):
        scene = join(name + ".yaml")
        code, out, err = run("import", write(folder, name + ".obj", box(size, size, size)), "-o", join(name + ".hpart"), "--scene", scene)
        check(f"{name}: is written, with the size that would fit", code == 0 and os.path.exists(scene) and fix in err and f"rm {scene}" in err, out + err)
        check(f"{name}: can be run", run("run", scene, "--virtual-time", "--for", "1").returncode == 0)
    code, out, err = run("import", join("hall.obj"), "-o", join("hall.hpart"), "--scene", join("hall-2.yaml"), "--fit", "0.15")
    check("the advice is right", code == 0 and "warning" not in err, err)
    afar = write(folder, "afar.obj", box(0.05, 0.05, 0.05, (15, 0, 2)))
    code, out, err = run("import", afar, "-o", join("afar.hpart"), "--scene", join("afar.yaml"))
    check("afar: is written, with how to bring it near", code == 0 and "is 15.2 m from the origin" in err and "--center" in err, out + err)
    code, out, err = run("import", afar, "-o", join("afar.hpart"), "--scene", join("afar-2.yaml"), "--center")
    told = run("check", join("afar-2.yaml"))
    check("that advice is right, too", code == 0 and "warning" not in err + told.stdout + told.stderr, f"{err}{told}")
    presses(join("hall-2.yaml"))


def units():
    """A mesh states no unit: an import that was not told one says what it took, and what the size would be in others."""
    inches = write(folder, "inches.stl", stl(box(3, 2, 1.5)))
    code, out, err = run("import", inches, "-o", join("inches.hpart"))
    check("a mesh without --scale: what was assumed", code == 0 and "no unit, so metres were assumed: in millimetres it is 3 mm large (--scale 0.001), "
          "in inches 76.2 mm (--scale 0.0254)" in out, out + err)
    for chosen in (("--scale", "0.0254"), ("--fit", "0.1")):
        code, out, err = run("import", inches, "-o", join("inches.hpart"), *chosen)
        check(f"a mesh with {chosen[0]}: nothing was", code == 0 and "assumed" not in out, out + err)
    code, out, err = run("import", "--medial", join("egg.obj"), "-o", join("unit.yaml"), "--samples", "1000")
    check("a soft body without --scale: what was assumed", code == 0 and "in inches 2.54 mm" in out, out + err)
    code, out, err = run("import", os.path.join(SOURCE, "config", "models", "teapot.bpt"), "-o", "-")
    check("a model on standard output is nothing else", code == 0 and "assumed" not in out, out[:300] + err)


def paths():
    os.makedirs(join("parts", "of mine"))
    os.makedirs(join("scenes"))
    scene, part = join("scenes", "a.yaml"), join("parts", "of mine", "null.hpart")
    code, out, err = run("import", join("cube.obj"), "-o", part, "--scene", scene)
    check("the geometry is named relative to the scene, in quotes", code == 0 and '"../parts/of mine/null.hpart"' in presses(scene), out + err)
    os.rename(folder, folder + "-moved")
    check("both can be moved together", run("check", scene.replace(folder, folder + "-moved")).stdout.strip().endswith(": ok"))
    os.rename(folder + "-moved", folder)


def refusals():
    cube, part = join("cube.obj"), join("new.hpart")
    mine = write(folder, "mine.yaml", "mine")
    os.symlink("nowhere.yaml", join("dangling.yaml"))
    for what, arguments, word in (
            ("an existing scene", ("-o", part, "--scene", mine), "mine.yaml exists already, expected the name of a new file"),
            ("a dangling link", ("-o", part, "--scene", join("dangling.yaml")), "exists already"),
            ("no folder", ("-o", part, "--scene", join("none", "a.yaml")), "cannot be written, expected a file in a folder that you may write to"),
            ("a folder that takes no file", ("-o", part, "--scene", "/proc/a.yaml"), "cannot be written"),
            ("another ending", ("-o", part, "--scene", join("a.hpart")), "expected a name that ends in .yaml"),
            ("the model's own name", ("-o", join("same.yaml"), "--scene", join(".", "same.yaml")), "is the file that --out names"),
            ("standard output", ("-o", "-", "--scene", join("a.yaml")), "expected the name of a file for --out"),
            ("nothing is written by --check", ("--check", "--scene", join("a.yaml")), "--scene"),
            ("a fit", ("--calibrate", cube, "-o", join("a-body.yaml"), "--scene", join("a.yaml")), "--scene")):
        code, out, err = run("import", cube, *arguments)
        check(f"{what}: is refused before anything is written", code == 2 and word in err and not os.path.exists(part) and not os.path.exists(join("a.yaml")), (code, out + err))
    check("the scene of another is kept", open(mine).read() == "mine")
    code, out, err = run("import", write(folder, "bad.stl", "solid\n"), "-o", part, "--scene", join("a.yaml"))
    check("without a part there is no scene", code != 0 and not os.path.exists(join("a.yaml")), out + err)
    code, out, err = run("import", cube, "-o", part, "--scene", join("a.yaml"), "--json")
    check("the report for programs stays JSON", code == 0 and json.loads(out)["closed"] and os.path.exists(join("a.yaml")), out + err)


def cad():
    subprocess.run([MAKE_PARTS, folder], check=True)
    for name in ("box", "bracket", "plate", "torus", "cone"):
        made(join(name + ".step"), name + ".hpart")
    text, _ = made(join("inch.step"), "inch.hpart")
    check("inches are metres in the scene", "25.4 x 25.4 x 25.4 mm" in text, text)
    made(join("trough.brep"), "open.hpart")
    made(join("roof.brep"), "roof.hpart")  # a crease: the hand presses what is drawn
    text, _ = made(join("assembly.step"), "assembly.hpart")
    name, rest = (re.search(rf"# ({key}: \S+)", text) for key in ("instance", "without"))
    check("a small ball is stopped by each part of an assembly", "tip_radius: 0.0002" in text, text)
    check("an assembly names its parts", name and "the whole assembly of 2 parts" in text and text.count("plugin:") == 1, text)
    alone = write(folder, "alone.yaml", text.replace("# " + name[1], name[1]))
    others = write(folder, "others.yaml", text.replace("# " + rest[1], rest[1]))
    features = [run("explain", scene).stdout for scene in (alone, others)]
    check("the lines part the assembly", "details              features 0 to 5:" in features[0] and "details              features 6 to" in features[1], "\n".join(features))
    check("the line makes a scene of one of them", "no instance" not in run("check", alone).stdout and run("check", alone).returncode == 0)


meshes()
model_files()
soft_bodies()
scenes_of_models()
odd_sizes()
units()
paths()
refusals()
if MAKE_PARTS:
    cad()
finish()
