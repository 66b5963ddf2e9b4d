#!/usr/bin/env python3
"""What people who write a shape and its hand get wrong is reported at its own place, all at once, and with a fix that helps.

Usage: shape_slips.py HAPTICD SOURCE     prints one line per case; exit 1 when one is off.
"""
import os
import re
import sys
import tempfile

HAPTICD, SOURCE = sys.argv[1], sys.argv[2]
sys.path.insert(0, os.path.join(SOURCE, "tests", "support"))
from e2e import check, finish, program, write

BALL = f"models:\n  - {{name: ball, plugin: nurbs_rigid, parameters: {{geometry: {SOURCE}/config/models/sphere.yaml, stiffness: 800}}}}\n"
ROOF = """format: hapticd-model/1
surfaces:
  - name: west
    degree: [1, 1]
    knots: [[0, 0, 1, 1], [0, 0, 1, 1]]
    points: [[-0.05, 0, 0.05], [-0.05, 0, -0.05], [0, 0.03, 0.05], [0, 0.03, -0.05]]
  - name: east
    degree: [2, 1]
    knots: [[0, 0, 0, 1, 1, 1], [0, 0, 1, 1]]
    points: [[0, 0.03, 0.05], [0, 0.03, -0.05], [0.03, 0.03, 0.05], [0.03, 0.03, -0.05], [0.05, 0, 0.05], [0.05, 0, -0.05]]
    weights: [1, 1, 0.8, 0.8, 1, 1]
edges:
  - sides: [[west, u1], [east, u0]]
"""


def reach(folder, ask):
    code, out, _ = ask("device", "info", os.path.join(SOURCE, "config/devices/simulated-premium15.yaml"))
    box = re.search(r"reach of the tip in the device frame: x (\S+) to (\S+), y (\S+) to (\S+), z (\S+) to (\S+) m", out)
    check("device info tells a box of reach, alike to the left and to the right", code == 0 and box and 0.3 < float(box[2]) < 0.5
          and abs(float(box[1]) + float(box[2])) < 2e-3, out)

    def start(place):
        return ask("check", write(folder, "far.yaml", f"hapticd: 1\nhand: {{script: hold, center: {place}, radius: 0, approach: 0}}\n{BALL}"))

    code, out, _ = start("[0, 0.1, 0.6]")
    near = re.search(r"the nearest place that it reaches is (\[.*?\])", out)
    check("a hand out of reach is told the nearest place", code == 2 and near, out)
    if near:
        code, out, _ = start(near[1])
        check("which the arm reaches", code == 0, out)


def hand_path(folder, rows):
    path = write(folder, "way.csv", "t,x,y,z\n" + rows)
    return path, write(folder, "follows.yaml", f"hapticd: 1\nhand: {{script: path, path: way.csv}}\n{BALL}")


def tables(folder, ask):
    path, scene = hand_path(folder, "0,0.04,0.035,0\n0.5,O.04,0.015,0\n0.4,0.04,x,0\n1.0,0.04,0.012\n2,0.04,0.035,0\n")
    code, out, err = ask("check", scene)
    check("a hand's path is told all problems at their places", code == 2 and all(f"{path}:{at}: " in out for at in ("3:5", "4:1: t", "4:10", "5:1"))
          and err.startswith("4 problems") and "follows.yaml:2" not in out, out + err)
    path, scene = hand_path(folder, "0,40,35,0\n500,40,15,0\n2000,40,35,0\n")
    code, out, _ = ask("check", scene)
    check("millimetres and milliseconds are told in the table", code == 2 and f"{path}:2:1: x: " in out and "is it in mm?" in out
          and f"{path}:3:1: t: " in out and "times must be in s" in out and "hand.center" not in out, out)
    path = write(folder, "model.csv", "t,x,y,z,qw,qx,qy,qz\n0,0,0,0,1,0,0,0\n1,0,0,0,1,1,0,0\n0.5,0,0,0,1,0,0,0\n2,0,0,0,2,0,0,0\n")
    scene = write(folder, "moved.yaml", "hapticd: 1\nhand: {script: none}\n" + BALL.replace("name: ball,", "name: ball, motion: kinematic, path: model.csv,"))
    code, out, _ = ask("check", scene)
    check("a model's path, too", code == 2 and all(f"{path}:{at}: " in out for at in ("3:1: qw", "4:1: t", "5:1: qw")), out)


def geometry(folder, ask):
    scene = write(folder, "roof-scene.yaml", "hapticd: 1\nhand: {script: none}\nmodels:\n  - {name: roof, plugin: nurbs_rigid, parameters: {geometry: roof.yaml}}\n")

    def told(**changes):
        text = ROOF
        for old, new in changes.values():
            assert old in text, old
            text = text.replace(old, new, 1)
        roof = write(folder, "roof.yaml", text)
        code, out, err = ask("check", scene)
        return code, out.replace(roof, "ROOF"), err

    code, out, err = told(knots=("[[0, 0, 1, 1], [0, 0, 1, 1]]", "[[0, 0, 1, 0.5], [0, 0, 1, 1]]"), weights=("0.8, 0.8", "0.8, -1"))
    check("knots and weights are told at their place", code == 2 and "ROOF:5:23: surfaces[0].knots[0][3]: " in out
          and "ROOF:11:26: surfaces[1].weights[3]: " in out, out)
    check("and nothing else is counted", err.startswith("2 problems") and "own places" not in out, out + err)
    code, out, err = told(edge=("[west, u1]", "[wset, u1]"))
    check("an edge of no surface is told which was meant", code == 2 and "ROOF:13:14: edges[0].sides[0][0]: " in out
          and 'there is no surface "wset"' in out and 'did you mean "west"?' in out, out)
    east = ROOF[ROOF.index("[[0, 0.03, 0.05], [0, 0.03, -0.05], [0.03"):ROOF.index("\n    weights")]
    points = re.findall(r"\[[^\[\]]*\]", east)
    code, out, _ = told(folded=(east, f"[{', '.join(points[0::2] + points[1::2])}]"))
    check("a folded surface of 3 by 2 points is warned of", code == 0 and "run to and fro" in out, out)
    code, out, _ = told()
    check("a good one is not", code == 0 and "warning" not in out, out)


def told_of(folder, ask):
    """A function that checks a scene with a hand."""
    return lambda hand, top="", models=BALL: ask("check", write(folder, "hand.yaml", f"hapticd: 1\nhand: {{{hand}}}\n{top}{models}"))


def presses(folder, ask):
    told = told_of(folder, ask)
    for rise in (0.2, 0.5, 1):
        code, out, _ = told(f"script: press, center: [0, 0, -0.09], radius: 0.05, rise: {rise}, rate: 0.2")
        check(f"a press of {rise} m comes out behind the ball", code == 0 and "comes out behind" in out, out)
    door = (f"  - {{name: door, plugin: nurbs_rigid, motion: dynamic, pose: {{position: [-0.06, 0, 0.08]}}, parameters: {{geometry: {SOURCE}/config/models/door.yaml, "
            "stiffness: 800, mass: 0.4, joint: hinge, axis: [0, 1, 0], limits: [0, 0.6], angular_tether: 0.12, angular_drag: 0.02}}\n")
    swings = (f"models:\n  - {{name: ball, plugin: pendulum, parameters: {{geometry: {SOURCE}/config/models/sphere.yaml, stiffness: 800, "
              "pivot: [0, 0.2, 0], axis: [1, 0, 0], mass: 0.5, length: 0.2}}\n")
    for models, before in ((BALL, True), (BALL + door, False), (swings, False)):
        code, out, _ = told("script: press, center: [0.01, 0, -0.05], radius: 0.04, rise: 0.14, rate: 0.2", models=models)
        check("a press into a body that gives way is not judged by a thickness", code == 0 and ("comes out behind" in out) == before, out)
    code, out, _ = told("script: press, center: [0, 0, -0.09], radius: 0.05, rise: 0.003, rate: 1")
    check("one of 3 mm does not", code == 0 and "warning" not in out, out)


def radii(folder, ask):
    """A hand that meets nothing is told the radius with which it does."""
    told = told_of(folder, ask)
    for hand in ("radius: 0.1", "radius: 0.02", "radius: 0.1, script: press, rise: 0.005, rate: 1", "radius: 0.01, script: tap, rise: 0.004"):
        code, out, _ = told(hand)
        radius = re.search(r"hand.radius of (\S+) m", out)
        check(f"a hand with {hand} is told a radius", code == 0 and radius, out)
        if radius:
            code, out, _ = told(re.sub(r"radius: [^,]*", f"radius: {radius[1]}", hand))
            check("and the warning goes away with it", code == 0 and "warning" not in out, out)
    code, out, _ = told("radius: 0.01, center: [0, 0.1, 0]")
    check("a hand that no radius leads to the ball is told none", "feels nothing" in out and "give a hand.radius" not in out, out)
    for size, by in ((0.05, 0.0055), (0.05, 0.008), (0.1, 0.008)):  # parts of 5 and 10 mm, which the hand passes around
        small = re.sub(r"^      - \[(.*)\]$", lambda m: "      - [" + ", ".join(f"{size * float(x) + by:g}" for x in m[1].split(",")) + "]",
                       open(f"{SOURCE}/config/models/box.yaml").read(), flags=re.M)
        part = write(folder, "small.yaml", small)
        models = f"models:\n  - {{name: rods, plugin: nurbs_rigid, parameters: {{geometry: {part}, stiffness: 500}}}}\n"
        code, out, _ = told("script: stroke", models=models)
        radius = re.search(r"expected a hand.radius of (\S+) m, with which it touches", out)
        check(f"a hand round a part of {size * 100} mm at {by} m is told a radius, and no other place", code == 0 and radius and "mount.position" not in out, out)
        if radius:
            code, out, _ = told(f"script: stroke, radius: {radius[1]}", models=models)
            check("and touches it with that", code == 0 and "feels nothing" not in out, out)


def scripts(folder, ask):
    told = told_of(folder, ask)
    huge = re.sub(r"^      - \[(.*)\]$", lambda m: "      - [" + ", ".join(str(30 * float(x)) for x in m[1].split(",")) + "]",
                  open(f"{SOURCE}/config/models/sphere.yaml").read(), flags=re.M)
    write(folder, "huge.yaml", huge)
    write(folder, "huge-scene.yaml", "hapticd: 1\nhand: {radius: 0.046}\nmodels:\n  - {name: ball, plugin: nurbs_rigid, "
          "pose: {position: [0, 0, -1.4]}, parameters: {geometry: huge.yaml, stiffness: 800}}\n")
    code, out, _ = ask("check", os.path.join(folder, "huge-scene.yaml"))
    check("a model that is too large is told, and that the hand starts inside, too", "m large; a hand feels" in out and "the hand starts inside ball" in out, out)
    code, out, _ = told("script: press, radius: 0.05", models=BALL.replace("stiffness: 800", "stiffness: 800, tip_radius: 0.05"))
    check("a tip of 50 mm that reaches into the model is told, and no surface is turned", code == 0 and "the hand starts inside ball" in out
          and "a ball of 50 mm about it (tip_radius)" in out and "other side" not in out, out)
    both = f"device: {{file: {SOURCE}/config/devices/simulated-premium15.yaml, hand: {{script: hold, radius: 0.04}}}}\n"
    code, out, _ = told("script: press, radius: 0.05, rise: 0.003, rate: 1", both)
    check("two hands are told, and which holds", code == 0 and "device.hand: warning" in out and "these here hold: script, radius" in out, out)
    for key in ("rise: 0, rate: 1", "rise: 0.003, rate: 0"):
        code, out, _ = told(f"script: tap, radius: 0.05, {key}")
        check(f"a tap with {key} never taps", code == 0 and "never does its script" in out, out)
    code, out, _ = told("script: press, center: [0.06, 0, -0.01], normal: [0, 1, 0], radius: 0.015, rise: 0.005, rate: 1")
    check("a hand that moves past the model is told its normal, not a radius", "turn hand.normal" in out and "hand.radius above" not in out, out)
    code, out, _ = told("script: press, center: [0.06, 0, -0.09], normal: [0, 1, 0], radius: 0.04, rise: 0.01, rate: 1, stiffness: 5, tremor: 0, wander: 0")
    check("a soft hand is told its spring", code == 0 and "hand.stiffness: warning" in out and "a stiffer hand" in out, out)
    code, out, _ = told("script: press, normal: [0, 1]")
    check("three numbers are no rows", "2 numbers, expected 3 numbers\n" in out, out)
    code, out, err = told("script: press", models=BALL.replace("name: ball,", "name: ball, pose: {orientation: {axis: [1, 0, 0], angle: 90}},"))
    check("a turn about an axis is told as it was meant", "90 degrees about this axis are [0.7071068, 0.7071068, 0, 0]" in out, out)
    check("and that the hand was not moved", "the hand was not moved yet" in err, err)


with tempfile.TemporaryDirectory(dir="/dev/shm") as scratch:
    ask = program(HAPTICD, dict(os.environ, RUNTIME_DIRECTORY=scratch, STATE_DIRECTORY=scratch))
    for part in (reach, tables, geometry, presses, radii, scripts):
        part(scratch, ask)
finish()
