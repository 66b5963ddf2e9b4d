#!/usr/bin/env python3
"""conio.h beside the headers of the HDAPI: a program sees each key at once, and leaves the terminal as it was.

Usage: keys_of_a_terminal.py SOURCE KEYS     KEYS: the built hd_keys; exit 1 when one is off
"""
import os
import pty
import subprocess
import sys
import termios

SOURCE, KEYS = sys.argv[1:3]
sys.path.insert(0, os.path.join(SOURCE, "tests", "support"))
from e2e import check, finish

ours, theirs = pty.openpty()
before = termios.tcgetattr(theirs)
program = subprocess.Popen([KEYS], stdin=theirs, stdout=subprocess.PIPE, text=True)
check("no key is there at first", program.stdout.readline() == "none\n" and program.stdout.readline() == "ready\n")
for key in "aq":
    os.write(ours, key.encode())
    check(f"the key {key} comes without Enter", program.stdout.readline() == f"key {ord(key)}\n")
check("and ends the program", program.wait(timeout=60) == 0)
check("the terminal is as it was", termios.tcgetattr(theirs) == before)

for name, source in (("an empty file", subprocess.DEVNULL), ("the end of a pipe", subprocess.PIPE)):
    ended = subprocess.Popen([KEYS], stdin=source, stdout=subprocess.PIPE, text=True)
    told = ended.communicate(timeout=60)[0]
    check(f"{name} has no key, and is an end", told == "none\nready\nkey -1\n" and ended.returncode == 0, told)
finish()
