#!/usr/bin/env python3
"""An engineer errs once in the device file, or captured in the wrong moment: decode names the cause, and encode makes of its table the same bytes again.

Usage: decode_findings.py HAPTICD       exit 1 when one is off
"""
import math
import os
import sys
import tempfile

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "support"))
from e2e import check, finish
from wire import TORQUES, fed, modbus, own_arm, table_of

HAPTICD = sys.argv[1]
SCALE = 4.0e-5

HID = own_arm("""    input:
      id: 1
      size: 12
      fields:
        - {is: counter, at: 0, type: u16}
        - {is: position, joint: 1, at: 2, type: i16, scale: 4.0e-5, wraps: true}
        - {is: position, joint: 2, at: 4, type: i16, scale: 4.0e-5}
        - {is: position, joint: 3, at: 6, type: i16, scale: 4.0e-5}
        - {is: fault, at: 8, type: u1}
        - {is: calibrated, at: 8, bit_offset: 1, type: u1}
        - {is: starts, at: 9, type: u8}
        - {is: checksum, at: 10, type: u16, method: crc16-modbus, from: 0, to: 10}
""" + TORQUES)
SERIAL = own_arm("""    framing: {start: 0x7e, end: 0x7e, escape: {mark: 0x7d, xor: 0x20}}
    input:
      size: 10
      fields:
        - {is: counter, at: 1, type: u8}
        - {is: position, joint: 1, at: 2, type: i16, scale: 4.0e-5}
        - {is: position, joint: 2, at: 4, type: i16, scale: 4.0e-5}
        - {is: position, joint: 3, at: 6, type: i16, scale: 4.0e-5}
        - {is: checksum, at: 8, type: u8, method: sum, from: 1, to: 8}
    output:
      size: 8
      fields:
        - {is: torque, joint: 1, at: 1, type: i16, scale: 2.0e-5}
        - {is: torque, joint: 2, at: 3, type: i16, scale: 2.0e-5}
        - {is: torque, joint: 3, at: 5, type: i16, scale: 2.0e-5}
""", module="usb_bulk")
COUNT = 400


def joint(value):
    return (round(value / SCALE) % 65536).to_bytes(2, "little")


def angles(i):
    """The first one goes round: 1.31072 rad is the last number of its type."""
    return 1.2 + 0.2 * math.sin(i / 40), 0.6 + 0.3 * math.sin(i / 50), 0.5 * math.cos(i / 45)


def hid(i, flags=2, starts=7, order="little"):
    body = (i + 1000).to_bytes(2, order) + b"".join(joint(q) for q in angles(i)) + bytes([flags, starts])
    return body + modbus(body)


def serial(i, total=lambda data: sum(data) & 255, mark=0x7E, escape=0x7D, flip=0x20):
    body = bytes([i & 255]) + b"".join(joint(q) for q in (0.1, *angles(i)[1:]))
    body += bytes([total(body)])
    return bytes([mark]) + b"".join(bytes([escape, b ^ flip]) if b in (mark, escape) else bytes([b]) for b in body) + bytes([mark])


def text(reports, period=0.001, head=b"\x01"):
    return "\n".join("E: %012.6f %d %s" % (i * period, len(head + r), (head + r).hex(" ")) for i, r in enumerate(reports)).encode() + b"\n"


run = fed(HAPTICD, "device")


with tempfile.TemporaryDirectory() as folder:
    arm = os.path.join(folder, "arm.yaml")

    def told(capture, description=HID, change=None):
        if change:
            assert change[0] in description, change[0]
            description = description.replace(*change)
        open(arm, "w").write(description)
        code, out, err = run("decode", arm, given=capture)
        return code, err, table_of(out)

    good = [hid(i) for i in range(COUNT)]
    capture = text(good)
    code, err, rows = told(capture)
    check("what is right is not remarked on", code == 0 and err.count("\n") == 1 and f"{COUNT} good" in err, err)
    check("turns of a position that wraps are counted", max(abs(float(r["position1"]) - angles(i)[0]) for i, r in enumerate(rows)) < SCALE and
          max(angles(i)[0] for i in range(COUNT)) > 1.35, rows[:2])

    # The table of decode is one for encode.
    table = run("decode", arm, given=capture)[1]
    code, out, err = run("encode", "--from-arm", arm, given=table)
    check("encode takes the table of decode, and makes the same bytes", code == 0 and err == "" and
          [bytes.fromhex(line) for line in out.decode().splitlines()] == [b"\x01" + r for r in good], err)
    broken = [r[:4] + bytes([r[4] ^ 1]) + r[5:] if i in (3, 5) else r for i, r in enumerate(good)]
    table = run("decode", arm, given=text(broken))[1]
    code, out, err = run("encode", "--from-arm", arm, given=table)
    check("without the rows that are no good report", code == 0 and "left out: 2" in err and len(out.splitlines()) == COUNT - 2, err)
    code, out, err = run("encode", "--from-arm", arm, given=b"position1,position2,position3\n2.0,0.1,9\n-2.0,9,0\n0,0.1,8\n")
    check("what does not fit is told once a column, with a count", code == 0 and err.count("warning") == 2 and
          "line 2: position3: 9 is beyond" in err and "so is 1 further row" in err and "line 3: position2" in err, err)
    check("and a position that wraps does so", bytes.fromhex(out.decode().splitlines()[0])[3:5] == joint(2.0), out)

    # The layout.
    code, err, _ = told(text([r + bytes(51) for r in good]))
    check("reports that are filled up are told", code == 1 and "every report has 64 bytes" in err and "give wire.input size: 63 (it is 12)" in err, err)
    code, err, _ = told(text([r + bytes(51) for r in good]), change=("size: 12", "size: 63"))
    check("and with that size they are good", code == 0, err)
    code, err, _ = told(text(good, head=b""))
    check("lines without the report id are told", code == 1 and "if they were captured without the report id, put 0x01 in front" in err, err)
    code, err, _ = told(text(good[30:230], head=b""))  # none of these begins with a 1
    check("and the bytes are those of the reports", f"no report in {12 * 200} bytes" in err and "put 0x01 in front" in err, err)

    # What no arm means.
    code, err, _ = told(text(good, period=0.01))
    check("another rate is told", "a rate of 100 Hz, and wire.rate is 1000: at so low a rate (health.least_rate) no torque goes out; give rate: 100" in err, err)
    code, err, _ = told(text(good, period=1.0))
    check("a rate that no arm has is not proposed", "a rate of 1 Hz" in err and "give rate" not in err and "a rate must be 50 to 20000 Hz" in err, err)
    code, err, _ = told(text(good, period=0.001), change=("rate: 1000", "rate: 300"))
    check("a rate is told in full", "a rate of 1000 Hz" in err and "give rate: 1000" in err, err)
    code, err, _ = told(capture, change=("rate: 1000", "rate: 950"))
    check("but not one that is nearly right", code == 0 and err.count("\n") == 1, err)
    code, err, _ = told(text([hid(i, flags=3) for i in range(COUNT)]))
    check("a fault in every report is told", f"fault is set in all {COUNT} reports" in err and "inverted: true" in err, err)
    code, err, _ = told(text([hid(i, flags=0) for i in range(COUNT)]))
    check("and an arm that is never calibrated", f"calibrated is 0 in all {COUNT} reports" in err, err)
    code, err, _ = told(text([hid(i, starts=i & 255) for i in range(COUNT)]))
    check("a start with each report is a counter or a clock", "the field starts has another number in 399 of 400 reports" in err, err)
    code, err, _ = told(text([hid(i, order="big") for i in range(COUNT)]))
    check("a counter in the other byte order is told", "the counter counts with endian: big" in err, err)

    # The motion that is decoded is not one of an arm.
    for order, wraps in (("the first", ", wraps: true"), ("another", "")):
        joint_ = 1 if wraps else 2
        right = f"joint: {joint_}, at: {2 * joint_}, type: i16, scale: 4.0e-5{wraps}"
        code, err, _ = told(capture, change=(right, right + ", endian: big"))
        check(f"the wrong byte order of {order} position is told", f"joint {joint_}: moves far more smoothly" in err and "give endian: little" in err, err)
    code, err, _ = told(capture, HID.replace("scale: 4.0e-5", "scale: 4.0e-7"))
    check("and a scale a hundred times too small", code == 0 and "no joint moved by more than" in err and "scale is far too small" in err, err)
    limited = HID.replace("max_torque: [0.5]}", "max_torque: [0.5], limits: [[0, 1.5], [0, 1], [-0.6, 0.6]]}")
    code, err, _ = told(capture, limited)
    check("but not the right one, with limits", code == 0 and err.count("\n") == 1, err)
    code, err, _ = told(capture, limited.replace("scale: 4.0e-5", "scale: 4.0e-7"))
    check("a scale a hundred times too small is told with limits too", "% of the distance between their arm.limits" in err and "times too small" in err, err)
    still = text([hid(0)] * COUNT)
    code, err, _ = told(still)
    check("an arm at rest is not remarked on", "joint" not in err, err)

    # Numbers that a report cannot carry would be sent as others.
    names = b"position1,sequence,fault,calibrated,starts\n"
    code, out, err = run("encode", "--from-arm", arm, given=names + b"0.1,65536,2,1,256\n0.1,-1,0,0.5,1\n0.1,70000,3,1,1.5\n")
    check("a counter, a flag and a count of starts beyond their fields are refused", code == 2 and out == b"" and err.count("\n") == 4 and
          "-:2:1: sequence: 65536, expected a whole number from 0 to 65535" in err and "-:2:1: fault: 2, expected 0 (no) or 1 (yes)" in err and
          "-:3:1: calibrated: 0.5" in err and "-:2:1: starts: 256, expected a whole number from 0 to 255" in err, err)
    code, out, err = run("encode", "--from-arm", arm, given=names + b"0.1,65535,1,1,255\n")
    check("and what fits is sent", code == 0 and err == "" and len(out.splitlines()) == 1, err)
    open(arm, "w").write(HID.replace("{is: fault, at: 8, type: u1}", "{is: button, button: 2, at: 8, type: u1}"))
    code, out, err = run("encode", "--from-arm", arm, given=b"position1,buttons\n0.1,1\n")
    check("buttons that the report lacks are refused", code == 2 and "-:2:1: buttons: 1, expected 0 or a sum of these numbers: 2 for button 2" in err, err)
    open(arm, "w").write(HID)

    # A stream.
    stream = b"".join(serial(i) for i in range(COUNT))
    code, err, _ = told(stream, SERIAL)
    check("a framed stream is right", code == 0 and f"{COUNT} good" in err and err.count("\n") == 1, err)
    code, err, _ = told(stream[3:], SERIAL)
    check("one that begins within a report is good", code == 0 and f"{COUNT - 1} good; the capture begins with the last" in err, err)
    code, err, _ = told(b"".join(serial(i, total=lambda d: -sum(d) & 255) for i in range(COUNT)), SERIAL)
    check("a negated sum is told", code == 1 and "right with method: sum, negated: true" in err, err)
    code, err, _ = told(b"".join(serial(i, total=lambda d: ~sum(d) & 255) for i in range(COUNT)), SERIAL)
    check("and the complement of one", code == 1 and "method: sum, final_xor: 0xff" in err, err)
    for name, made, words in (("another mark", {"mark": 0xC0}, "framing.start and end: 0xc0"), ("another flip", {"flip": 0x55}, "framing.escape: {mark: 0x7d, xor: 0x55}"),
                              ("another escape", {"escape": 0x1B}, "framing.escape: {mark: 0x1b, xor: 0x20}")):
        code, err, _ = told(b"".join(serial(i, **made) for i in range(COUNT)), SERIAL)
        check(f"{name} is told", code == 1 and "reports are good with " + words + "\n" in err, err)
        check("and blamed on the framing alone", "no method that is known" not in err, err)
    code, err, _ = told(stream, SERIAL, change=(", escape: {mark: 0x7d, xor: 0x20}", ""))
    check("a missing escape is told too", code == 1 and "good with framing.escape: {mark: 0x7d, xor: 0x20}\n" in err, err)
    noisy = bytearray(stream)
    for at in range(500, len(noisy), 997):
        noisy[at] ^= 0x01
    code, err, _ = told(bytes(noisy), SERIAL)
    check("but noise on the wire is not blamed on the file", code == 1 and "good with" not in err and "corrupt" in err, err)
finish()
