#!/usr/bin/env python3
"""Device files that their format allows and nobody means are told at the key; what ships and what is usual is not.

Usage: unusual_arms.py HAPTICD SOURCE     prints one line per case; exit 1 when one is off.
"""
import glob
import json
import os
import sys
import tempfile

HAPTICD, SOURCE = (os.path.abspath(one) for one in sys.argv[1:3])
sys.path.insert(0, os.path.join(SOURCE, "tests", "support"))
from arm_files import CHAIN, TWIN, WIRED
from e2e import check, finish, program

hapticd = program(HAPTICD)
PREMIUM = open(os.path.join(SOURCE, "config", "devices", "simulated-premium15.yaml")).read()
SARCOS = open(os.path.join(SOURCE, "config", "devices", "sarcos.yaml")).read()
IN, OUT = "parameters.wire.input.fields", "parameters.wire.output.fields"
READ = "joint: {0}, at: {1}, type: i16, scale: 9.6e-5"
SENT = "joint: {0}, at: {1}, type: i16, scale: 2.0e-5"
SECOND, FIRST_OUT = READ.format(2, 4), SENT.format(1, 0)

# What is given, what for, its key and a word that is told of it; a bar stands in front of the place.
CASES = [
    (WIRED, {SECOND: SECOND.replace("i16", "i16, endian: |big")}, f"{IN}[2].endian", "is big, but most other numbers of this report are little"),
    (WIRED, {SENT.format(n + 1, 2 * n): SENT.format(n + 1, 2 * n).replace("i16", "i16, endian: " + "|" * (n == 0) + "big") for n in range(3)},
     f"{OUT}[0].endian", "big in all of wire.output, but little in all of wire.input"),
    (WIRED, {SECOND: SECOND.replace("i16", "|u16")}, f"{IN}[2].type", "the types of the other joints are signed"),
    (WIRED, {SECOND: SECOND.replace("9.6e-5", "|0.0055")}, f"{IN}[2].scale", "scale_degrees: 0.0055"),
    (WIRED, {SECOND: SECOND.replace("9.6e-5", "|20000")}, f"{IN}[2].scale",
     "if it is the counts of a turn, write 2 pi / (counts of a motor turn * motor turns of one joint turn): 0.000314159"),
    (WIRED.replace("usb_hid", "usb_bulk"), {"    exchange": "    |exchange"}, "parameters.wire.endpoints", "not given, so {in: 0x81, out: 0x02} are used"),
    (WIRED, {READ.format(3, 6): READ.format(3, 6).replace("9.6e-5", "|9.6e-4")}, f"{IN}[3].scale", "10 times as coarse as that of any other"),
    (WIRED, {SENT.format(3, 4): SENT.format(3, 4).replace("2.0e-5", "|2.0e-4")}, f"{OUT}[2].scale", "measured by arm.max_torque"),
    (WIRED, {FIRST_OUT: FIRST_OUT.replace("1, at", "|3, at"), SENT.format(3, 4): SENT.format(1, 4)}, f"{OUT}[0].joint",
     "wire.input has joint 1 at this place"),
    (WIRED, {"        - {is: button": "        - {is: counter, at: |0, type: u16}\n        - {is: button"}, f"{IN}[4].at", "the counter of fields[0]"),
    (WIRED, {"method: crc16-modbus, from: 0, to: 10": "method: crc, polynomial: |0xA001, reflected: true, initial: 0xffff, from: 0, to: 10"},
     f"{IN}[5].polynomial", "0xa001 is 0x8005 with its bits reversed"),
    (WIRED, {SECOND: SECOND.replace("9.6e-5", "9.6e-5, offset: |3")}, f"{IN}[2].offset", "has no effect"),
    (WIRED, {"continuous_force: 2": "continuous_force: |8"}, "parameters.device.continuous_force", "more than the 5 N of device.max_force"),
    (WIRED, {"max_stiffness: 600": "max_stiffness: |0.6"}, "parameters.device.max_stiffness", "0.6 N/mm is 600 N/m"),
    (WIRED, {"max_stiffness: 600": "max_stiffness: |1000000"}, "parameters.device.max_stiffness", "no model would ever be called too stiff"),
    (WIRED, {"mass: 0.2": "mass: |75"}, "parameters.device.mass", "75 g is 0.075 kg"),
    (WIRED, {"lengths: [0.21": "lengths: [|0.021"}, "parameters.arm.lengths[0]", "nearer to its shoulder than 0.149 m"),
    (WIRED, {"lengths: [0.21, 0.17,": "lengths: |[0.021, 0.017,"}, "parameters.arm.lengths", "reaches 38 mm from its shoulder"),
    (WIRED, {"force: 2,": "force: |0.002,"}, "limits.force", "0.002 kN is 2 N"),
    (WIRED, {"from: 0, to: 8}": "from: 0, to: |6}"}, f"{OUT}[5].to", "leaves out enable, counter: a wrong one"),
    (WIRED, {"crc16-modbus, from: 0, to: 10}": "crc16-modbus, from: 2, to: |10}"}, f"{IN}[5].to", "leaves out counter: a wrong one"),
    (WIRED, {"{is: enable, at: 6, type: u8}": "{is: calibrate, at: 6, type: u8}\n        - {is: enable, at: |6, type: u8}"}, f"{OUT}[4].at",
     "these bits are already fields[3] (calibrate)"),
    (WIRED, {READ.format(2, 4): READ.format(2, 4).replace("9.6e-5", "|9.6e-8, wraps: true")}, f"{IN}[2].scale", "16 bits would wrap within arm.limits"),
    (WIRED, {READ.format(2, 4): READ.format(2, 4).replace("9.6e-5", "|9.6e-7, wraps: true")}, f"{IN}[2].scale", "100 times as fine as that of any other joint"),
    (WIRED.replace("mount: {position: [0, 0, 0.09]}\n", ""), {"hapticd-device": "|hapticd-device"}, "mount", "inside the shapes"),
    (WIRED.replace("{position: [0, 0, 0.09]}", "{}"), {"mount: {}": "mount: |{}"}, "mount", "inside the shapes"),
    (WIRED.replace("size: 12", "size: 14").replace("from: 0, to: 10}", "from: 0, to: 10}\n        - {is: velocity, joint: 1, at: 12, type: i16, scale: 1000}"),
     {"scale: 1000": "scale: |1000"}, f"{IN}[6].scale", "one count of the velocity of joint 1 is 1000 rad/s"),
    (CHAIN.replace("mount: {position: [-0.42, 0, 0.09]}\n", ""), {"hapticd-device": "|hapticd-device"}, "mount", "mount: {position: [-0.42, 0, 0.09]} puts"),
    (CHAIN, {"force: 2": "force: |200", "max_force: 5": "max_force: 500"}, "limits.force", "in half of twelve poses, as it rests stretched out"),
    (CHAIN, {"- [0.22, 0": "- [|2.2, 0"}, "parameters.arm.dh[1][0]", "was 0.22 m meant?"),
    (WIRED, {"force: 2,": "force: 2, slew: |2,"}, "limits.slew", "2 N/ms is 2000 N/s"),
    (WIRED, {"force: 2,": "force: 2, power: |0.0001,"}, "limits.power", "cannot be felt"),
    (WIRED, {"force: 2,": "force: 2, impulse: |0.0001,"}, "limits.impulse", "cannot be felt"),
    (WIRED, {"force: 2,": "force: 2, velocity: |0.05,"}, "limits.velocity", "a hand moves at 0.1 to 1 m/s"),
    (WIRED, {"force: 2,": "force: 2, velocity: |50,"}, "limits.velocity", "50 mm/s is 0.05 m/s"),
    (WIRED, {"force: 2,": "force: 2, weight: |200,"}, "limits.weight", "would throw the arm"),
    (WIRED, {"mount:": "admittance: |{mass: 1, damping: 10}\nmount:"}, "admittance", "no field {is: torque}"),
    (WIRED, {"      size: 12": "      id: |3\n      size: 12"}, "parameters.wire.input.id", "numbers all of its reports or none"),
    (WIRED, {"        - {is: button": "        - {is: time, at: 9, type: u8, scale: |1}\n        - {is: button"}, f"{IN}[4].scale", "clock is 1 s"),
    (TWIN, {"hand:": "  joint: {friction: |5}\nhand:"}, "parameters.joint.friction", "5 mN m is 0.005 N m"),
    (TWIN, {"hand:": "  joint: {damping: |10}\nhand:"}, "parameters.joint.damping", "drags with"),
    (TWIN, {"hand:": "  joint: {gear: 1000, rotor: |1}\nhand:"}, "parameters.joint.rotor", "1 g cm^2 is 1e-7"),
    (TWIN, {"hand:": "  substep: |0.01\nhand:"}, "parameters.substep", "longer than a tick"),
    (TWIN, {"hand:": "  joint: {motor_lag: |0.5}\nhand:"}, "parameters.joint.motor_lag", "0.5 ms is 0.0005 s"),
    (TWIN, {"hand:": "  device: {rate: |10}\nhand:"}, "parameters.device.rate", "10 kHz is 10000"),
    (CHAIN, {"[0.2, 0, 0, 0]": "[0.2, 0, 0, 0]\n    masses: [0.1, 0.1, 0.1]\n    centers: |[[0, 0, 0], [-10, 0, 0], [-10, 0, 0]]"}, "parameters.arm.centers",
     "pull the tip up"),
    (WIRED, {"max_torque: [0.6]": "max_torque: [|0, 0.6, 0.6]"}, "parameters.arm.max_torque[0]", "0 is no bound"),
    (CHAIN, {"    dh:": "    base_orientation: |[0, 0, 0, 1]\n    dh:"}, "parameters.arm.base_orientation", "half turn about z"),
    (TWIN, {"masses: [0.03, 0, 0.05, 0]": "masses: |[30, 0, 50, 0]"}, "parameters.arm.masses", "30 g is 0.03 kg"),
    (PREMIUM, {"force: 8.5": "force: |0.0085"}, "limits.force", "0.0085 kN is 8.5 N"),
    (PREMIUM, {"force: 8.5": "force: |850"}, "limits.force", "850 mN is 0.85 N"),
    (PREMIUM, {"force: 8.5": "force: |12"}, "limits.force", "12 N is more than the 8.5 N of the arm"),
    (PREMIUM, {"  seed: 1": "  joint: {gear: 0.1, counts: |4}"}, "parameters.joint.counts", "one count moves the tip by"),
]

CASES += [
    (WIRED.replace("method: pose, pose: [0, 0, 0]", "method: none").replace("i16, scale: 9.6e-5", "u16, scale: 9.6e-5, offset: -3.14159"),
     {"at: 4, type: u16, scale: 9.6e-5, offset: -3.14159": "at: 4, type: u16, scale: 9.6e-5, offset: |+3.14159"}, f"{IN}[2].offset",
     "has the wrong sign: this field covers 3.142 to 9.433 rad, and arm.limits of joint 2 go from -0.3 to 0.9; with the other sign it covers -3.142 to 3.15 rad: expected offset: -3.14159"),
    (WIRED.replace("scale: 9.6e-5", "scale: 9.6e-6, wraps: true"), {"at: 6, type: i16, scale: 9.6e-6": "at: 6, type: i16, scale: |5.5e-4"}, f"{IN}[3].scale",
     "57.3 times as coarse as that of any other joint: if it is in degrees, write scale_degrees: 0.00055"),
    (WIRED, {SECOND: SECOND.replace("9.6e-5", "9.6e-5, offset: |-524288")}, f"{IN}[2].offset", "if it is in counts, multiply it by scale: offset: -50.3316"),
    (WIRED, {SECOND: SECOND.replace("9.6e-5", "9.6e-5, offset: |90")}, f"{IN}[2].offset", "write offset_degrees: 90"),
    (WIRED, {"max_torque: [0.6]": "max_torque: |[600]"}, "parameters.arm.max_torque", "these torques give 5370 N at the tip"),
    (WIRED, {"lengths: [0.21, 0.17, 0.03, 0, 0]": "lengths: |[0,2, 0,2, 0]"}, "parameters.arm.lengths", "write 0.2, not 0,2"),
]

MOTOR = "{torque_constant: 0.0259, resistance: 2.3, ratio: 12}"
MOTORS = f"motors: [{MOTOR}, {MOTOR}, {MOTOR}], "
ROWS = """      - [0, 1.5707963, 0, 0]
      - [0.22, 0, 0, 0]
      - [0.2, 0, 0, 0]
"""
CASES += [
    (CHAIN, {ROWS: """      - [0, 0.15, 0, 1.5707963]
      - |[0, 0, 0.22, 0]
      - [0, 0, 0.2, 0]
"""}, "parameters.arm.dh[1]", "theta, d, a, alpha: expected [0.22, 0, 0, 0] here"),
    (CHAIN, {"- [0, 1.5707963, 0, 0]": "- [|1.5707963, 0.01, 0, 0]"}, "parameters.arm.dh[0][0]", "a quarter of a turn in rad"),
    (CHAIN, {"    dh:": "    lengths: |[0.2, 0.2]\n    dh:"}, "parameters.arm.lengths", "a chain has no lengths"),
    (WIRED, {"[[-1.2, 1.2]": "[|[0, 0]"}, "parameters.arm.limits[0]", "joint 1 cannot move"),
    (WIRED, {"workspace: 0.3": "workspace: |0.01"}, "limits.workspace", "a hand is farther away at once"),
    (WIRED, {"force: 2, ": "force: 2, " + MOTORS.replace("0.0259", "|25.9", 1)}, "limits.motors[0].torque_constant", "25.9 mN m/A is 0.0259 N m/A"),
    (WIRED, {"force: 2, ": "force: 2, " + MOTORS.replace("ratio: 12", "ratio: |0.0833", 1)}, "limits.motors[0].ratio", "12 if it was inverted"),
    (PREMIUM, {"force: 8.5": "force: 8.5, " + MOTORS.replace("2.3", "|2300", 1).rstrip(", ")}, "limits.motors[0].resistance", "2300 mohm is 2.3 ohm"),
    (WIRED, {"force: 2, ": "force: 2, " + MOTORS.replace("ratio: 12", "ratio: 12, housing_time: |10", 1)}, "limits.motors[0].housing_time", "10 min is 600 s"),
    (TWIN, {"hand:": "  delay: |16\nhand:"}, "parameters.delay", "stiffer than about 303 N/m may bounce"),
]
BIG = {SENT.format(n + 1, 2 * n): SENT.format(n + 1, 2 * n).replace("i16", "i16, endian: big") for n in range(3)}
# What is unusual and right: nothing is told of it.
RIGHT = [
    (WIRED, BIG | {"{is: checksum, at: 10, type: u16,": "{is: checksum, at: 10, type: u16, endian: big,"}),
    (WIRED, {"force: 2, ": "force: 2, " + MOTORS}),
    (WIRED, {"workspace: 0.3": "workspace: 0.1"}),
    (TWIN, {"hand:": "  delay: 1\nhand:"}),
    (CHAIN, {"- [0.22, 0, 0, 0]": "- [0.22, 0, 0.03, 0]", "[0.2, 0, 0, 0]": "[0.2, 3.1415927, 0, 0]"}),
]

# What no run could begin with is an error of the device file alone.
REFUSED = [
    (TWIN, {"    masses": "    max_torque: |[0.5, 0.4]\n    masses"}, "parameters.arm.max_torque", "2 numbers, expected 1 or 3"),
    (TWIN, {"rate: 1,": "rate: 1, axis: |[0, 0, 0],"}, "hand.axis", "expected a direction"),
    (TWIN, {"center: [0, 0, -0.09]": "center: |[0, 0, -0.9]"}, "hand", "which the arm cannot reach"),
    (TWIN, {"kind: phantom": "kind: premium15", "lengths: [": "lengths: |["}, "parameters.arm.lengths", "expected arm.kind phantom"),
    (TWIN, {"kind: phantom": "kind: premium15", "    lengths: [0.21, 0.17, 0, 0, 0]\n": "", "masses: [": "masses: |["}, "parameters.arm.masses",
     "a premium15 has fixed masses"),
    (TWIN, {"{force: 2}": "{force: 2, enable: {button: |1}}"}, "limits.enable.button", "the device has 0 buttons"),
    (WIRED, {"lengths: [0.21, 0.17, 0.03, 0, 0]": "lengths: |[0,2, 0,18, 0, 0, 0]"}, "parameters.arm.lengths", "zeros and whole numbers take turns; a comma separates two numbers: write 0.2, not 0,2"),
    (WIRED, {"lengths: [0.21, 0.17, 0.03, 0, 0]": "lengths: |[0,2, 0,9, 0, 0, 0]"}, "parameters.arm.lengths", "expected 5 for this kind of arm; a comma separates two numbers: write 0.2, not 0,2"),
    (WIRED, {"max_torque: [0.6]": "max_torque: |[0,6, 0,6]"}, "parameters.arm.max_torque", "write 0.6, not 0,6"),
    (WIRED, {"lengths: [0.21, 0.17, 0.03, 0, 0]": "lengths: |[0, 2, 1]"}, "parameters.arm.lengths", "3 numbers, expected 5 for this kind of arm\n"),
    (WIRED, {"lengths: [0.21": "lengths: [|21"}, "parameters.arm.lengths[0]", "21 mm is 0.021 m, and 21 cm is 0.21 m\n"),
    (WIRED, {"hapticd-device: 1\n": "hapticd-device: 1\n|verified: true\n"}, "verified",
     "it is a parameter of usb_hid: expected parameters: {device: {verified: true}}"),
    (WIRED, {"hapticd-device: 1\n": "hapticd-device: 1\n|device: {verified: true}\n"}, "device",
     "it is a parameter of usb_hid: expected parameters: {device: {verified: true}}\n"),
    (WIRED, {"hapticd-device: 1\n": "hapticd-device: 1\n|id: '1:2'\n"}, "id", 'expected parameters: {usb: {id: "1:2"}}'),
    (WIRED, {"lengths: [0.21": "lengths: [|205"}, "parameters.arm.lengths[0]", "205 mm is 0.205 m\n"),
]

TWIN_CHAIN = TWIN[:TWIN.index("    kind")] + "    kind: chain\n    dh:\n" + ROWS + "hand: {script: none}\n"
# Several mistakes in one file, all of them told at once: a mistake in one key stops no judgement of another.
TOGETHER = [
    (TWIN, {"[0.21, 0.17,": "[210, 170,", "[0.03, 0, 0.05, 0]": "[30, 0, 50, 0]\n    max_torque: [500, 400, 400]"},
     {"arm.lengths[0]": "210 mm is 0.21 m", "arm.masses": "50 g is 0.05 kg", "arm.max_torque": "500 N mm is 0.5 N m"}),
    (TWIN_CHAIN, {"    dh:": "    limits: [[-1, 1], [-1, 1]]\n    masses: [1]\n    base_orientation: [0.7, 0.7, 0.7, 0]\n    base_position: [-30, 0, 0]\n    dh:"},
     {"arm.limits": "2 rows, expected 3", "arm.masses": "1 rows, expected 3", "arm.base_orientation": "expected a unit quaternion",
      "arm.base_position[0]": "-30 mm is -0.03 m"}),
    (TWIN_CHAIN, {ROWS: "      - [0, 0.15, 0, 90]\n      - [0, 0, 0.22, 0]\n      - [0, 0, 0.2, 0]\n"},
     {"arm.dh[0][3]": "90 degrees is 1.57", "arm.dh[1]": "theta, d, a, alpha"}),
    (WIRED, {"from: 0, to: 10}": "from: 0, to: 12}", SECOND: SECOND.replace("9.6e-5", "9.2e-2"), FIRST_OUT: FIRST_OUT.replace("i16", "u16"),
             SENT.format(2, 2): SENT.format(2, 2).replace("2.0e-5", "2.0e-2")},
     {"wire.input.fields[5].to": "so the checksum covers itself", "wire.input.fields[2].scale": "scale_degrees: 0.092",
      "wire.output.fields[0].type": "expected both signs", "wire.output.fields[1].scale": "0.02 N mm is 2e-05 N m"}),
    (WIRED, {"usb_hid": "usb-hid", "1209:0a0a": "0x1209:0x0a0a", "pose: [0, 0, 0]": "pose: [0, 45, 30]"},
     {"module": "did you mean", "usb.id": "", "calibration.pose": "45 degrees is 0.7854 rad"}),
    (WIRED, {"force: 2, ": "force: 40, slew: 2, ramp_in: 250, velocity: 0.02, ", "workspace: 0.3": "workspace: 0.01"},
     {"limits.ramp_in": "250 ms is 0.25 s", "limits.slew": "2 N/ms is 2000 N/s", "limits.velocity": "its first stroke would be a fault",
      "limits.workspace": "a hand is farther away at once", "limits.force": "N"}),
    (WIRED, {"force: 2, ": "force: 2, slew: 0, torque_slew: 0, velocity: 0, "},
     {"limits.slew": "0 means no limit", "limits.torque_slew": "0 means no limit", "limits.velocity": "0 means no limit"}),
    (WIRED, {"[0.21, 0.17": "[0.21, 17", "method: pose": "method: device", "max_stiffness: 600": "max_stiffness: 0.6", "mass: 0.2": "mass: 100"},
     {"arm.lengths[1]": "17 mm is 0.017 m", "calibration.method": "no field of wire.input", "device.max_stiffness": "0.6 N/mm is 600 N/m",
      "device.mass": "100 g is 0.1 kg"}),
    (CHAIN, {"1.5707963": "90", "[-0.3, 0.9], [-1, 1]": "[0.9, -0.3]", "max_torque: [0.6]": "max_torque: [0.6, 0.6]"},
     {"arm.dh[0][1]": "90 degrees is 1.57", "arm.limits": "2 rows, expected 3", "arm.limits[1]": "the smaller number first",
      "arm.max_torque": "2 numbers, expected 1 or 3"}),
    (WIRED, {"crc16-modbus, from: 0, to: 10": "crc-16, from: 0, to: 10", SECOND: SECOND.replace("9.6e-5", "1.6e-5")},
     {"wire.input.fields[5].method": "did you mean", "wire.input.fields[2].scale": "arm.limits of joint 2 go from"}),
    (WIRED, {"[0, 0, 0.09]}": "[0, 0, 0.09], orientation: [0, 180, 0, 0]}", "pose: [0, 0, 0]": "pose: [0, 1.57, 1.57]"},
     {"mount.orientation": "expected a unit quaternion", "calibration.pose[1]": "beyond arm.limits of joint 2"}),
    (WIRED, {"crc16-modbus, from: 0, to: 10": "crc, polynomial: 0x18005, from: 0, to: 10", SECOND: SECOND.replace("9.6e-5", "0.018")},
     {"wire.input.fields[5].polynomial": "a whole number of 16 bits; without its highest bit it is 0x8005", "wire.input.fields[2].scale": "scale_degrees: 0.018"}),
    (WIRED, {"module: usb_hid": "module: hid", "1209:0a0a": "1209-0a0a", "max_torque: [0.6]": "max_torque: [500]"},
     {"module": "judged as those of usb_hid", "usb.id": "vendor:product", "arm.max_torque": "500 N mm is 0.5 N m"}),
    (WIRED, {"usb_hid": "usb_bulk", "exchange: stream": "exchange: stream\n    framing: {start: 7e, end: 0x7e, escape: {mark: 0x7d}}"},
     {"wire.framing.start": "if it is hexadecimal, write 0x7e", "wire.input.fields[0].at": "where framing.start puts its mark 0x7e",
      "wire.output.fields[5].at": "where framing.end puts its mark"}),
    (WIRED, {"method: pose, pose: [0, 0, 0]": "method: homing, pose: [0, 90]"},
     {"calibration.method": "expected one of none, device, pose", "calibration.pose": "90 degrees is 1.571 rad"}),
    (WIRED, {"method: pose, pose: [0, 0, 0]": "method: homing, pose: [0, 0]"}, {"calibration.pose": "2 numbers, expected 3"}),
    (WIRED, {"[[-1.2, 1.2], [-0.3, 0.9], [-1, 1]]": "[[1, -1], [-45, 45]]"},
     {"arm.limits": "45 degrees is 0.7854 rad", "arm.limits[0]": "the smaller number first"}),
    (WIRED, {"[[-1.2, 1.2], [-0.3, 0.9], [-1, 1]]": "[[1, -1], [-0.8, 0.8]]"}, {"arm.limits": "2 rows, expected 3"}),
    (WIRED, {"parameters:": "hd: {joints: [[0], [1], [3]], buttons: [2]}\nparameters:", "  calibration:": "  health: {stale: 0.001}\n  calibration:"},
     {"hd.joints[2][0]": "expected 0 to 2", "hd.buttons[0]": "its only button"}),
    (WIRED, {"  calibration:": "  health: {stale: 0.001}\n  calibration:"}, {"health.stale": "one late report switches the motors off"}),
    (WIRED, {SENT.format(1, 0): SENT.format(1, 0).replace("2.0e-5", "-2.0e-5"), SENT.format(3, 4): SENT.format(3, 4).replace("2.0e-5", "-2.0e-5")},
     {"wire.output.fields[0].scale": "of joint 1, 3 have opposite signs"}),
    (WIRED, {"kind: phantom": "kind: delat", "[0.21, 0.17, 0.03, 0, 0]": "[0.06, 0.1, 0.015, 0.025, 0.015]"},
     {"arm.kind": "did you mean \"delta\"", "arm.lengths": "expected 8"}),
    (WIRED, {READ.format(3, 6): READ.format(2, 6)},
     {"wire.input.fields[3].joint": "fields[2] is the position of joint 2 already", "wire.input.fields": "no position of joint 3"}),
    (CHAIN, {ROWS: "", "    dh:\n": "", READ.format(3, 6): READ.format(4, 6), FIRST_OUT: FIRST_OUT.replace("2.0e-5", "2.0")},
     {"arm.dh": "has no rows", "wire.input.fields[3].joint": "from 1 to 3", "wire.output.fields[0].scale": "most torques would be sent as 0"}),
    (CHAIN, {ROWS: "", "    dh:\n": "", "    limits: [[-1.2, 1.2], [-0.3, 0.9], [-1, 1]]\n": "", READ.format(3, 6): READ.format(4, 6)},
     {"arm.dh": "has no rows", "wire.input.fields": "no position of joint 3"}),
    (WIRED, {"module: usb_hid": "module: vme_bus", "watchdog: 0.02": "watchdog: 20"},
     {"module": "judged as those of vme", "usb": "unknown parameter of vme", "vme.window": "missing", "wire.watchdog": "20 ms is 0.02 s"}),
    ("hapticd-device: 1\nmodule: haply\nname: mine\nlimits: {force: -2}\nparameters: {url: localhost, rate: 5}\n", {},
     {"module": "judged as those of haply_service", "limits.force": "out of range", "url": "unknown parameter", "rate": "out of range"}),
    (SARCOS, {"/m0": "/m9", "size: 0x10000": "size: 0x100", "command: 0x100": "command: 0x020"},
     {"vme.window": "expected /dev/bus/vme/m0 to m3", "vme.size": "multiple of 64 KiB", "vme.command": "overlaps the state block"}),
    (PREMIUM, {"premium15}": "premium1.5}", "substep: 0.0002": "substep: 0.2"}, {"arm.kind": "did you mean \"premium15\"", "substep": "0.2 ms is 0.0002 s"}),
    (WIRED, {"method: pose, pose: [0, 0, 0]": "method: device", SENT.format(3, 4): SENT.format(4, 4)},
     {"calibration.method": "no field of wire.input", "wire.output.fields[2].joint": "from 1 to 3"}),
    (TWIN_CHAIN, {"    dh:": "    masses: [1]\n    dh:", "parameters:\n": "parameters:\n  joint: {damping: [1, 1], friction: [0.1, 0.1], motor_lag: -1}\n"},
     {"joint.motor_lag": "out of range", "joint.damping": "2", "joint.friction": "2", "arm.masses": "expected 3"}),
]
CLOCK = WIRED.replace("        - {is: button", "        - {is: time, at: 9, type: u8, scale: 1}\n        - {is: button")
TOGETHER += [
    (CLOCK, {"rate: 1000": "rate: 1", "watchdog: 0.02": "watchdog: 20"},
     {"wire.rate": "1 kHz is 1000 Hz", "wire.watchdog": "20 ms is 0.02 s", "wire.input.fields[4].scale": "clock is 1 s, and a report comes every 0.001 s"}),
    (WIRED, {"type: u16, method: crc16-modbus, from: 0, to: 10": "type: u61, method: crc16-modbus, from: 4, to: 10"},
     {"wire.input.fields[5].type": "expected u16 for crc16-modbus", "wire.input.fields[5].to": "leaves out counter, position 1"}),
    (WIRED, {"    output:": "    ouput:", SENT.format(2, 2): SENT.format(2, 2).replace("2.0e-5", "2.0e-2")},
     {"wire.ouput": "did you mean \"output\"", "wire.output.fields[1].scale": "0.02 N mm is 2e-05 N m"}),
    (WIRED, {"parameters:": "parameter:", "  wire:": "  wrie:", SECOND: SECOND.replace("9.6e-5", "1.6e-5")},
     {"parameter": "did you mean \"parameters\"", "wrie": "did you mean \"wire\"", "wire.input.fields[2].scale": "arm.limits of joint 2 go from"}),
]
# The keys beside which nothing else may be told, because it would follow from the same mistake.
ALONE = [
    (WIRED, {"max_torque: [0.6]": "max_torque: [500]"}, ["parameters.arm.max_torque"]),
    (WIRED, {"type: u16, method: crc16-modbus, from: 0, to: 10": "type: u61, method: crc16-modbus, from: 0, to: 10"}, [f"{IN}[5].type"]),
    (WIRED, {"[-1.2, 1.2]": "[1.2, -1.2]", READ.format(1, 2): READ.format(1, 2).replace("9.6e-5", "6e-6"), SECOND: SECOND.replace("9.6e-5", "6e-6")},
     ["parameters.arm.limits[0]", f"{IN}[1].scale", f"{IN}[2].scale"]),
    (WIRED, {"max_torque: [0.6]": "max_torque: [500]", "force: 2, ": "force: 5000, "}, ["limits.force", "parameters.arm.max_torque"]),
]


def together(folder):
    files = []
    for i, (text, changes, _) in enumerate(TOGETHER + ALONE):
        file, _ = written(os.path.join(folder, f"together{i}.yaml"), text + "|", changes)
        files.append(file)
    done = hapticd("check", "--json", *files)
    told = {one["file"]: one for one in json.loads(done.stdout)["files"]}
    for file, (_, _, keys) in zip(files[len(TOGETHER):], ALONE):
        all_told = told[file]["problems"] + told[file]["warnings"]
        check(f"{os.path.basename(file)} tells nothing that follows", sorted(one["key"] for one in all_told) == keys
              and not any("only 0 N" in one["what"] for one in all_told), all_told)
    for file, (_, _, wanted) in zip(files, TOGETHER):
        all_told = {w["key"]: w["what"] for w in told[file]["problems"] + told[file]["warnings"]}
        for key, word in wanted.items():
            found = all_told.get(key, all_told.get("parameters." + key))
            check(f"{os.path.basename(file)} tells {key} at once", found is not None and word in found, all_told)


def strict(folder):
    """A limit that leaves nothing to feel is told at the device file, not at a model."""
    scene = os.path.join(SOURCE, "config", "scenes", "sphere.yaml")
    file, place = written(os.path.join(folder, "near.yaml"), PREMIUM, {"force: 8.5": "force: 8.5, impulse: |0.002"})
    done = hapticd("check", scene, "--device", file)
    check("a limit that cuts all is told where it stands", f"{place}: limits.impulse: warning: this limit cuts the force" in done.stdout
          and "stiffness" not in done.stdout, done.stdout)
    weak, _ = written(os.path.join(folder, "weak.yaml"), PREMIUM + "|", {"arm: {": "arm: {max_torque: [0.02], "})
    done = hapticd("check", scene, "--device", weak)
    check("the motors' bound has the name of its key", ": arm.max_torque cuts the force in" in done.stdout and "limits.motors" not in done.stdout, done.stdout)
    done = hapticd("run", scene, "--device", weak, "--virtual-time", "--for", "2")
    check("also in the summary of a run", "arm.max_torque: " in done.stdout + done.stderr and "motors (torque)" not in done.stdout + done.stderr, done.stdout + done.stderr)
    file, place = written(os.path.join(folder, "slow.yaml"), PREMIUM, {"force: 8.5": "force: 8.5, velocity: |0.02"})
    with open(scene) as text:
        own = text.read().replace("../", f"{SOURCE}/config/")
    device = [line for line in own.splitlines() if line.startswith("device:")]
    named = os.path.join(folder, "slow_scene.yaml")
    with open(named, "w") as out:
        out.write(own.replace(device[0], f"device: {file}") if device else own + f"device: {file}\n")
    done = hapticd("check", named)
    both, place2 = written(os.path.join(folder, "both.yaml"), PREMIUM, {"force: 8.5": "force: 8.5, " + MOTORS.replace("0.0259", "|25.9", 1).rstrip(", ")})
    for i, change in enumerate((lambda text: text, lambda text: text.replace("radius:", "radios:"))):
        other = os.path.join(folder, f"other{i}.yaml")
        with open(other, "w") as out:
            out.write(change(own.replace(device[0], f"device: {both}")))
        told = hapticd("check", other)
        check(f"a scene {'with' if i else 'without'} mistakes tells those of its device", told.returncode == 2 * i and ("radios" in told.stdout) == bool(i)
              and f"{os.path.realpath(both)}{place2[len(both):]}: limits.motors[0].torque_constant: warning" in told.stdout, told.stdout)
    check("a fault that the hand meets is told", f"{os.path.realpath(file)}{place[len(file):]}: limits.velocity: warning: the tip of" in done.stdout, done.stdout)


def refused(folder):
    for i, (text, changes, key, word) in enumerate(REFUSED):
        file, place = written(os.path.join(folder, f"refused{i}.yaml"), text, changes)
        done = hapticd("check", file)
        check(f"refused: {key}: {word.strip()}", done.returncode == 2 and f"{place}: {key}: " in done.stdout and word in done.stdout, done.stdout)
    # A scene tells all of it, too, at the places there.
    file, _ = written(os.path.join(folder, "two.yaml"), WIRED, {"rate: 1000": "rate: |1", "watchdog: 0.02": "watchdog: 20"})
    scene = os.path.join(folder, "scene.yaml")
    with open(scene, "w") as out:
        out.write(f"hapticd: 1\ndevice: two.yaml\nmodels:\n  - {{name: ball, plugin: nurbs_rigid, parameters: {{geometry: {SOURCE}/config/models/sphere.yaml}}}}\n")
    done = hapticd("check", scene)
    told = [line for line in done.stdout.splitlines() if f"{os.path.realpath(file)}:" in line]
    chain = os.path.join(folder, "chain.yaml")
    with open(chain, "w") as out:
        out.write(CHAIN.replace("mount: {position: [-0.42, 0, 0.09]}\n", ""))
    base = hapticd("check", os.path.join(SOURCE, "config", "scenes", "sphere.yaml"), "--device", chain)
    check("a chain without a mount stands in a sphere", f"{chain}:1:1: mount: warning: mine stands with its base in the middle of sphere" in base.stdout, base.stdout)
    new = hapticd("device", "new", "a3", "--no-questions", "--checksum", "crc9", cwd=folder)
    check("a checksum without a name writes nothing", new.returncode == 2 and "--checksum crc9: no checksum has this name" in new.stderr
          and not os.path.exists(os.path.join(folder, "a3.yaml")), new)
    for given, meant in (("CRC16", "crc16"), ("modbus", "crc16-modbus"), ("crc-32", "crc32"), ("summ", "sum")):
        new = hapticd("device", "new", "a3", "--no-questions", "--checksum", given, cwd=folder)
        check(f"for the checksum {given} a name is proposed", new.returncode == 2 and f'did you mean "{meant}"?' in new.stderr, new)
    for count in (0, 1, 3):
        new = hapticd("device", "new", f"buttons{count}", "--no-questions", "--buttons", f"{count}", cwd=folder)
        report = hapticd("device", "decode", f"buttons{count}.yaml", "-", cwd=folder, input="00 " * 8 + ("ff" if count else "")).stdout
        row = dict(zip(*(line.split(",") for line in report.splitlines()[:2])))
        check(f"an arm with {count} buttons reports so many", new.returncode == 0 and int(row.get("buttons", 0)) == 2**count - 1, (new, report))
    double = os.path.join(folder, "double.yaml")
    with open(double, "w") as out:
        out.write(WIRED.replace("exchange: stream", "exchange: pull").replace("joint: 2, at: 4", "joint: 1, at: 4"))
    checked = hapticd("check", double)
    twin = hapticd("device", "twin", double, cwd=folder)
    problems = [line for line in checked.stdout.splitlines() if line.startswith(double) and ": warning: " not in line]
    check("a twin of a faulty file is refused with the problems that check tells", twin.returncode == 2 and len(problems) == 3 and all(line in twin.stderr for line in problems)
          and not os.path.exists(os.path.join(folder, "double-twin.yaml")), (problems, twin))
    short, _ = written(os.path.join(folder, "short.yaml"), WIRED, {"lengths: [0.21, 0.17,": "lengths: |[0.021, 0.017,"})
    twin = hapticd("device", "twin", short, cwd=folder)
    check("a twin that does not reach its hand is told the lengths, too", twin.returncode == 1 and "arm.lengths or arm.limits" in twin.stderr, twin)
    decoded = hapticd("device", "decode", short, "none.txt", cwd=folder)
    check("a capture that is not there is told once", decoded.returncode == 2 and decoded.stderr.count("expected") == 1 and "hapticd device record" in decoded.stderr, decoded)
    soft, _ = written(os.path.join(folder, "soft.yaml"), WIRED, {"max_stiffness: 600": "max_stiffness: |0.6"})
    stiff = hapticd("check", os.path.join(SOURCE, "config", "scenes", "sphere.yaml"), "--device", soft)
    check("a model is not blamed for an arm in N/mm", "as its device.max_stiffness says" in stiff.stdout and "expected at most 0.6 N/m" not in stiff.stdout, stiff.stdout)
    check("a scene tells all of its device", done.returncode == 2 and len(told) == 2 and all("parameters.wire." in line for line in told), done.stdout)


def degrees(folder):
    """Limits in degrees are told at once, and nothing is told that follows from them."""
    rad = "[[-1.2, 1.2], [-0.3, 0.9], [-1, 1]]"
    for i, (limits, words) in enumerate((("[[-70, 70], [10, 50], [-60, 60]]", ("70 rad is more than a whole turn, and so are -70, 10, 50, -60, 60; the values",)),
                                         ("[[-120, 120], [10, 50], [-60, 60]]", ("[0][0]: -120 rad is out of range", "60 rad is more than a whole turn, and so are 10, 50, -60;")))):
        file = os.path.join(folder, f"degrees{i}.yaml")
        with open(file, "w") as out:
            out.write(WIRED.replace(rad, limits))
        done = hapticd("check", file)
        check(f"limits in degrees are told at once: {limits}", all(word in done.stdout for word in words) and "inverse()" not in done.stdout, done.stdout)


def written(file, text, changes):
    """The file without its bar, and the place of it."""
    for old, new in changes.items():
        assert old in text, (file, old)
        text = text.replace(old, new, 1)
    before = text[:text.index("|")]
    with open(file, "w") as out:
        out.write(text.replace("|", "", 1))
    return file, f"{file}:{before.count(chr(10)) + 1}:{len(before) - before.rfind(chr(10))}"


def right():
    files = glob.glob(os.path.join(SOURCE, "config", "devices", "*.yaml")) + glob.glob(os.path.join(SOURCE, "devices", "*", "*.yaml"))
    check("there are devices that ship", len(files) >= 9, files)
    return sorted(files)


def main():
    with tempfile.TemporaryDirectory() as folder:
        placed = []
        for i, (text, changes, key, word) in enumerate(CASES):
            file, place = written(os.path.join(folder, f"arm{i}.yaml"), text, changes)
            placed.append((file, place, key, word))
        usual = []
        for i, (text, changes) in enumerate([(one, {}) for one in (WIRED, TWIN, PREMIUM, CHAIN)] + RIGHT):
            usual.append(os.path.join(folder, f"usual{i}.yaml"))
            written(usual[-1], text + "|", changes)
        ships = right()
        done = hapticd("check", "--json", *(one[0] for one in placed), *usual, *ships)
        told = {one["file"]: one for one in json.loads(done.stdout)["files"]}
        for file, place, key, word in placed:
            lines = [f"{w['file']}:{w['line']}:{w['column']}: {w['key']}: {w['what']}" for w in told[file]["warnings"]]
            own = [line for line in lines if line.startswith(f"{place}: {key}: ")]
            check(f"{key}: {word}", told[file]["ok"] and len(own) == 1 and word in own[0], lines)
        for file in usual + ships:
            odd = [w["what"] for w in told[file]["warnings"] if "sustains" not in w["what"]]
            check(f"{os.path.basename(file)} is as it should be", told[file]["ok"] and not odd, odd)
        refused(folder)
        degrees(folder)
        together(folder)
        strict(folder)
    finish()


main()
