#!/usr/bin/env python3
"""A real arm at a low rate pushes less: `run` warns of it, and the status says why and how to have all of the force.

Usage: slow_arm_test.py HAPTICD RIG.so ENDING_SHAPES.so     prints one line per check; exit 1 when one fails.
"""
import json
import os
import sys

here = os.path.dirname(os.path.abspath(__file__))
sys.path[:0] = [here, os.path.join(here, "..", "..", "support"), os.path.join(here, "..", "..", "support", "rig")]
from daemon import Daemon
from e2e import check, finish

HAPTICD, *MODULES = (os.path.abspath(argument) for argument in sys.argv[1:4])

for rate, slow in (("340", True), ("1000", False)):
    run = Daemon(HAPTICD, MODULES, ["{name: pushes, plugin: ending}"], arguments=("--rate", rate))
    check(f"{rate} Hz: a force comes", run.arm.wait_for_force(60))
    code, told = run.ctl("status")
    why = json.loads(told)["devices"][0]["less_force"] if code == 0 else told
    run.process.terminate()
    said = run.end()[1]
    words = "the servo's rate is low: after a fault the motors may keep the last command for 2.94 ms, so the force is limited to 8.09 N instead of 8.5 N"
    check(f"{rate} Hz: the status says why it pushes less, or nothing", why.startswith(words) if slow else why is None, why)
    check(f"{rate} Hz: so does the run", (words in said) == slow, said)
finish()
