#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The wire format that driver/docs/devices.md shows works as pasted: its reports are framed both ways, and read back.

Usage: wire_example.py HAPTICD SOURCE_DIR       exit 1 when one is off
"""
import csv
import io
import os
import sys
import tempfile

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "support"))
from e2e import check, finish, program

HAPTICD, SOURCE = sys.argv[1:3]
run = program(HAPTICD)


def example():
    """The indented block of the page that begins with framing."""
    lines = open(os.path.join(SOURCE, "driver/docs/devices.md")).read().splitlines()
    first = next(i for i, line in enumerate(lines) if line.startswith("    framing: {"))
    block = lines[first:lines.index("", first)]
    return "".join(line + "\n" for line in block)


def crc16_x25(data):
    """Bit by bit, by other code than ours."""
    crc = 0xFFFF
    for byte in data:
        crc ^= byte
        for _ in range(8):
            crc = crc >> 1 ^ (0x8408 if crc & 1 else 0)
    return crc ^ 0xFFFF


def unescaped(line):
    data, out, rest = bytes.fromhex(line), [], iter(bytes.fromhex(line))
    for byte in rest:
        out.append(next(rest) ^ 0x20 if byte == 0x7D else byte)
    return data, bytes(out)


with tempfile.TemporaryDirectory() as folder:
    arm = os.path.join(folder, "pasted.yaml")
    open(arm, "w").write("hapticd-device: 1\nmodule: usb_bulk\nname: pasted\nlimits: {force: 2}\nparameters:\n  usb: {id: \"0403:6001\"}\n"
                         "  arm: {kind: phantom, lengths: [0.2, 0.2, 0, 0, 0], max_torque: [0.5]}\n  wire:\n    rate: 1000\n" + example())
    code, out, err = run("check", arm)
    check("the example passes hapticd check", code == 0, out + err)

    # 126 and 125 raw units are the marks 0x7e and 0x7d.
    code, out, err = run("device", "encode", arm, input="0.00252,0.0025,-0.5\n0.1,0.2,0.3\n")
    lines = out.splitlines()
    check("torques are encoded", code == 0 and len(lines) == 2, out + err)
    for line in lines:
        sent, plain = unescaped(line)
        check("a command begins and ends with its mark, and has none inside", sent[0] == 0x7E and sent[-1] == 0x7E and 0x7E not in sent[1:-1], line)
        check("and carries the bytes that the example says", len(plain) == 10 and crc16_x25(plain[1:7]) == int.from_bytes(plain[7:9], "little"), line)
    check("a mark inside is escaped", "7d 5e" in lines[0] and "7d 5d" in lines[0], lines[0])

    truth = [(0.5, 0.4, -0.5), (0.126, 0.125, 0.1), (-1.5, 1.4, 0.3), (0.000126, 0.032126, 0)]
    code, out, err = run("device", "encode", "--from-arm", "--raw", arm, "-o", os.path.join(folder, "cap.bin"),
                         input="".join("%g,%g,%g\n" % row for row in truth))
    check("what the arm would send is written", code == 0, err)
    code, out, err = run("device", "decode", arm, os.path.join(folder, "cap.bin"))
    told = [[float(row[f"position{j}"]) for j in (1, 2, 3)] for row in csv.DictReader(io.StringIO(out)) if row["verdict"] == "good"]
    check("and is read back", code == 0 and len(told) == 4 and max(abs(a - b) for t, u in zip(told, truth) for a, b in zip(t, u)) < 1e-6, (err, told))
finish()
