#!/usr/bin/env python3
"""An engineer errs in the sign, the direction or the scale of positions that are read without a fault: decode and check tell, and encode takes what kinematics wrote.

Usage: other_readings.py HAPTICD       exit 1 when one is off
"""
import csv
import io
import math
import os
import random
import resource
import subprocess
import sys
import tempfile

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "support"))
from e2e import check, finish
from wire import TORQUES, own_arm

HAPTICD = sys.argv[1]
TURN = 65536  # counts of a joint turn
SCALE = 2 * math.pi / TURN

ARM = own_arm("""    input:
      size: 6
      fields:
        - {is: position, joint: 1, at: 0, type: i16, scale: @}
        - {is: position, joint: 2, at: 2, type: i16, scale: @}
        - {is: position, joint: 3, at: 4, type: i16, scale: @}
""".replace("@", f"{SCALE:.9g}") + TORQUES, limits="{force: 2, workspace: 0.3}", stops="[[-1.2, 1.2], [-0.3, 0.9], [-1, 1]]")
FIRST, SECOND, THIRD = (f"joint: {i + 1}, at: {2 * i}, type: i16, scale: {SCALE:.9g}" for i in range(3))


def swing(part=1.0):
    """Angles of a hand that moves each joint between its stops, or over a part of that way."""
    return [(part * 1.15 * math.sin(i / 60), 0.3 + part * 0.57 * math.sin(i / 75 + 1), part * 0.95 * math.cos(i / 70)) for i in range(900)]


def as_signed(code):
    return code % 65536


def sent(angles, number=as_signed, joint=0):
    """As a board writes them whose numbers of one joint are made in another way."""
    lines = []
    for row in angles:
        codes = [as_signed(round(angle / SCALE)) for angle in row]
        codes[joint] = number(round(row[joint] / SCALE)) % 65536
        lines.append("".join(code.to_bytes(2, "little").hex() for code in codes))
    return "\n".join(lines).encode()


def run(*arguments, given=b""):
    done = subprocess.run([HAPTICD, *arguments], input=given, capture_output=True, timeout=120)
    return done.returncode, done.stdout.decode(), done.stderr.decode()


with tempfile.TemporaryDirectory() as folder:
    arm = os.path.join(folder, "arm.yaml")

    def write(**changes):
        text = ARM
        for old, new in changes.get("change", {}).items():
            assert old in text, old
            text = text.replace(old, new)
        open(arm, "w").write(text)

    def told(capture, change=None):
        write(change=change or {})
        code, out, err = run("device", "decode", arm, given=capture)
        return err.split("\n", 1)[1] if code == 0 else f"exit {code}: {err}"

    # The sign of a type.
    check("what is right is not remarked on", told(sent(swing())) == "", told(sent(swing())))
    said = told(sent(swing()), {FIRST: FIRST.replace("i16", "u16")})
    check("signed numbers that are read as unsigned are told", said.startswith("joint 1: jumps by nearly the whole range of its u16") and "give type: i16, or wraps: true" in said and
          said.count("\n") == 1, said)
    fixed = sent([(math.pi + q, r, s) for q, r, s in swing()])
    said = told(fixed, {"[[-1.2, 1.2]": "[[1.9, 4.4]"})
    check("unsigned numbers that are read as signed are told", said.startswith("joint 1: jumps by nearly the whole range of its i16") and "give type: u16, or wraps: true" in said, said)
    check("and read as unsigned they are right", told(fixed, {"[[-1.2, 1.2]": "[[1.9, 4.4]", FIRST: FIRST.replace("i16", "u16")}) == "", said)
    once = [(-0.01 + 0.0001 * i, 0.3, 0.5) for i in range(300)]
    said = told(sent(once), {FIRST: FIRST.replace("i16", "u16")})
    check("one such jump is enough", "1 time: " in said, said)
    said = told(sent([(8 * i / 900, r, s) for i, (q, r, s) in enumerate(swing())]), {"[-1.2, 1.2]": "[-9, 9]"})
    check("numbers that go on past their end want wraps", "joint 1: jumps by nearly the whole range" in said and "give wraps: true" in said, said)

    # The direction, and other codes of the same angle.
    mirrored = sent(swing(), lambda code: -code, joint=1)
    said = told(mirrored)
    check("a joint that counts the other way is told by its stops", said.startswith("joint 2: goes from -0.869959 to 0.269981, beyond its arm.limits; it stays within them with scale: -9.58738e-05\n"), said)
    check("and is right so", told(mirrored, {SECOND: SECOND.replace("scale: ", "scale: -")}) == "", said)
    middle = sent(swing(), lambda code: code + 32768, joint=2)
    said = told(middle, {THIRD: THIRD.replace("i16", "u16")})
    check("a zero in the middle of an unsigned range is told", "joint 3: goes from" in said and "within them with offset: -3.14159" in said, said)
    check("and is right so", told(middle, {THIRD: THIRD.replace("i16", "u16") + ", offset: -3.14159265"}) == "", said)
    said = told(middle)
    check("and where it is read as signed", "give type: u16, offset: -3.14159, or wraps" in said, said)
    above = sent([(q, r, 0.6 + 0.2 * math.sin(i / 60)) for i, (q, r, s) in enumerate(swing())], lambda code: code + 32768, joint=2)
    said = told(above)
    check("also where it stays in one half", "joint 3: goes from" in said and "within them with type: u16, offset: -3.14159" in said and "sign?" not in said, said)
    complement = sent([(0.7, 0.6 + 0.25 * math.sin(i / 60), 0.5) for i in range(900)], lambda code: 65535 - code, joint=1)
    said = told(complement, {SECOND: SECOND.replace("i16", "u16")})
    check("the complement of a number is told", "joint 2: goes from 5.43" in said and "within them with type: i16, scale: -9.58738e-05\n" in said, said)
    amount = sent(swing(), lambda code: code if code >= 0 else 32768 - code)
    said = told(amount)
    check("sign and amount is told, which no type reads", "joint 1: jumps by half the range" in said and "two's complement" in said, said)

    # A scale that is too small.
    small = {f"scale: {SCALE:.9g}": f"scale: {SCALE / 4:.9g}"}
    said = told(sent(swing()), small)
    check("joints that all moved over a quarter of their way are told", said.startswith("nothing is wrong if") and "of the distance between their arm.limits" in said and "about 4.17 times too small" in said and "counts for each of its lines" in said, said)
    check("but not where one of them moved", told(sent(swing()), {SECOND: SECOND.replace(f"scale: {SCALE:.9g}", f"scale: {SCALE / 4:.9g}")}) == "", said)
    check("nor of an arm that stands still", told(sent(swing(0.0))) == "", told(sent(swing(0.0))))
    write(change=small)
    code, out, err = run("check", arm)
    check("check tells that positions end before the stops do", code == 0 and out.count("this field covers only ") == 3 and "expected a scale that is 1.53 times as large" in out, out)
    write(change={**small, ", limits: [[-1.2, 1.2], [-0.3, 0.9], [-1, 1]]": "", f"scale: {SCALE / 4:.9g}": f"scale: {SCALE / 16:.9g}"})
    code, out, err = run("check", arm)
    check("and without stops by the workspace", code == 0 and "limits.workspace: warning: 0.3 m is more than the tip can move: the positions in wire.input reach only " in out, out)
    for change in ({}, {", limits: [[-1.2, 1.2], [-0.3, 0.9], [-1, 1]]": ""}):
        write(change=change)
        code, out, err = run("check", arm)
        check("nothing of a scale that is right", code == 0 and "this field covers only" not in out and "limits.workspace" not in out, out)

    # A stream whose reports begin with a byte of their own, cut anywhere.
    def stream(cut, header=b"\xa5"):
        whole = b"".join(header + bytes.fromhex(line.decode()) for line in sent(swing()).splitlines())
        return whole[cut:]

    wider = {"size: 6\n      fields:\n        - {is: position": "size: 7\n      fields:\n        - {is: position", "joint: 1, at: 0": "joint: 1, at: 1",
             "joint: 2, at: 2": "joint: 2, at: 3", "joint: 3, at: 4": "joint: 3, at: 5"}

    def streamed(capture, change):
        text = ARM.split("    output:")
        for old, new in change.items():
            assert old in text[0], old
            text[0] = text[0].replace(old, new)
        open(arm, "w").write("    output:".join(text))
        code, out, err = run("device", "decode", arm, "--raw", given=capture)
        return code, out, err

    code, out, err = streamed(stream(0)[:-3], {})
    check("a header byte that the file leaves out is told", code == 1 and "0xa5 occurs every 7 bytes, first at byte 0: if it begins each report, give framing: {start: 0xa5} and wire.input size: 7 (it is 6)" in err, err)
    code, out, err = streamed(stream(4), {})
    check("in the middle of a stream too", "0xa5 occurs every 7 bytes, first at byte 3" in err, err)
    code, out, err = streamed(stream(4), wider)
    check("a capture that begins inside a report is told", "0xa5 occurs at byte 3 of the capture and every 7 bytes after it" in err and "give framing: {start: 0xa5}" in err, err)
    code, out, err = streamed(stream(0), wider)
    check("one that begins with a report is not", code == 0 and err.count("\n") == 1, err)
    code, out, err = streamed(stream(4), {**wider, "    input:\n": "    framing: {start: 0xa5}\n    input:\n"})
    told_rows = list(csv.DictReader(io.StringIO(out)))
    check("and with the mark its reports are found", "899 reports, 899 good" in err and abs(float(told_rows[0]["position1"]) - swing()[1][0]) < SCALE, (err, told_rows[:1]))

    # A line that stands at one level has one byte everywhere, at which every report could begin.
    sarcos = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "..", "config", "devices", "sarcos.yaml")

    def cost(capture):
        before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
        run("device", "decode", sarcos, "--raw", given=capture)
        return resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before

    level, noise = cost(b"U" * 1_000_000), cost(random.Random(1).randbytes(1_000_000))
    check("it costs no more than noise", level < 8 * noise, (level, noise))

    # What `device kinematics` writes is what `device encode` reads.
    write()
    joints, forces = os.path.join(folder, "joints.csv"), os.path.join(folder, "forces.csv")
    open(joints, "w").write("q1,q2,q3\n0.1,0.2,-0.3\n0.4,-0.1,0.5\n")
    open(forces, "w").write("q1,q2,q3,fx,fy,fz\n0.1,0.2,-0.3,0.5,0,0\n0.4,-0.1,0.5,0,-0.5,0.2\n")
    table = run("device", "kinematics", arm, "--joints", joints)[1]
    code, out, err = run("device", "encode", arm, "--from-arm", given=table.encode())
    back = list(csv.DictReader(io.StringIO(run("device", "decode", arm, given=out.encode())[1])))
    check("its joints are positions", code == 0 and len(back) == 2 and abs(float(back[1]["position3"]) - 0.5) < SCALE, (code, err, out))
    tips = "\n".join(",".join(row[axis] for axis in "xyz") for row in csv.DictReader(io.StringIO(table)))
    code, tip_out, err = run("device", "encode", arm, "--from-arm", given=("x,y,z\n" + tips + "\n").encode())
    check("its tip is reached by the same joints", code == 0 and tip_out == out, (code, err, tip_out, out))
    code, out, err = run("device", "encode", arm, "--from-arm", given=b"x,y,z\n5,0,0\n")
    check("a tip out of reach is told with its line", code == 2 and "line 2: the tip [5, 0, 0] is out of the arm's reach" in err and not out, (err, out))
    pushed = run("device", "kinematics", arm, "--joints", forces)[1]
    code, out, err = run("device", "encode", arm, given=pushed.encode())
    rows = list(csv.DictReader(io.StringIO(pushed)))
    plain = "\n".join(",".join(row[f"tau{i}"] for i in (1, 2, 3)) for row in rows) + "\n"
    check("its torques are torques", code == 0 and out == run("device", "encode", arm, given=plain.encode())[1] and len(out.splitlines()) == 2, (err, out))
    code, out, err = run("device", "encode", arm, given=table.encode())
    check("a table without forces says what it lacks", code == 2 and "without torques (tau1, ...)" in err and "fx,fy,fz" in err and not out, err)
    code, out, err = run("device", "encode", arm, "--from-arm", given=b"q1,q2,q3,speed\n0,0,0,1\n")
    check("another column is still named", code == 2 and '"speed"' in err, err)
    code, out, err = run("device", "encode", arm, "--from-arm", given=b"q1,position1\n0,1\n")
    check("a joint of two columns is refused", code == 2 and "position1 twice" in err, err)
finish()
