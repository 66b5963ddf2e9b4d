#!/usr/bin/env python3
"""What people write by mistake is named, with what they meant: files of other programs, units, endings, words.

Usage: slips_of_users.py HAPTICD SOURCE     prints one line per case; exit 1 when one is off.
"""
import os
import struct
import sys
import tempfile

HAPTICD, SOURCE = sys.argv[1], sys.argv[2]
sys.path.insert(0, os.path.join(SOURCE, "tests", "support"))
from e2e import check, finish, program

SCENE = """hapticd: 1
device: {source}/config/devices/simulated-premium15.yaml
clients: {clients}
models:
  - name: part
    plugin: nurbs_rigid
    parameters: {{geometry: {geometry}, stiffness: {stiffness}}}
"""
SPHERE = os.path.join(SOURCE, "config", "models", "sphere.yaml")
STL = struct.pack("<80sI12f2x", b"", 1, *[0.0] * 3, 0, 0, 0, 1, 0, 0, 0, 1, 0)


def write(folder, name, content):
    file = os.path.join(folder, name)
    with open(file, "wb") as out:
        out.write(content if isinstance(content, bytes) else content.encode())
    return file


def scene(folder, geometry=SPHERE, stiffness=800, clients="off"):
    return write(folder, "scene.yaml", SCENE.format(source=SOURCE, geometry=geometry, stiffness=stiffness, clients=clients))


def foreign(folder, ask):
    for name, content, kind in (("cube.stl", STL, "a mesh (STL)"), ("block.step", "ISO-10303-21;\nHEADER;\n", "a STEP file"),
                                ("cube.obj", "v 0 0 0\n", "a mesh (OBJ)")):
        file = write(folder, name, content)
        code, out, err = ask("check", scene(folder, geometry=name))
        part = name.split(".")[0] + ".hpart"
        check(f"geometry: {name} is told how to come in", code == 2 and f"{kind}, expected YAML" in out + err
              and f"hapticd import {file} -o {part}" in out + err, (code, out, err))
    code, out, err = ask("check", write(folder, "a.hpart", b"\3\0\0"))
    check("a part is no scene", code == 2 and "hapticd part info" in out + err, (code, out, err))
    code, out, err = ask("import", write(folder, "cubestl", STL), "-o", os.path.join(folder, "x.hpart"))
    check("a file without an ending is asked for it", code == 2 and "expected the ending .bpt, .stl" in err, (code, out, err))
    code, out, err = ask("import", write(folder, "short.stl", STL[:-1]), "-o", os.path.join(folder, "x.hpart"))
    check("a short STL is told its length", code != 0 and "1 triangles has 134 bytes, and this file has 133" in err, (code, out, err))


def numbers(folder, ask):
    code, out, _ = ask("check", scene(folder, stiffness=0.8))
    check("a stiffness in N/mm is warned of", code == 0 and "0.8 N/m cannot be felt" in out and "1 N/mm is 1000 N/m" in out, out)
    code, out, _ = ask("check", scene(folder, clients="{mode: add, max_force: 40}"))
    check("so is a bound beyond the arm's", code == 0 and "clients.max_force" in out and "8.5 N at most" in out, out)
    code, out, _ = ask("check", scene(folder))
    check("a good scene is not", code == 0 and "warning" not in out, out)


def words(folder, ask):
    code, _, err = ask("run", scene(folder), "--for", "0.1", "--virtual-time", "--picture", os.path.join(folder, "run.png"))
    check("a picture is no PNG", code == 2 and "ends in .svg" in err and not os.path.exists(os.path.join(folder, "run.png")), err)


with tempfile.TemporaryDirectory(dir="/dev/shm") as scratch:
    ask = program(HAPTICD, dict(os.environ, RUNTIME_DIRECTORY=scratch, STATE_DIRECTORY=scratch))
    foreign(scratch, ask)
    numbers(scratch, ask)
    words(scratch, ask)
finish()
