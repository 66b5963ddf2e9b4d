#!/usr/bin/env python3
"""A problem of a file hides no warning about its other values, and nothing is told that only follows from it.

Usage: values_beside_problems.py HAPTICD SOURCE     prints one line per case; exit 1 when one is off.
"""
import json
import os
import sys
import tempfile

HAPTICD, SOURCE = (os.path.abspath(one) for one in sys.argv[1:3])
sys.path.insert(0, os.path.join(SOURCE, "tests", "support"))
from e2e import check, finish, program
from scene_files import ARM, BOX, CUBIC, MASS, QUADRIC, SOFT, body, flat_net, model, net, own_state, pendulum, scene, texts, write

# A wrong key hides no judgement of the others. A bar stands before each place, with what is told there.
LATE = [
    ("a typo and friction turned round", scene(model("viscocity: 0.5, friction_static: 0.2, friction_dynamic: |0.4")), ["more than friction_static"]),
    ("a typo and millimetres", scene(model("dampnig: 3, stiffness: |0.8, texture: {amplitude: 0.0001, wavelength: |0.5}")),
     ["cannot be felt", "0.5 mm is 0.0005 m"]),
    ("a pose of Euler angles, far away", scene(model("stiffness: 800") + "    pose: {position: |[5, 10, 0], orientation: [0, 90, 0]}\n"),
     ["where no arm reaches"]),
    ("a rate in kHz and a radius in mm", scene(model("stiffness: 800"), top="servo: {rate: 1, activation_radius: |100, gravity: |[0, 9.81, 0]}\n"),
     ["100 mm is 0.1 m", "points up"]),
    ("a cut-off of three samples", scene(model("damping: 3"), top=f"device: {ARM}\nservo: {{rate: 1, velocity: {{estimator: butterworth, parameter: |3}}}}\n"),
     ["a cut-off of 3 Hz lags"]),
    ("programs: seconds, newtons, metres", scene(model("stiffness: 800"), top="clients: {mode: add, answer_time: 0.1, max_force: |85, origin: |[0, 0, 90]}\n"),
     ["gives 8.5 N at most", "90 mm is 0.09 m"]),
    ("one arm and a list, of one name", scene(model("stiffness: 800"), top=f"device: {ARM}\ndevices:\n  - {ARM}\n  - ||{ARM}\n"), ["another device is named", "in the same place"]),
    ("one name twice, in one place", scene(model("stiffness: 800"), model("stiffness: 700").replace("  - n", "  - |n")), ["the same geometry"]),
    ("a hand: a script, and degrees", scene(model("stiffness: 800"), top=f"device: {ARM}\nhand: {{script: strokes, sweep: |52, rise: 8}}\n"), ["52 degrees is"]),
    ("a hand whose axis is no direction", scene(model("stifness: 800"), top=f"device: {ARM}\nhand: {{radius: 0.046, normal: |[0, 0, 0]}}\n"), ["is zero"]),
    ("of another plugin, and a model file of another", scene(model("young: 20000", "mat_deformable").replace("geometry: ", "geometry: |")), ["medial: expected"]),
    ("a joint forgotten, and mm", body(MASS + "tether: 20, gravity: false, dampnig: 1, pivot: ||[5, 0, 0], axis: [0, 1, 0]", geometry=BOX),
     ["5 mm is 0.005 m", "add joint: hinge"]),
    ("a body: degrees, grams and a name", body("joint: slide, tether: 20000, mass: |500, spin: |[360, 0, 0]"), ["500 g is 0.5 kg", "360 degrees/s"]),
    ("a curve of a button with two mistakes", scene(model("axis: [0, 0, -1], detent: [|[0, 1], [0.003, 4], |[0.004, |-2], [0.005, 3]]", "push_button", BOX)),
     ["expected [0, 0]", "above 0 N", "out of range"]),
    ("a pendulum: an axis along gravity, a pivot below", pendulum("stifness: 900, pivot: |[0, -0.25, 0], length: 0.25, axis: |[0, 1, 0]"),
     ["expected a pivot above them", "along gravity"]),
    ("what a plugin refuses, and a wave in mm", scene(model("friction_dynamic: |0.3, texture: {amplitude: 0.0001, wavelength: |0.5}")),
     ["more than friction_static", "0.5 mm is 0.0005 m"]),
    ("what is stiff beside a typo", scene(model("dampnig: 3, stiffness: |80000")), ["stable up to"]),
    ("a spring in N/mm beside a misspelt script", scene(model("stiffness: 800"), top=f"device: {ARM}\nhand: {{script: |guidet, stiffness: |0.5}}\n"),
     ["expected one of", "does not follow the program that leads it"]),
]
# What follows only from a value that was not read is not told.
FOLLOWS = [
    ("a tether misspelt", body("mass: 0.5, tehter: 200"), "nothing holds it"),
    ("a tether out of range", body("mass: 0.5, tether: -200"), "nothing holds it"),
    ("gravity misspelt", scene(model("motion: dynamic, mass: 0.5"), top="servo: {gravty: [0, 0, 0]}\n"), "nothing holds it"),
    ("a friction misspelt", scene(model("friction_statik: 0.5, friction_dynamic: 0.4")), "more than friction_static"),
    ("a friction of no number", scene(model("friction_static: much, friction_dynamic: 0.4")), "more than friction_static"),
    ("the other friction misspelt", scene(model("friction_static: 0.5, friction_dynamik: 0.4")), "friction_dynamic is not given"),
    ("a wall whose scale is wrong", scene(model("stiffness: 800, exponent: 0.25, depth_scale: -1")), "as a blow"),
    ("a place that is wrong", scene(model("stiffness: 800"), model("stiffness: 800", name="two") + "    pose: {position: [1, 2]}\n"), "the same geometry"),
    ("a rate that is wrong", scene(model("stiffness: 3000"), top=f"device: {ARM}\nservo: {{rate: 100 Hz}}\n"), "is stable up to"),
    ("a hand whose length is wrong", scene(model("stiffness: 800"), top=f"device: {ARM}\nhand: {{script: circle, radius: 46, rate: 100}}\n"), "faster than a human"),
    ("a hand's script that is none", scene(model("stiffness: 800"), top=f"device: {ARM}\nhand: {{script: zzzzzz, stiffness: 0.5}}\n"), "so soft"),
    ("a joint misspelt", body(MASS + "tether: 20, gravity: false, joint: hinges, pivot: [0.05, 0, 0]"), "add joint"),
    ("a stiffness misspelt", scene(model("axis: [0, 0, -1], stifness: 100, end_stiffness: 800", "push_button", BOX)), "too soft for a stop"),
]
# In model files, too, with the words of all that is told.
LATE_MODELS = [
    ("weights in rows, degrees turned round", "nurbs_rigid", net([2, 3], f"[{CUBIC}, {QUADRIC}]", "    weights: [[1, 1, 1, 1]]\n"),
     ["one flat list", "the knots fit degree: [3, 2]"]),
    ("knots of Rhino, and another format", "nurbs_rigid", net([3, 2], f"[{CUBIC.replace('0, 0', '0', 1).replace('1, 1]', '1]')}, "
     f"{QUADRIC.replace('0, 0', '0', 1).replace('1, 1]', '1]')}]", form=2), ["expected hapticd-model/1", "knots[u]", "knots[v]", "as Rhino does"]),
    ("a typo and mm", "nurbs_rigid", net([3, 2], f"[{CUBIC}, {QUADRIC}]", "    outwards: forward\n", flat_net(20)), ["unknown key", "m large"]),
    ("names of edges", "nurbs_rigid", net([3, 2], f"[{CUBIC}, {QUADRIC}]", "edges:\n  - sides: [[nett, u0], [net, u1]]\n  - sides: [[net, v0], [net, v0]]\n"),
     ["a name or index", "a side with itself"]),
    ("percent, kPa and mm", "mat_deformable", SOFT + "  young: 10\n  poisson: 45\n  thickness: 20\n", ["expected 0 to 0.5", "softer than any tissue", "20 mm is 0.02 m"]),
    ("a typo, and g", "mat_deformable", SOFT + "  stiffness: 300\n  dampnig: 1\n  mass: 10\n", ["unknown key", "10 g is 0.01 kg"]),
    ("indices from 1 in mm", "mat_deformable", "2 1 0\nv 0 0 0 10\nv 40 0 0 12\ne 1 2\n", ["different vertices", "in millimetres?"]),
]
LATE_MODELS_FOLLOW = [("a stiffness misspelt", "mat_deformable", SOFT + "  stiffnes: 300\n", "cannot be felt"),
                      ("a radius of no number", "mat_deformable", SOFT.replace("[[0.02, 0.02, 0.02]]", "thick") + "  stiffness: 300\n  mass: 1\n", "kg in all")]


def places_of_bars(text):
    lines = text.split("\n")
    return [(n + 1, at - line[:at].count("|") + 1) for n, line in enumerate(lines) for at, letter in enumerate(line) if letter == "|"]


def told_of(folder, name, text):
    """Everything that is told of a file with problems."""
    file, *_ = write(folder, name, text)
    code, out, err = program(HAPTICD, own_state(folder))("check", "--json", file)
    check(f"{name}: is refused", code == 2, err)
    told = json.loads(out)["files"][0]
    return told["problems"] + told["warnings"]


def late(folder):
    for i, (name, text, words) in enumerate(LATE):
        told = told_of(folder, f"late{i}.yaml", text)
        for place, word in zip(places_of_bars(text), words, strict=True):
            check(f"{name}: {word}: told at once, at its place",
                  any((one["line"], one["column"]) == place and word in one["what"] for one in told), (place, texts(told)))
    for i, (name, plugin, text, words) in enumerate(LATE_MODELS):
        file, *_ = write(folder, f"late{i}.{'ma' if text[0].isdigit() else 'yaml'}", text)
        told = " ".join(texts(told_of(folder, "late_model.yaml", scene(model("", plugin, geometry=file)))))
        check(f"{name}: told at once", all(word in told for word in words), told)
    for i, (name, plugin, text, word) in enumerate(LATE_MODELS_FOLLOW):
        file, *_ = write(folder, f"follows_model{i}.yaml", text)
        told = texts(told_of(folder, "late_model.yaml", scene(model("", plugin, geometry=file))))
        check(f"{name}: nothing that only follows", not any(word in one for one in told), told)
    for i, (name, text, word) in enumerate(FOLLOWS):
        told = told_of(folder, f"follows{i}.yaml", text)
        check(f"{name}: nothing that only follows", not any(word in one["what"] for one in told), texts(told))


def main():
    with tempfile.TemporaryDirectory() as folder:
        late(folder)
    finish()


main()
