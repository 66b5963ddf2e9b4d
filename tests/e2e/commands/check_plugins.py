#!/usr/bin/env python3
"""`hapticd plugin check`: every plugin that ships passes, and broken ones fail by the test that names what is wrong.

Usage: check_plugins.py HAPTICD SOURCE_DIR SHIPPED_FOLDER BROKEN_FOLDER TEST_SHAPES.so     exit 1 when one is off
"""
import glob
import json
import os
import subprocess
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "support"))
from e2e import check, finish

HAPTICD, SOURCE, SHIPPED, BROKEN, SHAPES = sys.argv[1:6]


def examined(file, *more):
    done = subprocess.run([HAPTICD, "plugin", "check", file, "--json", *more], capture_output=True, text=True, timeout=280)
    try:
        tests = json.loads(done.stdout)["tests"]
    except ValueError:
        tests = []
    failed = {(t["plugin"], t["name"]) for t in tests if t["result"] == "fail"}
    return done.returncode, tests, failed, done.stderr


shipped = sorted(glob.glob(os.path.join(SHIPPED, "*.so")))
check("plugins ship", len(shipped) >= 4, shipped)
for file in shipped:
    code, tests, failed, err = examined(file)
    check(f"{os.path.basename(file)} passes", len(tests) >= 25 and not failed, (code, failed, err[-300:]))

for name, test in (("bad_crash", "descriptor-complete"), ("bad_no_symbol", "descriptor-complete"),
                   ("bad_magic", "descriptor-complete"), ("bad_no_step", "descriptor-complete")):
    code, tests, failed, err = examined(os.path.join(BROKEN, name + ".so"))
    check(f"{name} fails by {test}", code == 1 and any(t == test for _, t in failed), (code, failed, err[-300:]))

code, tests, failed, err = examined(SHAPES)
for shape, test in (("allocating", "no-allocation-in-step"), ("rude", "no-lock-in-step"), ("misbehaving", "finite-outputs"),
                    ("pulling", "force-outward")):
    check(f"{shape} fails by {test}", code == 1 and (shape, test) in failed, (code, sorted(failed), err[-300:]))
finish()
