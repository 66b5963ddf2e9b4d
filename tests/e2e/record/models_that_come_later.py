#!/usr/bin/env python3
"""Models that come while a run is recorded: their names, parts and joints are in the recording from their tick on, for explain, the
tables, MCAP, the picture and Python; a reload gives the old numbers to other models; older recordings are read and replayed.

Usage: models_that_come_later.py HAPTICD SOURCE     prints one line per case; exit 1 when one is off.
"""
import csv
import json
import os
import re
import subprocess
import sys
import tempfile
import time

HAPTICD, SOURCE = sys.argv[1:3]
sys.path[:0] = [os.path.join(SOURCE, "tests", "support"), os.path.join(SOURCE, "driver", "doors", "client", "python")]
from e2e import check, finish, program
import h5py
import hapticd

SCENES = os.path.join(SOURCE, "config", "scenes")


def changes(ask, scratch):
    """Adds, sets, removes and reloads. Returns the ticks after each step."""
    with open(os.path.join(SCENES, "torus.yaml")) as scene, open(os.path.join(scratch, "ring.yaml"), "w") as other:
        other.write(re.sub(r"name: \w+", "name: r\u00f6ng", scene.read(), count=1).replace("../", os.path.join(SOURCE, "config") + "/"))

    def do(*words):
        code, told = ask("ctl", "--name", "later", *words)
        check("ctl " + " ".join(words), code == 0, told)
    with hapticd.connect("later", wait=30) as h:
        def since(tick):
            while (now := h.mark("now")) < tick:
                time.sleep(0.1)
            return now
        since(500)
        do("add", os.path.join(scratch, "ring.yaml"))
        do("set", "r\u00f6ng", "stiffness", "500", "--consent")
        do("disable", "r\u00f6ng")
        with_ring = since(0)
        do("remove", "r\u00f6ng")
        since(3800)  # the hand has left the door, and opens it again a second later
        do("reload")
        with_new_door = since(6500)
        do("add", os.path.join(SCENES, "sphere.yaml"))
        with_sphere = since(0) + 200
        since(with_sphere)
        do("stop")
    return with_ring, with_new_door, with_sphere


def tableOf(folder, name):
    with open(os.path.join(folder, name), newline="") as table:
        return list(csv.DictReader(table))


def areNamed(file, steps, folder, ask):
    code, told = ask("explain", file)
    check("explain lists the models, with their times", code == 0 and re.search(r"model     door \(nurbs_rigid\)\n  model     r\u00f6ng \(nurbs_rigid\), from \d+\.\d{4} s on\n"
                                                                                r"  model     door \(nurbs_rigid\), from .*\n  model     sphere \(nurbs_rigid\), from ", told), told)
    check("its events name them", "r\u00f6ng: is in the scene now" in told and "r\u00f6ng: has left the scene" in told and "sphere: is in the scene now" in told, told)
    check("its orders name models and parameters", "set r\u00f6ng stiffness 500\n" in told and "disable r\u00f6ng\n" in told, told)
    check("nothing is called by a number", not re.search(r"\bmodel \d", told), told)
    moved = told.split("moved\n")[-1]
    check("both doors moved", len(re.findall(r"^  door: turned from ", moved, re.M)) == 2, moved)
    check("a description is no mark", "{" not in told, told)
    code, said = ask("export", file, "--csv", os.path.join(folder, "tables"), "--mcap", os.path.join(folder, "run.mcap"))
    models = tableOf(os.path.join(folder, "tables"), "models.csv")
    check("models.csv has the models of each number", code == 0 and [m["name"] for m in models] == ["door", "r\u00f6ng", "door", "sphere"] and
          [m["from_tick"] for m in models][0] == "0" and all(m["plugin"] == "nurbs_rigid" for m in models), models)
    starts = [int(m["from_tick"]) for m in models]
    check("from their ticks on", 0 < starts[1] < steps[0] < starts[2] < steps[1] < starts[3] < steps[2], (starts, steps))
    joints = tableOf(os.path.join(folder, "tables"), "joints.csv")
    ticks = [int(j["tick"]) for j in joints if j["name"] == "door"]
    check("joints.csv goes on after the reload", min(ticks) < starts[1] and max(ticks) > steps[1], (min(ticks), max(ticks)))
    last = [float(j["position"]) for j in joints if int(j["tick"]) > starts[2] + 500]
    check("with angles of the new door", max(last) > 0.1 and min(last) > -0.01 and max(last) < 0.7, (min(last), max(last)))
    with open(os.path.join(folder, "run.mcap"), "rb") as mcap, open(os.path.join(folder, "tables", "models.csv"), "rb") as table:
        check("the MCAP file carries models.csv", table.read() in mcap.read())
    rows = h5py.File(file)["marks"][:]
    text = "".join(row["text"].decode() for row in rows[rows["model"] == 1] if row["tick"] < steps[0])
    told = json.loads(text)
    check("the rows join to JSON", (told["name"], told["plugin"]) == ("r\u00f6ng", "nurbs_rigid") and "stiffness" in [p["id"] for p in told["parameters"]], text)
    code, told = ask("plot", file, "--out", os.path.join(folder, "run.svg"))
    with open(os.path.join(folder, "run.svg")) as picture:
        check("the picture names a model", code == 0 and ">door<" in picture.read(), told)


def olderForm(file, folder, ask):
    """Renames the columns that marks did not have before, so that a reader does not find them."""
    with open(file, "rb") as whole:
        data = whole.read()
    columns = re.search(rb'"marks":\[.*?\]', data)
    former = columns[0].replace(b'"left"', b'"lefx"').replace(b'"model"', b'"modex"')
    check("the description has the columns", former != columns[0])
    old = os.path.join(folder, "old.h5")
    with open(old, "wb") as out:
        out.write(data.replace(columns[0], former))
    code, told = ask("explain", old)
    check("an older recording calls them by number", code == 0 and "model 1: is in the scene now" in told and "  model     model 1, from " in told, told)
    code, told = ask("replay", old)
    check("an older recording replays up to the first model that came", code == 3 and re.search(r"the replay ends at tick \d+, in which \"model 1\" was added: "
                                                                                               "the recording does not describe it", told) and "first difference" not in told, told)
    code, told = ask("replay", file)
    check("a recording replays to its end", code == 0 and "every bit is the same" in told, told)


with tempfile.TemporaryDirectory() as scratch:
    environment = dict(os.environ, RUNTIME_DIRECTORY=scratch, STATE_DIRECTORY=scratch)
    os.environ.update(RUNTIME_DIRECTORY=scratch)
    ask = program(HAPTICD, environment, together=True)
    recorded, log = os.path.join(scratch, "run.h5"), os.path.join(scratch, "log")
    command = [HAPTICD, "run", os.path.join(SCENES, "door.yaml"), "--for", "100", "--name", "later", "--record", recorded]
    with open(log, "w") as out, subprocess.Popen(command, env=environment, stdout=out, stderr=out) as run:
        steps = changes(ask, scratch)
        check("the run ends well", run.wait(60) == 0, open(log).read())
    areNamed(recorded, steps, scratch, ask)
    olderForm(recorded, scratch, ask)
finish()
