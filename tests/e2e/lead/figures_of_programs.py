#!/usr/bin/env python3
"""What top, doctor, status and the report of a run tell of the programs that pushed.

Usage: figures_of_programs.py HAPTICD SOURCE     prints a line a case; exit 1 when one is off.
"""
import json
import os
import signal
import subprocess
import sys
import tempfile

HAPTICD, SOURCE = sys.argv[1], sys.argv[2]
PYTHON = os.path.join(SOURCE, "driver", "doors", "client", "python")
sys.path.insert(0, os.path.join(SOURCE, "tests", "support"))
sys.path.insert(0, PYTHON)
from daemon import Daemon
from e2e import check, finish, until

SCENE = f"""hapticd: 1
servo: {{rate: 1000}}
device: {SOURCE}/config/devices/simulated-premium15.yaml
clients: CLIENTS
models: []
"""
ARM = "simulated Premium 1.5"
HERE = os.path.dirname(os.path.abspath(__file__))


class Run(Daemon):
    """A run of a scene, its report, and what other commands say meanwhile."""

    def __init__(self, folder, name, clients):
        self.report = os.path.join(folder, name + ".json")
        super().__init__(HAPTICD, folder, name, SCENE.replace("CLIENTS", clients), "--report", self.report)

    def clients(self):
        return json.loads(self.run("top", "--name", self.name, "--once", "--json")[1])["clients"]

    def advice(self):
        checks = json.loads(self.run("doctor", "--seconds", "0", "--json")[1])["checks"]
        return next(one for one in checks if one["name"] == "clients")

    def table(self):
        return self.run("top", "--name", self.name, "--once")[1]

    def pusher(self):
        return subprocess.Popen([sys.executable, os.path.join(HERE, "pusher.py"), PYTHON, self.name, self.folder, ARM])

    def end(self):
        """The summary and the report."""
        self.stop()
        with open(self.report) as file:
            return self.summary(), json.load(file)


def told_meanwhile(run):
    check("nobody pushes, and doctor says so", run.advice()["verdict"] == "ok", run.advice())
    check("nor in top", run.clients() == [] and "PROGRAM" not in run.table())
    program = run.pusher()
    pushes = until(lambda: any(one["answers"] > 300 and one["force_n"] == 2 for one in run.clients()), 60)
    one = run.clients()[0]
    check("top tells of a program that pushes", pushes and one["pid"] == program.pid and one["device"] == ARM, one)
    check("by its name", one["program"].endswith(" pusher.py"), one)
    check("its force now and the largest", one["force_n"] == 2 and one["largest_n"] == 2, one)
    check("and which part came in time", 0 <= one["same_tick"] < 0.95 and one["same_tick"] + one["next_tick"] <= 1, one)
    text = run.table()
    check("as a table too", "PROGRAM" in text and "pusher.py" in text and "LATE" in text, text)
    advice = run.advice()
    check("doctor tells of a program that comes late, and what to do",
          advice["verdict"] == "warn" and "pusher.py" in advice["state"] and "answer_time" in advice["fix"], advice)
    return program


def stalls(run, program):
    program.send_signal(signal.SIGSTOP)
    check("a program that stands is told as silent", until(lambda: run.clients()[0]["force_n"] == 0), run.clients())
    check("once", run.clients()[0]["silences"] >= 1, run.clients())
    program.kill()
    program.wait()
    check("one that died is gone", until(lambda: run.clients() == []), run.clients())


def watched(folder):
    """A scene that lets programs look on."""
    run = Run(folder, "watched", "{mode: add, push: false}")
    program = run.pusher()
    check("push: false lets nobody push", program.wait(timeout=60) != 0)
    told, report = run.end()
    check("and the report tells of nobody", report["clients"] == [] and "program " not in told, report)


with tempfile.TemporaryDirectory(dir="/dev/shm") as place:
    first = Run(place, "figures", "add")
    stalls(first, told_meanwhile(first))
    again = first.pusher()
    until(lambda: any(one["answers"] > 300 for one in first.clients()), 60)
    printed, written = first.end()
    again.kill()
    again.wait()
    clients = written["clients"]
    check("the report has it once, however often it came",
          len(clients) == 1 and clients[0]["times"] == 2 and clients[0]["program"].endswith(" pusher.py"), clients)
    check("with its figures", clients[0]["answers"] > 600 and clients[0]["largest_n"] == 2 and clients[0]["silences"] >= 1 and
          clients[0]["device"] == ARM, clients)
    check("the summary too, with what helps", "pusher.py on " + ARM in printed and "answer_time: 60e-6" in printed, printed)
    watched(place)
finish()
