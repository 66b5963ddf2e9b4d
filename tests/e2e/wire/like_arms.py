#!/usr/bin/env python3
"""Two arms of one kind in a scene: check says when nothing tells which is whose.

Usage: like_arms.py HAPTICD SOURCE_DIR       exit 1 when one is off
"""
import os
import sys
import tempfile

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "support"))
from e2e import check, finish, program

run = program(sys.argv[1], together=True)
ARM = open(os.path.join(sys.argv[2], "config/devices/woodenhaptics.yaml")).read()

with tempfile.TemporaryDirectory() as folder:
    def put(name, text):
        with open(os.path.join(folder, name), "w") as file:
            file.write(text)

    def told(left, right):
        """What check says of a scene whose arms have these keys `usb`."""
        for name, usb in (("left", left), ("right", right)):
            put(name + ".yaml", ARM.replace('usb: {id: "1234:0006"}', f"usb: {{{usb}}}"))
        put("scene.yaml", "hapticd: 1\nmodels: []\ndevices:\n  - {file: left.yaml, name: left}\n  - {file: right.yaml, name: right}\n")
        return run("check", os.path.join(folder, "scene.yaml"))[1]

    WORDS = "the same USB device may be left or right"
    known = 'id: "1234:0006", serial: A1'
    check("two of one id are told", WORDS in told('id: "1234:0006"', 'id: "1234:0006"'), told('id: "1234:0006"', 'id: "1234:0006"'))
    check("with its line", "right.yaml:11:13: parameters.usb.serial" in told('id: "1234:0006"', 'id: "1234:0006"'), told('id: "1234:0006"', 'id: "1234:0006"'))
    check("capitals do not matter", WORDS in told('id: "12ab:0006"', 'id: "12AB:0006"'))
    check("one serial number does not tell the other arm", WORDS in told(known, 'id: "1234:0006"'))
    check("the same one twice is no two arms", WORDS in told(known, known))
    check("two serial numbers do", WORDS not in told(known, 'id: "1234:0006", serial: B2'))
    check("or two ports", WORDS not in told('id: "1234:0006", port: 1-2', 'id: "1234:0006", port: 1-2.1'))
    check("a port is bus and ports", 'usb.port: "2", expected bus and ports such as "1-2.3"' in told('id: "1234:0006", port: "2"', known))
    for port in ("0-0", "01-2", "1-02", "1-2.3.4.5.6.7.8.9", "1-2.", "9999-1"):
        check(f"no port is {port}", f'usb.port: "{port}", expected bus and ports' in told(f'id: "1234:0006", port: "{port}"', known))
    check("the deepest one is", "expected bus" not in told('id: "1234:0006", port: 1-2.3.4.5.6.7.8', known))
    check("an id is written as it is listed", 'usb.id: "4d8:3f", expected vendor:product such as "1234:0006", of four digits each' in told('id: "4d8:3f"', known))
    mixed = told(known, 'id: "1234:0006", port: 1-2')
    check("a serial number and a port may be one arm, and the advice tells two apart", "both with usb.serial or, if one has no serial number, both with usb.port" in mixed, mixed)
    check("and so do two ids", WORDS not in told('id: "1234:0006"', 'id: "1234:0007"'))
    check("or two interfaces", WORDS not in told('id: "1234:0006", interface: 0', 'id: "1234:0006", interface: 1'))
finish()
