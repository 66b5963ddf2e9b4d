#!/usr/bin/env python3
"""The examples of the Python package against a running daemon, as a user runs them.

Usage: run_the_examples.py HAPTICD SOURCE BUTTON     prints one line per case; exit 1 when one is off.
"""
import csv
import json
import os
import re
import signal
import subprocess
import sys
import tempfile
import time

HAPTICD, SOURCE, BUTTON = sys.argv[1:4]
CLIENT = os.path.join(SOURCE, "driver", "doors", "client", "python")
sys.path.insert(0, os.path.join(SOURCE, "tests", "support"))
sys.path.insert(0, CLIENT)
from daemon import Daemon
from e2e import check, finish
from hapticd import FAULTS

SCENE = """hapticd: 1
servo: {{rate: 1000}}
device: {source}/config/devices/simulated-premium15.yaml
hand: {{script: guided, tremor: 0, wander: 0}}
models:
  - name: door
    plugin: nurbs_rigid
    motion: kinematic
    path: door.csv
    parameters: {{geometry: {source}/config/models/box.yaml, stiffness: 500}}
"""


def example(name, *arguments, without=()):
    """@param without variables of the environment that the example does not get"""
    given = {key: value for key, value in environment.items() if key not in without}
    done = subprocess.run([sys.executable, os.path.join(CLIENT, "examples", name), "--name", "lib", *arguments],
                          env=given, capture_output=True, text=True, timeout=120)
    return done.returncode, done.stdout, done.stderr


ALONE = """
import mmap, sys, warnings
sys.modules["numpy"] = None  # as where it is not installed
import hapticd
from hapticd._line import _plain
from hapticd._lead import ForceLead, PoseLead
from hapticd._rows import Column, Stream
stream = Stream(None, 0, "ticks", 12, 8, 0, [Column("t", "f8", 0, "s", ""), Column("n", "u4", 8, "", "")])
rows = stream._parsed(bytearray(__import__("struct").pack("<dIdI", 0.5, 7, 0.25, 8)), 2)
assert rows["t"] == [0.5, 0.25] and rows[1]["n"] == 8 and rows[1][0] == 0.25 and rows[-1:][0]["t"] == 0.25, rows
try:
    rows["tt"]
    raise SystemExit("no such column was accepted")
except KeyError as error:
    assert "expected one of: t, n (did you mean \\"t\\"?)" in str(error), error
try:
    hapticd._error.Named("model", {"door": 1})["doors"]
except KeyError as error:
    assert str(error).endswith("expected one of: door (did you mean \\"door\\"?)") and str(error).startswith("there is no model"), str(error)
asked = {}
model = hapticd.Model(type("Client", (), {"ask": lambda self, **request: asked.update(request) or {"seconds": 1}})(),
                      {"name": "door", "number": 0, "plugin": "p", "enabled": True, "kinematic": True, "leader": None,
                       "pose": {"position": [0, 0, 0], "orientation": [1, 0, 0, 0]}})
model.move([0, 0, 0.1], orientation=[1, 0, 0, 0])
assert asked["orientation"] == [1, 0, 0, 0] and "seconds" not in asked, asked
try:
    model.move([0, 0, 0.1], [1, 0, 0, 0])
    raise SystemExit("an orientation was taken for seconds")
except TypeError as error:
    assert "orientation=[w, x, y, z]" in str(error), error
def lead(kind):
    return kind(mmap.mmap(-1, 4096), lambda: None)
nan = float("nan")
for use, words in ((lambda: lead(ForceLead).put(1, [nan, 0, 0]), "not finite"), (lambda: lead(ForceLead).put(1, [0, 0]), "force [x, y, z] in N"),
                   (lambda: lead(PoseLead).put([nan, 0, 0]), "not finite"), (lambda: lead(PoseLead).put([11, 0, 0]), "farther than 10 m"),
                   (lambda: lead(PoseLead).put([0, 0, 0], [90, 0, 1, 0]), "unit quaternion")):
    try:
        use()
        raise SystemExit(words + ": accepted")
    except ValueError as error:
        assert words in str(error), error
for use, words in ((lambda: lead(PoseLead).put(0.1, 0, 0), "position [x, y, z] in m"), (lambda: lead(ForceLead).put(1, 5), "force [x, y, z] in N"),
                   (lambda: stream.last("ten"), "a whole number of rows"), (lambda: hapticd.connect(5), "the name of a daemon"),
                   (lambda: _plain({1}), "a request has only texts, numbers")):
    try:
        use()
        raise SystemExit(words + ": accepted")
    except TypeError as error:
        assert words in str(error), error
with warnings.catch_warnings(record=True) as caught:
    warnings.simplefilter("always")
    bounded = lead(lambda *memory: ForceLead(*memory, max_force=3))
    for force in (3, 5, 7):
        bounded.put(1, [0, force, 0])
assert [str(w.message)[:50] for w in caught] == ["a force of 5 N was asked for, but the arm gets 3 N"], caught
lead(ForceLead).put(1, [0.1, 0, 0])
lead(PoseLead).put([0.1, 0, 0])
"""


def alone():
    done = subprocess.run([sys.executable, "-c", ALONE], env=dict(os.environ, PYTHONPATH=CLIENT), capture_output=True, text=True, timeout=120)
    words = re.search(r"kNames\[\] = \{(.*?)\};", open(os.path.join(SOURCE, "driver/daemon/record/picture.cpp")).read(), re.S)[1]
    words = re.findall(r'"([^"]*)"', words)
    check("faults have the words of the pictures", [w.replace("stopped", "held or stopped") for w in words] == list(FAULTS) and len(words) == 13, (words, FAULTS))
    for name in ("button.py", "experiment.py", "move_door.py", "plot_live.py", "record_to_pandas.py", "spring.py"):
        ended = subprocess.run([sys.executable, os.path.join(CLIENT, "examples", name), "--name", "nobody", *{"move_door.py": ["door"], "experiment.py": ["scene.yaml"]}.get(name, [])],
                               env=dict(os.environ, PYTHONPATH=CLIENT), capture_output=True, text=True, timeout=120)
        check(f"{name} without a daemon says so, with no traceback", ended.returncode == 1 and "error: no daemon named nobody runs" in ended.stderr
              and "Traceback" not in ended.stderr, ended.stderr)
    check("without numpy rows have names, and what the daemon would refuse raises", done.returncode == 0, done.stderr)


def examples(folder):
    code, out, err = example("move_door.py", "door", "--seconds", "1")
    check("move_door.py", code == 0 and "the door stands at" in out, (out, err))
    code, out, err = example("move_door.py", "window")
    check("move_door.py tells of a model that is none", code != 0 and "window" in err, err)
    picture = os.path.join(folder, "live.png")
    code, out, err = example("plot_live.py", "arm0_sent_fx", "depth", "--save", picture, "--window", "0.5")
    check("plot_live.py", code == 0 and open(picture, "rb").read(4) == b"\x89PNG" and os.path.getsize(picture) > 5000, (out, err))
    code, out, err = example("plot_live.py", without=("DISPLAY", "WAYLAND_DISPLAY"))
    check("plot_live.py without a display says what to do", code == 1 and "there is no display" in err and "--save FILE" in err, (code, err))
    code, out, err = example("plot_live.py", "--list")
    check("plot_live.py lists columns", code == 0 and re.search(r"arm0_sent_fx +N ", out), out[:300])
    code, out, err = example("plot_live.py", "no_such_column")
    check("plot_live.py tells of a column that is none", code == 2 and "no_such_column" in err, err)
    table = os.path.join(folder, "run.csv")
    code, out, err = example("record_to_pandas.py", "--seconds", "1", "--csv", table)
    check("record_to_pandas.py", code == 0 and " 0 gaps" in out and open(table).readline().startswith("tick,time_ns,t,"), (out, err))


STIMULUS = """hapticd: 1
device: {source}/config/devices/simulated-premium15.yaml
hand: {{script: press, radius: 0.053, rise: 0.008, rate: 1}}
models:
  - {{name: ball, plugin: nurbs_rigid, parameters: {{geometry: {source}/config/models/sphere.yaml, stiffness: {stiffness}, damping: 2}}}}
"""


def experiment(folder):
    """Two stimuli in random order, each felt while the hand came from outside."""
    soft, hard = (STIMULUS.format(source=SOURCE, stiffness=stiffness) for stiffness in (200, 1000))
    scenes = [os.path.join(folder, name) for name in ("soft.yaml", "hard.yaml")]
    for scene, text in zip(scenes, (soft, hard)):
        with open(scene, "w") as file:
            file.write(text)
    out = os.path.join(folder, "session")
    recorded = os.path.join(folder, "trials.h5")
    with Daemon(HAPTICD, folder, "trials", soft, "--record", recorded):
        done = subprocess.run([sys.executable, os.path.join(CLIENT, "examples", "experiment.py"), *scenes, "--name", "trials", "--trials", "4", "--seconds",
                               "2.5", "--out", out, "--question", "How hard? "], env=environment, input="\n5\n" * 4, capture_output=True, text=True, timeout=200)
        cut = subprocess.run([sys.executable, os.path.join(CLIENT, "examples", "experiment.py"), *scenes, "--name", "trials", "--trials", "1", "--seconds",
                              "0.5", "--out", out + "-cut", "--question", "How hard? "], env=environment, input="\n", capture_output=True, text=True, timeout=200)
    kept = list(csv.DictReader(open(os.path.join(out + "-cut", "trials.csv"))))
    check("a trial whose question has no answer keeps its row", cut.returncode != 0 and [row["answer"] for row in kept] == [""], (cut, kept))
    table = list(csv.DictReader(open(os.path.join(out, "trials.csv")))) if done.returncode == 0 else []
    force = {name: [float(row["force_n"]) for row in table if row["scene"].endswith(name)] for name in ("soft.yaml", "hard.yaml")}
    check("experiment.py presents each stimulus equally often", [len(f) for f in force.values()] == [2, 2], (done, table))
    check("each trial was felt, and the stiffer one more", all(row["valid"] == "1" for row in table) and min(force["hard.yaml"]) > 1.3 * max(force["soft.yaml"]), table)
    ticks = list(csv.DictReader(open(os.path.join(out, "trial-002.csv"))))
    told = subprocess.run([HAPTICD, "explain", recorded], capture_output=True, text=True, timeout=60).stdout
    check("the recording has a mark where each trial begins and ends", [line.split(" s  ")[1] for line in told.split("marks\n")[-1].split("\n")[:8]]
          == [text for i, row in enumerate(table, 1) for text in (f"trial {i} begins: {os.path.basename(row['scene'])}", f"trial {i} ends")], told)
    check("each answer stands beside its trial", [row.get("answer") for row in table] == ["5"] * 4, table)
    before = open(os.path.join(out, "trials.csv")).read() if table else ""
    again = subprocess.run([sys.executable, os.path.join(CLIENT, "examples", "experiment.py"), *scenes, "--name", "nobody", "--out", out], env=environment,
                           capture_output=True, text=True, timeout=60)
    check("the table of a former session stays", again.returncode == 2 and "expected a new folder" in again.stderr and open(os.path.join(out, "trials.csv")).read() == before, again)
    check("a trial has its ticks without a gap", len(ticks) == int(table[1]["ticks"]) > 1000 and ticks[0]["tick"] == table[1]["tick"]
          and all(int(b["tick"]) - int(a["tick"]) == 1 for a, b in zip(ticks, ticks[1:])), table)


PUSHES = """
import os, signal, sys, time
import hapticd
h = hapticd.connect("push")
def until(seen, seconds=60):
    end = time.monotonic() + seconds
    while not seen() and time.monotonic() < end:
        time.sleep(0.05)
    return seen()
def broken(state):
    raise ValueError("no force today")
push = h.push(h.devices[0], broken)
assert until(lambda: push.error is not None)
print("before end()", file=sys.stderr)
try:
    push.end()
    raise SystemExit("what the callback raised was lost")
except ValueError:
    pass
push = h.push(h.devices[0], lambda state: [0.1, 0, 0])
assert until(lambda: push.answers > 0), "nothing was answered"
os.kill(int(sys.argv[1]), signal.SIGKILL)
assert until(lambda: push.error is not None), "the end of the daemon was not noticed"
try:
    push.end()
    raise SystemExit("the end of the daemon was not told")
except hapticd.HapticdError as error:
    assert "the daemon is gone" in str(error), error
"""


def pushes(folder):
    """What ends a push is told at once, not only where the program ends it."""
    victim = Daemon(HAPTICD, folder, "push", "hapticd: 1\nclients: add\nmodels: []\n")
    done = subprocess.run([sys.executable, "-c", PUSHES, str(victim.process.pid)], env=environment, capture_output=True, text=True, timeout=300)
    victim.stop(signal.SIGKILL)
    told = done.stderr.split("before end()")[0]
    check("what a callback raises is told at once", done.returncode == 0 and "ValueError: no force today" in told, done.stderr)
    check("and so is the end of the daemon", "the daemon is gone" in done.stderr, done.stderr)


FOLLOWS = """
import hapticd
with hapticd.connect("snaps") as h, h.lead_model("box") as box, h.push(h.devices[0], lambda state: [0.1, 0, 0]):
    print("ready", flush=True)
    for rows in h.follow("ticks"):
        box.put([0.15, 0, 0])
print("over", h.ended(), h.died())
"""
SNAPS = """hapticd: 1
device: {source}/config/devices/simulated-premium15.yaml
clients: add
hand: {{script: press, radius: 0.05, rise: 0.014, rate: 2}}
models:
  - {{name: box, plugin: nurbs_rigid, motion: kinematic, pose: {{position: [0.15, 0, 0]}}, parameters: {{geometry: {source}/config/models/box.yaml}}}}
  - name: button
    plugin: push_button
    parameters: {{geometry: {source}/config/models/box.yaml, axis: [0, 0, -1], stiffness: 2000, detent: [[0, 0], [0.003, 4], [0.004, 2], [0.005, 3]], end_stiffness: 3000}}
"""


def snaps(folder, stop):
    """Programs that react to a button and end with their daemon: quietly where it is stopped, and told where it is killed."""
    daemon = Daemon(HAPTICD, folder, "snaps", SNAPS.format(source=SOURCE))
    python = [sys.executable, os.path.join(CLIENT, "examples", "button.py"), "--name", "snaps"]
    programs = {"button.c": [BUTTON, "snaps"], "button.py": python, "a program that follows, leads and pushes": [sys.executable, "-c", FOLLOWS]}
    running = {name: subprocess.Popen(command, env=environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) for name, command in programs.items()}
    said = {name: "".join(program.stdout.readline() for _ in range(2 if "button" in name else 1)) for name, program in running.items()}
    time.sleep(0.3)
    if stop:
        daemon.ctl("clear")  # a busy machine may have latched a fault
        told = daemon.ctl("events")[1]
        clicks = [json.loads(line).get("snapped") for line in told.splitlines() if '"click"' in line]
        check("clicks go in and out in turn", len(clicks) > 1 and clicks == ["in", "out"] * (len(clicks) // 2) + ["in"] * (len(clicks) % 2), clicks)
        daemon.ctl("stop")
    else:
        daemon.process.kill()
    for name, program in running.items():
        out, err = program.communicate(timeout=60)
        err = re.sub(r".*answers came more than 20 ms.*\n(  .*\n)?", "", err)  # the machine was busy
        err = re.sub(r"warning: no real-time priority: .*\n", "", err)  # this user has no right to it
        if stop:
            check(f"{name} ends quietly with a daemon that is stopped", program.returncode == 0 and err == "" and out.splitlines()[-1].startswith(("the daemon has ended", "over True False")), (program.returncode, out[-200:], err))
        else:
            check(f"{name} is told that its daemon was killed", program.returncode == 1 and "was killed, or it crashed" in err, (program.returncode, out[-200:], err))
        check(f"{name} said what it saw", "snapped in" in said[name] or said[name] == "ready\n", said[name])
    daemon.stop(signal.SIGKILL)


with tempfile.TemporaryDirectory(dir="/dev/shm") as folder:
    with open(os.path.join(folder, "door.csv"), "w") as file:
        file.write("t,x,y,z,qw,qx,qy,qz\n0,0,-0.3,0,1,0,0,0\n")
    with Daemon(HAPTICD, folder, "lib", SCENE.format(source=SOURCE)) as lib:
        environment = dict(lib.environment, PYTHONPATH=CLIENT)
        alone()
        examples(folder)
        experiment(folder)
        pushes(folder)
        snaps(folder, True)
        snaps(folder, False)
finish()
