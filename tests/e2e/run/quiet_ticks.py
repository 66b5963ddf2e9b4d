#!/usr/bin/env python3
"""Every shipped scene in real time: the servo thread allocates nothing, locks nothing, faults no page and asks the kernel
for nothing but sleep. Planted violations must be seen.

Usage: quiet_ticks.py HAPTICD SOURCE_DIR WITNESS.so TEST_SHAPES.so     prints one line per check; exit 1 when one fails.
"""
import concurrent.futures
import glob
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "support"))
sys.path.insert(0, os.path.join(sys.argv[2], "driver", "doors", "client", "python"))
import hapticd
from e2e import can_lock_memory, check, finish

HAPTICD, SOURCE, WITNESS, SHAPES = sys.argv[1:5]
SECONDS = 2
strace = shutil.which("strace")
can_lock = can_lock_memory()


def systemCalls(log):
    """Calls of the servo thread, but for sleeping, between the end of its warm-up and of its run: both ask for the faults;
    the witness asks for the thread's name when the warm-up ends."""
    servo = named = None
    for line in open(log):  # a line begins with the name that its thread was born with: look for who was renamed
        named = re.search(r'/proc/self/task/(\d+)/comm"', line) or named
        if named and '"hapticd-servo"' in line:
            servo = named[1]
            break
    calls = re.findall(rf"^{servo}<.*?> \d+\.\d+ (\w+\((?:CLOCK_THREAD_CPUTIME_ID)?)", open(log).read(), re.M)
    calls = [call.rstrip("(") for call in calls]
    warm = calls.index("prctl") if "prctl" in calls else len(calls)
    asked = [i for i, name in enumerate(calls) if name == "getrusage" and i > warm]
    if len(asked) < 2:
        return ["no window found: " + " ".join(calls)]
    # a step over its budget, which a busy machine makes of any, asks whether it was preempted, and the ticks after it ask for
    # the processor time that steps take: that tick was late anyway, and who is slow must be told from who was held up
    return [name for name in calls[asked[0] + 1:asked[-1]] if name not in ("getrusage", "clock_gettime(CLOCK_THREAD_CPUTIME_ID")]


def watched(scene, environment):
    """What one run was seen to do."""
    with tempfile.TemporaryDirectory() as folder:
        file = {name: os.path.join(folder, name) for name in ("report", "witness", "strace")}
        command = [HAPTICD, "run", scene, "--for", str(SECONDS), "--report", file["report"], "--name", "x"]
        if strace:
            command = [strace, "-f", "--seccomp-bpf", "--decode-pids=comm", "-ttt", "-o", file["strace"], "-e",
                       "trace=!clock_nanosleep", "-E", "LD_PRELOAD=" + WITNESS, *command]
        else:
            environment = dict(environment, LD_PRELOAD=WITNESS)
        done = subprocess.run(command, env=dict(environment, WITNESS=file["witness"], RUNTIME_DIRECTORY=folder,
                                                STATE_DIRECTORY=folder), capture_output=True, text=True, timeout=120)
        if not os.path.exists(file["witness"]) or not os.path.exists(file["report"]):
            return {"error": (done.returncode, done.stderr[-500:])}
        report, witness = json.load(open(file["report"])), json.load(open(file["witness"]))
        return {"error": None, "allocations": report["servo_allocations"], "page_faults": report["page_faults"],
                "locks": witness["locks"], "sleeps": witness["sleeps"],
                "calls": systemCalls(file["strace"]) if strace else []}


def wakeUps(folder):
    """The one call that the servo may make: it wakes who waits for its ticks, and only while somebody waits."""
    log = os.path.join(folder, "strace")
    environment = dict(os.environ, RUNTIME_DIRECTORY=folder, STATE_DIRECTORY=folder, WITNESS=os.path.join(folder, "witness"))
    daemon = subprocess.Popen([strace, "-f", "--seccomp-bpf", "--decode-pids=comm", "-ttt", "-o", log, "-e", "trace=!clock_nanosleep",
                               "-E", "LD_PRELOAD=" + WITNESS, HAPTICD, "run", os.path.join(SOURCE, "config", "scenes", "sphere.yaml"),
                               "--for", str(2 * SECONDS), "--name", "bell"], env=environment, stdout=subprocess.DEVNULL,
                              stderr=subprocess.DEVNULL)
    for _ in range(600):
        if os.path.exists(os.path.join(folder, "bell.sock")):
            break
        time.sleep(0.05)
    heard = 0
    with hapticd.connect("bell", folder=folder) as client:
        while daemon.poll() is None and client.streams["ticks"].written < 1000 * SECONDS:  # the warm-up is over
            time.sleep(0.05)
        while daemon.poll() is None and heard < 200:
            heard += client.wait(client.streams["ticks"].written, timeout=1)
    daemon.wait(timeout=60)
    return heard, systemCalls(log)


def quiet(scene):
    seen = watched(scene, os.environ)
    name = os.path.basename(scene)
    return name, seen


def planted(folder):
    """A shape that misbehaves must be seen, or the checks above mean nothing."""
    os.makedirs(os.path.join(folder, "plugins"))
    shutil.copy(SHAPES, os.path.join(folder, "plugins"))
    environment = dict(os.environ, HAPTICD_PLUGIN_PATH=os.path.join(folder, "plugins"))
    found = {}
    for name, plugin, parameters in (("allocation", "allocating", "{}"), ("lock", "rude", "{how: lock}"),
                                     ("call", "rude", "{how: ask}"), ("fault", "rude", "{how: fault}")):
        scene = os.path.join(folder, name + ".yaml")
        open(scene, "w").write(f"hapticd: 1\nmodels:\n  - {{name: it, plugin: {plugin}, parameters: {parameters}}}\n")
        found[name] = watched(scene, environment)
    check("a planted allocation is seen", found["allocation"].get("allocations", 0) > 0, found["allocation"])
    check("a planted lock is seen", found["lock"].get("locks", 0) > 0, found["lock"])
    check("a planted page fault is seen", found["fault"].get("page_faults", 0) > 0, found["fault"])
    if strace:
        check("a planted system call is seen", "getppid" in found["call"].get("calls", []), found["call"])


def onSimulatedArm(scene):
    named = re.search(r"^device: *(\S+)", open(scene).read(), re.M)
    return named is None or "module: simulated" in open(os.path.join(os.path.dirname(scene), named[1])).read()


scenes = sorted(glob.glob(os.path.join(SOURCE, "config", "scenes", "*.yaml")))
scenes = [scene for scene in scenes if onSimulatedArm(scene)]
check("there are scenes", len(scenes) > 5, scenes)
with concurrent.futures.ThreadPoolExecutor(2) as pool:
    for scene, seen in pool.map(quiet, scenes):
        good = seen["error"] is None and seen["sleeps"] > 100 and seen["allocations"] == 0 and seen["locks"] == 0
        good = good and (seen["page_faults"] == 0 or not can_lock) and not seen["calls"]
        check(f"{scene}: no allocation, lock, page fault or system call in {seen.get('sleeps')} ticks", good, seen)
if strace:
    with tempfile.TemporaryDirectory(dir="/dev/shm") as scratch:
        heard, calls = wakeUps(scratch)
        check("who waits for ticks is woken by FUTEX_WAKE, and the servo makes no other call",
              heard >= 200 and len(calls) > 20 and set(calls) == {"futex"}, (heard, set(calls), len(calls)))
else:
    print("skipped: system calls, strace is missing")
with tempfile.TemporaryDirectory() as scratch:
    planted(scratch)
finish()
