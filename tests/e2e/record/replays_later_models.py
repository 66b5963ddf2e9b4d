#!/usr/bin/env python3
"""Models that come and leave while a run is recorded come and leave in its replay, which has every bit the same. What cannot be built
ends the replay in the tick in which it came, with the reason; a file that has changed is told.

Usage: replays_later_models.py HAPTICD SOURCE     prints one line per case; exit 1 when one is off.
"""
import os
import re
import shutil
import sys
import tempfile
import warnings

HAPTICD, SOURCE = sys.argv[1:3]
sys.path[:0] = [os.path.join(SOURCE, "tests", "support"), os.path.join(SOURCE, "driver", "doors", "client", "python")]
from daemon import Daemon
from e2e import check, finish, program, until, write
import h5py
import hapticd

warnings.simplefilter("ignore", hapticd.NoForceWarning)  # the hand is often in a model that comes
SCENE = f"""hapticd: 1
device: {SOURCE}/config/devices/simulated-premium15.yaml
hand: {{script: press, radius: 0.053, rise: 0.008, rate: 2}}
models:
  - {{name: first, plugin: nurbs_rigid, parameters: {{geometry: {SOURCE}/config/models/sphere.yaml, stiffness: 200}}}}
"""
OTHERS = f"""hapticd: 1
models:
  - {{name: r\u00f6ng, plugin: nurbs_rigid, pose: {{position: [0.001, 0.002, 0.0003]}}, parameters: {{geometry: ball.yaml, stiffness: 600}}}}
  - {{name: asleep, plugin: nurbs_rigid, enabled: false, parameters: {{geometry: ball.yaml, stiffness: 300}}}}
  - {{name: wall, plugin: nurbs_rigid, motion: kinematic, path: wall.csv, parameters: {{geometry: {SOURCE}/config/models/box.yaml, stiffness: 500}}}}
  - name: swing
    plugin: nurbs_rigid
    motion: dynamic
    pose: {{position: [0, -0.06, 0.02]}}
    parameters: {{geometry: {SOURCE}/config/models/box.yaml, stiffness: 500, mass: 1, gravity: false, tether: 20, drag: 4, angular_drag: 0.01}}
"""
RELEASE = 8  # kind of an order
SAME = "every bit is the same"


def files(folder):
    """Writes the scene of the models that come, and the files that it names."""
    with open(os.path.join(SOURCE, "config", "models", "sphere.yaml")) as sphere:
        write(folder, "ball.yaml", sphere.read())
    write(folder, "wall.csv", "t,x,y,z\n0,0,-0.2,0\n1,0.01,-0.12,0\n2,0,-0.2,0\n")
    return write(folder, "others.yaml", OTHERS)


def isFelt(h, name):
    def felt():
        rows = h.rows("contacts", last=200)
        return (rows["fx"][rows["model"] == h.models[name].number] != 0).any()
    return until(felt, 30)


def pause(h, ticks=300):
    h.wait(h.mark("pause") + ticks, timeout=60)


def comeAndLeave(h, others):
    pause(h)
    h.ask(do="add", file=others)
    number = h.models["r\u00f6ng"].number
    check("a model that came is felt", isFelt(h, "r\u00f6ng"))
    h.ask(do="set", model="r\u00f6ng", parameter="stiffness", value=450, consent=True)
    h.models["asleep"].enable()
    check("so is one that came disabled", isFelt(h, "asleep"))
    h.ask(do="move", model="wall", position=[0, -0.1, 0.01], seconds=0.2)
    isFelt(h, "r\u00f6ng")
    h.ask(do="remove", model="r\u00f6ng")  # its force fades out
    h.ask(do="add", file=others, model="r\u00f6ng")
    check("one that comes takes the number of one that has left", h.models["r\u00f6ng"].number == number)
    pause(h)
    h.ask(do="reload")
    check("a reload gives another number", h.models["first"].number != 0 and [m["name"] for m in h.ask(do="list")["models"]] == ["first"])
    h.ask(do="add", file=others, model="swing")
    check("number 0 has another model", h.models["swing"].number == 0)
    check("the model of the reload is felt", isFelt(h, "first"))
    pause(h)


def replayed(name, file, ticks_at_least):
    code, told, notes = ask("replay", file)
    found = re.match(r"(\d+) ticks of (\d+): " + SAME, told)
    check(f"{name} replays to its end, with every bit the same", code == 0 and found and found[1] == found[2] and int(found[1]) > ticks_at_least, (told, notes))
    check("and without a note", notes == "", notes)


def damaged(file):
    """In a copy no model leaves, so places are not empty when others come."""
    copy = file + ".damaged"
    shutil.copy(file, copy)
    with h5py.File(copy, "r+") as recording:
        orders = recording["orders"][:]
        orders["kind"][orders["kind"] == RELEASE] = 0
        recording["orders"][:] = orders
    code, told, notes = ask("replay", copy)
    check("a place that is not empty takes no other model", code == 1 and "the first difference is in tick" in told, (code, told, notes))


def isReplayed(folder):
    for name, options in (("real", []), ("virtual", ["--virtual-time"])):
        file = os.path.join(folder, name + ".h5")
        with Daemon(HAPTICD, folder, name, SCENE, "--for", "3600", "--record", file, *options) as daemon:
            with daemon.connect() as h:
                comeAndLeave(h, files(folder))
        replayed(f"a run in {name} time", file, 900)
        damaged(file)
    code, told, notes = ask("replay", file, "--set", "r\u00f6ng.stiffness=610")
    check("a model that came can be changed", code == 1 and re.search(r"the first difference is in tick .*of model r\u00f6ng was", told), (code, told, notes))
    code, told, notes = ask("replay", file, "--set", "sw\u00efng.mass=1")
    check("one that the run never had cannot", code == 2 and "expected one of first, " in notes and notes.count("first") == 1, (code, told, notes))


def blackBox(folder):
    with Daemon(HAPTICD, folder, "box", SCENE) as daemon:
        with daemon.connect() as h:
            h.ask(do="add", file=files(folder), model="swing")
            h.ask(do="remove", model="first")
            pause(h, 100)
        _, dump, _ = daemon.ctl("dump")
    replayed("a black box that has its beginning", re.search(r"[^\"\s]+\.h5", dump)[0], 100)


def shortRun(folder, name, others, model):
    """Records a run in which a model comes."""
    file = os.path.join(folder, name + ".h5")
    with Daemon(HAPTICD, folder, name, SCENE, "--record", file) as daemon:
        with daemon.connect() as h:
            pause(h, 100)
            h.ask(do="add", file=others, model=model)
            pause(h)
    return file


def endsThere(case, file, why):
    code, told, notes = ask("replay", file)
    check(f"{case} ends the replay where the model came", code == 3 and SAME in told and re.search(r"note: the replay ends at tick \d+, in which .* was added: ", notes) and
          why in notes, (code, told, notes))


def whatIsMissing(folder):
    file = shortRun(folder, "changed", files(folder), "r\u00f6ng")
    replayed("the run", file, 100)
    ball = os.path.join(folder, "ball.yaml")
    with open(ball) as text:
        before = text.read()
    write(folder, "ball.yaml", before + "\n# a comment\n")
    code, told, notes = ask("replay", file)
    check("a changed file is told", code == 0 and SAME in told and f"warning: {ball} has changed since the recording" in notes and notes.count("ball.yaml") == 1, (code, told, notes))
    os.remove(ball)
    endsThere("a missing file", file, "ball.yaml")
    write(folder, "ball.yaml", before)
    with open(file, "rb") as whole:
        data = whole.read()
    for word, other, why in ((b'{"name":"r\\u00f6ng"', b'["name":"r\\u00f6ng"', "its description in the stream marks is damaged"),
                             (b'"marks":[{"name":"tick"', b'"marks":[{"name":"tock"', "the recording does not describe it")):
        check("the recording has it", word in data, word)
        with open(os.path.join(folder, "damaged.h5"), "wb") as out:
            out.write(data.replace(word, other))
        endsThere(why, os.path.join(folder, "damaged.h5"), why)


def longPath(folder):
    others = files(folder)
    path = lambda points: write(folder, "wall.csv", "t,x,y,z\n" + "".join(f"{i / 100},0,{-0.05 - i / 1000000},0\n" for i in range(points)))
    path(1000)
    replayed("a path of a thousand points", shortRun(folder, "thousand", others, "wall"), 100)
    path(10000)
    endsThere("a path that is too long for the recording", shortRun(folder, "long", others, "wall"), "describes it only in part")


with tempfile.TemporaryDirectory() as scratch:
    ask = program(HAPTICD, dict(os.environ, RUNTIME_DIRECTORY=scratch, STATE_DIRECTORY=scratch))
    for case in (isReplayed, blackBox, whatIsMissing, longPath):
        case(scratch)
finish()
