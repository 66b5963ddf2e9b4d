#!/usr/bin/env python3
"""A daemon among pipes, idle clients and others of its name: it answers, is stopped, and loses no file.

Usage: misbehaving_clients.py HAPTICD SCENES     prints one line per case; exit 1 when one is off.
"""
import atexit
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
        atexit.register(self.run.kill)

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
        """Exit code and what was said; None: it did not end. No signal: it ends by itself."""
        if sig is not None and self.run.poll() is None:
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
        check(f"{command[0]} refuses a pipe", code == 2 and "is a pipe, expected a file" in said, (code, said))
    check("and the daemon answers", daemon.ctl("status")[0] == 0)
    check("and ends in order", daemon.end()[0] == 0)


def idle(folder):
    """As many connections that say nothing as the daemon and its queue take."""
    daemon = Daemon(folder).ready()
    crowd = []
    for _ in range(32 + 16):  # connections, and its queue
        client = socket.socket(socket.AF_UNIX)
        client.connect(os.path.join(folder, "x.sock"))
        crowd.append(client)
    for command in (["hold"], ["stop"]):
        code, said = daemon.ctl(*command)
        check(f"{command[0]} is obeyed among 48 idle clients", code == 0, (code, said))
    check("and the daemon ends in order", daemon.end(None)[0] == 0)


def sameName(folder):
    first = Daemon(folder).ready()
    second = Daemon(folder)
    code, said = second.end(None)
    check("a name that is taken is refused", code == 2 and "another daemon has the name x" in said, (code, said))
    check("and the first one keeps its files", sorted(n for n in os.listdir(folder) if n.startswith("x.")) ==
          ["x.blackbox.h5", "x.lock", "x.sock", "x.status"], os.listdir(folder))
    check("and answers", first.ctl("status")[0] == 0)
    code, said = first.end(signal.SIGKILL)
    third = Daemon(folder).ready()
    check("the name of one that was killed is free", third.ctl("status")[0] == 0)
    code, said = third.end()
    check("and what it left is kept", code == 0 and "was killed or crashed" in said and
          os.path.exists(os.path.join(folder, "blackbox-x-crash-1.h5")), (code, said, os.listdir(folder)))
    check("at the end nothing is left", not [n for n in os.listdir(folder) if n.startswith("x.")], os.listdir(folder))


def unnamedTogether(folder):
    both = [Daemon(folder, name=""), Daemon(folder, name="")]
    end = time.monotonic() + 30
    while time.monotonic() < end and len([n for n in os.listdir(folder) if n.endswith(".sock")]) < 2:
        time.sleep(0.1)
    names = sorted(n for n in os.listdir(folder) if n.endswith(".sock"))
    check("two unnamed daemons started together have a name each", len(names) == 2 and "hapticd.sock" in names, names)
    told = [daemon.end() for daemon in both]
    check("and no files of the other", all(code == 0 and "was killed or crashed" not in said for code, said in told), told)


def oneRecording(folder):
    file = os.path.join(folder, "both.h5")
    first = Daemon(folder, "--record", file).ready()
    second = Daemon(folder, "--record", file, name="y")
    code, said = second.end(None)
    check("a recording that another run writes is refused", code == 1 and "another run records into it" in said, (code, said))
    check("the first run ends in order", first.end()[0] == 0)
    done = subprocess.run([HAPTICD, "replay", file], capture_output=True, text=True, timeout=60)
    check("and its recording replays", done.returncode == 0, done)


CASES = [pipes, idle, sameName, unnamedTogether, oneRecording]
for case in CASES:
    with tempfile.TemporaryDirectory() as scratch:
        case(scratch)
finish()
