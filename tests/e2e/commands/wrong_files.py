#!/usr/bin/env python3
"""Files as new users get them wrong: every problem is told at once and at its line, and nothing else is.

A line of a file that has "# wrong: WORDS" must have a problem whose text has the words; no other line may have one. A file with "# warns:
WORDS" must have a warning.

Usage: wrong_files.py HAPTICD FOLDER       prints a line a file; exit 1 when one is off
"""
import glob
import os
import re
import sys
import tempfile

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "support"))
from e2e import check, finish, program

HAPTICD, FOLDER = sys.argv[1:3]
hapticd = program(HAPTICD)
SOURCE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "..")


def expected(file):
    """Words by line."""
    found = {}
    for number, line in enumerate(open(file), 1):
        if mark := re.search(r"# wrong: (.*)$", line):
            found[number] = mark[1]
    return found


files = sorted(glob.glob(os.path.join(FOLDER, "*.yaml")))
check("sixty of them", len(files) >= 60, len(files))
for file in files:
    done = hapticd("check", file)
    told = {}
    for line in done.stdout.splitlines():
        if (place := re.match(re.escape(file) + r":(\d+):(\d+): (.*)$", line)) and "warning:" not in line:
            told.setdefault(int(place[1]), []).append(place[3])
    wanted = expected(file)
    if warns := re.search(r"# warns: (.*)", open(file).read()):
        check(os.path.basename(file), done.returncode == 0 and "warning: " in done.stdout and warns[1] in done.stdout, done.stdout)
        continue
    missing = [f"line {n}: {words}" for n, words in wanted.items() if not any(words in text for text in told.get(n, []))]
    more = [f"line {n}: {text}" for n, texts in told.items() if n not in wanted for text in texts]
    check(os.path.basename(file), done.returncode == 2 and wanted and not missing and not more, f"missing {missing}, more {more}\n{done.stdout}{done.stderr}")

# A scene that is judged on an arm says what the arm's own check says.
arm, sphere = os.path.join(FOLDER, "9999j-torque-in-newton-millimetres.yaml"), os.path.join(FOLDER, "..", "..", "..", "config", "scenes", "sphere.yaml")
done = hapticd("check", sphere, "--device", arm)
check("a scene on another arm has that arm's warnings", done.returncode == 0 and "one raw unit is 0.02 N m" in done.stdout, done.stdout + done.stderr)

# What the hand meets on its way is as it was meant in the scenes that ship.
walked = ("comes no nearer", "cannot be felt", "cuts the force", "never clicks", "does not move", "faster than a human hand", "half a turn", "lags by", "walk")
ships = os.path.dirname(sphere)
for scene in sorted(glob.glob(os.path.join(ships, "*.yaml")) + glob.glob(os.path.join(ships, "*", "*.yaml"))):
    done = hapticd("check", scene)
    wrong = [line for line in done.stdout.splitlines() if any(words in line for words in walked)]
    check(f"the hand of {os.path.relpath(scene, ships)} meets what it shall", done.returncode == 0 and not wrong, done.stdout + done.stderr)

with tempfile.TemporaryDirectory() as folder:  # of arms, check refuses what run refuses, in the same words
    shipped = open(os.path.join(ships, "..", "devices", "simulated-premium15.yaml")).read()
    arm, scene = os.path.join(folder, "arm.yaml"), os.path.join(folder, "scene.yaml")
    geometry = os.path.abspath(os.path.join(ships, "..", "models", "sphere.yaml"))
    with open(scene, "w") as out:
        out.write(f"hapticd: 1\ndevice: arm.yaml\nhand: {{radius: 0.046}}\nmodels:\n  - {{name: ball, plugin: nurbs_rigid, parameters: {{geometry: {geometry}}}}}\n")
    for key, block in (("limits.enable.button", "limits: {enable: {button: 0}}"), ("admittance", "admittance: {mass: 1, damping: 10}"),
                       ("hd.joints[0][0]", "hd: {joints: [[5, 1, 0], [1, 1, 0], [2, 1, 0]]}"), ("hd.buttons[0]", "hd: {buttons: [3]}")):
        with open(arm, "w") as out:
            out.write(shipped.replace("limits: {force: 8.5}\n", "") + block + "\n")
        ran = hapticd("run", scene, "--virtual-time", "--for", "0.1")
        told = hapticd("check", scene)
        place = re.search(r"^" + re.escape(os.path.realpath(arm)) + r":(\d+):\d+: " + re.escape(key) + ": (.*)$", told.stdout, re.M)
        check(f"check refuses {key} as run does", ran.returncode != 0 and told.returncode == 2 and place and int(place[1]) == 1 + shipped.count("\n") - 1
              and place[2] in ran.stderr and "--virtual-time allows" not in ran.stderr, told.stdout + ran.stderr)
        alone = hapticd("check", arm)
        check(f"likewise of the arm alone: {key}", alone.returncode == 2 and f": {key}: " in alone.stdout, alone.stdout)
    for passivity, clients, warns in ((False, "add", True), (False, "off", False), (True, "add", False)):
        with open(arm, "w") as out:
            out.write(shipped.replace("limits: {force: 8.5}", f"limits: {{force: 8.5, passivity: {str(passivity).lower()}}}"))
        with open(scene, "w") as out:
            out.write(f"hapticd: 1\ndevice: arm.yaml\nclients: {clients}\nhand: {{radius: 0.046}}\n"
                      f"models:\n  - {{name: ball, plugin: nurbs_rigid, parameters: {{geometry: {geometry}}}}}\n")
        told = hapticd("check", scene).stdout
        check(f"check of passivity {passivity} with clients {clients}", ("limits.passivity: warning: false, and programs may push" in told) == warns, told)
    with open(os.path.join(folder, "path.csv"), "w") as out:
        out.write("t,x,y,z\n" + "".join(f"{i},0,0,{0.06 - 0.0005 * i}\n" for i in range(40)))
    with open(scene, "w") as out:
        out.write(f"hapticd: 1\nhand: {{script: path, path: path.csv}}\nmodels:\n  - {{name: ball, plugin: nurbs_rigid, parameters: {{geometry: {geometry}}}}}\n")
    told = hapticd("check", scene)
    check("a path in ms is told", f"{os.path.join(folder, 'path.csv')}:3:1: t: warning: " in told.stdout and "times must be in s (1 ms is 0.001)" in told.stdout, told.stdout)

for name in ("part.dae", "part.glb"):
    done = hapticd("import", name, "-o", "part.hpart")
    check(f"import of {name} says which way leads here", done.returncode == 2 and "hapticd import PART.stl -o PART.hpart" in done.stderr, done.stderr)

with tempfile.TemporaryDirectory() as folder:
    part, mesh, scene = (os.path.join(folder, name) for name in ("egg.hpart", "egg.obj", "scene.yaml"))
    with open(mesh, "w") as out:
        out.write("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    for scale, pose, told in (("0.1", "", ""), ("1000", "", "1.41e+03 m large"), ("0.0001", "", "a wrong unit?"),
                              ("0.1", "pose: {position: [0, -5, 0]}, ", "its nearest point is 4.9 m from the world's origin")):
        hapticd("import", mesh, "--scale", scale, "-o", part, check=True)
        with open(scene, "w") as out:
            out.write("hapticd: 1\nhand: {script: none}\n"
                      f"models:\n  - {{name: egg, plugin: nurbs_rigid, {pose}parameters: {{geometry: egg.hpart}}}}\n")
        done = hapticd("check", scene)
        check(f"check of a part: {told or 'no warning'}", done.returncode == 0 and (told in done.stdout if told else "warning" not in done.stdout), done.stdout)
    def imported(*options):
        return hapticd("import", mesh, "-o", part, *options)

    done = imported("--fit", "0.06", "--center", "--up", "z")
    check("triangles are fitted and turned", done.returncode == 0 and "0.06 x 0 x 0.06 m" in done.stdout, (done.stdout, done.stderr))
    done = imported("--outward", "normal")
    check("what means nothing for triangles is refused", done.returncode == 2 and "--outward has an effect only with .bpt files" in done.stderr, done.stderr)
    # What is wrong at one place hides nothing that is wrong elsewhere.
    hiding = os.path.join(folder, "hiding.yaml")
    with open(hiding, "w") as out:
        out.write(f"hapticd: 1\ndevice: {os.path.join(SOURCE, 'config/devices/simulated-premium15.yaml')}\n"
                  "hand: {script: circle, center: [0, 30, 0], normal: [0, 0, 0]}\n"
                  "models:\n  - {name: rough, plugin: nurbs_rigid, parameters: {friction_static: 0.2, friction_dynamic: 0.4}}\n")
    done = hapticd("check", hiding)
    check("all is told at once", done.returncode == 2 and all(w in done.stdout for w in (
        "hand.center[1]: 30 m is out of range", "hand.normal: is zero", "parameters.geometry: missing", "0.4 is more than friction_static, 0.2")), done.stdout)
    stl = os.path.join(folder, "cube.stl")
    open(stl, "w").write("solid\nendsolid\n")
    with open(scene, "w") as out:
        out.write("hapticd: 1\nmodels:\n  - {name: egg, plugin: nurbs_rigid, parameters: {geometry: cube.stl}}\n")
    done = hapticd("check", scene)
    check("a mesh in the place of a model says how it becomes a part", done.returncode == 2 and "hapticd import" in done.stdout, done.stdout)
finish()
