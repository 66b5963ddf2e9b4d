#!/usr/bin/env python3
"""The C library, what it shares with Python, and the force loops of the examples against a running daemon.

Usage: use_the_library.py HAPTICD SOURCE EVERYTHING SPRING LEAD_MODEL     prints one line per case; exit 1 when one is off.
"""
import os
import re
import subprocess
import sys
import tempfile

HAPTICD, SOURCE, EVERYTHING, SPRING, LEAD_MODEL = sys.argv[1:6]
CLIENT = os.path.join(SOURCE, "driver", "doors", "client", "python")
sys.path.insert(0, os.path.join(SOURCE, "tests", "support"))
sys.path.insert(0, CLIENT)
import numpy
from daemon import Daemon
from e2e import check, finish

SCENE = f"""hapticd: 1
servo: {{rate: 1000}}
device: {SOURCE}/config/devices/simulated-premium15.yaml
hand: {{script: guided, tremor: 0, wander: 0}}
clients: add
models:
  - name: door
    plugin: nurbs_rigid
    motion: kinematic
    path: door.csv
    parameters: {{geometry: {SOURCE}/config/models/box.yaml, stiffness: 500}}
"""
ARM = "simulated Premium 1.5"


def example(name, *arguments):
    done = subprocess.run([sys.executable, os.path.join(CLIENT, "examples", name), "--name", "lib", *arguments],
                          env=dict(environment, PYTHONPATH=CLIENT), capture_output=True, text=True, timeout=120)
    return done.returncode, done.stdout, done.stderr


def examples(folder):
    code, out, err = example("spring.py", "--seconds", "2")
    check("spring.py", code == 0 and "answers" in out and "% of the answers" in out, (out, err))
    done = subprocess.run([SPRING, "lib", "1"], env=environment, capture_output=True, text=True, timeout=60)
    ticks = re.match(r"(\d+) ticks answered", done.stdout)
    check("spring.c", done.returncode == 0 and ticks and int(ticks[1]) > 100, done)
    done = subprocess.run([SPRING, "nobody"], env=environment, capture_output=True, text=True, timeout=60)
    check("spring.c tells of a daemon that is none", done.returncode == 1 and names_the_others(done.stderr, "give hapticd_connect the name of one of these"),
          done)
    done = subprocess.run([sys.executable, "-c", "import hapticd\nhapticd.connect('nobody')"], env=dict(environment, PYTHONPATH=CLIENT), capture_output=True,
                          text=True, timeout=60)
    check("Python does, too", names_the_others(done.stderr, "hapticd.connect(NAME)"), done)


def names_the_others(message, fix):
    """Another daemon may run on this machine, so ours need not be the only one."""
    return (re.search(r"no daemon named nobody runs;?\s+(in \S+ )?these run: (.*, )?lib\b", message)
            and "hapticd run SCENE --name nobody" in message and fix in message)


def leads_a_model(client):
    before = client.models["door"].position
    done = subprocess.run([LEAD_MODEL, "door", "lib", "1"], env=environment, capture_output=True, text=True, timeout=60)
    check("lead_model.c", done.returncode == 0 and len(done.stdout.splitlines()) > 10 and " N" in done.stdout, done)
    after = client.models["door"].position
    far = max(abs(a - b) for a, b in zip(before, after))
    check("it leads the model about where it was", far < 0.05, (before, after))
    done = subprocess.run([LEAD_MODEL, "window", "lib"], env=environment, capture_output=True, text=True, timeout=60)
    check("lead_model.c tells of a model that is none", done.returncode == 1 and "window" in done.stderr, done)
    done = subprocess.run([LEAD_MODEL, "door", "nobody"], env=environment, capture_output=True, text=True, timeout=60)
    check("lead_model.c tells of a daemon that is none", done.returncode == 1 and "hapticd run" in done.stderr, done)


def links(client):
    rows, ticks = client.rows("links", last=200), client.rows("ticks", last=4000)
    told = client.about["devices"][0]["links"]
    check("the arm tells how its links hang together", told["parent"] == [-1, 0] and len(told["base"]) == 3, told)
    tips = rows[rows["link"] == 1]
    ticks = ticks[numpy.isin(ticks["tick"], tips["tick"])]
    tips = tips[numpy.isin(tips["tick"], ticks["tick"])]
    off = max(abs(tips[c] - ticks["arm0_" + c]).max() for c in "xyz")
    check("the last link ends at the tip", len(tips) > 20 and off < 1e-12, (len(tips), off))
    elbows = rows[rows["link"] == 0]
    upper = numpy.sqrt(sum((elbows[c] - told["base"][i]) ** 2 for i, c in enumerate("xyz")))
    check("the first begins at the shoulder", abs(upper - 0.215).max() < 1e-12, upper)


with tempfile.TemporaryDirectory(dir="/dev/shm") as folder:
    with open(os.path.join(folder, "door.csv"), "w") as file:
        file.write("t,x,y,z,qw,qx,qy,qz\n0,0,-0.2,0,1,0,0,0\n")
    daemon = Daemon(HAPTICD, folder, "lib", SCENE)
    environment = daemon.environment
    done = subprocess.run([EVERYTHING, "lib", ARM, "door"], env=environment, capture_output=True, text=True, timeout=120)
    print(done.stdout, end="")
    check("every function of the library", done.returncode == 0, done.stdout[-2000:] + done.stderr)
    examples(folder)
    with daemon.connect() as client:
        leads_a_model(client)
        links(client)
    check("the run ends in order", daemon.stop() == 0)
finish()
