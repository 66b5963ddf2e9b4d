#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Takes some seconds of a running daemon into pandas, and prints what was felt. Needs pandas (sudo apt install
python3-pandas).

    ./record_to_pandas.py --seconds 5 --csv run.csv

A recording of any length, made with `hapticd run --record run.h5`, is read by
`pandas.DataFrame(h5py.File("run.h5")["ticks"][:])` with the same columns.
"""
import argparse
import time

import numpy
import pandas

import hapticd

parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
parser.add_argument("--name", default="hapticd", help="name of the daemon")
parser.add_argument("--seconds", type=float, default=2, help="how much of the run is taken [s]")
parser.add_argument("--csv", metavar="FILE", help="write all ticks to this CSV file")
options = parser.parse_args()

try:
    h = hapticd.connect(options.name)
except hapticd.HapticdError as error:  # mostly because no daemon runs; its text says what to do
    raise SystemExit(f"error: {error}")

with h:
    parts, end = [], time.monotonic() + options.seconds
    for rows in h.follow("ticks", timeout=1):
        parts.append(rows)
        if time.monotonic() > end:
            break
    frame = pandas.DataFrame(numpy.concatenate(parts)).set_index("tick")
    names = {model.number: name for name, model in h.models.items()}
    contacts = pandas.DataFrame(h.rows("contacts", last=100_000))

frame["force"] = numpy.sqrt(sum(frame["arm0_sent_f" + axis] ** 2 for axis in "xyz"))
print(frame[["depth", "force", "lateness_us", "compute_us"]].describe().to_string())
gaps = int((frame.index.to_series().diff().dropna() != 1).sum())
print(f"{len(frame)} ticks, {gaps} gaps")
if len(contacts):
    depth = contacts[contacts["depth"] > 0].groupby("model")["depth"].max()
    for model, deepest in depth.items():
        print(f"{names.get(model, model)}: at most {1e3 * deepest:.2f} mm deep")
if options.csv:
    frame.to_csv(options.csv)
    print(f"{options.csv}: {len(frame)} rows, {len(frame.columns)} columns")
