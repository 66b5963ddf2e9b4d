#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Every program ends a wrong command line with 2 and says what is wrong; its help ends with 0.

Usage: usage.py PROGRAM...
"""
import os
import subprocess
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "support"))
from e2e import check, finish, program

for path in sys.argv[1:]:
    name, run = os.path.basename(path), program(path)
    code, out, err = run("--help")
    check(f"{name} --help ends with 0 and shows its options", code == 0 and "--help" in out and not err, f"{code} {out} {err}")
    code, out, err = run("--no-such-option")
    check(f"{name} ends a wrong option with 2", code == 2 and not out, f"{code} {out}")
    check(f"{name} says how to go on", err.startswith("error: ") and "--no-such-option" in err and f"{name}" in err and "--help" in err, err)
with open("/dev/full", "w") as full:
    done = subprocess.run([sys.argv[1], "check", "--schema", "scene"], stdout=full, stderr=subprocess.PIPE, text=True, timeout=60)
check("what does not fit on the disk is an error", done.returncode == 1 and "standard output cannot be written" in done.stderr, done)
finish()
