#!/usr/bin/env python3
"""An arm that is not plugged in: doctor says so, and what else its file lacks; info tells of the switch that must be held.

Usage: absent_arm.py HAPTICD       exit 1 when one is off
"""
import os
import re
import sys
import tempfile

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "support"))
from e2e import check, finish, program

COUNTER = "        - {is: counter, at: 0, type: u16}"
run = program(sys.argv[1], together=True)

with tempfile.TemporaryDirectory() as folder:
    arm = os.path.join(folder, "own.yaml")

    def put(text):
        open(arm, "w").write(text)

    code, told = run("device", "new", "own", "-o", arm, "--id", "1209:FA0A", "--no-questions")
    text = open(arm).read().replace("# watchdog: 0.02", "watchdog: 0.02")
    check("there is a counter to be taken away", code == 0 and text.count(COUNTER) == 1, told)
    put(text)
    code, told = run("doctor", arm, "--seconds", "0")
    check("doctor says that an arm is not there", re.search(r"warn\S* +own +cannot be opened: \S", told) and told.count("cannot be opened") == 1, told)
    check("and does not fail for it", "fail" not in "".join(line for line in told.splitlines() if " own " in line), told)
    check("and that no rule lets a user open it", "no installed udev rule names its id 1209:" in told and f"/udev/generate-rules {os.path.abspath(arm)}" in told, told)
    check("and nothing of a counter that it has", "no counter" not in told, told)
    put(text.replace(COUNTER, "        - {is: constant, at: 0, type: u16, value: 0}"))
    code, told = run("doctor", arm, "--seconds", "0")
    check("but that old reports pass without one", "its reports have no counter and no time" in told, told)
    put(text.replace(COUNTER, "        - {is: time, at: 0, type: u16, scale: 1.0e-5}"))
    code, told = run("doctor", arm, "--seconds", "0")
    check("a clock is as good", "no counter" not in told, told)
    code, told = run("device", "controls", arm)
    check("as controls say", re.search(r"on +a repeated report is noticed.*by the arm's clock", told), told)

    for words, target, content in (("its own device file", arm, open(arm).read()), ("a scene", os.path.join(folder, "scene.yaml"), "hapticd: 1\nmodels: []\n")):
        with open(target, "w") as file:
            file.write(content)
        code, told = run("device", "record", arm, "-o", target)
        check(f"record writes over {words} in no case", code == 2 and target in told and open(target).read() == content, told)
        given = os.path.join(folder, "given")
        with open(given, "w") as file:
            file.write("00\n")
        code, told = run("device", "decode", arm, given, "-o", target)
        check(f"nor does decode over {words}", code == 2 and target in told and open(target).read() == content, told)
    content = open(arm).read()
    code, told = run("device", "encode", arm, given, "-o", arm)
    check("nor encode over its device file", code == 2 and "the device file" in told and open(arm).read() == content, told)

    code, told = run("device", "info", arm)
    check("info says that no switch must be held", "enable     none" in told, told)
    put(re.sub(r"(?m)^limits:.*$", "limits: {force: 2, enable: {button: 0}}", text))
    code, told = run("device", "info", arm)
    check("or which one", re.search(r"enable     while .*button", told), told)
finish()
