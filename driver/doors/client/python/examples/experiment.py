#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Presents scenes in random order, one per trial, and writes what a hand felt in each.

    hapticd run soft.yaml --record session.h5             # all of it, beside the trials
    ./experiment.py soft.yaml hard.yaml --trials 20 --seed 7 --out participant-07 --question 'How hard, 1 to 7? '

Enter begins a trial: the scene is loaded while the hand is outside of its models, and then felt for some seconds. The
scenes may differ in anything but their devices. `trials.csv` has a row per trial: its first tick, the largest force [N]
and depth [m], and the answer. `trial-001.csv` has the ticks, in SI units and the world frame. The recording has marks
where a trial begins, with its scene, and where it ends (`hapticd explain session.h5`, column `text` of `marks`).

This program pushes on nobody: if it crashes, the last scene stays, and the daemon's limits hold. Ctrl-C ends it between
two rows.
"""
import argparse
import csv
import os
import random
import time

import hapticd

COLUMNS = ["tick", "t", "arm0_x", "arm0_y", "arm0_z", "arm0_sent_fx", "arm0_sent_fy", "arm0_sent_fz", "depth", "arm0_fault"]

parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
parser.add_argument("scenes", nargs="+", help="scene files, one per stimulus")
parser.add_argument("--name", default="hapticd", help="name of the daemon")
parser.add_argument("--trials", type=int, default=10, help="how many in all; each scene comes equally often, up to one")
parser.add_argument("--seconds", type=float, default=3, help="how long a stimulus is felt [s], at most 8")
parser.add_argument("--seed", type=int, default=1, help="of the order; the same seed gives the same order")
parser.add_argument("--out", default="session", help="folder for the tables, one for each participant")
parser.add_argument("--question", default="", help="is asked after each trial; the answer is written beside it")
options = parser.parse_args()
if not 0 < options.seconds <= 8:
    parser.error("--seconds: expected more than 0 and at most 8, because the daemon keeps the last 10 s")
if os.path.exists(os.path.join(options.out, "trials.csv")):
    parser.error(f"--out: {options.out} has the trials of another session, expected a new folder")

order = [options.scenes[i % len(options.scenes)] for i in range(options.trials)]
random.Random(options.seed).shuffle(order)


def present(h, scene):
    """Loads a scene. Returns when the hand may feel it."""
    h.ask(do="reload", file=os.path.abspath(scene))
    told = False
    while any(model.waits for model in h.models.values()):  # a model gives no force while a tip is inside it
        if not told:
            print("draw the hand back, out of the model", flush=True)
        told = True
        time.sleep(0.02)


def felt(h, name, scene):
    """Marks the begin and the end of a trial in the recording. Returns the rows of its ticks."""
    first = h.mark(f"{name} begins: {os.path.basename(scene)}".encode()[:95].decode(errors="ignore"))  # a mark has 95 bytes
    end = time.monotonic() + options.seconds
    while (left := end - time.monotonic()) > 0:
        time.sleep(left)
    last = h.mark(f"{name} ends")
    h.wait(last)
    return h.streams["ticks"].read(first, last - first + 1)[1]


def write(number, scene, rows, table):
    with open(os.path.join(options.out, f"trial-{number:03}.csv"), "w", newline="") as file:
        out = csv.writer(file)
        out.writerow(COLUMNS)
        out.writerows([row[column] for column in COLUMNS] for row in rows)
    force = max(sum(row["arm0_sent_f" + axis] ** 2 for axis in "xyz") ** 0.5 for row in rows)
    depth = max(row["depth"] for row in rows)
    valid = force > 0 and not any(row["arm0_fault"] for row in rows)  # a trial without a force, or with a fault, is none
    answer = ""
    try:
        if options.question:
            answer = input(options.question)
    finally:  # Ctrl-C at the question loses the answer alone
        table.writerow([number, scene, rows[0]["tick"], len(rows), force, depth, int(valid), answer])
    print(f"{scene}: at most {force:.2f} N, {1e3 * depth:.2f} mm deep{'' if valid else ': NOT VALID (no force, or a fault)'}", flush=True)


try:
    h = hapticd.connect(options.name)
except hapticd.HapticdError as error:  # mostly because no daemon runs; its text says what to do
    raise SystemExit(f"error: {error}")

os.makedirs(options.out, exist_ok=True)
with h, open(os.path.join(options.out, "trials.csv"), "w", newline="", buffering=1) as file:
    trials = csv.writer(file)
    trials.writerow(["trial", "scene", "tick", "ticks", "force_n", "depth_m", "valid", "answer"])
    for number, scene in enumerate(order, 1):
        input(f"trial {number} of {len(order)}: Enter ")
        present(h, scene)
        write(number, scene, felt(h, f"trial {number}", scene), trials)
