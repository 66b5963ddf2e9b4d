#!/usr/bin/env python3
"""Programs lead a model and the simulated hand of a running daemon, die, lie and write nonsense; what they did is told
as events, recorded, and replays to the last bit.

Usage: lead_a_daemon.py HAPTICD SOURCE     prints one line per case; exit 1 when one is off.
"""
import fcntl
import json
import math
import mmap
import os
import signal
import socket
import struct
import subprocess
import sys
import tempfile
import time

import numpy

HAPTICD, SOURCE = sys.argv[1], sys.argv[2]
sys.path.insert(0, os.path.join(SOURCE, "tests", "support"))
sys.path.insert(0, os.path.join(SOURCE, "driver", "doors", "client", "python"))
import hapticd
from daemon import Daemon
from e2e import check, finish, refused, until

SCENE = f"""hapticd: 1
servo: {{rate: 1000}}
device: {SOURCE}/config/devices/simulated-premium15.yaml
hand: {{script: guided, tremor: 0, wander: 0}}
models:
  - name: ball
    plugin: nurbs_rigid
    parameters: {{geometry: {SOURCE}/config/models/sphere.yaml, stiffness: 800}}
  - name: door
    plugin: nurbs_rigid
    motion: kinematic
    path: door.csv
    parameters: {{geometry: {SOURCE}/config/models/box.yaml, stiffness: 500}}
"""
ARM = "simulated Premium 1.5"
START = (0.0, -0.3, 0.0)  # m: where the door stands, out of reach


def door(rows):
    """Positions [m], velocities [m/s] and ticks of the door in rows of poses."""
    rows = rows[rows["model"] == 1]
    return (numpy.stack([rows[c] for c in "xyz"], axis=1), numpy.stack([rows["v" + c] for c in "xyz"], axis=1), rows["tick"])


def height(client):
    return door(client.rows("poses", last=4))[0][-1][1]


def raised(action, kind, word):
    try:
        action()
    except kind as error:
        return word in str(error)
    return False


def leads_a_model(daemon):
    with daemon.connect() as client:
        first = client.streams["poses"].written
        with client.lead_model("door") as lead:
            begun = time.monotonic()
            while (t := time.monotonic() - begun) < 2:
                lead.put([0, START[1] + 0.05 * math.sin(math.pi * t), 0],
                         linear=[0, 0.05 * math.pi * math.cos(math.pi * t), 0])
                time.sleep(1 / 60)
            check("a second leader is refused, and told who leads",
                  refused(lambda: daemon.connect().lead_model("door"), f"process {os.getpid()}"))
            check("a move of a led model is refused", refused(lambda: client.models["door"].move([0, 0, 0]), "only that process can move it"))
            check("a record of another shape is refused before it is written", raised(lambda: lead.put([0, 0]), ValueError, "position [x, y, z] in m"))
            check("list tells who leads", client.models["door"].leader == os.getpid())
        position, velocity, _ = door(client.streams["poses"].read(first)[1])
        check("the model follows", position[:, 1].max() > START[1] + 0.049, position[:, 1].max())
        speed = numpy.linalg.norm(velocity, axis=1)
        check("within its bounds", speed.max() <= 1.0001, speed.max())
        check("list tells that nobody leads", client.models["door"].leader is None)
        check("what cannot move cannot be led", refused(lambda: client.lead_model("ball"), "kinematic"))
        check("a name that is none is refused", refused(lambda: client.lead_model("dor"), "door"))
        for what, names in (("model", client.models), ("stream", client.streams), ("parameter", client.models["ball"].parameters)):
            check(f"a {what} that is not there is named, and those that are", raised(lambda: names["dor"], KeyError, "one of"))
        check("an end without a lead is refused", refused(lambda: client.ask(do="unlead", model="door"), "neither leads"))


def leader_dies(daemon, how):
    """A leader moves the door up at 0.5 m/s and is killed or stopped meanwhile."""
    program = f"""
import sys, time
sys.path.insert(0, {os.path.join(SOURCE, "driver", "doors", "client", "python")!r})
import hapticd
client = hapticd.connect("x", folder={daemon.folder!r})
lead = client.lead_model("door")
for i in range(200):
    lead.put([0, {START[1]}, 0]); time.sleep(0.01)
begun = time.monotonic()
while True:
    t = time.monotonic()
    lead.put([0, {START[1]} + 0.5 * (t - begun), 0], linear=[0, 0.5, 0], when=t)
    time.sleep(0.005)
"""
    with daemon.connect() as client:
        first, first_tick = client.streams["poses"].written, client.streams["ticks"].written
        leader = subprocess.Popen([sys.executable, "-c", program])
        moving = until(lambda: height(client) > START[1] + 0.15)
        leader.send_signal(how)
        at = height(client)
        time.sleep(1)
        rows = client.streams["poses"].read(first)[1]
        position, velocity, tick = door(rows)
        name = signal.Signals(how).name
        check(f"the door moved until its leader got {name}", moving)
        rests = numpy.linalg.norm(velocity[-100:], axis=1).max()
        check(f"and rests after {name}", rests == 0, rests)
        check(f"not far on after {name}", position[-1][1] - at < 0.13 * 0.5 + 0.03, (position[-1][1], at))
        ticks = client.streams["ticks"].read(first_tick)[1]  # a tick after one that was missed is longer
        seconds = numpy.interp(tick.astype(float), ticks["tick"].astype(float), ticks["t"])
        change = numpy.linalg.norm(numpy.diff(velocity, axis=0), axis=1)[1:] / numpy.diff(seconds)[1:]
        check(f"within its acceleration after {name}", change.max() < 20.1, change.max())
        leader.kill()
        leader.wait()
        check(f"the door has no leader after {name}", until(lambda: client.models["door"].leader is None))
        check(f"and can be led again after {name}", client.lead_model("door") is not None)


def hostile(daemon):
    """Whatever is done to the memory of a lead: no fault, no motion beyond the bounds."""
    with daemon.connect() as client:
        answer = client.ask(do="lead", model="door")
        fd = client._line.descriptor()
        check("the memory cannot be cut", raises(lambda: os.ftruncate(fd, 0)) and raises(lambda: os.ftruncate(fd, 1 << 20)))
        check("nor sealed", raises(lambda: fcntl.fcntl(fd, 1033, 0x0008)))
        lead = hapticd.PoseLead(mmap.mmap(fd, answer["bytes"]), lambda: None)
        lead.put([0, START[1], 0])
        until(lambda: abs(height(client) - START[1]) < 1e-3)
        first = client.streams["poses"].written
        nan = float("nan")

        def nonsense(position, orientation=(1, 0, 0, 0)):  # put() would refuse it
            lead._put(struct.pack("<14d", *position, *orientation, *[0] * 6, time.monotonic()))
            time.sleep(0.02)

        check("put() refuses nonsense itself", raised(lambda: lead.put([nan, 0, 0]), ValueError, "not finite") and
              raised(lambda: lead.put([0, 0, 0], orientation=[2, 0, 0, 0]), ValueError, "unit quaternion"))
        for bad in ([nan, 0, 0], [1e300, 0, 0], [0, math.inf, 0], [0, 11, 0]):
            nonsense(bad)
        nonsense([0, 0, 0], (2, 0, 0, 0))
        lead.put([0, 0, 0], when=time.monotonic() + 100)
        time.sleep(0.02)
        os.pwrite(fd, (1).to_bytes(8, "little"), 0)
        os.pwrite(fd, b"\xff" * 112, 8)
        time.sleep(0.05)
        fcntl_hole(fd)
        time.sleep(0.05)
        position, _, _ = door(client.streams["poses"].read(first)[1])
        check("nonsense moves nothing", numpy.abs(position[:, 1] - START[1]).max() < 1e-3, position[-1])
        lead.put([0, START[1], 0], linear=[1e300, -1e300, 1e300])
        begun = time.monotonic()
        while time.monotonic() - begun < 0.5:
            os.pwrite(fd, os.urandom(128), 0)
        time.sleep(0.5)
        position, velocity, _ = door(client.streams["poses"].read(first)[1])
        check("random bytes keep the bounds", numpy.linalg.norm(velocity, axis=1).max() <= 1.0001)
        os.close(fd)
        check("and latch no fault", all(d["fault"] is None for d in client.status()["devices"]), client.status())


def fcntl_hole(fd):
    import ctypes
    libc = ctypes.CDLL(None, use_errno=True)
    libc.fallocate(fd, 0x02 | 0x01, ctypes.c_long(0), ctypes.c_long(4096))


def raises(action):
    try:
        action()
    except OSError:
        return True
    return False


def leads_the_hand(daemon):
    with daemon.connect() as client:
        listener = daemon.connect()
        events = listener.events(timeout=5)
        with client.lead_hand(ARM) as lead:
            check("events tell that a program leads",
                  any(e["event"] == "joined" and e["value"] == os.getpid() for e in take(events, 1)))
            for step in range(200):
                lead.put([0, 0, 0.09 - 0.05 * step / 200])
                time.sleep(0.005)
            time.sleep(0.5)
            rows = client.rows("ticks", last=100)
            force = numpy.sqrt(sum(rows["arm0_sent_f" + c] ** 2 for c in "xyz"))
            check("the hand presses the ball", force.mean() > 0.5, force.mean())
            check("events tell of the touch", any(e["event"] == "touch" and e["model"] == "ball" for e in take(events, 3)))
        check("a hand that follows a script is not led", refused(lambda: client.lead_hand("no such arm"), "no device"))


def take(events, seconds):
    end = time.monotonic() + seconds
    taken = []
    for event in events:
        taken.append(event)
        if event["event"] in ("joined", "touch") or time.monotonic() > end:
            break
    return taken


def answers(daemon):
    with daemon.connect() as client:
        snapshot = client.snapshot()
        names = [m["name"] for m in snapshot["models"]]
        check("a snapshot has the models at rest", names == ["ball", "door"] and snapshot["models"][0]["pose"]["position"] == [0, 0, 0])
        check("and the next row of each stream", set(snapshot["next"]) == set(client.streams), snapshot["next"])
        check("streams are numbered", [s["name"] for s in client.about["streams"]] == list(client.streams))
        ball = client.models["ball"]
        check("list gives values", ball.parameters["stiffness"].value == 800, ball.parameters)
        ball.set("stiffness", 700, consent=True)
        check("which change", client.models["ball"].parameters["stiffness"].value == 700 and ball.get("stiffness") == 700)
        check("get knows what cannot change, too", ball.get("geometry").endswith("sphere.yaml"))
        check("an id comes back", client.ask(do="status")["id"] == client._asked)
        code, out, _ = daemon.ctl("get", "ball", "stiffness")
        check("ctl get", code == 0 and json.loads(out)["value"] == 700, out)
        code, out, _ = daemon.ctl("events")
        check("ctl events", code == 0 and '"joined"' in out, out[-500:])
        code, out, err = daemon.ctl("lead", "door", "--hold", "1.5", given="0 -0.25 0\n0, -0.2, 0, 1, 0, 0, 0\n")
        check("ctl lead moves a model", code == 0 and abs(height(client) + 0.2) < 1e-6, (err, height(client)))
        code, out, err = daemon.ctl("lead", "door", given="0 0\n")
        check("ctl lead tells of a line that is none", code == 2 and "line 1" in err, err)
        code, out, err = daemon.ctl("lead", "door", given="0 -0.2 0\n0 -250 0\n")
        check("and of one that is too far away, as in mm", code == 2 and "line 2" in err and "10 m" in err, err)
        code, out, err = daemon.ctl("lead", "door", given="0 -0.2 0 1 1 0 0\n")
        check("and of an orientation that is none", code == 2 and "line 1" in err and "the quaternion has length 1.41421, expected 1" in err, err)
        code, out, err = daemon.ctl("lead")
        check("ctl lead needs a target", code == 2, err)


def subscribers_are_bounded(daemon):
    """More than may stay: refused in words, and the socket goes on."""
    crowd = []
    for _ in range(26):
        crowd.append(socket.socket(socket.AF_UNIX))
        crowd[-1].connect(daemon.socket)
        crowd[-1].sendall(b'{"do":"subscribe","id":"s"}\n')
    told = [json.loads(client.makefile().readline()) for client in crowd]
    check("only so many may stay", sum(t["ok"] for t in told) <= 24 and not told[-1]["ok"] and told[-1]["code"] == "too_many", told[-1])
    with daemon.connect() as client:
        check("others are served", client.status()["ok"])
    for client in crowd:
        client.close()


with tempfile.TemporaryDirectory(dir="/dev/shm") as scratch:
    recording = os.path.join(scratch, "led.h5")
    with open(os.path.join(scratch, "door.csv"), "w") as file:
        file.write("t,x,y,z,qw,qx,qy,qz\n0,{},{},{},1,0,0,0\n".format(*START))
    daemon = Daemon(HAPTICD, scratch, "x", SCENE, "--record", recording)
    leads_a_model(daemon)
    leader_dies(daemon, signal.SIGKILL)
    leader_dies(daemon, signal.SIGSTOP)
    hostile(daemon)
    leads_the_hand(daemon)
    answers(daemon)
    subscribers_are_bounded(daemon)
    check("the run ends in order", daemon.stop() == 0)
    done = subprocess.run([HAPTICD, "replay", recording], capture_output=True, text=True, timeout=120)
    check("and replays to the last bit", done.returncode == 0, done.stdout + done.stderr)
    virtual = Daemon(HAPTICD, scratch, "virtual", SCENE, "--virtual-time", "--for", "100000")
    with virtual.connect() as client:
        check("a run in virtual time is not led", refused(lambda: client.lead_model("door"), "virtual"))
    virtual.stop()
finish()
