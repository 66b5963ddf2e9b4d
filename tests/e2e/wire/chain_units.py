#!/usr/bin/env python3
"""A chain in millimetres and degrees, limits the wrong way round, a watchdog in milliseconds: each is told where it stands, in the unit of its column, with the number that was meant.

Usage: chain_units.py HAPTICD       exit 1 when one is off
"""
import os
import sys
import tempfile

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "support"))
from e2e import check, finish, program

hapticd = program(sys.argv[1], together=True)
ARM = """hapticd-device: 1
module: usb_hid
limits: {force: 3}
parameters:
  usb: {id: "16c0:0499"}
  arm:
    kind: chain
    dh:
      - [FIRST, 0.11, 0]
      - [0.23, 0, 0, 0.3]
    limits: [LIMITS, [-0.4, 1.6]]
    max_torque: [0.8, 0.7]
  wire:
    rate: 1000
    watchdog: WATCHDOG
    input:
      size: 4
      fields:
        - {is: position, joint: 1, at: 0, type: i16, scale: 6.0e-05}
        - {is: position, joint: 2, at: 2, type: i16, scale: 6.0e-05}
    output:
      size: 4
      fields:
        - {is: torque, joint: 1, at: 0, type: i16, scale: 4.0e-5}
        - {is: torque, joint: 2, at: 2, type: i16, scale: 4.0e-5}
"""
GOOD = {"FIRST": "0.05, 1.57", "LIMITS": "[-1.6, 1.6]", "WATCHDOG": "0.02"}


def told(**changed):
    text = ARM
    for word, value in {**GOOD, **changed}.items():
        text = text.replace(word, value)
    path = os.path.join(tempfile.mkdtemp(), "arm.yaml")
    with open(path, "w") as file:
        file.write(text)
    return hapticd("check", path)


code, text = told()
check("the arm is in order", code == 0, text)
code, text = told(LIMITS="[1.6, -0.4]")
check("limits the wrong way round are told at their row", code == 2 and "arm.yaml:11:14: parameters.arm.limits[0]: [1.6, -0.4], expected the smaller number first" in text, text)
code, text = told(FIRST="50, 1.57")
check("millimetres", code == 2 and "dh[0][0]: 50 m is out of range, expected -10 to 10 m; 50 mm is 0.05 m" in text, text)
code, text = told(FIRST="0.05, 90")
check("degrees", code == 2 and "dh[0][1]: 90 rad is out of range, expected -10 to 10 rad; 90 degrees is 1.57" in text, text)
code, text = told(WATCHDOG="20")
check("milliseconds", code == 2 and "expected a number from 0 to 10 s (20 ms is 0.02 s)" in text, text)
finish()
