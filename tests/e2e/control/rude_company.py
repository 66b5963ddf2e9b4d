#!/usr/bin/env python3
"""A daemon among pipes, idle clients and others of its name: it answers, is stopped, and loses no file.

Usage: rude_company.py HAPTICD SCENES     prints a line a case; exit 1 when one is off.
"""
import json
import os
import signal
import socket
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "support"))
from e2e import check, finish

HAPTICD, SCENES = sys.argv[1], sys.argv[2]
SCENE = os.path.join(SCENES, "sphere.yaml")


class Daemon:
    """Runs under its name until it is told to end; its files are in the folder."""

    def __init__(self, folder, *more, name="x"):
        self.folder, self.name = folder, name
        self.environment = dict(os.environ, RUNTIME_DIRECTORY=folder, STATE_DIRECTORY=folder)
        self.run = subprocess.Popen([HAPTICD, "run", SCENE, "--for", "100", *(["--name", name] if name else []), *more],
                                    env=self.environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)

    def ctl(self, *arguments, timeout=20):
        try:
            done = subprocess.run([HAPTICD, "ctl", "--name", self.name or "hapticd", *arguments], env=self.environment,
                                  capture_output=True, text=True, timeout=timeout)
            return done.returncode, done.stdout + done.stderr
        except subprocess.TimeoutExpired:
            return None, f"no answer within {timeout} s"

    def ready(self):
        end = time.monotonic() + 30
        while time.monotonic() < end and self.run.poll() is None and self.ctl("status")[0] != 0:
            time.sleep(0.1)
        return self

    def end(self, sig=signal.SIGTERM, timeout=20):
        """Exit code and what was said; None: it did not end."""
        if self.run.poll() is None:
            self.run.send_signal(sig)
        try:
            said = self.run.communicate(timeout=timeout)[0]
            return self.run.returncode, said
        except subprocess.TimeoutExpired:
            self.run.kill()
            return None, self.run.communicate()[0]


def pipes(folder):
    pipe = os.path.join(folder, "pipe")
    os.mkfifo(pipe)
    for command in (["run", pipe], ["replay", pipe], ["check", pipe], ["run", SCENE, "--device", pipe], ["plot", pipe]):
        done = subprocess.run([HAPTICD, *command], capture_output=True, text=True, timeout=20)
        check(f"{command[0]} {len(command)} refuses a pipe", done.returncode == 2 and "is a pipe, expected a file" in done.stdout + done.stderr, done)
    daemon = Daemon(folder).ready()
    for command in (["add", pipe], ["reload", pipe]):
        code, said = daemon.ctl(*command)
        check(f"{command[0]} refuses a pipe", code == 1 and "is a pipe, expected a file" in said, (code, said))
    check("and the daemon answers", daemon.ctl("status")[0] == 0)
    check("and ends in order", daemon.end()[0] == 0)


CASES = [pipes]
for case in CASES:
    with tempfile.TemporaryDirectory() as scratch:
        case(scratch)
finish()
