#!/usr/bin/env python3
"""The name of a run: free once `ctl stop` answers, told where another is meant, and cleared where its run was killed.

Usage: names_of_runs.py HAPTICD SOURCE     prints one line per case; exit 1 when one is off.
"""
import os
import subprocess
import sys
import tempfile
import time

HAPTICD, SOURCE = sys.argv[1], sys.argv[2]
sys.path.insert(0, os.path.join(SOURCE, "tests", "support"))
from e2e import check, finish, program, until

SCENE = os.path.join(SOURCE, "config", "scenes", "sphere.yaml")


class House:
    """A folder in which runs live."""

    def __init__(self, folder):
        self.folder = folder
        self.environment = dict(os.environ, RUNTIME_DIRECTORY=folder, STATE_DIRECTORY=os.path.join(folder, "state"))
        self.ask = program(HAPTICD, self.environment)
        self.runs = []

    def start(self, *options):
        run = subprocess.Popen([HAPTICD, "run", SCENE, *options], env=self.environment, stdout=subprocess.DEVNULL,
                               stderr=subprocess.PIPE, text=True)
        self.runs.append(run)
        return run

    def serves(self, name):
        return until(lambda: self.ask("ctl", "--name", name, "status")[0] == 0, 30)

    def files(self):
        return sorted(file for file in os.listdir(self.folder) if file != "state")


def stopped(house):
    for _ in range(3):
        house.start()
        check("a run takes the name hapticd", house.serves("hapticd"), house.files())
        code, out, err = house.ask("ctl", "stop")
        check("stop answers once it has ended", code == 0 and house.files() == [], (code, out, err, house.files()))


def named(house):
    first, second = house.start(), None
    house.serves("hapticd")
    second = house.start()
    name = f"hapticd-{second.pid}"
    check("a second run has a name with its number", house.serves(name), house.files())
    code, _, err = house.ask("ctl", "--name", "nobody", "status")
    check("who asks for another is told those that run", code == 1 and f"these run: hapticd, {name}" in err, err)
    second.kill()
    second.wait()
    left = [file for file in house.files() if file.startswith(name)]
    check("a killed run leaves its files", len(left) > 1, left)
    told = second.stderr.read()
    check("it was warned of its name", "warning" in told and f"this one has the name {name}" in told, told)
    third = house.start()
    check("the next start", house.serves(f"hapticd-{third.pid}"))
    left = [file for file in house.files() if file.startswith(name)]
    check("clears them", left == [], left)
    kept = os.listdir(os.path.join(house.folder, "state"))
    check("and keeps the last seconds", any(name in file for file in kept), kept)
    for run in (first, third):
        run.terminate()
        run.wait(30)


def ends(house, kill):
    """Streams of a daemon that is killed fail, those of one that is stopped end."""
    run = house.start("--name", "watched")
    house.serves("watched")
    watchers = [subprocess.Popen([HAPTICD, *words, "--name", "watched"] if words[0] == "top" else
                                 [HAPTICD, "ctl", "--name", "watched", *words], env=house.environment, text=True,
                                 stdout=subprocess.PIPE, stderr=subprocess.PIPE)
                for words in (["top", "--json", "--every", "0.05"], ["events", "--follow"])]
    check("top tells", watchers[0].stdout.readline().startswith("{"))
    time.sleep(0.5)  # s: the other one listens by then
    (run.kill if kill else run.terminate)()
    run.wait(30)
    for watcher in watchers:
        _, err = watcher.communicate(timeout=30)
        words = watcher.args[1:]
        check(f"{words} of a daemon that was {'killed' if kill else 'stopped'}",
              (watcher.returncode == 1 and "was killed" in err) if kill else (watcher.returncode == 0 and err == ""),
              (watcher.returncode, err))


with tempfile.TemporaryDirectory(dir="/dev/shm") as scratch:
    house = House(scratch)
    try:
        stopped(house)
        named(house)
        ends(house, True)
        ends(house, False)
    finally:
        for run in house.runs:
            run.kill()
            run.wait()
finish()
