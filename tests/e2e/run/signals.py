#!/usr/bin/env python3
"""Signals that end a program end a run in order, at any moment of its start too.

Usage: signals.py HAPTICD SOURCE_DIR     prints one line per check; exit 1 when one fails.
"""
import json
import os
import resource
import signal
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "support"))
from e2e import check, finish

HAPTICD, SOURCE = (os.path.abspath(argument) for argument in sys.argv[1:3])
SCENE = os.path.join(SOURCE, "config", "scenes", "sphere.yaml")


def start(folder, *more, **how):
    environment = dict(os.environ, RUNTIME_DIRECTORY=folder, STATE_DIRECTORY=folder)
    return subprocess.Popen([HAPTICD, "run", SCENE, "--name", "st", *more], env=environment, stdout=subprocess.PIPE,
                            stderr=subprocess.STDOUT, text=True, **how)


def ticking(daemon):
    end = time.monotonic() + 30
    while time.monotonic() < end and daemon.poll() is None:
        try:
            if any(open(f"/proc/{daemon.pid}/task/{t}/comm").read().strip() == "hapticd-servo" for t in os.listdir(f"/proc/{daemon.pid}/task")):
                return time.sleep(0.3)
        except OSError:  # a thread ended while it was being read
            pass
        time.sleep(0.02)


def left(folder):
    return [name for name in os.listdir(folder) if name.endswith((".h5", ".status", ".sock"))]


def inOrder(folder):
    for sig in (signal.SIGHUP, signal.SIGQUIT):
        report = os.path.join(folder, "report.json")
        daemon = start(folder, "--report", report)
        ticking(daemon)
        daemon.send_signal(sig)
        said = daemon.communicate(timeout=20)[0]
        check(f"{sig.name} ends the run with exit code 0", daemon.returncode == 0, (daemon.returncode, said))
        check(f"{sig.name} still writes the report", os.path.exists(report) and json.load(open(report))["ticks"] > 0)
        check(f"{sig.name} leaves nothing", not left(folder), left(folder))


def nohup(folder):
    daemon = start(folder, preexec_fn=lambda: signal.signal(signal.SIGHUP, signal.SIG_IGN))
    ticking(daemon)
    daemon.send_signal(signal.SIGHUP)
    time.sleep(0.5)
    check("a run under nohup outlives its terminal", daemon.poll() is None)
    daemon.terminate()
    daemon.communicate(timeout=20)


def tooLarge(folder):
    """A recording that reaches the largest size of a file is an error told, not the end of the process by a signal."""
    most = 4 << 20  # bytes; a virtual run without a name keeps no other file
    daemon = subprocess.Popen([HAPTICD, "run", SCENE, "--for", "60", "--virtual-time", "--record", os.path.join(folder, "r.h5")],
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                              preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (most, most)))
    said = daemon.communicate(timeout=60)[0]
    check("a recording that grows too large is told", daemon.returncode == 1 and "File too large" in said, (daemon.returncode, said))


def aborted(folder):
    daemon = start(folder)
    ticking(daemon)
    daemon.send_signal(signal.SIGABRT)
    said = daemon.communicate(timeout=20)[0]
    check("SIGABRT switches the motors off first, and is told", daemon.returncode == 1 and "(SIGABRT)" in said and "motors were switched off first" in said, (daemon.returncode, said))


def early(folder):
    """Before the handler there is nothing to leave."""
    for after in (0.02, 0.05, 0.08, 0.1, 0.13, 0.16, 0.2, 0.25, 0.3, 0.4):
        daemon = start(folder)
        time.sleep(after)
        daemon.terminate()
        said = daemon.communicate(timeout=20)[0]
        check(f"SIGTERM after {after} s leaves nothing",
              daemon.returncode in (0, -signal.SIGTERM) and not left(folder) and "was killed or crashed" not in said,
              (daemon.returncode, left(folder), said))


for case in (inOrder, nohup, early, aborted, tooLarge):
    with tempfile.TemporaryDirectory() as scratch:
        case(scratch)
finish()
