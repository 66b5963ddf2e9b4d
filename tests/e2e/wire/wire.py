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
