#!/usr/bin/env python3
"""What `hapticd import` says of CAD files: unit, size, place and openness. `hapticd part info` says the same.

Usage: cad_report.py HAPTICD MAKE_PARTS
A part that is placed by --scale, --up and --center is compared with the part as it is, by traces of both.
"""
import csv
import json
import os
import random
import re
import subprocess
import sys
import tempfile

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "support"))
from e2e import check, finish, program

HAPTICD, MAKE_PARTS = sys.argv[1:3]
run = program(HAPTICD, timeout=300)
folder = tempfile.mkdtemp(prefix="hapticd-report-")
join = lambda name: os.path.join(folder, name)
PART = join("x.hpart")


def told(name, *arguments):
    """Imports a file. Returns the report, the warnings, and the text of `part info`."""
    code, out, err = run("import", join(name), "-o", PART, *arguments)
    check(f"{name} {' '.join(arguments)}: is imported", code == 0, out + err)
    return out, err, run("part", "info", PART)[1]


def units():
    for name, assumed in (("loose.brep", True), ("box.step", False), ("box.iges", False)):
        out, _, info = told(name)
        for program_name, text in (("import", out), ("part info", info)):
            check(f"{name}: {program_name} says whether the unit is stated", ("unit mm (assumed)" in text) == assumed and
                  ("millimetres were assumed; is the size right? If not, import it with --scale" in text) == assumed, text)
        report = json.loads(told(name, "--json")[0])
        source = json.loads(run("part", "info", PART, "--json")[1])["source"]
        check(f"{name}: and so in JSON", report["unit_assumed"] == source["unit_assumed"] == assumed, (report, source))


def names():
    """A component without a name has that of its shape, and not the number that Open CASCADE gives it."""
    text = open(join("assembly.step")).read()
    for file, pattern in (("nameless.step", r"'(?:left|right)'"), ("half.step", r"'left'")):
        with open(join(file), "w") as out:
            out.write(re.sub(r"(NEXT_ASSEMBLY_USAGE_OCCURRENCE\('\d+',)" + pattern, r"\1''", text))
    _, _, info = told("half.step")
    check("one without a name has that of its shape", "instance 'block': body 0" in info and "instance 'right': body 0" in info, info)
    _, _, info = told("nameless.step")
    check("two of them have numbers", "instance 'block 1': body 0" in info and "instance 'block 2': body 0" in info, info)


def written_without_a_name():
    """Open CASCADE names a product after itself if its program gave no name."""
    _, _, info = told("box.step")
    check("it has the name of its file", "STEP translator" in open(join("box.step")).read() and "instance 'box': body 0" in info, info)


def axes():
    """The axes about which a scene can turn a body, without knowing the numbers of faces."""
    told("assembly.step")
    code, out, err = run("part", "info", PART, "--axes")
    check("boxes have no axis", code == 0 and "no face has an axis" in out, out + err)
    part = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "..", "config", "models", "as1.hpart")
    code, out, err = run("part", "info", part, "--axes")
    lines = [line for line in out.splitlines() if line.startswith("as1/rod-assembly_1/rod_1: ")]
    check("a rod has one axis", code == 0 and len(lines) == 1, out + err)
    kinds = re.findall(r"[(;] ?(an? [^:;]*): features? [\d, ]+", lines[0])
    check("its faces of one kind and size are named together", kinds and len(set(kinds)) == len(kinds) and "features " in lines[0], lines)
    feature = re.search(r"features? (\d+)", lines[0])[1]
    one = run("part", "info", part, "--feature", feature)[1]
    check("it is that of its face", re.search(r"joint: hinge, pivot: \[.*\], axis: \[.*?\]", lines[0])[0] in one, (lines, one))


def crossed_axes():
    """A hinge whose pivot lies on the axis of a round face, and whose axis is across it."""
    part = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "..", "config", "models", "as1.hpart")
    for axis, warned in (("[1, 0, 0]", False), ("[-2, 0, 0]", False), ("[0, 1, 0]", True)):
        with open(join("crossed.yaml"), "w") as scene:
            scene.write(f"hapticd: 1\nhand: {{script: none}}\nmodels:\n  - name: rod\n    plugin: nurbs_rigid\n    motion: dynamic\n    parameters:\n"
                        f"      geometry: {os.path.abspath(part)}\n      instance: rod_1\n      joint: hinge\n      pivot: [0.09, 0.075, 0.06]\n      axis: {axis}\n")
        code, out, err = run("check", join("crossed.yaml"))
        check(f"a rod on a hinge along {axis}", code == 0 and (":12:" in out and "give axis: [1, 0, 0]" in out) == warned
              and ("crosses at the pivot" in out) == warned, out + err)


def sizes():
    out, err, info = told("box.step")
    check("the first line has the size", "40 x 30 x 20 mm, unit mm" in out.splitlines()[0] and err == "", out + err)
    out, err, info = told("box.step", "--scale", "1000")
    check("a size in m, and the scale", "40 x 30 x 20 m, unit mm, scaled by 1000" in out.splitlines()[0], out)
    check("a part too large for a hand is warned of", "53.9 m large from corner to corner, too large for a hand" in err and "is --scale right?" in err, err)
    check("part info tells the scale", "unit mm, scaled by 1000" in info, info)
    out, err, info = told("box.step", "--scale", "0.001")
    check("one too small too", "0.0539 mm large from corner to corner, too small for a hand" in err, err)
    code, out, err = run("import", join("box.step"), "-o", PART, "--scale", "1e9")
    check("a size that no part may have names the scale", code == 2 and "the part is 4e+07 m large with the factor 1e+09, expected at most 1000000 m" in err and "a smaller --scale" in err, (code, err))
    report = json.loads(told("box.step", "--json", "--fit", "0.1")[0])
    check("--fit gives the largest extent", max(abs(a - b) for a, b in zip(report["size_m"], (0.1, 0.075, 0.05))) < 1e-9, report["size_m"])
    # The control points of a sphere's quarter reach half as far again as it does.
    out, err, info = told("spline_quarter.brep", "--fit", "0.1", "--center")
    check("the size is that of the surface", "100 x 50 x 50 mm" in out.splitlines()[0] and "size: 100 x 50 x 50 mm" in info and
          "middle at (0, 0, 0) mm" in info, out + info)
    out, err, info = told("box.step", "--up", "z", "--center")
    check("the part is turned", "40 x 20 x 30 mm, unit mm, turned, z is up, centred" in out and "least corner at (-20, -10, -15) mm" in info, out + info)


def full_disks():
    for arguments in ((), ("--json",), ("--check",)):
        with open("/dev/full", "w") as full:
            done = subprocess.run([HAPTICD, "import", join("box.step"), "-o", PART, *arguments], stdout=full, stderr=subprocess.PIPE, text=True, timeout=300)
        check(f"{arguments}: a report that is not complete is told", done.returncode == 1 and "standard output cannot be written" in done.stderr, done)


def check_of_scene(*arguments):
    told(*arguments)
    with open(join("scene.yaml"), "w") as out:
        out.write("hapticd: 1\nmodels:\n  - {name: a, plugin: nurbs_rigid, parameters: {geometry: x.hpart}}\n")
    return "".join(run("check", join("scene.yaml"))[1:])


def sizes_in_scenes():
    text = check_of_scene("box.step", "--scale", "1000")
    check("check says that a part is too large, and not also too small", "too large for a hand" in text and "too small" not in text and "--scale" in text, text)
    text = check_of_scene("box.step", "--scale", "0.001")
    check("or too small", "too small for a hand" in text and "too large" not in text, text)


def open_bodies():
    for name, where in (("trough.brep", "1 border of 4 free edges, around (0, 5, 10) mm, 30 mm wide"),
                        ("shell_off.brep", "1 border of 4 free edges, around (6, 6, 10) mm")):
        out, _, info = told(name)
        for text in (out, info):
            check(f"{name}: where it is open", "open, so it is felt from both sides" in text and where in text, text)
    for placing in ((), ("--center", "--scale", "2")):
        out, _, _ = told("moved_trough.brep", *placing)
        check(f"one that the file moves is told where the CAD program has it {placing}", "around (100, 5, 10) mm, 30 mm wide" in out, out)
    out, _, info = told("loose.brep")
    check("part info has the steps of the import", "loose faces sewn over gaps" in out and "loose faces sewn over gaps" in info, info)
    check("a closed body is not open", "felt from both sides" not in out, out)


def thin_walls():
    out, _, _ = told("foil.step")
    check("the sides of a tube of 500 mm with a wall of 0.01 mm are right", "faces tried" not in out and "nothing was lost" in out, out)


def counts():
    _, _, info = told("trough.brep")
    check("one face is one face", "open, 1 face, 4 edges" in info, info)
    check("and has nothing to be sewn to", "sewn" not in info, info)


def poses():
    told("bracket.step")  # from 0 to 40, 40 and 10 mm
    info = json.loads(run("part", "info", PART, "--json")[1])
    check("part info has the middle", max(abs(a - b) for a, b in zip(info["middle_m"], (0.02, 0.02, 0.005))) < 1e-9, info["middle_m"])
    check("and a pose that centres", info["poses"]["centred"] == "pose: {position: [-0.02, -0.02, -0.005]}", info["poses"])
    check("and one with z up", info["poses"]["z_up"] == "pose: {position: [-0.02, -0.005, 0.02], orientation: [0.7071068, -0.7071068, 0, 0]}", info["poses"])
    text = run("part", "info", PART)[1]
    check("in the text too", all(pose in text for pose in info["poses"].values()) and "middle at (20, 20, 5) mm" in text, text)
    with open(join("scene.yaml"), "w") as out:
        out.write("hapticd: 1\nmodels:\n  - {name: a, plugin: nurbs_rigid, " + info["poses"]["z_up"].replace("0.7071068", "0.7") +
                  ", parameters: {geometry: x.hpart}}\n")
    err = "".join(run("check", join("scene.yaml"))[1:])
    check("a rounded quaternion is told with that of length 1", "with length 1 it is [0.7071068, -0.7071068, 0, 0]" in err, err)


def features():
    told("bracket.step")
    lines = [run("part", "info", PART, "--feature", str(i))[1] for i in range(8)]
    check("a face is told with kind, size and place", any("a plane that looks along (0, 0, 1), 40 x 40 x 0 mm large, middle at (20, 20, 10) mm" in line for line in lines), lines)
    told("sphere.step")
    line = run("part", "info", PART, "--feature", "0")[1]
    check("a sphere with its radius", "a sphere of radius 20 mm, 40 x 40 x 40 mm large, middle at (0, 0, 0) mm, centre at (0, 0, 0) mm" in line, line)


def depths(points, metres):
    """Depth and foot at some points of the part, each time with the probe from far away."""
    with open(join("scene.yaml"), "w") as out:
        json.dump({"hapticd": 1, "models": [{"name": "part", "plugin": "nurbs_rigid", "parameters": {"geometry": PART, "stiffness": 1000}}]}, out)
    with open(join("probe.csv"), "w") as out:
        out.write("t,x,y,z\n")
        for i, p in enumerate(points):
            for k, q in enumerate(([9.0] * 3, [x * metres for x in p])):
                out.write(",".join(map(repr, [(2 * i + k) * 1e-3, *q])) + "\n")
    subprocess.run([HAPTICD, "trace", join("scene.yaml"), "--probe", join("probe.csv"), "--out", join("out.csv")], check=True, capture_output=True, timeout=300)
    with open(join("out.csv")) as file:
        return [float(row["depth"]) for row in csv.DictReader(file)][1::2]


def placed_parts():
    """A part of twice the size, with z up, has twice the depths at the turned places."""
    source = random.Random(5)
    for name in ("bracket.step", "cylinder.step", "cone.step", "torus.step", "sphere.step", "spline_hole.step", "spline_cylinder.step",
                 "pin_on_rim.iges", "trough.brep", "shell_off.brep", "spline_quarter.brep", "assembly.step"):
        points = [[source.uniform(-25, 45) for _ in range(3)] for _ in range(60)]
        told(name)
        plain = depths(points, 1e-3)
        told(name, "--scale", "2", "--up", "z")
        doubled = depths([[x, z, -y] for x, y, z in points], 2e-3)
        off = max(abs(2 * a - b) for a, b in zip(plain, doubled))
        check(f"{name}: twice as large, off by {off:.2g} m", off < 2e-9, [(a, b) for a, b in zip(plain, doubled) if abs(2 * a - b) >= 2e-9][:3])


subprocess.run([MAKE_PARTS, folder], check=True, timeout=300)
for part_of_the_test in (units, names, written_without_a_name, axes, crossed_axes, sizes, full_disks, sizes_in_scenes, open_bodies, thin_walls, counts, poses, features, placed_parts):
    part_of_the_test()
finish()
