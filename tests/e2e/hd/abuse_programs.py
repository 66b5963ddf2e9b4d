#!/usr/bin/env python3
"""Programs of the HDAPI are killed, stopped and continued at any moment, or call everything in any order: the daemon goes
on, no program hangs, no force and no place of theirs stays.

Usage: abuse_programs.py HAPTICD SOURCE PROGRAMS [HOW_MANY [SEED]]     prints one line per case; exit 1 when one is off.
"""
import os
import random
import signal
import subprocess
import sys
import tempfile
import time

HAPTICD, SOURCE, PROGRAMS = sys.argv[1:4]
HOW_MANY = int(sys.argv[4]) if len(sys.argv) > 4 else 24
SEED = int(sys.argv[5]) if len(sys.argv) > 5 else 1
sys.path.insert(0, os.path.join(SOURCE, "tests", "support"))
sys.path.insert(0, os.path.join(SOURCE, "driver", "doors", "client", "python"))
from daemon import Daemon
from e2e import check, finish, until

SCENE = """hapticd: 1
servo: {{rate: 1000}}
device: {source}/config/devices/simulated-premium15.yaml
clients: add
models: []
"""
TOGETHER = 4  # at one time; the arm has 8 places


def start(number):
    words = (["hd_random", str(number), "60"] if number % 3 == 0 else
             ["hd_forces", ("spring", "clamp", "wall")[number % 3], "60"])
    return subprocess.Popen([os.path.join(PROGRAMS, words[0]), *words[1:]], env=daemon.environment, stdout=subprocess.DEVNULL,
                            stderr=subprocess.DEVNULL)


def mistreat(chance, program):
    """Ends a program in some way. Programs of random calls end by themselves."""
    time.sleep(chance.random() * 0.15)
    for _ in range(chance.randrange(3)):
        program.send_signal(signal.SIGSTOP)
        time.sleep(chance.random() * 0.05)
        program.send_signal(signal.SIGCONT)
    program.send_signal(chance.choice([signal.SIGKILL, signal.SIGTERM, signal.SIGSTOP, signal.SIGUSR1]))


def batch(chance, first):
    programs = [start(first + i) for i in range(TOGETHER)]
    for i, program in enumerate(programs):
        if (first + i) % 3 != 0:
            mistreat(chance, program)
    for i, program in enumerate(programs):
        if (first + i) % 3 == 0:
            program.wait(timeout=120)  # one that hangs ends the test
    gone = until(lambda: force_now() == 0)  # also of those that are only stopped
    for program in programs:
        if program.poll() is None:
            program.kill()
            program.wait()
    return gone


def force_now():
    row = client.rows("ticks", last=50)[-1]
    return max(abs(row["arm0_client_f" + c]) for c in "xyz")


class Comings:
    """Who joined and who was told to have left, counted as it happens: old events are not kept."""

    def __init__(self):
        self.joined = self.left = 0
        self.next = client.streams["events"].written

    def match(self):
        begin, events = client.streams["events"].read(self.next)
        self.next = begin + len(events)
        self.joined += int((events["kind"] == 10).sum())
        self.left += int((events["kind"] == 11).sum())
        return self.joined == self.left


def resources(pid):
    return len(os.listdir(f"/proc/{pid}/fd")), len(os.listdir(f"/proc/{pid}/task"))


with tempfile.TemporaryDirectory(dir="/dev/shm") as folder:
    library = os.path.join(os.path.dirname(HAPTICD), "..", "lib", "hapticd", "hdapi")
    with Daemon(HAPTICD, folder, "abused", SCENE.format(source=SOURCE), HAPTICD_NAME="abused", LD_LIBRARY_PATH=library) as daemon:
        chance = random.Random(SEED)
        with daemon.connect() as client:
            comings = Comings()
            batch(chance, 1)  # what is made once is made
            until(lambda: not client.status()["devices"][0]["clients"])
            before = resources(daemon.process.pid)
            stays = 0
            for first in range(0, HOW_MANY, TOGETHER):
                stays += not batch(chance, first)
                until(comings.match)
            check(f"{HOW_MANY} programs: no force stays", stays == 0, stays)
            check("no place of theirs stays", until(lambda: not client.status()["devices"][0]["clients"]),
                  client.status()["devices"][0]["clients"])
            check("no descriptor and no thread of the daemon's stays", until(lambda: resources(daemon.process.pid) == before),
                  (before, resources(daemon.process.pid)))
            check("who joined was told to have left", until(comings.match) and comings.joined > 0, vars(comings))
            rows = client.rows("ticks", last=8000)
            sent = max(abs(rows["arm0_sent_f" + c]).max() for c in "xyz")
            check("the daemon's limit held", sent <= 8.5 * 1.0001, sent)
finish()
