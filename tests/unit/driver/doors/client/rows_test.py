#!/usr/bin/env python3
"""Rows of a ring that goes round: each read has the rows that are kept, in order, wherever the ring begins.

Usage: rows_test.py SOURCE     exit 1 when a case is off
"""
import mmap
import os
import struct
import sys
import tempfile

sys.path.insert(0, os.path.join(sys.argv[1], "driver", "doors", "client", "python"))
sys.path.insert(0, os.path.join(sys.argv[1], "tests", "support"))
from e2e import check, finish
from hapticd._rows import _HEADER, _HEADER_AT, _STREAM, Column, Stream, _File

CAPACITY, AT = 7, 4096
box = tempfile.NamedTemporaryFile()
box.truncate(8192)
memory = mmap.mmap(box.fileno(), 8192)  # as the daemon writes it
stream = Stream(_File(box.name), 0, "ticks", 16, CAPACITY, AT, [Column("tick", "u8", 0, "", ""), Column("twice", "f8", 8, "", "")])


def write(rows):
    for row in range(rows):
        struct.pack_into("<Qd", memory, AT + row % CAPACITY * 16, row, 2.0 * row)
    struct.pack_into("<Q", memory, _HEADER_AT + _HEADER.size + 24, rows)


def ticks(rows):
    return [(int(row[0]), float(row[1])) for row in rows]


good = True
for written in range(40):
    write(written)
    for first in range(45):
        for most in (None, 0, 1, 3, 100):
            begins = min(max(first, written - CAPACITY + 1, 0), written)
            ends = written if most is None else min(written, begins + most)
            got, rows = stream.read(first, most)
            good &= got == begins and ticks(rows) == [(row, 2.0 * row) for row in range(begins, ends)]
check("rows in order, whole, and none that is being overwritten", good)
check("the newest", ticks(stream.last(3)) == [(row, 2.0 * row) for row in (36, 37, 38)])
check("more than are kept", [row for row, _ in ticks(stream.last(100))] == list(range(33, 39)))
check("places of the header", _STREAM.size == 40)
finish()
