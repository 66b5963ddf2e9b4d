#!/usr/bin/env python3
"""A running daemon is changed in every way that ctl knows: the servo thread faults no page, allocates and locks nothing,
and a plugin that crashes while it is looked at is an answer and not an end.

Usage: quiet_changes.py HAPTICD SOURCE_DIR CRASHING.so WITNESS.so     prints one line per check; exit 1 when one fails.
"""
import json
import os
import shutil
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "support"))
from e2e import can_lock_memory, check, finish, program, until

HAPTICD, SOURCE, CRASHING, WITNESS = (os.path.abspath(argument) for argument in sys.argv[1:5])
SCENES = os.path.join(SOURCE, "config", "scenes")
can_lock = can_lock_memory()
WARM = 1  # s: the first 200 ticks are not counted


def sceneOf(folder, plugin):
    file = os.path.join(folder, plugin + ".yaml")
    open(file, "w").write(f"hapticd: 1\nmodels:\n  - {{name: {plugin}, plugin: {plugin}}}\n")
    return file


def changes(ctl, folder):
    """Plugins that the daemon has never seen, one that it has, one that crashes, and everything else."""
    for scene in ("button", "pendulum", "sphere"):
        code, _, told = ctl("add", os.path.join(SCENES, scene + ".yaml"))
        check(f"a {scene} is added", code == 0, told)
    code, _, told = ctl("add", sceneOf(folder, "crash"))
    check("a plugin that crashes while it is loaded is an answer that says so",
          code == 2 and "crashed: Segmentation fault" in told and "crash.so" in told, (code, told))
    code, _, told = ctl("add", sceneOf(folder, "nobody"))
    check("one that does not exist too", code == 2 and 'usable shape plugin "nobody"' in told, (code, told))
    for command in (["set", "teapot", "stiffness", "600", "--consent"], ["disable", "teapot"], ["enable", "teapot"], ["remove", "pendulum"], ["remove", "button"],
                    ["reload"], ["add", os.path.join(SCENES, "button.yaml")], ["hold"], ["clear"], ["dump"], ["reload", os.path.join(SCENES, "torus.yaml")], ["status"], ["list"]):
        code, _, told = ctl(*command)
        check(" ".join(os.path.basename(word) for word in command), code == 0, told)


with tempfile.TemporaryDirectory() as scratch:
    os.makedirs(os.path.join(scratch, "plugins"))
    shutil.copy(CRASHING, os.path.join(scratch, "plugins"))
    environment = dict(os.environ, RUNTIME_DIRECTORY=scratch, STATE_DIRECTORY=scratch,
                       HAPTICD_PLUGIN_PATH=os.path.join(scratch, "plugins"))
    report, witness = (os.path.join(scratch, name) for name in ("report.json", "witness.json"))
    ask = program(HAPTICD, environment)
    ctl = lambda *arguments: ask("ctl", "--name", "x", *arguments)
    run = subprocess.Popen([HAPTICD, "run", os.path.join(SCENES, "teapot.yaml"), "--for", "120", "--name", "x",
                            "--report", report], env=dict(environment, LD_PRELOAD=WITNESS, WITNESS=witness),
                           stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    try:
        check("the daemon answers", until(lambda: ctl("status")[0] == 0))
        time.sleep(WARM)
        changes(ctl, scratch)
        check("stop", ctl("stop")[0] == 0)
        run.wait(timeout=30)
    finally:
        run.kill()
    seen = json.load(open(report))
    check("the servo thread faulted no page", seen["page_faults"] == 0 or not can_lock, seen["page_faults"])
    check("and allocated nothing", seen["servo_allocations"] == 0, seen["servo_allocations"])
    locks = json.load(open(witness))["locks"]
    check("and locked nothing", locks == 0, locks)
    check("and ticked all the while", seen["ticks"] > 1000, seen["ticks"])
finish()
