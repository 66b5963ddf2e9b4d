#!/usr/bin/env python3
"""Random faults in real time, a daemon each: whatever happens, the arm `rig` is left without a force, the force never
grows after the fault, and a model beside the culprit is not blamed.

Usage: schedules_test.py HAPTICD RIG.so ENDING_SHAPES.so SOURCE [COUNT [SEED]]     exit 1 when a schedule fails.
"""
import collections
import os
import random
import signal
import sys
import time
from multiprocessing.pool import ThreadPool

here = os.path.dirname(os.path.abspath(__file__))
sys.path[:0] = [here, os.path.join(here, "..", "..", "support"), os.path.join(here, "..", "..", "support", "rig")]
import rig
from daemon import Daemon
from e2e import check, finish

HAPTICD, MODULE, SHAPES = (os.path.abspath(argument) for argument in sys.argv[1:4])
COUNT = int(sys.argv[5]) if len(sys.argv) > 5 else 24
SEED = int(sys.argv[6]) if len(sys.argv) > 6 else 1

BY_PLUGIN = ["exit", "quick_exit", "exit_in_thread", "segv_in_thread", "abort_in_thread", "raise", "timer", "masked_segv",
             "reset_segv", "plain_exit", "raw_exit"]
BY_SIGNAL = ["SIGKILL", "SIGTERM", "SIGINT", "SIGHUP", "SIGSTOP", "SIGUSR1", "SIGTSTP"]
BY_ARM = {"lost": rig.LOST, "hardware fault": rig.HARDWARE_FAULT, "silent": rig.SILENT, "hangs in read": rig.HANG_IN_READ,
          "hangs in write": rig.HANG_IN_WRITE, "write fails": rig.WRITE_FAILS}
ENDING = ("SIGTERM", "SIGINT", "SIGHUP", "SIGUSR1")  # a person's, or the system's, wish for an orderly end
OTHERS = ["garbage on the socket, then SIGTERM", "disk full, then SIGTERM", "slow steps, then SIGTERM", "hold, then SIGKILL"]


def start(event, chance):
    """The culprit pushes beside an innocent model of another plugin, which pushes too."""
    how = event if event in BY_PLUGIN else "never"
    culprit = f"{{name: bad, plugin: ending, parameters: {{how: {how}, after: {chance.randint(200, 3000)}, signal: 10}}}}"
    busy = 0.004 if event.startswith("slow") else 0
    innocent = f"{{name: good, plugin: slow, parameters: {{busy: {busy}}}}}"
    options = ["--rate", str(chance.choice([1000, 2000, 4000]))]
    if event.startswith("disk"):
        options += ["--record", "/dev/full"]
    return Daemon(HAPTICD, [MODULE, SHAPES], [culprit, innocent], rig={"lazy": chance.choice(["true", "false"])}, arguments=options)


def happen(event, run):
    """What comes from outside. @return time.monotonic_ns() of it; 0: the plugin does it at a time of its own"""
    if event in BY_PLUGIN:
        return 0
    if event.startswith("garbage"):
        with run.connect() as line:
            line.sendall(os.urandom(4096).replace(b"\n", b" ") + b"\n")
            line.settimeout(10)
            line.recv(4096)
    if event.startswith("hold"):
        run.ctl("hold")
    begun = time.monotonic_ns()
    if event in BY_ARM:
        run.arm.wish(BY_ARM[event])
        run.arm.silent_after(20)
        run.arm.wish(0)
        run.process.terminate()
    else:
        run.process.send_signal(getattr(signal, event.rsplit(" ", 1)[-1]))
    return begun


def faults_of(event, run):
    """What is wrong with how a schedule ended; "": nothing."""
    entries = run.arm.entries()
    if run.arm.motors_on():
        return "the last force stays on"
    if not any(entry.on for entry in entries) and not event.startswith("disk"):
        return "nothing ever pushed"
    cuts = [i for i, entry in enumerate(entries) if entry.kind == rig.CUT]
    late = entries[cuts[0]:] if cuts and event not in BY_ARM else []
    if any(entry.on for entry in late):
        return "a force after the cut"
    if "slow" in run.quarantined():
        return "the innocent plugin is blamed"
    return ""


def grown(entries, begun):
    """The force grows after the event, by more than the two models together push at a moment."""
    forces = [sum(f * f for f in entry.force) ** 0.5 for entry in entries if entry.kind == rig.COMMAND and entry.time_ns > begun]
    return any(b > a + 1e-9 for a, b in zip(forces, forces[1:]))


def pushes(run, event):
    """The arm pushes; or the run has ended before that, because its recording cannot be written."""
    end = time.monotonic() + 60
    while time.monotonic() < end:
        if run.process.poll() is not None and event.startswith("disk"):
            return True
        try:
            if run.arm.wait_for_force(0.5):
                return True
        except TimeoutError:  # the arm is not even opened yet
            pass
    return False


def play(number):
    chance = random.Random(SEED * 1_000_003 + number)
    event = chance.choice(BY_PLUGIN + BY_SIGNAL + list(BY_ARM) + OTHERS)
    run = start(event, chance)
    try:
        if event not in BY_PLUGIN and not pushes(run, event):
            return number, event, "no force came", run.end(1)[1]
        time.sleep(0 if event in BY_PLUGIN else chance.uniform(0, 0.3))
        begun = happen(event, run)
        stopped = event == "SIGTSTP"
        if stopped:
            run.arm.silent_after(20)
            run.process.send_signal(signal.SIGCONT)
            run.process.terminate()
        code, said = run.end(60)
        if event in ("SIGKILL", "SIGSTOP", "masked_segv", "reset_segv", "raw_exit", "hold, then SIGKILL"):
            run.arm.silent_after(10)  # the guard's part
        wrong = faults_of(event, run)
        if not wrong and "(it never ended)" in said and event.endswith(ENDING):
            wrong = "it was asked to end and did not"
        if not wrong and begun and event in ("SIGTERM", "SIGINT", "SIGHUP", "SIGUSR1") and grown(run.arm.entries(), begun + 5_000_000):
            wrong = "the force grew after the event"
        return number, event, wrong, said
    finally:
        run.leave()


signal.signal(signal.SIGHUP, signal.SIG_DFL)  # under nohup the daemon would ignore it, as it should
counts = collections.Counter()
for number, event, wrong, said in ThreadPool(2).imap_unordered(play, range(COUNT)):
    counts[event] += 1
    if wrong:
        check(f"schedule {number} of seed {SEED} ({event}): {wrong}", False, said[-600:])
print(f"{COUNT} schedules: {dict(sorted(counts.items()))}")
finish()
