#!/usr/bin/env python3
"""Plugins of the same name, and hints that lead on: the file that hides another one, what to do about a file that cannot be loaded, and
which plugin takes a geometry.

Usage: names_and_hints.py HAPTICD SOURCE PLUGINS TEST_PLUGINS     prints one line per case; exit 1 when one is off.
"""
import json
import os
import shutil
import sys
import tempfile

HAPTICD, SOURCE, PLUGINS, TESTED = sys.argv[1:5]
sys.path.insert(0, os.path.join(SOURCE, "tests", "support"))
from e2e import check, finish, program, write


def scene(folder, plugin, geometry, more=""):
    return write(folder, "scene.yaml", f"hapticd: 1\nmodels:\n  - {{name: ball, plugin: {plugin}, parameters: {{geometry: {geometry}{more}}}}}\n")


def listed(folder, ask):
    code, out, err = ask("check", scene(folder, "nurbs_rigid", os.path.join(SOURCE, "config/models/sphere.yaml"), ", friction_dyn: 0.3"))
    check("a list that is cut begins with the names that may be meant", code == 2 and "expected one of friction_dynamic, friction_static, " in err + out
          and "in all)" in err + out, err + out)


def hidden(folder, ask):
    other = os.path.join(folder, "other")
    os.mkdir(other)
    shutil.copy(os.path.join(PLUGINS, "nurbs_rigid.so"), os.path.join(other, "aaa.so"))
    code, out, _ = ask("--plugin-path", other, "plugin", "list", "--files")
    lines = [line for line in out.splitlines() if line.startswith("nurbs_rigid ")]
    shipped = os.path.join(PLUGINS, "nurbs_rigid.so")
    check("NAME.so comes before another file in an earlier folder, and the list says which one hides which",
          code == 0 and len(lines) == 2 and f"(hidden by {shipped})" in lines[0] and "hidden" not in lines[1], out)
    code, out, _ = ask("--plugin-path", other, "plugin", "list", "--json")
    by_file = {p["file"]: p["hidden_by"] for p in json.loads(out)["plugins"] if p["name"] == "nurbs_rigid"}
    check("as JSON, too", by_file == {os.path.join(other, "aaa.so"): shipped, shipped: None}, by_file)
    code, out, err = ask("plugin", "new", "nurbs_rigid", "--dir", os.path.join(folder, "mine"))
    check("a new plugin with the name of another is warned of", code == 0 and 'there is a plugin "nurbs_rigid" already' in err and shipped in err, err)
    code, out, err = ask("plugin", "new", "my_own_shape", "--dir", os.path.join(folder, "own"))
    check("one with a name of its own is not", code == 0 and err == "", err)
    for name, like in (("my-ball", "my_ball"), ("2ndBall", "ndball"), ("template", "my_shape"), ("\u00e4", "my_shape")):
        code, out, err = ask("plugin", "new", name)
        check(f"{name} is refused with a name that can be used", code == 2 and f"beginning with a letter: {like}\n" in err, err)
    code, out, _ = ask("plugin", "info", "push_button")
    check("a list of rows tells its rows", "list of 1 to 64 rows of 2 numbers each" in out, out)
    check("and one of numbers its numbers", "list of 3 numbers" in out, out)


def unloadable(folder, ask):
    broken = os.path.join(folder, "broken")
    os.mkdir(broken)
    write(broken, "junk.so", "junk")
    code, out, _ = ask("--plugin-path", broken, "check", scene(folder, "junk", "x"))
    check("a plugin file that cannot be loaded is told what to do", code == 2 and "build it again, for this machine" in out
          and "add the folder of the missing file" not in out, out)
    module = write(folder, "arm.yaml", "hapticd-device: 1\nmodule: template\nname: x\n")
    code, out, _ = ask("check", module)
    check("a shape's name as a module is told the module, and no build", code == 2 and 'did you mean "template_arm"?' in out
          and "cmake" not in out, out)


def geometries(folder, ask):
    shutil.copy(os.path.join(SOURCE, "tests/e2e/package/sphere.step"), folder)
    code, out, _ = ask("check", scene(folder, "nurbs_rigid", "sphere.step"))
    check("a STEP file is told its import, and no soft body of itself", code == 2 and "sphere.step -o sphere.hpart" in out
          and "--medial MESH.stl" in out, out)
    code, out, _ = ask("check", scene(folder, "push_button", f"{SOURCE}/config/models/branch.ma"))
    check("a medial mesh is told its plugin", code == 2 and "use it as the geometry of mat_deformable" in out, out)
    part = f"{SOURCE}/config/models/as1.hpart"
    code, out, err = ask("check", scene(folder, "push_button", part))
    check("a part for a button is one problem", code == 2 and err.startswith("1 problem") and "no such file" not in out, out + err)
    code, out, _ = ask("check", scene(folder, "nurbs_rigid", part, ", instance: plate_2"))
    check("a misspelt instance is told which was meant", code == 2 and 'did you mean "plate_1"?' in out, out)
    told = write(folder, "unit.yaml", "hapticd: 1\nmodels:\n  - {name: ball, plugin: unit, parameters: {stiffness: 1}}\n")
    code, out, _ = ask("--plugin-path", TESTED, "check", told)
    check("a stiffness of another unit is not judged in N/m", code == 0 and "1 N/mm is 1000 N/m" not in out, out)
    code, _, said = ask("part", "info", f"{SOURCE}/config/models/sphere.yaml")
    check("a model file needs no part", code == 2 and "a model file needs no import" in said, said)


def plugin_files(folder, ask):
    """What people give in the place of a plugin's file, and old notes of the quarantine."""
    bump = os.path.join(folder, "bump")
    os.mkdir(bump)
    code, _, err = ask("plugin", "check", bump)
    check("a folder without a plugin is told to be built", code == 2 and f"{bump} is a folder" in err and "build it first" in err, err)
    shutil.copy(os.path.join(PLUGINS, "nurbs_rigid.so"), os.path.join(bump, "bump.so"))
    code, _, err = ask("plugin", "check", bump)
    check("a folder is told the file in it", code == 2 and err.rstrip().endswith(f"expected the file of a plugin: {bump}/bump.so"), err)
    code, _, err = ask("plugin", "check", "nurbs_rigid")
    check("the name of a plugin is told its file", code == 2 and "the file of the plugin with this name is" in err and "nurbs_rigid.so" in err, err)
    os.environ["HAPTICD_PLUGIN_PATH"] = folder + "/none"
    absent = program(HAPTICD, dict(os.environ, RUNTIME_DIRECTORY=folder, STATE_DIRECTORY=folder))("plugin", "list")
    del os.environ["HAPTICD_PLUGIN_PATH"]
    check("a folder of the path that does not exist is told", absent[0] == 0 and f"HAPTICD_PLUGIN_PATH names {folder}/none, but there is no such folder" in absent[2], absent)
    old = "nurbs_rigid\tan abort\t{} bytes of {}.80406239 /x/nurbs_rigid.so\n"
    note = write(folder, "quarantine", old.format(93968, 1795916526) + old.format(93999, 1795916626))
    balls = write(folder, "balls.yaml", "hapticd: 1\nmodels:\n" + "".join(
        f"  - {{name: {name}, plugin: nurbs_rigid, parameters: {{geometry: {SOURCE}/config/models/sphere.yaml}}}}\n" for name in "ab"))
    code, out, err = ask("run", balls, "--virtual-time", "--for", "0.1")
    check("old builds in the quarantine are told once, the newest with its date", code == 0 and (out + err).count("ended an earlier run") == 1
          and "/x/nurbs_rigid.so of 2026-11-29 01:43:46 UTC, 93999 bytes; and 1 before it" in out + err, out + err)
    os.remove(note)


with tempfile.TemporaryDirectory(dir="/dev/shm") as scratch:
    said = program(HAPTICD, dict(os.environ, RUNTIME_DIRECTORY=scratch, STATE_DIRECTORY=scratch))
    listed(scratch, said)
    hidden(scratch, said)
    unloadable(scratch, said)
    geometries(scratch, said)
    plugin_files(scratch, said)
finish()
