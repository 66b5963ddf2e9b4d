#!/usr/bin/env python3
"""Reads a recording with h5py, which knows nothing of hapticd, and prints a line that the test compares."""
import sys

import h5py

with h5py.File(sys.argv[1], "r") as file:
    ticks = file["ticks"][:]
    assert ticks.dtype.names == ("tick", "x", "y", "status"), ticks.dtype
    last = int(ticks["tick"].max()) if len(ticks) else -1
    scene = file["scene"][()].decode().splitlines()[0]
    print(len(ticks), last, f"{ticks['x'].sum():.1f}", len(file["events"]), file.attrs["format"].decode(), scene)
