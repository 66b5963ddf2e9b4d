#!/usr/bin/env python3
"""The same bits everywhere: a recording names the processor instructions that its shapes used; a replay takes the same where it
can, and says where it cannot.

Usage: instructions.py HAPTICD SOURCE     prints one line per case; exit 1 when one is off.
"""
import json
import os
import sys
import tempfile

import h5py

HAPTICD, SOURCE = sys.argv[1], sys.argv[2]
sys.path.insert(0, os.path.join(SOURCE, "tests", "support"))
from e2e import check, finish, program

with open(os.path.join(SOURCE, "config", "scenes", "teapot.yaml")) as file:
    TEAPOT = file.read().replace("../", os.path.join(SOURCE, "config") + "/")


def run(environment, *arguments):
    return program(HAPTICD, dict(os.environ, **environment), together=True)(*arguments)


def record(folder, instructions, **environment):
    scene, file = os.path.join(folder, instructions + ".yaml"), os.path.join(folder, instructions + "".join(environment) + ".h5")
    with open(scene, "w") as out:
        out.write(TEAPOT.replace("servo: {rate: 1000}", f"servo: {{rate: 1000, instructions: {instructions}}}"))
    code, told = run(environment, "run", scene, "--virtual-time", "--for", "2", "--record", file)
    check(f"recorded with {instructions} {environment}", code == 0, told)
    with h5py.File(file) as recording:
        return file, json.loads(recording["about"][()])["instructions"], recording["ticks"]["arm0_fx"][:].tobytes()


with tempfile.TemporaryDirectory() as folder:
    has_avx2 = all(word in open("/proc/cpuinfo").read().split() for word in ("avx2", "fma"))
    fast, taken, fast_bits = record(folder, "auto")
    check("auto takes the fastest that there is, and says what", taken == ("avx2+fma" if has_avx2 else "portable"), taken)
    portable, taken, bits = record(folder, "portable")
    check("portable says so", taken == "portable", taken)
    _, taken, again = record(folder, "auto", HAPTICD_INSTRUCTIONS="portable")
    check("the environment may ask for it", taken == "portable" and again == bits, taken)
    for file in (fast, portable):
        code, told = run({}, "replay", file)
        check("a replay takes the same: " + os.path.basename(file), code == 0 and "every bit is the same" in told, told)
    code, told = run({"HAPTICD_INSTRUCTIONS": "portable"}, "replay", portable)
    check("a portable recording replays on a lesser machine", code == 0, told)
    if has_avx2:
        check("the two differ in their last bits, or this test tests nothing", bits != fast_bits)
        code, told = run({"HAPTICD_INSTRUCTIONS": "portable"}, "replay", fast)
        check("where it cannot, it says so", code == 1 and "avx2+fma, which are not available here" in told, told)
    code, told = run({}, "check", os.path.join(folder, "auto.yaml"))
    check("check knows the key", code == 0, told)
finish()
