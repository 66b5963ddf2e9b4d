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

SPHERE, BOX = (os.path.join(SOURCE, "config", "models", name) for name in ("sphere.yaml", "box.yaml"))
ARM = os.path.join(SOURCE, "config", "devices", "simulated-premium15.yaml")
SARCOS = os.path.join(SOURCE, "config", "devices", "simulated-sarcos.yaml")


def model(parameters, plugin="nurbs_rigid", geometry=SPHERE, name="ball"):
    return f"  - name: {name}\n    plugin: {plugin}\n    parameters: {{geometry: {geometry}, {parameters}}}\n"


def scene(*models, top=f"device: {ARM}\nhand: {{script: none}}\n"):  # what a hand meets is told by others
    return f"hapticd: 1\n{top}models:\n" + "".join(models)


def body(parameters, **how):
    return scene(model("motion: dynamic, " + parameters, **how))


def moved(how, name="ball"):
    return model("stiffness: 800", name=name) + "    motion: kinematic\n    path: lift.csv\n" + (f"    {how}\n" if how else "")


def pendulum(parameters):
    return scene(model(parameters, "pendulum"))


P = "models[0].parameters."
MASS = "mass: 0.5, "
BUTTON = "axis: [0, 0, -1], detent: "
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
     "greater by more than"),
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


def bulge(turned):
    """A net of 5 by 4 points, v fastest, or turned round."""
    points = [[[0.02 * i, 0.03 * j, 0.02 if 0 < i < 4 and 0 < j < 3 else 0] for j in range(4)] for i in range(5)]
    listed = [points[i][j] for j in range(4) for i in range(5)] if turned else [point for row in points for point in row]
    return ("format: hapticd-model/1\nsurfaces:\n  - name: bulge\n    degree: [2, 1]\n    knots: [[0, 0, 0, 1, 2, 3, 3, 3], [0, 0, 1, 2, 3, 3]]\n"
            f"    points: |{listed}\n")


def flat_net(step):
    return "[" + ", ".join(f"[{step * i:g}, {step * j:g}, 0]" for i in range(5) for j in range(4)) + "]"


def net(degree, knots, more="", points=flat_net(0.02), form=1):
    return f"format: hapticd-model/{form}\nsurfaces:\n  - name: net\n    degree: {degree}\n    knots: {knots}\n    points: {points}\n{more}"


CUBIC, QUADRIC = "[0, 0, 0, 0, 0.5, 1, 1, 1, 1]", "[0, 0, 0, 0.5, 1, 1, 1]"
SOFT = "format: hapticd-model/2\nmedial:\n  points: [[[-0.04, 0, 0], [0, 0, 0], [0.04, 0, 0]]]\n  radius: [[0.02, 0.02, 0.02]]\n"
MODELS = [
    ("a cube in mm", "nurbs_rigid", cube(half=50).replace("  - name: right", "  |- name: right"), "173 mm is 0.173 m"),
    ("a cube in cm", "nurbs_rigid", cube(half=5).replace("  - name: right", "  |- name: right"), "17.3 m large"),
    ("a face without area", "nurbs_rigid", cube(flat), "no area"),
    ("a name given twice", "nurbs_rigid", cube(second_right), '"right" is also the name of surfaces[0]'),
    ("a corner mistyped", "nurbs_rigid", cube(mistyped), "5 mm away"),
    ("a face beside its place", "nurbs_rigid", cube(shifted), "joins none of the 4 surfaces"),
    ("points with u fastest", "nurbs_rigid", bulge(True), "v runs fastest"),
    ("a decimal point elsewhere", "nurbs_rigid", net([3, 2], f"[{CUBIC}, {QUADRIC}]", points=flat_net(0.02).replace("[0.04, 0.02, 0]", "|[0.04, 0.02, 0.2]")), "decimal point"),
    ("a weight of 800000", "nurbs_rigid", cube(folded), "8e+05 times the neighbouring weight"),
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
    ("of another plugin, and a model file of another", scene(model("young: 20000", "mat_deformable").replace("  - n", "  - |n")), ["medial: expected"]),
    ("a joint forgotten, and mm", body(MASS + "tether: 20, gravity: false, dampnig: 1, pivot: ||[5, 0, 0], axis: [0, 1, 0]", geometry=BOX),
     ["5 mm is 0.005 m", "add joint: hinge"]),
    ("a body: degrees, grams and a name", body("joint: slide, tether: 20000, mass: |500, spin: |[360, 0, 0]"), ["500 g is 0.5 kg", "360 degrees/s"]),
    ("a curve of a button with two mistakes", scene(model("axis: [0, 0, -1], detent: |[[0, 1], [0.003, 4], [0.004, -2], [0.005, 3]]", "push_button", BOX)),
     ["expected [0, 0]"]),
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


GRID = "format: hapticd-model/2\nmedial:\n  points: [[[-0.04, 0, 0], [0, 0, 0], [0.04, 0, 0]]]\n  radius: [[0.02, 0.02, 0.02]]\n"
# In model files, too, with the words of all that is told.
LATE_MODELS = [
    ("weights in rows, degrees turned round", "nurbs_rigid", net([2, 3], f"[{CUBIC}, {QUADRIC}]", "    weights: [[1, 1, 1, 1]]\n"),
     ["one flat list", "the knots fit degree: [3, 2]"]),
    ("knots of Rhino, and another format", "nurbs_rigid", net([3, 2], f"[{CUBIC.replace('0, 0', '0', 1).replace('1, 1]', '1]')}, "
     f"{QUADRIC.replace('0, 0', '0', 1).replace('1, 1]', '1]')}]", form=2), ["expected hapticd-model/1", "knots[u]", "knots[v]", "as Rhino does"]),
    ("a typo and mm", "nurbs_rigid", net([3, 2], f"[{CUBIC}, {QUADRIC}]", "    outwards: forward\n", flat_net(20)), ["unknown key", "m large"]),
    ("names of edges", "nurbs_rigid", net([3, 2], f"[{CUBIC}, {QUADRIC}]", "edges:\n  - sides: [[nett, u0], [net, u1]]\n  - sides: [[net, v0], [net, v0]]\n"),
     ["a name or index", "a side with itself"]),
    ("percent, kPa and mm", "mat_deformable", GRID + "  young: 10\n  poisson: 45\n  thickness: 20\n", ["expected 0 to 0.5", "softer than any tissue", "20 mm is 0.02 m"]),
    ("a typo, and g", "mat_deformable", GRID + "  stiffness: 300\n  dampnig: 1\n  mass: 10\n", ["unknown key", "10 g is 0.01 kg"]),
    ("indices from 1 in mm", "mat_deformable", "2 1 0\nv 0 0 0 10\nv 40 0 0 12\ne 1 2\n", ["different vertices", "in millimetres?"]),
]
LATE_MODELS_FOLLOW = [("a stiffness misspelt", "mat_deformable", GRID + "  stiffnes: 300\n", "cannot be felt"),
                      ("a radius of no number", "mat_deformable", GRID.replace("[[0.02, 0.02, 0.02]]", "thick") + "  stiffness: 300\n  mass: 1\n", "kg in all")]


def write(folder, name, text):
    """Writes it without its bar. Returns the file and where the bar stood."""
    file = os.path.join(folder, name)
    before = text.split("|")[0]
    with open(file, "w", encoding="utf-8") as out:
        out.write(text.replace("|", ""))
    return file, before.count("\n") + 1, len(before) - before.rfind("\n")


def checked(files, folder):
    """Warnings of each file."""
    code, out, err = program(HAPTICD, own_state(folder))("check", "--json", *files)
    told = json.loads(out)["files"]
    check("nothing is refused", code == 0, (texts(problem for one in told for problem in one["problems"]), err))
    return {one["file"]: one["warnings"] for one in told}


def own_state(folder):
    return {**os.environ, "STATE_DIRECTORY": folder}


def texts(warnings):
    return [f"{one['file']}:{one['line']}:{one['column']}: {one['key']}: {one['what']}" for one in warnings]


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
        late(folder)
        right(folder)
    finish()


main()
