#!/usr/bin/env python3
"""Programs push on the arm of a running daemon, fall silent, die, lie and write nonsense. What they did stays within its
bounds, is told, recorded, and replays to the last bit.

Usage: push_an_arm.py HAPTICD SOURCE     prints one line per case; exit 1 when one is off.
"""
import fcntl
import math
import mmap
import os
import signal
import struct
import subprocess
import sys
import tempfile
import time

import numpy

HAPTICD, SOURCE = sys.argv[1], sys.argv[2]
PYTHON = os.path.join(SOURCE, "driver", "doors", "client", "python")
sys.path.insert(0, os.path.join(SOURCE, "tests", "support"))
sys.path.insert(0, PYTHON)
from daemon import Daemon
from e2e import check, finish, refused, until

SCENE = """hapticd: 1
servo: {{rate: 1000}}
device: {source}/config/devices/simulated-premium15.yaml
hand: {{script: guided, {hand}}}
clients: {clients}
models:
  - name: ball
    plugin: nurbs_rigid
    parameters: {{geometry: {source}/config/models/sphere.yaml, stiffness: 800}}
"""
ARM = "simulated Premium 1.5"
BOUND = 3.0  # N
STILL = "tremor: 0, wander: 0"


def scene(clients, hand=STILL):
    return SCENE.format(source=SOURCE, clients=clients, hand=hand)


def raises(action):
    try:
        action()
    except (OSError, PermissionError):
        return True
    return False


def pushed(rows):
    return numpy.sqrt(sum(rows["arm0_client_f" + c] ** 2 for c in "xyz"))


def newest(client):
    return float(pushed(client.rows("ticks", last=1))[-1])


def is_pushed(daemon):
    with daemon.connect() as client:
        listener = daemon.connect()
        events = listener.events(timeout=5)
        state = client.state(ARM)
        check("the state tells where the tip is", state.good and numpy.linalg.norm(state.position) < 0.5, state)
        rows = client.rows("ticks", last=1)
        check("a bell tells of rows", client.wait(int(rows["tick"][-1]) + 5, timeout=10))
        check("and does not wait for what is there", client.wait(0, timeout=0))
        with client.push(ARM, lambda state: (1.0, 0.0, 0.0)) as push:
            joined = next((event for event in events if event.get("event") == "joined"), {})
            check("events tell of a program that pushes",
                  joined.get("event") == "joined" and joined["code"] == 2 and joined["value"] == os.getpid(), joined)
            check("the hand is pushed", until(lambda: client.rows("ticks", last=1)["arm0_client_fx"][-1] == 1.0), newest(client))
            check("the device gets the force", until(lambda: client.rows("ticks", last=1)["arm0_sent_fx"][-1] > 0.9),
                  client.rows("ticks", last=1)["arm0_sent_fx"])
            one = client.status()["devices"][0]["clients"]
            check("status tells of it", len(one) == 1 and one[0]["pid"] == os.getpid() and one[0]["answers"] > 10, one)
            check("two may push", two_push(daemon))
            answers = push.answers
        check("each tick was answered", answers > 10, answers)
        check("the force ramps out at the end", until(lambda: newest(client) == 0))
        check("status forgets it", client.status()["devices"][0]["clients"] == [])
        rows = client.rows("pushes", last=100)
        check("answers are rows", len(rows) == 100 and (rows["answers"] <= rows["tick"]).all() and (rows["fx"] == 1).any())
        listener.close()


def two_push(daemon):
    with daemon.connect() as other:
        with other.push(ARM, lambda state: (0.0, 100.0, 0.0)):
            both = until(lambda: other.rows("ticks", last=1)["arm0_client_fx"][-1] > 0.9
                         and abs(other.rows("ticks", last=1)["arm0_client_fy"][-1] - BOUND) < 1e-9)
        return both


def leader_ends(daemon, how):
    """A program that pushes with 2 N is killed or stopped meanwhile: nothing of it is left 20 ms after its last answer."""
    program = f"""
import sys, time
sys.path.insert(0, {PYTHON!r})
import hapticd
client = hapticd.connect({daemon.name!r}, folder={daemon.folder!r})
push = client.push({ARM!r}, lambda state: (0.0, 0.0, 2.0))
time.sleep(1000)
"""
    name = signal.Signals(how).name
    with daemon.connect() as client:
        victim = subprocess.Popen([sys.executable, "-c", program])
        check(f"a program pushed until it got {name}", until(lambda: newest(client) > 1.9), newest(client))
        victim.send_signal(how)
        time.sleep(0.5)
        rows, answers = client.rows("ticks", last=2000), client.rows("pushes", last=1)
        at = rows[rows["tick"] == answers["tick"][-1]]["t"]
        after = rows[rows["t"] > at[-1] + 0.0201] if len(at) else rows[:0]
        check(f"nothing is left 20 ms after its last answer and {name}", len(after) > 100 and (pushed(after) == 0).all(),
              (len(after), pushed(after).max() if len(after) else None))
        between = rows[(rows["t"] > at[-1] + 0.0031) & (rows["t"] < at[-1] + 0.02)]
        check(f"it went in a ramp after {name}", (numpy.diff(pushed(between)) <= 1e-12).all())
        victim.kill()
        victim.wait()
        check(f"its place is free after {name}", until(lambda: client.status()["devices"][0]["clients"] == []))


def hostile(daemon):
    """Whatever is done to the memory: no fault, no force beyond the bound."""
    with daemon.connect() as client:
        client.ask(do="lead", force=ARM)
        fd = client._line.descriptor()
        check("the memory cannot be cut", raises(lambda: os.ftruncate(fd, 0)) and raises(lambda: os.ftruncate(fd, 1 << 20)))
        check("nor sealed anew", raises(lambda: fcntl.fcntl(fd, 1033, 0x0008)))
        client.ask(do="state")
        state = client._line.descriptor()
        check("the state cannot be written", raises(lambda: os.pwrite(state, b"x", 0)) and raises(lambda: mmap.mmap(state, 4096))
              and raises(lambda: os.ftruncate(state, 0)))
        check("it answers no wrong memory", refused(lambda: client.ask(do="lead", force=ARM), "already"))
        first = client.streams["ticks"].written
        refusals = client.streams["events"].written
        tick = lambda: client.streams["ticks"].written
        count = 0
        for bad in ((math.nan, 0, 0), (1e300, 0, 0), (0, math.inf, 0), (0, 0, -2e6)):
            count = put(fd, count, tick(), bad)
            time.sleep(0.02)
        for ahead in (1000, 1 << 40, 1 << 63):
            count = put(fd, count, tick() + ahead, (1, 0, 0))
            time.sleep(0.02)
        rows = client.streams["ticks"].read(first)[1]
        check("nonsense moves nothing", (pushed(rows) == 0).all(), pushed(rows).max())
        events = client.streams["events"].read(refusals)[1]
        check("and is told", ((events["kind"] == 12) & (events["code"] == 2)).any(), events)
        os.pwrite(fd, struct.pack("<Q", 7), 0)  # left odd, as by one who was killed inside
        begun = time.monotonic()
        while time.monotonic() - begun < 0.5:
            os.pwrite(fd, os.urandom(80), 0)
        client.ask(do="bell")
        bell = client._line.descriptor()
        while time.monotonic() - begun < 1:
            os.pwrite(bell, os.urandom(128), 0)
        check("a bell that others pull rings on", client.wait(tick() + 5, timeout=10))
        libc_hole(fd)
        time.sleep(0.1)
        rows = client.streams["ticks"].read(first)[1]
        check("random bytes keep the bound", pushed(rows).max() <= BOUND * 1.0001, pushed(rows).max())
        check("and latch no fault", all(d["fault"] is None for d in client.status()["devices"]), client.status())
        for one in (fd, state, bell):
            os.close(one)


def put(fd, count, tick, force):
    os.pwrite(fd, struct.pack("<Q", count + 1), 0)
    os.pwrite(fd, struct.pack("<Q6dQQ", tick, *force, 0, 0, 0, 0, 0), 8)
    os.pwrite(fd, struct.pack("<Q", count + 2), 0)
    return count + 2


def libc_hole(fd):
    import ctypes
    ctypes.CDLL(None).fallocate(fd, 0x02 | 0x01, ctypes.c_long(0), ctypes.c_long(4096))


def others(scratch):
    closed = Daemon(HAPTICD, scratch, "closed", scene("off"))
    with closed.connect() as client:
        check("a scene without clients is not pushed", refused(lambda: client.lead_force(ARM), "clients: add"))
        check("and has no rows for it", client.streams["pushes"].written == 0)
    closed.stop()
    alone = Daemon(HAPTICD, scratch, "alone", scene("{mode: instead, exclusive: true}"))
    with alone.connect() as client, alone.connect() as second:
        with client.lead_force(ARM):
            check("the second of an exclusive scene is refused, and told the first",
                  refused(lambda: second.lead_force(ARM), f"process {os.getpid()}"))
        check("and comes when the first has gone", second.lead_force(ARM) is not None)
        check("an arm of no name is refused", refused(lambda: client.lead_force("no such arm"), "no device"))
        with client.lead_hand(ARM) as hand:
            second.close()
            until(lambda: client.status()["devices"][0]["clients"] == [])
            for z in numpy.linspace(0.06, 0.04, 50):
                hand.put([0, 0, z])
                time.sleep(0.005)
            felt = until(lambda: client.rows("ticks", last=1)["arm0_sent_fz"][-1] > 0.5)
            with client.push(ARM, lambda state: (0.0, 0.0, 0.0)):
                check("instead of the models: they fade out",
                      felt and until(lambda: abs(client.rows("ticks", last=1)["arm0_sent_fz"][-1]) < 1e-9
                                     and client.rows("ticks", last=1)["arm0_fz"][-1] > 0.4))
            check("and come back", until(lambda: client.rows("ticks", last=1)["arm0_sent_fz"][-1] > 0.4))
    alone.stop()
    wrong = os.path.join(scratch, "wrong.yaml")
    for clients, said in (("maybe", "clients"), ("{mode: add, max_force: -1}", "clients.max_force"), ("{exclusive: true}", "clients.mode")):
        with open(wrong, "w") as file:
            file.write(scene(clients))
        done = subprocess.run([HAPTICD, "check", wrong], capture_output=True, text=True, timeout=60)
        check(f"clients: {clients} is refused by name", done.returncode == 2 and said in done.stdout + done.stderr, done.stdout)


def is_sent_as_asked(scratch):
    """A hand that trembles is pushed steadily, and by a soft spring: the passivity controller leaves both alone."""
    daemon = Daemon(HAPTICD, scratch, "steady", scene("add", hand="tremor: 0.02, wander: 0.02"))
    with daemon.connect() as client:
        start = client.state(ARM).position[0]
        for name, force in (("a push of 0.7 N", lambda state: (0.7, 0.0, 0.0)),
                            ("a spring of 200 N/m", lambda state: (0.7 - 200 * (state.position[0] - start), 0.0, 0.0))):
            with client.push(ARM, force):
                check(f"{name} is felt", until(lambda: newest(client) > 0.1), newest(client))
                time.sleep(3)
                rows = client.rows("ticks", last=1500)
            added = rows["arm0_sent_fx"] - rows["arm0_client_fx"] - rows["arm0_fx"]
            check(f"{name} is sent as it was asked for", len(rows) == 1500 and numpy.sqrt(numpy.mean(added ** 2)) < 0.01, added)
            if "push" in name:
                whole = rows["arm0_client_fx"] == 0.7
                check("and does not vary", whole.sum() > 100 and numpy.std(added[whole]) < 0.01, numpy.std(added[whole]))
    daemon.stop()


with tempfile.TemporaryDirectory(dir="/dev/shm") as scratch:
    recording = os.path.join(scratch, "pushed.h5")
    daemon = Daemon(HAPTICD, scratch, "p", scene(f"{{mode: add, max_force: {BOUND}}}"), "--record", recording)
    is_pushed(daemon)
    leader_ends(daemon, signal.SIGKILL)
    leader_ends(daemon, signal.SIGSTOP)
    hostile(daemon)
    check("the run ends in order", daemon.stop() == 0)
    done = subprocess.run([HAPTICD, "replay", recording], capture_output=True, text=True, timeout=120)
    check("and replays to the last bit", done.returncode == 0, done.stdout + done.stderr)
    others(scratch)
    is_sent_as_asked(scratch)
finish()
