#!/usr/bin/env python3
"""What the daemon would refuse of a program's push is told to the program.

Usage: refused_pushes.py HAPTICD SOURCE     prints one line per case; exit 1 when one is off.
"""
import atexit
import math
import os
import signal
import subprocess
import sys
import tempfile
import warnings

HAPTICD, SOURCE = sys.argv[1], sys.argv[2]
sys.path.insert(0, os.path.join(SOURCE, "tests", "support"))
sys.path.insert(0, os.path.join(SOURCE, "driver", "doors", "client", "python"))
import hapticd
from e2e import check, finish, until

SCENE = """hapticd: 1
servo: {{rate: 1000}}
device: {source}/config/devices/simulated-premium15.yaml
hand: {{script: guided, tremor: 0, wander: 0}}
clients: {{mode: add, max_force: 3}}
models: []
"""
ARM = "simulated Premium 1.5"


def raises(action):
    try:
        action()
    except ValueError as error:
        return str(error)
    return ""


def python(client):
    for force, said in (([1e7, 0, 0], "beyond 1e+06"), ([0, 0, 0, 0], "4 numbers"), ([0] * 7, "7 numbers"),
                        ([math.nan, 0, 0], "not finite")):
        def push():
            thread = client.push(ARM, lambda state: force)
            until(lambda: thread.error is not None, 30)
            thread.end()
        told = raises(push)
        check(f"Python raises for {force}", said in told, told)


def counted(client):
    rows = client.streams["ticks"]
    for name, action in (("read(-1)", lambda: rows.read(-1, 3)), ("read(0, -1)", lambda: rows.read(0, -1)), ("last(-5)", lambda: client.rows(last=-5))):
        check(f"{name} is no number of rows", "expected how many" in raises(action) or "counted from 0" in raises(action))


with tempfile.TemporaryDirectory(dir="/dev/shm") as scratch:
    scene = os.path.join(scratch, "scene.yaml")
    with open(scene, "w") as file:
        file.write(SCENE.format(source=SOURCE))
    environment = dict(os.environ, RUNTIME_DIRECTORY=scratch, STATE_DIRECTORY=scratch)
    run = subprocess.Popen([HAPTICD, "run", scene, "--name", "refuses"], env=environment, stdout=subprocess.DEVNULL,
                           stderr=subprocess.DEVNULL)
    atexit.register(run.kill)
    until(lambda: os.path.exists(os.path.join(scratch, "refuses.sock")), 30)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        with hapticd.connect("refuses", folder=scratch) as client:
            python(client)
            counted(client)
    run.send_signal(signal.SIGTERM)
    check("the run ends in order", run.wait(timeout=30) == 0)
finish()
