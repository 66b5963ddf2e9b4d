#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""An engineer captures an arm with another program: decode reads what usbmon and Wireshark write, and tells a byte that a program has put in front.

Usage: other_programs.py HAPTICD       exit 1 when one is off
"""
import math
import os
import sys
import tempfile

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "support"))
from e2e import check, finish
from wire import TORQUES, fed, own_arm, table_of

ARM = own_arm("""    input:
      size: 13
      fields:
        - {is: position, joint: 1, at: 0, type: i32, scale: 3.0e-4}
        - {is: position, joint: 2, at: 4, type: i32, scale: 3.0e-4}
        - {is: position, joint: 3, at: 8, type: i32, scale: 3.0e-4}
        - {is: button, button: 1, at: 12, type: u1}
""" + TORQUES)
SCALE = 3.0e-4
COUNT = 200
REPORTS = [b"".join(round(a / SCALE).to_bytes(4, "little", signed=True) for a in
                    (math.sin(i / 40), 0.6 + 0.3 * math.sin(i / 50), 0.5 * math.cos(i / 45))) + b"\0" for i in range(COUNT)]

run = fed(sys.argv[1], "device")


def lines(reports):
    return "".join(report.hex(" ") + "\n" for report in reports).encode()


def dump(report, column=True):
    """Wireshark's copy as a hex dump: offset, bytes and characters."""
    rows = [report[at:at + 16] for at in range(0, len(report), 16)]
    return "".join("%04x   %-47s%s\n" % (16 * i, row.hex(" "), "   ab..12" if column else "") for i, row in enumerate(rows))


with tempfile.TemporaryDirectory() as folder:
    arm = os.path.join(folder, "arm.yaml")

    def told(capture, size=13):
        open(arm, "w").write(ARM.replace("size: 13", f"size: {size}"))
        code, out, err = run("decode", arm, given=capture if isinstance(capture, bytes) else capture.encode())
        return code, err, table_of(out)

    plain = told(lines(REPORTS))[2]
    check("the capture is right", len(plain) == COUNT and all(row["verdict"] == "good" for row in plain), plain[:1])

    # A byte in front.
    remove = "some programs put 00 in front of reports without an id; if yours did, remove it from each line of the capture"
    for size, reports, given, advice in ((13, REPORTS, 13, "leave wire.input as it is"),
                                         (13, REPORTS, 14, "give wire.input size: 13 (it is 14)"),
                                         (64, [r + bytes(51) for r in REPORTS], 13, "give wire.input size: 64 (it is 13)"),
                                         (64, [r + bytes(51) for r in REPORTS], 65, "give wire.input size: 64 (it is 65)")):
        code, err, _ = told(lines(b"\0" + r for r in reports), given)
        check(f"a 00 in front of {size} bytes is told, where the file says {given}", remove in err and advice in err and "padding" not in err, err)
        check("and no joint is judged by the numbers at wrong places", "is scale in rad" not in err, err)
    code, err, _ = told(lines(b"\1" + r + bytes(50) for r in REPORTS))
    check("a report id in front of padded reports is told", "if it is the report id, give wire.input id: 1 and wire.input size: 63 (it is 13)" in err, err)
    code, err, _ = told(lines(r + bytes(51) for r in REPORTS))
    check("padding alone is still padding", "give wire.input size: 64 (it is 13)" in err and "in front" not in err, err)
    code, err, _ = told(lines([bytes(14)] * COUNT))
    check("reports of zeros may have either", remove in err and "the last bytes are padding, give wire.input size: 14 (it is 13)" in err, err)

    # Lines of other programs.
    same = [row["position1"] for row in plain]
    code, err, rows = told("".join(dump(r) for r in REPORTS))
    check("a hex dump of Wireshark is read", code == 0 and [row["position1"] for row in rows] == same, err)
    code, err, rows = told("".join(dump(r + bytes(51), column=False) for r in REPORTS), 64)
    check("also where a report has several lines", code == 0 and [row["position1"] for row in rows] == same, err)

    def usbmon(i, report, kind="C Ii", most=32):
        kept = report[:most].hex()
        words = " ".join(kept[at:at + 8] for at in range(0, len(kept), 8))
        return f"ffff8881 {1000 * i} {kind}:1:004:1 0:1 {len(report)} = {words}\n"
    text = "".join(usbmon(i, r) + f"ffff8881 {1000 * i + 5} S Io:1:004:2 -115:1 6 = 010203040506\nffff8881 {1000 * i + 9} C Io:1:004:2 0:1 6 >\n"
                   for i, r in enumerate(REPORTS))
    code, err, rows = told(text)
    check("lines of usbmon are read, those from the arm alone", code == 0 and [row["position1"] for row in rows] == same, err)
    check("with their times", [float(row["time"]) for row in rows[:3]] == [0, 0.001, 0.002], rows[:3])
    code, err, _ = told(usbmon(0, REPORTS[0] + bytes(51)), 64)
    check("what usbmon has not kept is told", code == 2 and "line 1: usbmon has kept only 32 of the 64 bytes" in err, (code, err))
    for line, advice in ((repr(REPORTS[0]), 'let it write report.hex(" ")'), (str(list(REPORTS[1])), 'bytes(numbers).hex(" ")'),
                         (",".join(map(str, REPORTS[1])), 'bytes(numbers).hex(" ")')):
        code, err, _ = told(line + "\n")
        check(f"advice for {line[:12]}", code == 2 and advice in err, err)
    # Degrees where rad is expected.
    open(arm, "w").write(ARM)
    for command, given in ((["encode", "--from-arm", arm], b"90,0,0\n"), (["kinematics", arm, "--joints", "-"], b"q1,q2,q3\n0,90,90\n")):
        code, out, err = run(*command, given=given)
        check(f"{command[0]} tells degrees", code == 0 and "90 rad is 14.3 turns; positions must be in rad: 90 degrees is 1.571 rad" in err, err)
        code, out, err = run(*command, given=given.replace(b"90", b"1.57"))
        check(f"{command[0]} says nothing of rad", code == 0 and err == "", err)
finish()
