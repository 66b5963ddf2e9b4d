# SPDX-License-Identifier: MIT
"""Scene and model files of tests, as texts. A bar in a text marks a place in the file."""
import os

SOURCE = os.path.abspath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", ".."))
SPHERE, BOX = (os.path.join(SOURCE, "config", "models", name) for name in ("sphere.yaml", "box.yaml"))
ARM = os.path.join(SOURCE, "config", "devices", "simulated-premium15.yaml")
SARCOS = os.path.join(SOURCE, "config", "devices", "simulated-sarcos.yaml")
P = "models[0].parameters."
MASS = "mass: 0.5, "
BUTTON = "axis: [0, 0, -1], detent: "
CUBIC, QUADRIC = "[0, 0, 0, 0, 0.5, 1, 1, 1, 1]", "[0, 0, 0, 0.5, 1, 1, 1]"
SOFT = "format: hapticd-model/2\nmedial:\n  points: [[[-0.04, 0, 0], [0, 0, 0], [0.04, 0, 0]]]\n  radius: [[0.02, 0.02, 0.02]]\n"


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


def flat_net(step):
    return "[" + ", ".join(f"[{step * i:g}, {step * j:g}, 0]" for i in range(5) for j in range(4)) + "]"


def net(degree, knots, more="", points=flat_net(0.02), form=1):
    return f"format: hapticd-model/{form}\nsurfaces:\n  - name: net\n    degree: {degree}\n    knots: {knots}\n    points: {points}\n{more}"


def write(folder, name, text):
    """Writes it without its bar. Returns the file and where the bar stood."""
    file = os.path.join(folder, name)
    before = text.split("|")[0]
    with open(file, "w", encoding="utf-8") as out:
        out.write(text.replace("|", ""))
    return file, before.count("\n") + 1, len(before) - before.rfind("\n")


def own_state(folder):
    return {**os.environ, "STATE_DIRECTORY": folder}


def texts(warnings):
    return [f"{one['file']}:{one['line']}:{one['column']}: {one['key']}: {one['what']}" for one in warnings]
