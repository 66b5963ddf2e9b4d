#!/usr/bin/env python3
"""Raw captures with bytes missing or too many are read on from the next report, and slips that a zero hides (wraps, the arm's own clock, units of motors, a workspace in mm) are named.

Usage: broken_captures.py HAPTICD       exit 1 when one is off
"""
import math
import os
import sys
import tempfile

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "support"))
from e2e import check, finish
from wire import fed, table_of

HAPTICD = sys.argv[1]
SCALE = 4.0e-5
ARM = """hapticd-device: 1
module: usb_hid
name: own arm
limits: LIMITS
parameters:
  usb: {id: "1209:0a0b"}
  arm: {kind: phantom, lengths: [LENGTHS, 0, 0, 0], masses: [0, 0, 0, 0], max_torque: [0.5], limits: [[-0.6, 0.6], [-0.5, 0.7], [-0.6, 0.6]]}
  calibration: {method: pose, pose: [0, 0, 0], instructions: "Hold it so."}
  wire:
    rate: RATE
    watchdog: 0.02
    input:
      id: 5
      size: SIZE
      fields:
        - {is: counter, at: 0, type: u16}
        - {is: position, joint: 1, at: 2, type: i24, scale: SCALE, wraps: true}
        - {is: position, joint: 2, at: 5, type: i24, scale: SCALE, wraps: true}
        - {is: position, joint: 3, at: 8, type: i24, scale: SCALE, wraps: true, offset: OFFSET}
        - {is: time, at: 11, type: u24, scale: TIME}
        - {is: checksum, at: 14, type: u16, method: crc16, from: 0, to: 14, over_id: true}
    output:
      size: 6
      fields:
        - {is: torque, joint: 1, at: 0, type: i16, scale: 4.0e-5}
        - {is: torque, joint: 2, at: 2, type: i16, scale: 4.0e-5}
        - {is: torque, joint: 3, at: 4, type: i16, scale: 4.0e-5}
"""
GOOD = {"LIMITS": "{force: 2}", "LENGTHS": "0.2, 0.17", "RATE": "1000", "SIZE": "16", "SCALE": f"{SCALE}", "TIME": "1.0e-6", "OFFSET": "0.05"}
folder = tempfile.mkdtemp()


def arm(**changed):
    text = ARM
    for word, value in {**GOOD, **changed}.items():
        text = text.replace(word, value)
    path = os.path.join(folder, "arm.yaml")
    with open(path, "w") as file:
        file.write(text)
    return path


run = fed(HAPTICD)


def decode(capture, **changed):
    code, out, err = run("device", "decode", arm(**changed), "-", *(["--raw"] if isinstance(capture, bytes) else []), given=capture if isinstance(capture, bytes) else capture.encode())
    return code, table_of(out), err


COUNT = 400
truth = [[round(a * math.sin(0.02 * i + k) / SCALE) * SCALE for k, a in enumerate((0.5, 0.45, 0.5))] for i in range(COUNT)]
table = "position1,position2,position3,sequence,clock\n" + "".join(f"{p[0]:.17g},{p[1]:.17g},{p[2] + 0.05:.17g},{i},{i * 0.001:.6f}\n" for i, p in enumerate(truth))
code, raw, err = run("device", "encode", arm(), "-", "--from-arm", "--raw", given=table.encode())
check("the capture is made", code == 0 and len(raw) == 17 * COUNT, (code, len(raw), err))

code, rows, err = decode(raw)
check("all reports are good", code == 0 and len(rows) == COUNT, (code, len(rows), err))
exact = all(float(row["position1"]) == round(p[0] / SCALE) * SCALE for row, p in zip(rows, truth))
check("numbers read back exactly", exact, rows[1] if rows else err)

code, rows, err = decode(b"\x07\x00\x01" + raw)
check("three stray bytes in front cost nothing", len(rows) == COUNT and all(r["verdict"] == "good" for r in rows), err)
code, rows, err = decode(raw[: 17 * 120 + 14] + raw[17 * 121 :])
bad = [r for r in rows if r["verdict"] != "good"]
check("a short report in the middle costs one", code == 1 and len(rows) == COUNT and len(bad) == 1 and bad[0]["verdict"] == "size", (len(rows), bad, err))
code, rows, err = decode(raw[: 17 * 120] + b"\x00\x00" + raw[17 * 120 :])
check("two bytes too many cost nothing", len(rows) == COUNT and "2 bytes outside of any report" in err, err)
flipped = bytearray(raw)
flipped[17 * 50 + 6] ^= 1
flipped[17 * 51 + 6] ^= 1
code, rows, err = decode(bytes(flipped))
check("corrupt reports in step stay reports", len(rows) == COUNT and sum(r["verdict"] == "corrupt" for r in rows) == 2, err)

code, rows, err = decode(raw, SCALE=f"{SCALE * 57.29578:.9g}")
check("degrees are seen in positions that wrap", "joint 1: moves over" in err and "times too large" in err, err)
code, rows, err = decode(raw, SCALE=f"{SCALE * 11:.9g}")
check("a forgotten gear is seen", "times too large" in err, err)
check("and none of it in the right file", "too large" not in decode(raw)[2] and "clock" not in decode(raw)[2], decode(raw)[2])
check("rate 100 contradicts the arm's clock", "give rate: 1000" in decode(raw, RATE="100")[2], decode(raw, RATE="100")[2])
check("a scale of time that is 1000 times too large", "scale of the field time that is 1000 times smaller" in decode(raw, TIME="1.0e-3")[2], decode(raw, TIME="1.0e-3")[2])
lines = "\n".join(raw[i : i + 17].hex(" ") for i in range(0, len(raw), 17)) + "\n"
short = "\n".join(line[: 3 * 16 - 1] for line in lines.splitlines()) + "\n"
code, rows, err = decode(short)
check("a size that counts the id is told", "size must not include the id; give wire.input size: 15" in err, err)


def warned(words, file):
    code, out, err = run("check", file)
    return check(words, words in (out.decode() + err) and code == 0, (code, out.decode() + err))


warned("is below 0", arm(LENGTHS="-0.2, 0.17"))
warned("offset_degrees: 50", arm(OFFSET="50"))
warned("90 m about the origin bounds nothing, because the tip is never farther", arm(LIMITS="{force: 2, workspace: 90}"))
motors = "{force: 2, motors: [" + ", ".join(["{torque_constant: KT, resistance: 2, ratio: GEAR}"] * 3) + "]}"
warned("30 mN m/A is 0.03 N m/A", arm(LIMITS=motors.replace("KT", "30").replace("GEAR", "11")))
warned("always too much", arm(LIMITS=motors.replace("KT", "0.03").replace("GEAR", "1")))
code, out, err = run("check", arm(LIMITS=motors.replace("KT", "0.03").replace("GEAR", "11")))
check("right motors are not warned of", "limits.motors" not in out.decode() + err, out.decode() + err)
code, out, err = run("check", arm(LIMITS="{force: 0}"))
check("force: 0 is refused", code == 2 and "limits.force: 0 N" in out.decode() + err, out.decode() + err)
code, out, err = run("device", "encode", arm(), "-", given=b"0.4,0.6,0.1\n")
check("torques above the motors are warned of", code == 0 and "above arm.max_torque of joint 2" in err, err)
code, out, err = run("device", "encode", arm(), "-", given=b"0.1 0.5 0.2\n")
check("the example has the user's numbers", "0.1,0.5,0.2" in err, err)
code, out, err = run("device", "kinematics", arm(), "--joints", "-", given=b"q1,q2,q3\n0,0.1,0.2\n")
check("kinematics takes standard input", code == 0 and out.decode().count("\n") == 2, err)
decoded = run("device", "decode", arm(), "-", "--raw", given=bytes(flipped))[1]
code, out, err = run("device", "kinematics", arm(), "--joints", "-", given=decoded)
tips = table_of(out)
check("kinematics takes the good rows that decode wrote", code == 0 and len(tips) == COUNT - 2
      and [float(row["q1"]) for row in tips[:50]] == [float(row["position1"]) for row in table_of(decoded)[:50]], (code, len(tips), err))
code, out, err = run("device", "new", "neg", "--no-questions", "--kind", "phantom", "--lengths", "-0.2,0.17", "-o", os.path.join(folder, "neg.yaml"))
check("device new refuses a length below 0", code == 2 and "--lengths" in err, (code, err))
finish()
