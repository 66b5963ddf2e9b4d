#!/usr/bin/env python3
"""An engineer with an arm of her own invention: its reports, written here by other code than ours, are decoded by a device file.

Usage: decode_a_capture.py HAPTICD SOURCE_DIR VME_BOARD MODULE_DIR       exit 1 when one is off
"""
import binascii
import functools
import json
import math
import operator
import os
import pty
import re
import struct
import subprocess
import sys
import tempfile

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "support"))
from e2e import check, finish, program
from wire import fed, modbus, table_of

HAPTICD, SOURCE, BOARD, MODULES = sys.argv[1:5]

ARM = """hapticd-device: 1
module: usb_hid
name: invented
limits: {force: 2}
parameters:
  usb: {id: "16c0:0486"}
  arm: {kind: phantom, lengths: [0.2, 0.2, 0, 0, 0], max_torque: [0.5]}
  wire:
    rate: 1000
    input:
      size: 18
      fields:
        - {is: constant, at: 0, type: u12, value: 0xabc}
        - {is: counter, at: 1, bit_offset: 4, type: u4}
        - {is: position, joint: 1, at: 2, type: i24, scale: 1.0e-6}
        - {is: position, joint: 2, at: 5, type: i24, endian: big, scale: 1.0e-6}
        - {is: position, joint: 3, at: 8, type: f32, scale: 1}
        - {is: button, button: 1, at: 12, type: u1}
        - {is: button, button: 2, at: 12, bit_offset: 1, type: u1}
        - {is: fault, at: 12, bit_offset: 7, type: u1}
        - {is: constant, at: 13, type: u8, value: 0}
        - {is: checksum, at: 14, type: u32, method: crc32, from: 0, to: 14}
    output:
      size: 8
      fields:
        - {is: torque, joint: 1, at: 0, type: i12, scale: 0.001, limit: 500}
        - {is: torque, joint: 2, at: 1, bit_offset: 4, type: i12, scale: 0.001, limit: 500}
        - {is: torque, joint: 3, at: 3, type: i12, scale: 0.001, limit: 500}
        - {is: enable, at: 4, bit_offset: 4, type: u1}
        - {is: checksum, at: 6, type: u16, method: crc16-modbus, from: 0, to: 6}
"""


def i24(value, order):
    return (value & 0xFFFFFF).to_bytes(3, order)


def report(counter, q1, q2, q3, buttons=0):
    """As the firmware would write it; zlib's CRC, not ours."""
    head = (0xABC | counter % 16 << 12).to_bytes(2, "little")
    body = head + i24(q1, "little") + i24(q2, "big") + struct.pack("<f", q3) + bytes([buttons, 0])
    return body + struct.pack("<I", binascii.crc32(body))


run, hapticd = fed(HAPTICD, "device"), program(HAPTICD)


with tempfile.TemporaryDirectory() as folder:
    arm = os.path.join(folder, "invented.yaml")
    open(arm, "w").write(ARM)
    done = hapticd("check", arm)
    check("the device file is good", done.returncode == 0, done.stdout + done.stderr)

    truth = [(i, 1000 * i, -2000 * i, 0.125 * i, i % 4) for i in range(40)]
    capture = b"".join(report(*one) for one in truth)
    code, out, err = run("decode", arm, given=capture)
    check("a raw capture is decoded", code == 0 and "40 reports, 40 good" in err, err)
    told = table_of(out)
    exact = all(abs(float(r["position1"]) - q1 * 1e-6) < 1e-12 and abs(float(r["position2"]) - q2 * 1e-6) < 1e-12 and float(r["position3"]) == q3 and
                int(r["buttons"]) == b and int(r["sequence"]) == i % 16 for r, (i, q1, q2, q3, b) in zip(told, truth))
    check("to the numbers that were written", len(told) == 40 and exact, told[:3])

    text = "\n".join("E: %012.6f 18 %s" % (i * 1e-3, report(*truth[i]).hex(" ")) for i in range(5))
    code, out, err = run("decode", arm, given=("D: 0\nN: an arm\n" + text + "\n").encode())
    check("hid-recorder's text is decoded", code == 0 and len(table_of(out)) == 5 and table_of(out)[3]["time"] == "0.003000", (err, out[:300]))

    broken = bytearray(capture)
    broken[18 * 7 + 3] ^= 0x10
    code, out, err = run("decode", arm, given=bytes(broken))
    check("a flipped bit is one bad report, and the reason is told", code == 1 and "39 good, 1 corrupt" in err and "checksum at byte 14" in err, err)
    code, out, err = run("decode", arm, given=capture[:50])
    check("a cut report is told", code == 1 and "expected 18" in err, err)
    code, out, err = run("decode", arm, "--hex", given=b"01 02 zz\n")
    check("text that is not hexadecimal is bad input with its line", code == 2 and "line 1" in err, err)
    code, out, err = run("decode", os.path.join(SOURCE, "config/devices/simulated-premium15.yaml"), given=b"00")
    check("an arm without a wire is bad input", code == 2 and "no parameter wire" in err, err)

    code, out, err = run("encode", arm, "--raw", given=b"torque1,torque2,torque3\n0.1,-0.2,9\n")
    raw = [0.1, -0.2, 0.5]
    value = sum((round(t * 1000) & 0xFFF) << 12 * i for i, t in enumerate(raw)) | 1 << 36
    body = value.to_bytes(6, "little")
    check("torques are encoded, limited and summed", code == 0 and out == body + modbus(body), (out.hex(" "), body.hex(" "), err))
    code, out, err = run("encode", arm, given=b"torque1,speed\n0.1,3\n")
    check("a column that is not in the report is named", code == 2 and "speed" in err and "torque2" in err, err)

    # What goes wrong with captures and numbers, and what is said of it.
    code, out, err = run("encode", arm, given=b"0.1,0.7,-5000\n")
    check("a torque beyond its field is told", code == 0 and "line 1: torque2: 0.7 is beyond what its field can carry, -0.5 to 0.5; sent as 0.5" in err and
          "torque3: -5000" in err and "torque1" not in err, err)
    code, out, err = run("encode", arm, given=b"0.1,0.5,-0.5\n")
    check("and nothing of one that fits", code == 0 and not err, err)
    code, out, err = run("encode", arm, "--from-arm", given=b"position1\n9999\n")
    check("a position beyond its field is told", "position1: 9999 is beyond" in err, err)
    lines = [report(*one).hex(" ") for one in truth]
    code, out, err = run("decode", arm, given="\n".join(lines[:7] + ["g1" + lines[7][2:]]).encode())
    check("one wrong letter in a text is its line, not a capture of other bytes", code == 2 and "line 8" in err and "g1" in err and "--raw" in err, err)
    for name, text in (("xxd", "00000000: bc0a 0000  ....\n"), ("decimal", "188 10 0 0\n"), ("CSV", "1,2,300\n")):
        code, out, err = run("decode", arm, given=text.encode())
        check(f"{name} is not taken for raw bytes", code == 2 and "line 1" in err and "not hexadecimal" in err, err)
    code, out, err = run("decode", arm, "--hex", given=b"\x1b[31m\x07\xff\n")
    check("bytes do not reach the terminal", code == 2 and "\x1b[31m" not in err and "leave --hex out" in err, repr(err))
    code, out, err = run("decode", arm, given=("\n".join("01 " + line for line in lines)).encode())
    check("a report id that the file lacks is guessed", code == 1 and "give wire.input id: 1" in err, err)
    code, out, err = run("decode", arm, given=" ".join(lines).encode())
    check("many reports in a line are counted", code == 1 and "720 bytes in a line are 40 reports of 18" in err, err)
    other = os.path.join(folder, "other.yaml")
    for wrong in ("method: crc32c", "method: crc32-bzip2", "endian: big, method: crc32"):
        open(other, "w").write(ARM.replace("method: crc32,", wrong + ","))
        code, out, err = run("decode", other, given="\n".join(lines).encode())
        check(f"{wrong}: the right one is found", code == 1 and "is right with method: crc32, endian: little" in err, err)
    open(other, "w").write(ARM.replace("at: 14, type: u32, method: crc32, from: 0, to: 14", "at: 14, type: u32, method: crc32, from: 1, to: 14"))
    code, out, err = run("decode", other, given="\n".join(lines).encode())
    check("a range that begins a byte late is found", code == 1 and "is right with from: 0\n" in err, err)
    own = "\n".join(line[:-2] + f"{int(line[-2:], 16) ^ 0x5A:02x}" for line in lines)
    code, out, err = run("decode", arm, given=own.encode())
    check("where none fits, this is told", code == 1 and "no method that is known by name fits" in err, err)
    # A checksum that begins with the report id, which no offset names: zlib's, binascii's, a plain sum and xor, by their own code.
    for method, type_, sum_of in (("crc32", "u32", lambda b: struct.pack("<I", binascii.crc32(b))),
                                  ("crc16-ccitt-false", "u32", lambda b: struct.pack("<I", binascii.crc_hqx(b, 0xFFFF))),
                                  ("sum", "u32", lambda b: struct.pack("<I", sum(b))), ("xor8", "u32", lambda b: struct.pack("<I", functools.reduce(operator.xor, b)))):
        over = ARM.replace("      size: 18\n", "      id: 5\n      size: 18\n").replace("method: crc32,", f"method: {method}, over_id: true,")
        text = "\n".join("05 " + (body[:14] + sum_of(b"\x05" + body[:14])).hex() for body in (report(i, 1000 * i, -7 * i, 0.5) for i in range(20)))
        open(other, "w").write(over)
        code, out, err = run("decode", other, given=text.encode())
        check(f"{method} over the report id: all are right", code == 0 and "20 reports, 20 good" in err, err)
        if method.startswith("crc"):
            open(other, "w").write(over.replace(", over_id: true", ""))
            code, out, err = run("decode", other, given=text.encode())
            check(f"{method} over the report id is found", code == 1 and "over_id: true" in err and f"method: {method}" in err.replace("crc16,", "crc16-ccitt-false,"), err)
    # Good reports of positions that the arm cannot have.
    stops = ARM.replace("max_torque: [0.5]}", "max_torque: [0.5], limits: [[-1.2, 1.2], [-0.8, 0.8], [-1, 1]]}")
    swing = "\n".join(report(i, round(1e6 * math.sin(i / 20)), round(5e5 * math.sin(i / 30)), 0.5).hex() for i in range(200))
    open(other, "w").write(stops)
    code, out, err = run("decode", other, given=swing.encode())
    check("positions within the stops are not remarked on", code == 0 and "joint" not in err, err)
    open(other, "w").write(stops.replace("type: i24, scale: 1.0e-6}", "type: i24, scale: 5.7e-5}", 1))
    code, out, err = run("decode", other, given=swing.encode())
    check("a scale in degrees is told by the stops", "joint 1: from -57 to 57 rad" in err and "scale_degrees" in err and "joint 2" not in err, err)
    open(other, "w").write(stops.replace("joint: 1, at: 2, type: i24, scale", "joint: 1, at: 2, type: i24, endian: big, scale"))
    code, out, err = run("decode", other, given=swing.encode())
    check("a wrong order of bytes is told", "joint 1: moves far more smoothly" in err and "give endian: little" in err and "joint 2" not in err, err)
    # One report in 256 has equal bytes in its checksum: right in the wrong order, and no reason to say nothing.
    swapped = ARM.replace("type: u32, method: crc32, from: 0, to: 14", "type: u16, method: crc16-modbus, from: 0, to: 14")
    open(other, "w").write(swapped)
    bodies = [report(i, 31 * i, -7 * i, 0.5)[:14] for i in range(1500)]
    text = "\n".join((body + modbus(body)[::-1] + b"\0\0").hex() for body in bodies)
    code, out, err = run("decode", other, given=text.encode())
    alike = sum(modbus(body)[0] == modbus(body)[1] for body in bodies)
    check("an order of bytes is found though some agree by chance", alike > 0 and "method: crc16-modbus, endian: big" in err, (alike, err))
    code, out, err = run("decode", arm, given=lines[0].encode())
    check("one report is one", "1 report, 1 good" in err, err)
    for text, words in ((b"0.1 -0.1 0.2\n", "expected commas between the numbers"), (b"abc,1,2\n", '"abc"'), (b"nan,0,0\n", '"nan"')):
        code, out, err = run("encode", arm, given=text)
        check(f"{text!r} is bad input in its own words", code == 2 and words in err, err)
    code, out, err = run("encode", arm, "0.1,0.2,0.3")
    check("numbers in place of a file are understood", code == 2 and "echo 0.1,0,0 | hapticd device encode" in err, err)

    code, out, err = run("encode", arm, "--from-arm", given=b"position1,position2,position3,buttons\n0.5,-0.25,1.5,3\n0.1,0.2,0.3,0\n")
    code2, out2, err2 = run("decode", arm, given=out)
    told = table_of(out2)
    check("what is encoded is decoded", code == 0 and code2 == 0 and [float(told[0][f"position{i}"]) for i in (1, 2, 3)] == [0.5, -0.25, 1.5] and
          told[0]["buttons"] == "3", (err, err2, out2))

    wrong = ARM.replace("type: i24, scale", "type: i99, scale").replace("method: crc32", "method: crc33").replace("rate: 1000", "rate: fast").replace(
        "{is: enable, at: 4,", "{is: enabel, at: 4,").replace("to: 6}", "to: 60}")
    open(arm, "w").write(wrong)
    done = hapticd("check", arm)
    lines = done.stdout.splitlines()
    def place(words, count=0):
        """Line of the n-th place where the words stand."""
        return [i + 1 for i, line in enumerate(wrong.splitlines()) if words in line][count]
    for words in ("rate: fast", "type: i99", "crc33", "enabel", "to: 60"):
        check(f"'{words}' is told at its place", any(line.startswith(f"{arm}:{place(words)}:") for line in lines), done.stdout)
    check("all of them at once, and nothing else", done.returncode == 2 and len([line for line in lines if ": warning: " not in line]) == 5, done.stdout)

# A file to start from, and an arm on a (played) bus whose bytes are recorded and read back.
with tempfile.TemporaryDirectory() as folder:
    for kind, more in (("phantom", ["--lengths", "0.21,0.17", "--bits", "24"]), ("delta", []), ("chain", ["--joints", "6", "--bits", "19", "--bus", "bulk"])):
        arm = os.path.join(folder, kind + ".yaml")
        code, out, err = run("new", kind, "-o", arm, "--kind", kind, "--no-questions", *more)
        done = hapticd("check", arm)
        warned = [line for line in done.stdout.splitlines() if "warning" in line and not (kind == "chain" and ": mount: warning: not given" in line)]
        check(f"device new writes a {kind} that check accepts", code == 0 and done.returncode == 0 and not warned, (out, err, done.stdout))
        check(f"and says where a {kind} stands, or asks for it", kind != "chain" or "mount: {position: [-1.2, 0, 0.09]} puts the resting tip" in done.stdout, done.stdout)
        joints = 6 if kind == "chain" else 3
        poses = os.path.join(folder, "poses.csv")
        open(poses, "w").write(",".join(f"q{i + 1}" for i in range(joints)) + "\n" + ",".join(["0.3"] * joints) + "\n")
        code, out, err = run("kinematics", arm, "--joints", poses)
        held = [float(value) for name, value in (table_of(out) or [{}])[0].items() if name.startswith("gravity")]
        check(f"and no weight that nobody gave is carried by a {kind}", code == 0 and len(held) == joints and not any(held), (held, err))
        joints = 6 if kind == "chain" else 3
        code, out, err = run("encode", arm, "--from-arm", given=(",".join(["0.1"] * joints) + "\n").encode())
        code, out, err = run("decode", arm, given=out)
        check(f"and whose reports of a {kind} can be tried", code == 0 and abs(float(table_of(out)[0]["position1"]) - 0.1) < 1e-3, (out, err))
    # A report id and a checksum over it, by zlib's and binascii's own code.
    for method, bytes_, sum_of in (("crc32", 4, binascii.crc32), ("crc16-ccitt-false", 2, lambda b: binascii.crc_hqx(b, 0xFFFF)), ("sum8", 1, lambda b: sum(b) % 256)):
        numbered = os.path.join(folder, f"numbered-{method}.yaml")
        code, out, err = run("new", "numbered", "-o", numbered, "--report-id", "7", "--checksum", method, "--no-questions")
        text = open(numbered).read()
        check(f"device new writes both ids and {method}", code == 0 and text.count("      id: 7\n") == 2 and "# - {is: checksum" not in text, (out, err, text))
        code, out, err = run("encode", numbered, "--from-arm", "--raw", given=b"0.1,0.2,0.3\n")
        check(f"and {method} covers the id", code == 0 and out[:1] == b"\x07" and sum_of(out[:-bytes_]).to_bytes(bytes_, "little") == out[-bytes_:], (out.hex(" "), err))
    code, out, err = run("new", "plain", "-o", os.path.join(folder, "plain.yaml"), "--no-questions")
    text = open(os.path.join(folder, "plain.yaml")).read()
    check("without them there is neither", code == 0 and " id: " not in text.split("wire:")[1] and "# - {is: checksum" in text, text)
    for wrong in ("16c0", "16c0:", ":0486", "16c0:0486x", "16c0:00486", "0x16:0486", "-1:0486", " 16c0:0486"):
        code, out, err = run("new", "usb", "-o", os.path.join(folder, "usb.yaml"), f"--id={wrong}", "--no-questions")
        check(f"'{wrong}' is refused as an id, with an example", code == 2 and f"--id {wrong}: expected vendor:product" in err, (code, err))
    code, out, err = run("new", "phantom", "-o", arm)
    check("no file is overwritten", code == 2 and "exists already" in err, err)
    for bad in (["--kind", "scara"], ["--lengths", "1,2,3"], ["--bits", "65"], ["--bus", "can"], ["--id", "hello"], ["--checksum", "crc16, at: 0"], ["--report-id", "256"]):
        code, out, err = run("new", "bad", "-o", os.path.join(folder, "bad.yaml"), "--no-questions", *bad)
        check(f"{' '.join(bad)} is refused", code == 2 and not os.path.exists(os.path.join(folder, "bad.yaml")), err)

    # Numbers of each joint, and what a chain without twists cannot do.
    own = os.path.join(folder, "own.yaml")
    code, out, err = run("new", "--counts", "16384", "--gear", "10,20,5", "--torque", "1.2,1,0.4", "own", "-o", own, "--no-questions")
    text = open(own).read() if os.path.exists(own) else err
    scales = [float(word) for word in re.findall(r"is: position.*scale: ([0-9.e-]+)", text)]
    check("each joint may have its own gear", [round(2 * math.pi / 16384 / scale) for scale in scales] == [10, 20, 5], text)
    check("and its own torque", "max_torque: [1.2, 1, 0.4]" in text and len(set(re.findall(r"is: torque.*scale: (\S+)}", text))) == 3, text)
    for bad in (["--gear", "10,20"], ["--torque", "1,0,1"], ["--twists", "1,0,0"], ["--kind", "chain", "--twists", "1,0"]):
        code, out, err = run("new", "bad", "-o", os.path.join(folder, "bad.yaml"), "--no-questions", *bad)
        check(f"{' '.join(bad)} is refused", code == 2 and bad[-2] in err and not os.path.exists(os.path.join(folder, "bad.yaml")), err)
    flat, bent = os.path.join(folder, "flat.yaml"), os.path.join(folder, "bent.yaml")
    code, out, err = run("new", "flat", "-o", flat, "--kind", "chain", "--no-questions")
    check("a chain whose axes are parallel is told", code == 0 and b"the tip stays in a plane" in out and "the tip stays in a plane" in open(flat).read(), out)
    code, out, err = run("new", "bent", "-o", bent, "--kind", "chain", "--twists", "1.5707963,0,0", "--lengths", "0,0.2,0.2", "--id", "1209:0a0b", "--no-questions")
    check("one with twists is not", code == 0 and b"in a plane" not in out and "- [0, 1.5707963, 0, 0]" in open(bent).read(), out)

    # A twin has the mechanism of its arm: the same tip for the same joints.
    for arm, joints in ((own, "0.1,0.2,0.3"), (bent, "0.1,0.4,-0.7"), (os.path.join(SOURCE, "config/devices/woodenhaptics.yaml"), "0.1,1.5,1.4")):
        twin, pose = os.path.join(folder, "twin.yaml"), os.path.join(folder, "pose.csv")
        open(pose, "w").write("q1,q2,q3\n" + joints + "\n")
        code, out, err = run("twin", arm, "-o", twin)
        check(f"{os.path.basename(arm)} has a twin", code == 0 and b"--device" in out, err)
        tips = [[float(row[axis]) for axis in "xyz"] for row in (table_of(run("kinematics", file, "--joints", pose)[1])[0] for file in (arm, twin))]
        check("with the same kinematics", max(abs(a - b) for a, b in zip(*tips)) < 1e-9, tips)
        code, out, err = run("twin", arm, "-o", twin)
        check("which is not overwritten", code == 2 and "exists already" in err, err)
        os.remove(twin)
    twin, report = os.path.join(folder, "twin.yaml"), os.path.join(folder, "twin.json")
    code, out, err = run("twin", own, "-o", twin)
    text = open(twin).read()
    check("its encoders are those of the wire", code == 0 and "counts: [163840, 327680, 81920]" in text, text)
    check("numbers that it borrows are told", "has no max_force, continuous_force, max_stiffness, mass: the twin has those of a Premium 1.5" in err and err.split("own.yaml: ")[-1].strip() in text, (err, text))
    done = hapticd("run", os.path.join(SOURCE, "config/scenes/sphere.yaml"), "--device", twin, "--for", "3", "--virtual-time", "--report", report)
    touched = json.load(open(report))["models"]["sphere"]["contact_ticks"] if os.path.exists(report) else 0
    check("and it presses the sphere", done.returncode == 0 and touched > 100, (touched, done.stdout[-800:], done.stderr[-800:]))
    # A chain with masses that does not say where they are would be pushed up.
    heavy = os.path.join(folder, "heavy.yaml")
    for centers, warned in (("", True), ("    centers: [[0, 0, 0], [-0.1, 0, 0], [-0.1, 0, 0]]\n", False)):
        open(heavy, "w").write(re.sub(r"    # masses:.*\n", "    masses: [0.5, 0.3, 0.2]\n" + centers, open(bent).read()))
        done = hapticd("check", heavy)
        check(f"masses with{'out' if warned else ''} centers", ("far end of its link" in done.stdout + done.stderr) == warned, (done.stdout, done.stderr))
    # A chain that does not say where it stands is put where scenes expect a hand.
    text = open(bent).read().replace("# limits: [[-1, 1], ...]", "limits: [[-1.5, 1.5], [-0.5, 1.5], [-2.57, -0.57]]").replace("# base_orientation", "base_orientation")
    open(bent, "w").write(text)
    os.remove(twin), os.remove(report)
    code, out, err = run("twin", bent, "-o", twin)
    done = hapticd("run", os.path.join(SOURCE, "config/scenes/sphere.yaml"), "--device", twin, "--for", "3", "--virtual-time", "--report", report)
    touched = json.load(open(report))["models"]["sphere"]["contact_ticks"] if os.path.exists(report) else 0
    check("a chain's twin presses the sphere too", code == 0 and touched > 100, (touched, open(twin).read(), done.stdout[-800:], done.stderr[-800:]))
    # A delta: the Falcon's twin strokes what its small workspace holds.
    falcon = os.path.join(folder, "falcon-twin.yaml")
    code, out, err = run("twin", os.path.join(SOURCE, "config/devices/falcon.yaml"), "-o", falcon)
    os.remove(report)
    done = hapticd("run", os.path.join(SOURCE, "config/scenes/sphere.yaml"), "--device", falcon, "--for", "3", "--virtual-time", "--report", report)
    touched = json.load(open(report))["models"]["sphere"]["contact_ticks"] if os.path.exists(report) else 0
    check("a Falcon's twin presses the sphere", code == 0 and done.returncode == 0 and touched > 100, (touched, open(falcon).read(), done.stdout[-800:], done.stderr[-800:]))
    for file, words in (("sarcos.yaml", "arm.others"), ("simulated-premium15.yaml", "simulated already")):
        code, out, err = run("twin", os.path.join(SOURCE, "config/devices", file), "-o", os.path.join(folder, "none.yaml"))
        check(f"{file} has none, and why", code == 2 and words in err and not os.path.exists(os.path.join(folder, "none.yaml")), err)

    # At a terminal: a wrong answer is asked for again, at once, and no other answer is lost.
    asked = os.path.join(folder, "asked.yaml")
    keyboard, screen = pty.openpty()
    answers = "HID\nhid\nhello\n16c0:0486\n256\n7\nphantom\n0.21;0.17\n0.2\n0.21, 0.17\nmany\n4000\n-10\n9.5\n99\n24\n2\nCRC8\ncrc8\n\n\n"
    os.write(keyboard, answers.encode())
    done = hapticd("device", "new", "asked", "-o", asked, stdin=screen)
    os.close(keyboard), os.close(screen)
    text = open(asked).read() if os.path.exists(asked) else ""
    check("wrong answers are asked for again", done.returncode == 0 and done.stdout.count("Bus: ") == 2 and done.stdout.count("Motor turns") == 2 and
          "\"many\" is not a list of numbers" in done.stdout and done.stdout.count("Lengths of upper arm") == 3, (done.stdout, done.stderr))
    check("and the right ones are in the file", "16c0:0486" in text and f"scale: {2 * 3.14159265358979 / 38000:.6g}"[:14] in text and "type: i24" in text and
          "button: 2" in text and "lengths: [0.21, 0.17, 0, 0, 0]" in text, text)
    check("the report id and the checksum are asked for too", text.count("      id: 7\n") == 2 and "method: crc8, from: 0, to: 12, over_id: true" in text and
          'did you mean "crc8"?' in done.stdout and done.stdout.count("HID report id") == 2, (text, done.stdout))
    for command in ("calibrate", "record"):
        code, out, err = run(command, asked)
        check(f"{command} of an arm that is not there says so once", code == 1 and err.count("fix:") == 1 and err.count("error:") == 1,
              (code, err))
    done = hapticd("doctor", asked, "--seconds", "0")
    check("doctor says what is left when the machine stops", "nothing does when the machine itself stops" in done.stdout or
          "nothing is known that switches its motors off" in done.stdout, done.stdout)
    open(asked, "w").write(text.replace("# watchdog: 0.02", "watchdog: 0.02"))
    done = hapticd("doctor", asked, "--seconds", "0")
    check("and that a watchdog does it", "its hardware switches the motors off when commands stop, as its file says" in done.stdout, done.stdout)

    window = os.path.join(folder, "window")
    board = subprocess.Popen([BOARD, window, "--arm", os.path.join(SOURCE, "config/devices/simulated-sarcos.yaml"), "--plugin-path", MODULES,
                              "--for", "60"], stdout=subprocess.PIPE, text=True)
    try:
        check("the board is up", board.stdout.readline() == "ready\n")
        arm = os.path.join(folder, "sarcos.yaml")
        open(arm, "w").write(open(os.path.join(SOURCE, "config/devices/sarcos.yaml")).read().replace("/dev/bus/vme/m0", window)
                             .replace("masses: [0, 0, 0, 0, 0, 0, 0, 0]", "masses: [1.0, 0.5, 2.0, 0.5, 1.2, 0.2, 0.3, 0.05]"))
        capture = os.path.join(folder, "capture.txt")
        code, out, err = run("record", arm, "--for", "1", "-o", capture)
        text = open(capture).read()
        check("record writes both directions", code == 0 and "\n@" in text and "\n> @" in text, (err, text[:300]))
        code, out, err = run("decode", arm, capture)
        told = [r for r in table_of(out) if r["verdict"] == "good"]
        check("which decode reads, with times", len(told) > 20 and float(told[-1]["time"]) > 0.3, (err, len(told)))
    finally:
        board.terminate()
        board.communicate()
    code, out, err = run("record", os.path.join(SOURCE, "config/devices/simulated-premium15.yaml"))
    check("an arm without bytes cannot be recorded", code == 2 and "no bytes to record" in err, err)

schema = hapticd("check", "--schema", "device").stdout
for key in ("bit_offset", "polynomial", "modulo", "escape", "final_xor"):
    check(f"the schema knows {key}", f'"{key}"' in schema)
finish()
