#!/usr/bin/env python3
"""Values that formats and plugins allow and nobody means are told at their place; what ships and what is usual is not.

Usage: unusual_values.py HAPTICD SOURCE     prints one line per case; exit 1 when one is off.
"""
import glob
import json
import os
import sys
import tempfile

HAPTICD, SOURCE = (os.path.abspath(one) for one in sys.argv[1:3])
sys.path.insert(0, os.path.join(SOURCE, "tests", "support"))
from e2e import check, finish, program
from scene_files import ARM, BOX, BUTTON, CUBIC, MASS, P, QUADRIC, SARCOS, SOFT, body, flat_net, model, moved, net, own_state, pendulum, scene, texts, write

# Before the place stands a bar: what is told there, and a word of it.
SCENES = [
    ("a friction of no material", scene(model("friction_static: |5, friction_dynamic: 1")), P + "friction_static", "rubber"),
    ("likewise of a sliding tip", scene(model("friction_static: 5, friction_dynamic: |5")), P + "friction_dynamic", "rubber"),
    ("friction that ends as it slides", scene(model("friction_static: |0.4")), P + "friction_static", "friction_dynamic is not given"),
    ("a damper in N s/mm", scene(model("stiffness: 800, damping: |1000")), P + "damping", "0.1 m/s with 100 N"),
    ("a drag of 10 N", scene(model("stiffness: 800, viscosity: |100")), P + "viscosity", "0.1 m/s with 10 N"),
    ("a wall that begins with a blow", scene(model("stiffness: 800, exponent: |0.25, depth_scale: 0.1")), P + "exponent", "the first 10 um give 8 N"),
    ("a shell that nothing holds", scene(model("sides: both, pop_through: |0.001")), P + "pop_through", "cannot be felt"),
    ("one model in another", scene(model("stiffness: 800"), model("stiffness: 700", name="two").replace("  - n", "  - |n")),
     "models[1].pose", "ball (line 5)"),
    ("one model in another on its path", scene(moved("pose: {position: [0.3, 0, 0]}"), moved("", "two").replace("path: ", "path: |")),
     "models[1].path", "ball (line 5)"),
    ("a pose beside a path", scene(moved("pose: |{position: [0.3, 0, 0]}")), "models[0].pose", "has no effect"),
    ("the stiffness of all in one place", scene(*(model("stiffness: 3000", name=f"w{i}") for i in range(6))).replace("stiffness: 3", "stiffness: |3", 1),
     P + "stiffness", "w0 with 5 models in its place pushes with up to 1.8e+04 N/m, and simulated"),
    ("grams", body("mass: |500, tether: 20000"), P + "mass", "500 g is 0.5 kg"),
    ("a body that hangs far away", body("mass: 5, tether: |20"), P + "tether", "hangs 2.45 m below its pose"),
    ("a body that falls", body("mass: |0.5"), P + "mass", "nothing holds it"),
    ("a slider that falls", body(f"{MASS}joint: slider, axis: [0, 1, 0]").replace("mass: ", "mass: |"), P + "mass", "nothing holds it"),
    ("millimetres a second", body(MASS + "velocity: |[500, 0, 0], tether: 20, gravity: false"), P + "velocity", "500 mm/s is 0.5 m/s"),
    ("degrees a second", body(MASS + "spin: |[360, 0, 0], tether: 20, gravity: false"), P + "spin", "360 degrees/s is 6.283 rad/s"),
    ("a pivot without a joint", body(MASS + "tether: 20, gravity: false, pivot: |[0.05, 0, 0], axis: [0, 1, 0]"), P + "pivot", "add joint: hinge beside"),
    ("an axis without a joint", body(MASS + "tether: 20, gravity: false, axis: |[0, 1, 0]"), P + "axis", "add joint: hinge or slider"),
    ("a pivot of a slider", body(MASS + "joint: slider, gravity: false, pivot: |[0.05, 0, 0]"), P + "pivot", "set joint: hinge"),
    ("a hinge in mm", body(MASS + "joint: hinge, pivot: |[50, 0, 0]", geometry=BOX), P + "pivot", "50 mm is 0.05 m"),
    ("a centre in mm", body(MASS + "tether: 200, center: |[0, 30, 0]", geometry=BOX), P + "center", "30 mm is 0.03 m"),
    ("a centre in another frame", body("mass: 1, gravity: false, tether: 50, center: |[0, 0, 0.3]", geometry=BOX), P + "center",
     "0.25 m outside the surfaces"),
    ("a drag in N s/mm", body(MASS + "tether: 20, gravity: false, drag: |4000", geometry=BOX), P + "drag", "a force of 400 N moves"),
    ("a drag of turns in mN m", body(MASS + "tether: 20, gravity: false, angular_drag: |100", geometry=BOX), P + "angular_drag", "a torque of 100 N m turns"),
    ("an inertia in kg mm^2", body(MASS + "tether: 200, inertia: |[8, 8, 8]", geometry=BOX), P + "inertia", "1 kg mm^2 is 1e-6"),
    ("end stops in degrees", body(MASS + "joint: hinge, pivot: [-0.05, 0, 0], limits: |[0, 90]", geometry=BOX), P + "limits", "if you meant 90 degrees, write 1.571"),
    ("end stops in mm", body(MASS + "joint: slider, axis: [1, 0, 0], limits: |[0, 300]", geometry=BOX), P + "limits", "300 mm is 0.3 m"),
    ("a rest in degrees", body(MASS + "joint: hinge, pivot: [-0.05, 0, 0], angular_tether: 1, rest: |45", geometry=BOX), P + "rest", "if you meant 45 degrees"),
    ("a rest without a spring", body(MASS + "joint: hinge, pivot: [-0.05, 0, 0], rest: |0.4", geometry=BOX), P + "rest", "give angular_tether, too"),
    ("a rest of a slider without a spring", body(MASS + "joint: slider, gravity: false, rest: |0.04", geometry=BOX), P + "rest", "give tether, too"),
    ("a rest of a free body", body(MASS + "tether: 20, gravity: false, rest: |0.4", geometry=BOX), P + "rest", "joint: hinge or slider"),
    ("a torsion spring of a slider", body(MASS + "joint: slider, gravity: false, angular_tether: |2", geometry=BOX), P + "angular_tether", "give tether, in N/m"),
    ("a torsion spring of a free body", body(MASS + "tether: 20, gravity: false, angular_tether: |2", geometry=BOX), P + "angular_tether", "set joint: hinge"),
    ("a torsion spring of what stands still", scene(model("angular_tether: |2")), P + "angular_tether", "does not move by forces"),
    ("degrees", pendulum("pivot: [0, 0.25, 0], angle: |45"), P + "angle", "if you meant 45 degrees, write 0.7854"),
    ("an axis along gravity", pendulum("pivot: [0, 0.25, 0], axis: |[0, 1, 0]"), P + "axis", "along gravity"),
    ("an inertia about the centre", pendulum("pivot: [0, 0.25, 0], length: 0.25, mass: 0.5, inertia: |0.0005"), P + "inertia", "0.0312 kg m^2"),
    ("a pivot in mm", pendulum("pivot: |[0, 250, 0], length: 250"), P + "pivot", "250 mm is 0.25 m"),
    ("its mass in g", pendulum("pivot: [0, 0.25, 0], mass: |500"), P + "mass", "500 g is 0.5 kg"),
    ("a pivot below its body", pendulum("pivot: |[0, -0.25, 0], length: 0.25"), P + "pivot", "expected a pivot above them"),
    ("a travel in mm", scene(model(BUTTON + "|[[0, 0], [3, 4], [4, 2], [5, 3]]", "push_button", BOX)), P + "detent", "5 mm is 0.005 m"),
    ("a force in mN", scene(model(BUTTON + "|[[0, 0], [0.003, 400], [0.004, 200], [0.005, 300]]", "push_button", BOX)), P + "detent",
     "400 mN is 0.4 N"),
    ("a stop in N/mm", scene(model("axis: [0, 0, -1], end_stiffness: |3", "push_button", BOX)), P + "end_stiffness", "1 N/mm is 1000 N/m"),
    ("a stop in N/mm beside one that is felt", scene(model("axis: [0, 0, -1], end_stiffness: |20", "push_button", BOX)), P + "end_stiffness", "too soft for a stop"),
    ("a stop softer than the surface", scene(model("axis: [0, 0, -1], end_stiffness: |800", "push_button", BOX)), P + "end_stiffness", "too soft for a stop"),
    ("a wave in mm", scene(model("texture: {amplitude: 0.0001, wavelength: |0.5}")), P + "texture.wavelength", "0.5 mm is 0.0005 m"),
    ("a wave of one bump", scene(model("texture: {amplitude: 0.0002, wavelength: |0.15}", geometry=BOX)), P + "texture.wavelength", "the model"),
    ("a model out of reach beside one in reach", scene(model("stiffness: 800"), model("stiffness: 800", name="two") + "    pose: {position: |[3, 0, 0]}\n"),
     "models[1].pose.position", "no arm reaches two"),
    ("a body within a body", scene(model("stiffness: 800", geometry="whole.yaml"), model("stiffness: 800", name="two", geometry="knob.yaml")
     + "    pose: {position: |[0, 0.01, 0]}\n"), "models[1].pose.position", "two lies within ball"),
    ("gravity up", scene(model("stiffness: 800"), top="servo: {gravity: |[0, 9.81, 0]}\n"), "servo.gravity", "points up"),
    ("gravity along z", scene(model("stiffness: 800"), top="servo: {gravity: |[0, 0, -9.81]}\n"), "servo.gravity", "+y is up"),
    ("gravity in cm", scene(model("stiffness: 800"), top="servo: {gravity: |[0, -981, 0]}\n"), "servo.gravity", "100 times the Earth's"),
    ("a radius in mm", scene(model("stiffness: 800"), top="servo: {activation_radius: |100}\n"), "servo.activation_radius", "100 mm is 0.1 m"),
    ("a budget in ms", scene(model("stiffness: 800"), top="servo: {budget_us: |0.1}\n"), "servo.budget_us", "0.1 ms is 100"),
    ("an origin in mm", scene(model("stiffness: 800"), top="clients: {mode: add, origin: |[0, 0, 90]}\n"), "clients.origin", "90 mm is 0.09 m"),
    ("a path that no script follows", scene(model("stiffness: 800"), top=f"device: {ARM}\nhand: {{script: press, radius: 0.053, path: |lift.csv}}\n"),
     "hand.path", "has no effect"),
    ("two arms in one place", scene(model("stiffness: 800"), top=f"devices:\n  - {{file: {ARM}, name: left}}\n  - |{{file: {ARM}, name: right}}\n"),
     "devices[1].mount", "right is in the same place as left"),
    ("presses a minute", scene(model("stiffness: 800"), top=f"device: {ARM}\nhand: {{script: press, radius: 0.05, rate: |60}}\n"), "hand.rate",
     "60 times a minute is 1 Hz"),
    ("a hand on a spring in N/mm", scene(model("stiffness: 800"), top=f"device: {ARM}\nhand: {{radius: 0.046, stiffness: |0.5}}\n"), "hand.stiffness",
     "does not follow its script"),
    ("a guided hand on such a spring", scene(model("stiffness: 800"), top=f"device: {ARM}\nhand: {{script: guided, stiffness: |0.5}}\n"), "hand.stiffness",
     "does not follow the program that leads it"),
    ("a hand of 70 kg", scene(model("stiffness: 800"), top=f"device: {ARM}\nhand: {{radius: 0.046, mass: |70}}\n"), "hand.mass", "70 g is 0.07 kg"),
    ("a tremor in mN", scene(model("stiffness: 800"), top=f"device: {ARM}\nhand: {{radius: 0.046, tremor: |5}}\n"), "hand.tremor", "5 mN is 0.005 N"),
    ("unrest in mN", scene(model("stiffness: 800"), top=f"device: {ARM}\nhand: {{radius: 0.046, wander: |10}}\n"), "hand.wander", "10 mN is 0.01 N"),
    ("a lead-in in ms", scene(model("stiffness: 800"), top=f"device: {ARM}\nhand: {{radius: 0.046, lead_in: |50}}\n"), "hand.lead_in", "50 ms is 0.05 s"),
    ("a wait of four ticks", scene(model("stiffness: 800"), top="servo: {rate: 20000}\nclients: {mode: add, answer_time: |0.0002}\n"),
     "clients.answer_time", "a quarter of its period"),
    ("a model felt from its back", scene(model("stiffness: 800, sides: |back"), top=f"device: {ARM}\nhand: {{radius: 0.046}}\n"), P + "sides", "from their other side"),
    ("a hand that begins inside", scene(model("stiffness: 800"), top=f"device: {ARM}\nhand: {{script: tap, radius: |0.02, rise: 0.005}}\n"), "hand.radius",
     "a hand.radius of 0.046 m, with which it starts outside"),
    ("far away", scene(model("stiffness: 800", name="two") + "    pose: {position: |[40, 2, 30]}\n"), "models[0].pose.position", "50.04 m from"),
    ("a damper too strong for a strong arm", scene(model("stiffness: 800, damping: |900"), top=f"device: {SARCOS}\nhand: {{script: none}}\n"), P + "damping",
     "0.1 m/s with 90 N"),
    ("a mass that no arm follows", scene(model("stiffness: 800"), top="servo: {rate: 1500}\ndevices:\n"
     f"  - {{file: {SARCOS}, admittance: {{mass: |0.003, damping: 0}}, hand: {{script: hold}}}}\n"),
     "devices[0].admittance.mass", "cannot follow so light a mass"),
]


def faces(half=0.05):
    """A cube: its six faces, a list of lines each."""
    corners = {"right": "+-- +-+ ++- +++", "left": "--- -+- --+ -++", "top": "-+- ++- -++ +++", "bottom": "--- --+ +-- +-+",
               "front": "--+ -++ +-+ +++", "back": "--- +-- -+- ++-"}
    return {name: [f"  - name: {name}", "    degree: [1, 1]", "    knots: [[0, 0, 1, 1], [0, 0, 1, 1]]", "    points:",
                   *(f"      - [{', '.join(f'{s}{half}' for s in p)}]".replace("+", "") for p in points.split())]
            for name, points in corners.items()}


def cube(change=lambda all: None, half=0.05):
    """A model file of a cube. The lines of its faces may be changed."""
    all_of_them = faces(half)
    change(all_of_them)
    return "format: hapticd-model/1\nsurfaces:\n" + "".join("\n".join(lines) + "\n" for lines in all_of_them.values())


def in_large_units(lines):  # told at the first point that is farthest from the middle
    first = next(iter(lines.values()))
    at = next(i for i, line in enumerate(first) if line.startswith("      - ["))
    first[at] = first[at].replace("- [", "- |[")


def mistyped(lines):  # a corner of the front face
    lines["front"][-1] = "      - |[0.055, 0.05, 0.05]"


def shifted(lines):  # the whole front face
    lines["front"][4:] = [line.replace("0.05]", "0.055]") for line in lines["front"][4:]]
    lines["front"][0] = "  - |name: front"


def second_right(lines):
    lines["left"][0] = "  - name: |right"


def flat(lines):
    lines["front"][3:] = ["    points: |[[0, 0, 0], [0, 0, 0], [0, 0, 0], [0, 0, 0]]"]


def folded(lines):
    lines["front"].append("    weights: [1, 1, |800000, 1]")


def ridge(points_apart, weights):
    """Two planes in one cubic surface: three rows of its control points coincide at the ridge, or nearly do."""
    points = [[x + apart, y, 0.05 - abs(x)] for x, apart in [(-0.05, 0), (0, 0), (0, points_apart), (0, 0), (0.05, 0)] for y in (-0.05, 0.05)]
    return ("format: hapticd-model/1\nsurfaces:\n  - name: ridge\n    degree: [3, 1]\n"
            f"    knots: [[0, 0, 0, 0, 0.5, 1, 1, 1, 1], [0, 0, 1, 1]]\n    points: |{points}\n    weights: {weights}\n")


def curved_ridge(weights):
    """Three rows of control points coincide at a curved ridge."""
    points = [[x, y, 0.05 - abs(x) + z] for x in (-0.05, 0, 0, 0, 0.05) for y, z in ((-0.05, 0), (0, 0.01), (0.05, 0))]
    return ("format: hapticd-model/1\nsurfaces:\n  - name: ridge\n    degree: [3, 2]\n"
            f"    knots: [[0, 0, 0, 0, 0.5, 1, 1, 1, 1], [0, 0, 0, 1, 1, 1]]\n    points: |{points}\n    weights: {weights}\n")


def bulge(turned):
    """A net of 5 by 4 points, v fastest, or turned round."""
    points = [[[0.02 * i, 0.03 * j, 0.02 if 0 < i < 4 and 0 < j < 3 else 0] for j in range(4)] for i in range(5)]
    listed = [points[i][j] for j in range(4) for i in range(5)] if turned else [point for row in points for point in row]
    return ("format: hapticd-model/1\nsurfaces:\n  - name: bulge\n    degree: [2, 1]\n    knots: [[0, 0, 0, 1, 2, 3, 3, 3], [0, 0, 1, 2, 3, 3]]\n"
            f"    points: |{listed}\n")


MODELS = [
    ("a cube in mm", "nurbs_rigid", cube(in_large_units, half=50), "173 mm is 0.173 m"),
    ("a cube in cm", "nurbs_rigid", cube(in_large_units, half=5), "17.3 m large"),
    ("a face without area", "nurbs_rigid", cube(flat), "no area"),
    ("a name given twice", "nurbs_rigid", cube(second_right), '"right" is also the name of surfaces[0]'),
    ("a corner mistyped", "nurbs_rigid", cube(mistyped), "5 mm away"),
    ("a face beside its place", "nurbs_rigid", cube(shifted), "joins none of the 4 surfaces"),
    ("points with u fastest", "nurbs_rigid", bulge(True), "v runs fastest"),
    ("a decimal point elsewhere", "nurbs_rigid", net([3, 2], f"[{CUBIC}, {QUADRIC}]", points=flat_net(0.02).replace("[0.04, 0.02, 0]", "|[0.04, 0.02, 0.2]")), "decimal point"),
    ("a weight of 800000", "nurbs_rigid", cube(folded), "8e+05 times the neighbouring weight"),
    ("weights at a curved cusp", "nurbs_rigid", curved_ridge([1.5] + [1] * 14), "their weights are no multiples of one another"),
    ("a soft body in g", "mat_deformable", SOFT + "  stiffness: 300\n  damping: 2\n  mass: |10\n", "10 g is 0.01 kg"),
    ("a reach in mm", "mat_deformable", SOFT + "  stiffness: 300\n  shear_reach: |3\n", "3 mm is 0.003 m"),
    ("a layer in mm", "mat_deformable", SOFT + "  young: 20000\n  poisson: 0.3\n  thickness: |20\n", "20 mm is 0.02 m"),
    ("a modulus in MPa", "mat_deformable", SOFT + "  young: |0.05\n  poisson: 0.3\n  thickness: 0.01\n", "cannot be felt"),
    ("a modulus in kPa", "mat_deformable", SOFT + "  young: |50\n  poisson: 0.3\n  thickness: 0.01\n", "cannot be felt"),
    ("a stiffness in N/mm", "mat_deformable", SOFT + "  stiffness: |0.3\n", "1 N/mm is 1000 N/m"),
]
SOFT_PARAMETERS = [("friction_static: |5, friction_dynamic: 1", "friction_static", "rubber"), ("crease: |1", "crease", "1 mm is 0.001 m"),
                   ("friction_static: |0.1, friction_dynamic: 0.5", "friction_static", "friction_dynamic must not be greater"),
                   ("shear_distance: |1", "shear_distance", "1 mm is 0.001 m"), ("rings: |4", "rings", "has no effect"),
                   ("dynamics: off, relaxation: {share: |0.5, time: 0.2}", "relaxation.share", "dynamics is off")]
# What is usual, though near to what is not.
RIGHT = {
    "weightless.yaml": scene(model("stiffness: 800"), top="servo: {gravity: [0, 0, 0]}\n"),
    "on-the-moon.yaml": scene(model("stiffness: 800"), top="servo: {gravity: [0, -1.62, 0]}\n"),
    "rubber.yaml": scene(model("friction_static: 1.2, friction_dynamic: 0.9")),
    "only-sliding-said.yaml": scene(model("friction_static: 0.4, friction_dynamic: 0")),
    "inside-and-outside.yaml": scene(model("sides: front"), model("sides: back, stiffness: 500", name="in")).replace("sphere", "cylinder"),
    "beside-on-the-table.yaml": scene(model("stiffness: 800"), model("stiffness: 800", name="two") + "    pose: {position: [0.4, 0, 0]}\n"),
    "a-hard-thing-in-a-soft-one.yaml": scene(model("", "mat_deformable", "soft-bar.yaml", "gel"), model("stiffness: 800", geometry="knob.yaml")),
    "beside.yaml": scene(model("stiffness: 800"), model("stiffness: 800", name="two") + "    pose: {position: [0.2, 0, 0]}\n"),
    "door.yaml": body(MASS + "joint: hinge, axis: [0, 1, 0], pivot: [-0.05, 0, 0]", geometry=BOX),
    "drawer.yaml": body("mass: 2, joint: slider, axis: [0, 0, 1], drag: 4", geometry=BOX),
    "door-with-stops.yaml": body(MASS + "joint: hinge, axis: [0, 1, 0], pivot: [-0.05, 0, 0], limits: [0, 4.71], angular_tether: 0.5, rest: -0.1", geometry=BOX),
    "drawer-that-rests-on-its-stop.yaml": body("mass: 2, joint: slider, axis: [0, 1, 0], limits: [-0.05, 0.02]", geometry=BOX),
    "spring-of-a-drawer.yaml": body("mass: 2, joint: slider, axis: [0, 0, 1], tether: 40, rest: -0.02, limits: [0, 0.1]", geometry=BOX),
    "heavy-knob.yaml": body("mass: 2.5, joint: hinge, axis: [0, 0, 1]", geometry="knob.yaml"),
    "on-a-spring.yaml": body("mass: 0.5, tether: 100, velocity: [0.3, 0, 0], spin: [3, 0, 0]"),
    "two-people.yaml": scene(model("stiffness: 800"), top="devices:\n" + "".join(
        f"  - {{file: {ARM}, name: {name}, hand: {{script: {script}}}}}\n" for name, script in (("left", "hold"), ("right", "stroke")))),
    "flail.yaml": pendulum("pivot: [0, 1, 0], length: 1, angle: 3.1, rate: 2, damping: 0.01"),
    "on-its-path.yaml": scene(moved("pose: {position: [0, 0, 0]}")),
    "button.yaml": scene(model("axis: [0, 0, -1], stiffness: 3000, end_stiffness: 4000", "push_button", BOX)),
    "cut-in.yaml": scene(model("texture: {amplitude: 0.0001, wavelength: 0.02}", geometry=BOX)),
    "origin-at-the-arm.yaml": scene(model("stiffness: 800"), top="clients: {mode: add, origin: [0, 0.1, 0.3]}\n"),
    "far-away-with-its-arm.yaml": scene(model("stiffness: 800") + "    pose: {position: [40, 2, 30]}\n", top=f"devices:\n"
     f"  - {{file: {ARM}, name: a, mount: {{position: [40, 2, 30.09]}}, hand: {{script: none}}}}\n"),
    "honey-on-a-strong-arm.yaml": scene(model("stiffness: 800, damping: 60"), top=f"device: {SARCOS}\nhand: {{script: none}}\n"),
    "own-hand.yaml": scene(model("stiffness: 800"), top=f"device: {ARM}\nhand: {{radius: 0.046, mass: 2, stiffness: 100, tremor: 0.3, wander: 0.5, lead_in: 5, rate: 3}}\n"),
    "waits-for-programs.yaml": scene(model("stiffness: 800"), top="servo: {rate: 4000}\nclients: {mode: add, answer_time: 60e-6}\n"),
    "rod.yaml": pendulum("pivot: [0, 0.25, 0], length: 0.2, inertia: 0.02, mass: 0.4"),
}


def checked(files, folder):
    """Warnings of each file."""
    code, out, err = program(HAPTICD, own_state(folder))("check", "--json", *files)
    told = json.loads(out)["files"]
    check("nothing is refused", code == 0, (texts(problem for one in told for problem in one["problems"]), err))
    return {one["file"]: one["warnings"] for one in told}


def scenes(folder):
    write(folder, "knob.yaml", cube(half=0.01))
    write(folder, "whole.yaml", cube())
    write(folder, "lift.csv", "t,x,y,z\n0,0,0,0\n3,0,0.03,0\n")
    placed = [(*write(folder, f"scene{i}.yaml", text), name, key, word) for i, (name, text, key, word) in enumerate(SCENES)]
    told = checked([one[0] for one in placed], folder)
    for file, line, column, name, key, word in placed:
        hits = [one for one in told[file] if one["key"] == key and word in one["what"]]
        check(f"{name}: told at its place", any((one["line"], one["column"]) == (line, column) for one in hits),
              (line, column, texts(told[file])))
        once = len(hits) == 1 or key.startswith("models[0]") and "in its place" in word  # what is not stable is told for each reason
        check(f"{name}: told once", once, texts(hits))


def models(folder):
    placed = []
    for i, (name, plugin, text, word) in enumerate(MODELS):
        file, line, column = write(folder, f"model{i}.yaml", text)
        user, *_ = write(folder, f"of{i}.yaml", scene(model("", plugin, geometry=file)))
        placed.append((user, f"{file}:{line}:{column}: ", name, word))
    soft, *_ = write(folder, "soft.yaml", SOFT + "  stiffness: 300\n")
    for i, (parameters, key, word) in enumerate(SOFT_PARAMETERS):
        user, line, column = write(folder, f"soft{i}.yaml", scene(model(parameters, "mat_deformable", geometry=soft)))
        placed.append((user, f"{user}:{line}:{column}: {P}{key}: ", f"{key} of a soft body", word))
    told = checked([one[0] for one in placed], folder)
    for user, place, name, word in placed:
        check(f"{name}: told at its place", any(place in text and word in text for text in texts(told[user])), (place, texts(told[user])))
        check(f"{name}: no more than that", sum(word in text for text in texts(told[user])) == 1, texts(told[user]))


def refused(folder):
    """What the host cannot do with a model."""
    for motion, plugin in (("kinematic", "push_button"), ("kinematic", "pendulum"), ("static", "pendulum"), ("dynamic", "mat_deformable")):
        path = "\n    path: lift.csv" if motion == "kinematic" else ""
        file, line, column = write(folder, "refused.yaml", scene(model("", plugin) + f"    motion: |{motion}{path}\n"))
        code, out, _ = program(HAPTICD, own_state(folder))("check", "--json", file)
        problems = [one for one in json.loads(out)["files"][0]["problems"] if one["key"] == "models[0].motion"]
        check(f"a {plugin} that is {motion}: refused at its place", code == 2 and [(one["line"], one["column"]) for one in problems] == [(line, column)]
              and plugin in problems[0]["what"], (line, column, out))
    file, line, column = write(folder, "compliant.yaml", f"hapticd: 1\ndevice:\n  file: {ARM}\n  admittance: |{{mass: 2, damping: 20}}\nmodels: []\n")
    code, out, _ = program(HAPTICD, own_state(folder))("check", "--json", file)
    problems = [one for one in json.loads(out)["files"][0]["problems"] if one["key"] == "device.admittance"]
    check("admittance of an arm without torque sensors: refused at its place", code == 2 and [(one["line"], one["column"]) for one in problems]
          == [(line, column)], (line, column, out))


def right(folder):
    write(folder, "lift.csv", "t,x,y,z\n0,0,0,0\n3,0,0.03,0\n")
    write(folder, "knob.yaml", cube(half=0.01))
    write(folder, "soft-bar.yaml", SOFT + "  stiffness: 300\n")
    own = [write(folder, name, text)[0] for name, text in RIGHT.items()]
    write(folder, "whole.yaml", cube())
    write(folder, "net.yaml", bulge(False))
    own.append(write(folder, "bulge.yaml", scene(model("sides: both", geometry="net.yaml")))[0])
    for name, text in (("near.yaml", ridge(1e-7, [1] * 10)), ("weighted.yaml", ridge(0, [1.5] + [1] * 9))):  # rows that fold the surface
        write(folder, name, text)
        own.append(write(folder, "a-ridge-" + name, scene(model("sides: both", geometry=name)))[0])
    own.append(write(folder, "cube.yaml", scene(model("", geometry="whole.yaml")))[0])
    shipped = sorted(glob.glob(os.path.join(SOURCE, "config", "scenes", "**", "*.yaml"), recursive=True))
    shipped += [os.path.join(SOURCE, "plugins", "template", "scene.yaml")]
    check("there are scenes that ship", len(shipped) > 20, shipped)
    for file, warnings in checked(own + shipped, folder).items():
        odd = [one for one in warnings if "starts inside" not in one["what"]] if file in own else warnings
        check(f"{os.path.relpath(file, SOURCE if file in shipped else folder)}: nothing is odd", not odd, texts(odd))


def main():
    with tempfile.TemporaryDirectory() as folder:
        scenes(folder)
        models(folder)
        refused(folder)
        right(folder)
    finish()


main()
