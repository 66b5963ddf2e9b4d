#!/usr/bin/env python3
"""Mistakes that were silent or told elsewhere when three strangers made them are told at their places; what is meant is not.

Usage: silent_slips.py HAPTICD SOURCE     prints one line per case; exit 1 when one is off.
"""
import csv
import json
import os
import sys
import tempfile

HAPTICD, SOURCE = (os.path.abspath(one) for one in sys.argv[1:3])
sys.path.insert(0, os.path.join(SOURCE, "tests", "support"))
from arm_files import CHAIN, TWIN, WIRED
from e2e import check, finish, program

MODELS = os.path.join(SOURCE, "config", "models")
ARM = f"device: {SOURCE}/config/devices/simulated-premium15.yaml\n"
READ = "joint: {0}, at: {1}, type: i16, scale: 9.6e-5"
LINKS = CHAIN.replace("    max_torque", "    masses: [0, 0.05, 0.03]\n    centers: [[0, 0, 0], [-0.11, 0, 0], [-0.1, 0, 0]]\n    max_torque")
PACKED = WIRED.replace("size: 12", "size: 14").replace(READ.format(1, 2), "joint: 1, at: 2, type: i20, endian: big, scale: 9.6e-6").replace(
    READ.format(2, 4), "joint: 2, at: 2, bit_offset: 20, type: i20, endian: big, scale: 9.6e-6").replace(
    READ.format(3, 6), "joint: 3, at: 2, bit_offset: 40, type: i20, endian: big, scale: 9.6e-6").replace(
    "button: 1, at: 8", "button: 1, at: 11").replace("at: 10, type: u16, method: crc16-modbus, from: 0, to: 10", "at: 12, type: u16, method: crc16-modbus, from: 0, to: 12")


def model(name="ball", shape="sphere", more="stiffness: 800", below="", plugin="nurbs_rigid"):
    return f"  - name: {name}\n    plugin: {plugin}\n{below}    parameters: {{geometry: {MODELS}/{shape}.yaml, {more}}}\n"


def scene(*models, top=ARM + "hand: {script: none}\n"):
    return f"hapticd: 1\n{top}models:\n" + "".join(models)


def at(x, y=0, z=0):
    return f"    pose: {{position: [{x}, {y}, {z}]}}\n"


BUTTON = scene(model("button", "box", "axis: [0, 0, -1], detent: []", plugin="push_button"))
# A device or a scene, what is changed in it, the key that is told, and words of it.
TOLD = [
    (LINKS, {"[-0.11, 0, 0]": "[0.11, 0, 0]"}, "parameters.arm.centers[1]", "beyond the far end of link 2"),
    (LINKS, {"[-0.11, 0, 0]": "[-0.5, 0, 0]"}, "parameters.arm.centers[1]", "beyond the near end of link 2"),
    (CHAIN, {"[-0.42, 0, 0.09]": "[0.42, 0, 0.09]"}, "mount", "is a sign or a decimal point wrong?"),
    (CHAIN, {"[-0.42, 0, 0.09]": "[0.9, 0.9, 0.9]"}, "mount", "is a sign or a decimal point wrong?"),
    (WIRED, {READ.format(2, 4): READ.format(2, 4).replace("scale", "scale_degrees")}, "parameters.wire.input.fields[2].scale_degrees", "write scale: 9.6e-05"),
    (WIRED, {"size: 12": "size: 96"}, "parameters.wire.input.size", "which are 96 bits"),
    (WIRED, {"    watchdog: 0.02": "    watchdog: 0.02\n    startup: [{send: [1, 2], wait: 10}]"}, "parameters.wire.startup[0].wait", "10 ms is 0.01 s"),
    (WIRED, {"    watchdog: 0.02": "    watchdog: 0.02\n    startup: [{expect: [1, 2], timeout: 100}]"}, "parameters.wire.startup[0].timeout", "100 ms is 0.1 s"),
    (PACKED, {"bit_offset: 20, type: i20, endian: big": "bit_offset: 20, type: i20"}, "parameters.wire.input.fields[2]", "expected endian: big here"),
    (WIRED, {"input:\n": "input:\n      id: 3\n", "    watchdog: 0.02": "    watchdog: 0.02\n    framing: {start: 0x7d}"}, "parameters.wire.input.id", "or framing, if the arm has none"),
    (WIRED, {'{id: "1209:0a0a"}': "{vendor: 1209, product: 0486}"}, "parameters.usb.product", "in hexadecimal"),
    (WIRED, {"kind: phantom": "kind: serial"}, "parameters.arm.kind", 'did you mean "chain"?'),
    (WIRED, {"{is: counter, at: 7, type: u8}": "{is: watchdog, at: 7, type: u8}"}, "parameters.wire.output.fields[4].is", "counter if it must change"),
    (WIRED, {"workspace: 0.3": "workspace: {min: [-1, -1, -1], max: [1, 1, 1]}"}, "limits.workspace", "one radius about the origin of the device frame"),
    (TWIN, {"module: simulated": "module: usb_hid"}, "module", "these are parameters of simulated"),
    (scene(model(), top="servo: {activation_radius: 0.001, hysteresis: 0}\n" + ARM + "hand: {script: none}\n"), {}, "servo.activation_radius", "a hand faster than 0.2 m/s"),
    (scene(model(below=at(0)), model("box", "box", below=at(0.08))), {}, "models[1].pose.position", "lie in one another at the start, 20 mm deep"),
    (scene(model(below=at(0)), model("box", "box", below=at(0))), {}, "models[1].pose.position", "lie in one another"),
    (scene(model("a", "box"), model("b", "box", below=at(0.05))), {}, "models[1].pose.position", "lie in one another"),
    (scene(model(), top=f"device: {{file: {SOURCE}/config/devices/simulated-premium15.yaml, mount: {{position: [0, 0, 90]}}}}\nhand: {{script: none}}\n"), {}, "device.mount.position",
     "away from its tip"),
    (scene(model("door", "box", below="    motion: kinematic\n    path: far.csv\n")), {}, "x", "50 mm is 0.05 m"),
    (scene(model("door", "box", below="    motion: kinematic\n    path: rise.csv\n"), top=ARM + "hand: {script: guided}\n"), {}, "models[0].pose", "33.5 mm deep"),
    (scene(model("door", "box", below="    motion: kinetic\n    path: rise.csv\n")), {}, "models[0].motion", 'did you mean "kinematic"?'),
    (scene(model(below="    motion: static\n", more="stiffness: 800, motion: dynamic, mass: 1")), {}, "models[0].motion", "as models[0].parameters.motion"),
    (scene(model("door", "box", below="    motion: static\n    path: rise.csv\n")), {}, "models[0].path", "write motion: kinematic in line 7"),
    (scene(model("door", "box", below="    path: turns.csv\n")), {}, "t", "does not grow"),
    (scene(model("door", "box", below="    path: turns.csv\n")), {}, "qw", "the quaternion has length 2"),
    (BUTTON, {"[]": "[[0, 0], [4, 0.003], [2, 0.004], [3, 0.005]]"}, "models[0].parameters.detent[2]", "the columns seem to be swapped"),
    (BUTTON, {"[]": "[[0, 1], [0.003, 4], [0.004, 2]]"}, "models[0].parameters.detent[0]", "[0, 1], expected [0, 0]"),
    (scene(model(more="stiffness: 800, contact_hysteresis: 1.0e-5")), {}, "models[0].parameters.contact_hysteresis", "feels the force turn from face to face"),
    (scene(model(), top=ARM + "hand: {script: press, path: rise.csv, radius: 0.053}\n"), {}, "hand.path", "replace the script in line 3 by script: path"),
]
# What must not be told of a file, whatever else is.
UNTOLD = [
    (CHAIN.replace("pose: [0, 0, 0]", "pose: [0, 0, x]").replace("[-0.42, 0, 0.09]", "[0.42, 0, 0.09]"), "is a sign or a decimal point wrong?"),
    (scene(model("door", "box", below="    motion: kinetic\n    path: rise.csv\n")), "does not follow its path"),
    (scene(model(more="stiffness: 800, texture: {amplitude: 0.1, wavelength: 0.002}")), "cannot be set up"),
    (WIRED.replace('{id: "1209:0a0a"}', "{vendor: 1209, product: 0486}"), "begins with a zero"),
    (scene(model(more="stiffness: 800, contact_hysteresis: 0.0001")), "from face to face"),
    (scene(model(below=at(0)), model("box", "box", below=at(0.1))), "in one another"),
    (scene(model(below=at(0)), model("box", "box", below=at(0.0995))), "in one another"),
    (scene(model(below=at(0), more="sides: both"), model("box", "box", below=at(0.08))), "in one another"),
]
RIGHT = [LINKS, PACKED, BUTTON.replace("[]", "[[0.001, 1], [0.003, 4], [0.004, 2], [0.005, 3]]"),
         LINKS.replace("[-0.11, 0, 0]", "[-0.25, 0, 0]")]  # a counterweight


def answer(folder, number, text):
    file = os.path.join(folder, f"file{number}.yaml")
    with open(file, "w") as out:
        out.write(text)
    _, out, _ = program(HAPTICD, {**os.environ, "STATE_DIRECTORY": folder})("check", "--json", file)
    told = json.loads(out)["files"][0]
    return told["problems"] + told["warnings"]


def words(told):
    return [f"{one['line']}: {one['key']}: {one['what']}" for one in told]


def changed(text, changes):
    for old, new in changes.items():
        assert old in text, (old, text)
        text = text.replace(old, new, 1)
    return text


def files(folder):
    for name, rows in (("far.csv", "0,0,0,0\n2000,50,0,0\n"), ("rise.csv", "0,0,0,0.05\n2,0.02,0,0.05\n"),
                       ("turns.csv", "2,0,0,0.05,1,0,0,0\n1,0.02,0,0.05,0,0,0,2\n")):
        with open(os.path.join(folder, name), "w") as out:
            out.write("t,x,y,z" + (",qw,qx,qy,qz" if name == "turns.csv" else "") + "\n" + rows)
    for number, (text, changes, key, word) in enumerate(TOLD):
        told = answer(folder, number, changed(text, changes))
        hits = [one for one in told if one["key"] == key and word in one["what"]]
        check(f"{key}: {word}", len(hits) == 1, words(told))
        if key == "x":
            check("a far row is told at the row", hits and hits[0]["file"].endswith("far.csv") and hits[0]["line"] == 3, hits)
    for number, (text, word) in enumerate(UNTOLD):
        told = answer(folder, 100 + number, text)
        check(f"not told: {word}", not any(word in one["what"] for one in told), words(told))
    for number, text in enumerate(RIGHT):
        check(f"right file {number}", not (told := answer(folder, 200 + number, text)), words(told))


def patch(name, *corners, weights=""):
    return (f"  - name: {name}\n    degree: [1, 1]\n    knots: [[0, 0, 1, 1], [0, 0, 1, 1]]\n    points:\n"
            + "".join(f"      - {list(corner)}\n" for corner in corners))


def surfaces(folder):
    """Corners that miss a neighbour by much are told; edges that are free on purpose are not."""
    a, b, c, d, e = (-0.05, 0, 0.05), (-0.05, 0, -0.05), (0, 0.03, 0.05), (0, 0.03, -0.05), (0, 0, 0.08)
    east = patch("east", c, d, (0.05, 0, 0.05), (0.05, 0, -0.05))
    cases = [(patch("west", a, b, (0, y, 0.05), d) + east, f"0{y}") for y in (0.3, 0.04, 0.06, 0.003)]
    cases += [(patch("west", a, b, c, d) + patch("east", c, (0, 0.3, -0.05), (0.05, 0, 0.05), (0.05, 0, -0.05)), "of east")]
    open_on_purpose = [
        ("two plates on a hinge", patch("west", a, b, c, d) + patch("lid", c, d, (-0.05, 0.06, 0.05), (-0.05, 0.06, -0.05))),
        ("a pyramid without a face", patch("one", e, e, (-0.05, -0.05, 0), (0.05, -0.05, 0)) + patch("two", e, e, (0.05, -0.05, 0), (0.05, 0.05, 0))
         + patch("three", e, e, (0.05, 0.05, 0), (-0.05, 0.05, 0))),
        ("two plates at one corner", patch("one", (0, 0, 0), (0, 0.05, 0), (0.05, 0, 0), (0.05, 0.05, 0)) + patch("two", (0, 0, 0), (0, -0.05, 0), (-0.05, 0, 0), (-0.05, -0.05, 0))),
        ("a step", patch("one", (0, 0, 0), (0, 0.05, 0), (0.05, 0, 0), (0.05, 0.05, 0)) + patch("two", (0, 0, 0), (0, -0.05, 0), (0.1, 0, 0), (0.1, -0.05, 0))),
    ]
    scene_text = f"hapticd: 1\n{ARM}hand: {{script: none}}\nmodels:\n  - {{name: roof, plugin: nurbs_rigid, parameters: {{geometry: roof.yaml}}}}\n"
    for number, (name, text) in enumerate([(name, text) for text, name in cases] + open_on_purpose):
        with open(os.path.join(folder, "roof.yaml"), "w") as out:
            out.write("format: hapticd-model/1\nsurfaces:\n" + text)
        told = words(answer(folder, 300 + number, scene_text))
        if number < len(cases):
            line = 9 if "of east" not in name else 16
            check(f"a corner that is far off is told at the corner: {name}", any("there is a gap between" in one for one in told)
                  and any(one.startswith(f"{line}:") for one in told), told)
        else:
            check(f"{name}: free edges are not told", not any("gap" in one for one in told), told)


def held(folder):
    """A contact is held however small the distances of the search are."""
    scene_file, table = os.path.join(folder, "held.yaml"), os.path.join(folder, "held.csv")
    run = program(HAPTICD, {**os.environ, "STATE_DIRECTORY": folder, "RUNTIME_DIRECTORY": folder})
    deepest = {}
    for radius, hysteresis in ((0.1, 0.05), (0.001, 0)):
        with open(scene_file, "w") as out:
            out.write(scene(model(), top=f"servo: {{activation_radius: {radius}, hysteresis: {hysteresis}}}\n" + ARM + "hand: {script: press, radius: 0.048, rate: 0.5}\n"))
        record = os.path.join(folder, f"held{radius}.h5")
        ran = run("run", scene_file, "--virtual-time", "--for", "3", "--record", record)
        check(f"a press runs with a radius of {radius}", ran[0] == 0, ran)
        done = run("export", record, "--csv", table, "--stream", "contacts")
        check("its contacts are exported", done[0] == 0, done)
        rows = list(csv.DictReader(open(table)))
        deepest[radius] = max(float(row[next(name for name in row if name.startswith("depth"))]) for row in rows)
    check("as deep with a short radius as with a long one", abs(deepest[0.1] - deepest[0.001]) < 1e-4 and deepest[0.1] > 0.002, deepest)


def main():
    with tempfile.TemporaryDirectory() as folder:
        files(folder)
        surfaces(folder)
        held(folder)
    finish()


main()
