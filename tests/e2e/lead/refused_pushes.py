#!/usr/bin/env python3
"""What the daemon refuses or cuts of a program's push is told to the program, in status and in the report.

Usage: refused_pushes.py HAPTICD SOURCE     prints one line per case; exit 1 when one is off.
"""
import json
import math
import os
import struct
import sys
import tempfile
import time
import warnings

HAPTICD, SOURCE = sys.argv[1], sys.argv[2]
sys.path.insert(0, os.path.join(SOURCE, "tests", "support"))
sys.path.insert(0, os.path.join(SOURCE, "driver", "doors", "client", "python"))
from daemon import Daemon
from e2e import check, finish, until

SCENE = f"""hapticd: 1
servo: {{rate: 1000}}
device: {SOURCE}/config/devices/simulated-premium15.yaml
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


def raw(client):
    """As a program does that knows the memory and no library."""
    client.ask(do="lead", force=ARM)
    fd = client._line.descriptor()
    count = 0
    for force in ((math.nan, 0, 0), (1e7, 0, 0), (7, 0, 0)):
        for _ in range(10):
            os.pwrite(fd, struct.pack("<Q", count + 1), 0)
            os.pwrite(fd, struct.pack("<Q6dQQ", client.streams["ticks"].written, *force, 0, 0, 0, 0, 0), 8)
            os.pwrite(fd, struct.pack("<Q", count + 2), 0)
            count += 2
            time.sleep(0.01)
        one = client.status()["devices"][0]["clients"][0]
        if math.isnan(force[0]):
            check("status counts refused answers, with the reason",
                  one["refused"] > 0 and one["answers"] == 0 and one["why"] == "a number is not finite", one)
        elif force[0] > 1e6:
            check("the reason is that of the last", one["why"] == "a force or torque is beyond 1e6 N or N m", one)
    check("status says what was asked for and what was cut",
          one["asked_n"] == 7 and one["bounded"] > 0 and one["largest_n"] <= 3.0001, one)
    os.close(fd)
    return one


with tempfile.TemporaryDirectory(dir="/dev/shm") as scratch:
    report = os.path.join(scratch, "report.json")
    daemon = Daemon(HAPTICD, scratch, "refuses", SCENE, "--report", report)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        with daemon.connect() as client:
            python(client)
            counted(client)
        with daemon.connect() as client:
            last = raw(client)
        with daemon.connect() as client:
            with client.lead_hand(ARM) as hand:
                hand._put(struct.pack("<14d", 0.03, 0, 0, *[0] * 11))
                check("a hand's target needs no orientation",
                      until(lambda: abs(client.state(ARM).position[0] - 0.03) < 0.002, 30), client.state(ARM).position)
                hand._put(struct.pack("<14d", 30, 0, 0, 1, *[0] * 10))
                seen = lambda: [e for e in client.ask(do="events")["events"] if e["event"] == "refused" and "farther" in e.get("why", "")]
                check("an event says why a target was refused", until(seen, 30), client.ask(do="events"))
    daemon.stop()
    out, text = daemon.summary(), daemon.log()
    with open(report) as file:
        programs = json.load(file)["clients"]
    check("the report has the same", any(one["refused"] >= last["refused"] and one["asked_n"] == 7 and one["bounded"] > 0
                                         and one["why"] for one in programs), programs)
    check("and the summary", "answers were refused" in out and "asked for up to 7 N" in out, out)
    check("the log says why a target was refused", "refused so far: its position is farther" in text, text)
finish()
