#!/usr/bin/env python3
"""An engineer with an arm of his own errs in the id, the size or the checksum of its reports: decode names each mistake, of raw bytes and of text.

Usage: raw_captures.py HAPTICD       exit 1 when one is off
"""
import csv
import io
import math
import os
import re
import subprocess
import sys
import tempfile

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "support"))
from e2e import check, finish
from wire import TORQUES, own_arm

HAPTICD = sys.argv[1]

SCALE = 2 * math.pi / (4096 * 40)  # counts of a motor turn, motor turns of one joint turn
SUM = "at: 18, type: u16, method: crc16, from: 0, to: 18, over_id: true"
ARM = own_arm("""    input:
      id: 1
      size: 20
      fields:
        - {is: counter, at: 0, type: u8}
        - {is: time, at: 1, type: u16, scale: 1.0e-5}
        - {is: position, joint: 1, at: 4, type: i24, scale: @}
        - {is: position, joint: 2, at: 8, type: i24, scale: @}
        - {is: position, joint: 3, at: 12, type: i24, scale: @}
        - {is: checksum, #}
""".replace("@", f"{SCALE:.9g}").replace("#", SUM) + TORQUES, stops="[[-1.2, 1.2], [-0.8, 0.8], [-1, 1]]")


def crc16(data):
    """CCITT, begun with ones: bit by bit, not by the code that is tested."""
    crc = 0xFFFF
    for byte in data:
        crc ^= byte << 8
        for _ in range(8):
            crc = (crc << 1 ^ 0x1021 if crc & 0x8000 else crc << 1) & 0xFFFF
    return crc


def report(i, over_id):
    body = bytes([i % 256]) + (i * 100 % 65536).to_bytes(2, "little") + b"\0"
    for angle in (1.1 * math.sin(i / 60), 0.7 * math.sin(i / 80 + 1), 0.9 * math.cos(i / 70)):
        body += (round(angle / SCALE) & 0xFFFFFF).to_bytes(3, "little") + b"\0"
    body = body.ljust(18, b"\0")
    return b"\1" + body + crc16((b"\1" if over_id else b"") + body).to_bytes(2, "little")


def text_of(capture):
    return "\n".join(capture[at:at + 21].hex(" ") for at in range(0, len(capture), 21)).encode()


OVER = b"".join(report(i, True) for i in range(600))
PLAIN = b"".join(report(i, False) for i in range(600))


with tempfile.TemporaryDirectory() as folder:
    def decode(capture, changes):
        text = ARM
        for old, new in changes.items():
            assert old in text, old
            text = text.replace(old, new)
        file = os.path.join(folder, "arm.yaml")
        open(file, "w").write(text)
        done = subprocess.run([HAPTICD, "device", "decode", file], input=capture, capture_output=True, text=False, timeout=120)
        return done.returncode, done.stdout.decode(), done.stderr.decode()

    def named(what, capture, changes, *words):
        code, out, err = decode(capture, changes)
        check(f"{what} is named", code == 1 and all(word in err for word in words), (code, err))

    no_id = {"      id: 1\n": "", ", over_id: true": ""}
    plain = {", over_id: true": ""}
    for changes, capture in (({}, OVER), ({}, text_of(OVER)), (plain, PLAIN)):
        code, out, err = decode(capture, changes)
        check("the right file has nothing to be told", code == 0 and "600 reports, 600 good" in err and err.count("\n") == 1, err)
        rows = list(csv.DictReader(io.StringIO(out)))
        check("the arm's own time is in its table", len(rows) == 600 and all(abs(float(row["clock"]) - i * 1e-3 % 0.65536) < 1e-9 for i, row in enumerate(rows)), rows[-1:])

    # Bytes without ids that begin within a report: few reports, broken ones, and lost bytes.
    bare = [report(i, False)[1:] for i in range(40)]
    broken = [bytes([one[0] ^ i % 2]) + one[1:] for i, one in enumerate(bare)]
    lost = b"".join(bare[:20]) + b"".join(bare[20:])[7:]
    named("a capture of two reports that begins in the first", b"".join(bare[:2])[7:], no_id, "from byte 13 on, all reports are good; leave out the first 13 bytes")
    named("a begun capture whose reports are broken by halves", b"".join(broken[:6])[7:], no_id, "from byte 13 on, 2 of 5 reports are good")
    named("lost bytes in a begun capture", lost[7:], no_id, "19 reports are good if the first one begins at byte 6, and 19 others if it begins at byte 13")
    named("lost bytes in a good capture", b"".join(bare[:30]) + b"".join(bare[30:])[7:], no_id, "bytes are missing or too many in the middle of the capture")
    for what, capture in (("only broken reports", b"".join(bytes([one[0] ^ 1]) + one[1:] for one in bare)[7:]), ("zeros", bytes(800)), ("one report broken in good ones", b"".join(broken[:2] + bare[2:]))):
        code, out, err = decode(capture, no_id)
        check(f"{what}: no beginning is made up", code in (0, 1) and "begins in the middle" not in err and "bytes are missing" not in err, err)

    # The checksum: what it covers, where it is, and in which order.
    named("a checksum that covers the report id", OVER, plain, "the checksum of each of them is right with method: crc16, endian: little, over_id: true\n")
    named("one that does not", PLAIN, {}, "is right with method: crc16, endian: little, over_id: false\n")
    named("another order of its bytes", OVER, {"method: crc16": "endian: big, method: crc16"}, "is right with method: crc16, endian: little, over_id: true\n")
    code, out, err = decode(OVER, {"method: crc16": "endian: big, method: crc16"})
    check("though single reports are good by chance", re.search(r"^\d+,[^,]*,good", out, re.M), err)
    named("a range that begins a byte late", PLAIN, {"from: 0, to: 18, over_id: true": "from: 1, to: 18"}, "is right with from: 0\n")
    named("a range that ends a byte early", PLAIN, {"from: 0, to: 18, over_id: true": "from: 0, to: 17"}, "is right with to: 18\n")
    named("a range that ends a byte early, and the wrong method", OVER, {"method: crc16, from: 0, to: 18": "method: crc16-modbus, from: 0, to: 17"},
          "is right with method: crc16, endian: little, to: 18, over_id: true\n")
    named("a place a byte too early", PLAIN, {"at: 18": "at: 17", "to: 18, over_id: true": "to: 17"}, "is right with at: 18, to: 18\n")
    named("a checksum of an unknown method", bytes(b ^ 0x5A if i % 21 == 20 else b for i, b in enumerate(OVER)), {}, "no method that is known by name fits them either")
    code, out, err = decode(OVER[:21 * 300] + bytes(b ^ 0x5A if i % 21 == 20 else b for i, b in enumerate(OVER[21 * 300:])), {})
    check("no reason is looked for where half of them are good", code == 1 and "300 good" in err and "right with" not in err and "no method" not in err, err)

    for change in ({", scale: 1.0e-5": ""}, {"scale: 1.0e-5": "scale: 0"}, {"is: time": "is: clock"}):
        code, out, err = decode(OVER, change)
        check(f"{change} is refused, and names of the other direction are not offered", code == 2 and ("scale" in err or "starts, time" in err) and "enable, calibrate" not in err, err)
    done = subprocess.run([HAPTICD, "device", "encode", "--from-arm", os.path.join(folder, "arm.yaml")], input=b"0,0,0\n0,0,0\n", capture_output=True, timeout=120)
    check("an input with a name that is none encodes nothing", done.returncode == 2 and not done.stdout, done)
    decode(OVER, {})
    done = subprocess.run([HAPTICD, "device", "encode", "--from-arm", os.path.join(folder, "arm.yaml")], input=b"0,0,0\n0,0,0\n", capture_output=True, timeout=120)
    bodies = [bytes.fromhex(line) for line in done.stdout.decode().splitlines()]
    check("encode lets the clock go on", len(bodies) == 2 and bodies[0][2:4] != bodies[1][2:4], done)

    # A number in another place is told from one of another size.
    second = f"joint: 2, at: 8, type: i24, scale: {SCALE:.9g}"
    code, out, err = decode(OVER, {second: second + ", offset: 2.3"})
    check("an offset that is too large is named", "joint 2" in err and "fits between them" in err and "offset_degrees" in err, err)
    code, out, err = decode(OVER, {second: second.replace("scale: ", "scale: 1")})
    check("a scale that is too large is named", "joint 2" in err and "is scale in rad" in err, err)

    # Id and size.
    for form, of in (("raw", bytes), ("text", text_of)):
        named(f"an id that the file lacks, {form}", of(PLAIN), no_id, "each bad report begins with 0x01 and has one byte too many", "give wire.input id: 1;")
        named(f"another id, {form}", of(OVER), {"      id: 1\n": "      id: 3\n"}, "with another id (0x01)", "each report begins with 0x01, expected 0x03", "give wire.input id: 1\n")
    named("a size of one byte too few, with an id", PLAIN, {"size: 20": "size: 19", SUM: SUM.replace("18", "17").replace(", over_id: true", "")},
          "0x01 occurs every 21 bytes", "give wire.input size: 20 (it is 19)")
    bare = b"".join(PLAIN[at + 1:at + 21] for at in range(0, len(PLAIN), 21))
    named("reports without their id", bare, plain, "captured without the report id", "put 0x01 in front")
    longer = {**no_id, "size: 20": "size: 21"}
    named("a size of one byte too many, without an id", bare, longer, "as reports of 20 bytes they are good: give wire.input size: 20\n")
    code, out, err = decode(OVER[:21 * 100 + 5], {})
    check("the last report cut is no other size", code == 1 and "100 good" in err and "wire.input" not in err, err)

    # Raw bytes that begin inside a report: the file's own checksum and constants tell where the next one begins, also
    # of a few reports, and where some are damaged.
    def damaged(capture, size):
        return bytes(b ^ (0x10 if i % (97 * size) == 50 * size else 0) for i, b in enumerate(capture))

    def marked(i):
        body = b"\xa5" + report(i, False)[1:18]
        return body + crc16(body).to_bytes(2, "little")

    mark = {**no_id, "        - {is: counter, at: 0, type: u8}": "        - {is: constant, at: 0, type: u8, value: 0xa5}", "is: time, at: 1": "is: time, at: 2",
            "{is: position, joint: 1, at: 4": "{is: position, joint: 1, at: 5", "{is: position, joint: 2, at: 8": "{is: position, joint: 2, at: 9",
            "{is: position, joint: 3, at: 12": "{is: position, joint: 3, at: 13"}
    whole = b"".join(marked(i) for i in range(400))
    for what, capture in (("few", whole[:20 * 12]), ("some of them damaged", damaged(whole, 20))):
        named(f"a capture that begins inside a report, {what}", capture[7:], mark, "from byte 13 on, nearly all reports are good; give framing: {start: 0xa5}, and the reports are found\n")
    for what, capture in (("few", bare[:20 * 12]), ("some of them damaged", damaged(bare, 20))):
        named(f"the same without a constant, {what}", capture[7:], {**no_id}, "from byte 13 on, nearly all reports are good; leave out the first 13 bytes (tail -c +14 FILE)\n")
finish()
