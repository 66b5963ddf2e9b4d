#!/usr/bin/env python3
"""The C library and its example against a running daemon.

Usage: use_the_library.py HAPTICD SOURCE EVERYTHING EXAMPLE     prints a line a case; exit 1 when one is off.
"""
import os
import subprocess
import sys
import tempfile
import time

HAPTICD, SOURCE, EVERYTHING, EXAMPLE = sys.argv[1:5]
sys.path.insert(0, os.path.join(SOURCE, "tests", "support"))
from e2e import check, finish

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
ARM = "simulated Premium 1.5"


def examples():
    done = subprocess.run([EXAMPLE, "door", "lib", "1"], env=environment, capture_output=True, text=True, timeout=60)
    check("lead_model.c", done.returncode == 0 and len(done.stdout.splitlines()) > 10 and " N" in done.stdout, done)
    done = subprocess.run([EXAMPLE, "window", "lib"], env=environment, capture_output=True, text=True, timeout=60)
    check("lead_model.c tells of a model that is none", done.returncode == 1 and "window" in done.stderr, done)
    done = subprocess.run([EXAMPLE, "door", "nobody"], env=environment, capture_output=True, text=True, timeout=60)
    check("lead_model.c tells of a daemon that is none", done.returncode == 1 and "hapticd run" in done.stderr, done)


with tempfile.TemporaryDirectory(dir="/dev/shm") as folder:
    environment = dict(os.environ, RUNTIME_DIRECTORY=folder, STATE_DIRECTORY=folder)
    scene = os.path.join(folder, "scene.yaml")
    with open(scene, "w") as file:
        file.write(SCENE.format(source=SOURCE))
    with open(os.path.join(folder, "door.csv"), "w") as file:
        file.write("t,x,y,z,qw,qx,qy,qz\n0,0,-0.3,0,1,0,0,0\n")
    daemon = subprocess.Popen([HAPTICD, "run", scene, "--name", "lib"], env=environment, stdout=subprocess.DEVNULL,
                              stderr=subprocess.DEVNULL)
    for _ in range(600):
        if os.path.exists(os.path.join(folder, "lib.sock")):
            break
        time.sleep(0.05)
    done = subprocess.run([EVERYTHING, "lib", ARM, "door"], env=environment, capture_output=True, text=True, timeout=120)
    print(done.stdout, end="")
    check("every function of the library", done.returncode == 0, done.stdout[-2000:] + done.stderr)
    examples()
    daemon.terminate()
    check("the run ends in order", daemon.wait(timeout=30) == 0)
finish()
