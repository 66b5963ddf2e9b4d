#!/usr/bin/env python3
"""A model that starts disabled: it is not computed until somebody enables it, and then it is as any other; two stimuli may stand in
one place, and a replay is exact.

Usage: starts_disabled.py HAPTICD SOURCE     prints one line per case; exit 1 when one is off.
"""
import json
import os
import subprocess
import sys
import tempfile
import warnings

HAPTICD, SOURCE = sys.argv[1:3]
sys.path[:0] = [os.path.join(SOURCE, "tests", "support"), os.path.join(SOURCE, "driver", "doors", "client", "python")]
from e2e import check, finish, program, until, write
import h5py
import hapticd
import numpy

SCENE = """hapticd: 1
device: {source}/config/devices/simulated-premium15.yaml
hand: {{script: press, radius: 0.053, rise: 0.008, rate: 2}}
models:
  - {{name: soft, plugin: nurbs_rigid, parameters: {{geometry: {source}/config/models/sphere.yaml, stiffness: 200}}}}
  - {{name: hard, plugin: nurbs_rigid, enabled: {enabled}, parameters: {{geometry: {source}/config/models/sphere.yaml, stiffness: 1000}}}}
"""


def sceneOf(folder, name, enabled):
    return write(folder, name, SCENE.format(source=SOURCE, enabled=enabled))


def isChecked(folder, scene):
    code, told = ask("check", scene)
    check("two stimuli in one place are no mistake if one starts disabled", code == 0 and "same geometry" not in told and "lie in one another" not in told, told)
    code, told = ask("check", sceneOf(folder, "both.yaml", "true"))
    check("but they are if both are enabled", "same geometry in the same place" in told, told)
    code, told = ask("check", sceneOf(folder, "word.yaml", "perhaps"))
    check("enabled is true or false", code == 2 and "models[1].enabled" in told and "true" in told, told)
    code, told = ask("explain", scene)
    check("explain tells that it starts disabled", code == 0 and "disabled: neither felt nor traced until it is enabled (hapticd ctl enable hard)" in told, told)
    schema = json.loads(ask("check", "--schema", "scene")[1])
    check("the schema has it", schema["properties"]["models"]["items"]["properties"]["enabled"]["type"] == "boolean", schema)


def stimuli(h):
    """The soft one is felt first, then the hard one. Returns the ticks of the change."""
    check("the list tells it", [(m["name"], m["enabled"], m["waits"]) for m in h.ask(do="list")["models"]] == [("soft", True, False), ("hard", False, False)], h.ask(do="list"))
    check("the soft one is felt", until(lambda: any(h.rows("contacts", last=100)["fx"] != 0)))
    steps = json.loads(ask("top", "--name", "stimuli", "--once", "--json")[1])["models"]
    hard = next(m for m in steps if m["name"] == "hard")
    check("the hard one was never stepped", hard["step_us"]["max"] == 0 and hard["feet"] == {"nearest": 0, "held": 0, "degraded": 0}, hard)
    h.models["soft"].disable()
    before = h.mark("enabled")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", hapticd.NoForceWarning)  # the hand may be in it at that moment
        h.models["hard"].enable()
    felt = lambda: any((rows := h.rows("contacts", last=100))["fx"][rows["model"] == 1] != 0)
    check("the hard one is felt after it was enabled", until(felt, 30))
    check("the list tells it, too", h.models["hard"].enabled and not h.models["soft"].enabled)
    return before


def comesAgain(h, scene):
    """reload and add keep what the scene says."""
    h.ask(do="reload", file=scene)
    check("after a reload it is disabled again", [(m["name"], m["enabled"]) for m in h.ask(do="list")["models"]] == [("soft", True), ("hard", False)], h.ask(do="list"))
    number = h.models["hard"].number
    h.wait(h.mark("reloaded") + 1500, timeout=30)
    rows = h.rows("contacts", last=1000)
    check("and not traced", not (rows["model"] == number).any())
    h.ask(do="remove", model="hard")
    answer = h.ask(do="add", file=scene, model="hard")
    check("add keeps it disabled", answer["ok"] and "waiting" not in answer and not h.models["hard"].enabled, answer)


def isRecorded(file, before):
    contacts = h5py.File(file)["contacts"][:]
    hard = contacts[contacts["model"] == 1]
    check("before it is enabled it has no row", len(hard) > 100 and hard["tick"].min() > before, (hard["tick"][:1], before))
    soft = contacts[contacts["model"] == 0]
    force = lambda rows: numpy.sqrt(sum(rows["f" + axis] ** 2 for axis in "xyz")).max()
    check("it is the stiffer one", force(hard) > 1.3 * force(soft) > 0, (force(hard), force(soft)))
    code, told = ask("replay", file)
    check("it replays with every bit the same", code == 0 and "every bit is the same" in told, told)
    code, told = ask("explain", file)
    check("explain tells when it was enabled", code == 0 and " s  enable hard\n" in told, told)


with tempfile.TemporaryDirectory() as scratch:
    environment = dict(os.environ, RUNTIME_DIRECTORY=scratch, STATE_DIRECTORY=scratch)
    os.environ.update(RUNTIME_DIRECTORY=scratch)
    ask = program(HAPTICD, environment, together=True)
    trial, recorded, log = sceneOf(scratch, "trial.yaml", "false"), os.path.join(scratch, "run.h5"), os.path.join(scratch, "log")
    isChecked(scratch, trial)
    with open(log, "w") as out, subprocess.Popen([HAPTICD, "run", trial, "--name", "stimuli", "--record", recorded], env=environment, stdout=out, stderr=out) as run:
        with hapticd.connect("stimuli", wait=30) as client:
            enabled_at = stimuli(client)
            comesAgain(client, trial)
        check("the run ends well", ask("ctl", "--name", "stimuli", "stop")[0] == 0 and run.wait(60) == 0)
    soft = open(log).read().partition("soft (nurbs_rigid)\n")[2].partition("(nurbs_rigid)")[0]
    check("the time in a disabled model is told, and is no part of its contact", "no force  in " in soft, soft)
    check("the log tells at the start what is disabled", "models soft, hard (disabled) on" in open(log).read(), open(log).read())
    isRecorded(recorded, enabled_at)
finish()
