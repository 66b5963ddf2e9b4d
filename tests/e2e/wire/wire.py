# SPDX-License-Identifier: MIT
"""What the tests of wire formats share: the program fed with bytes, the table that it prints, and a checksum."""
import csv
import io
import subprocess


def fed(path, *first):
    """A function that runs the program with these words and its arguments, fed with `given`: exit code, standard output (bytes) and error."""
    def run(*arguments, given=b""):
        done = subprocess.run([path, *first, *arguments], input=given, capture_output=True, timeout=120)
        return done.returncode, done.stdout, done.stderr.decode()
    return run


def table_of(table):
    """The rows of a table (bytes or text), each by the names of its columns."""
    return list(csv.DictReader(io.StringIO(table if isinstance(table, str) else table.decode())))


def modbus(data):
    """CRC-16 of Modbus, as it is sent."""
    crc = 0xFFFF
    for byte in data:
        crc ^= byte
        for _ in range(8):
            crc = crc >> 1 ^ (0xA001 if crc & 1 else 0)
    return crc.to_bytes(2, "little")


TORQUES = """    output:
      size: 6
      fields:
        - {is: torque, joint: 1, at: 0, type: i16, scale: 2.0e-5}
        - {is: torque, joint: 2, at: 2, type: i16, scale: 2.0e-5}
        - {is: torque, joint: 3, at: 4, type: i16, scale: 2.0e-5}
"""


def own_arm(wire, module="usb_hid", limits="{force: 2}", stops=""):
    """The device file of an arm with three joints, whose formats are in `wire`. @param stops its key `limits`, if it has one"""
    stops = f", limits: {stops}" if stops else ""
    return f"""hapticd-device: 1
module: {module}
name: own arm
limits: {limits}
parameters:
  usb: {{id: "1209:0a0a"}}
  arm: {{kind: phantom, lengths: [0.2, 0.2, 0, 0, 0], masses: [0, 0, 0, 0], max_torque: [0.5]{stops}}}
  wire:
    rate: 1000
    watchdog: 0.02
{wire}"""
