#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Plugins and an arm that are linked into one program give the forces of `hapticd run --virtual-time`, bit for bit, and
that program needs nothing of an operating system but files and a clock.

Usage: linked_modules.py LINKED_RUN HAPTICD SOURCE_DIR
"""
import csv
import pathlib
import subprocess
import sys
import tempfile

SECONDS = "2"
COLUMNS = [f"arm0_{kind}{axis}" for kind in ("f", "sent_f") for axis in "xyz"]
ENTRIES = ["hsp_entry_nurbs_rigid", "hsp_entry_push_button", "hsp_entry_pendulum", "hdv_entry_simulated"]
# What loads code, starts threads or processes, shares memory or opens sockets.
FORBIDDEN = {"dlopen", "dlmopen", "dlsym", "fork", "vfork", "execve", "posix_spawn", "pthread_create", "mmap", "socket",
             "sigaction", "getrusage"}


def names(program, *options):
    """Symbols without their versions."""
    said = subprocess.run(["nm", *options, program], capture_output=True, text=True, check=True).stdout
    return {line.split()[-1].split("@")[0] for line in said.splitlines()}


def rows(lines):
    return [[row[column] for column in COLUMNS] for row in csv.DictReader(lines)]


def of_daemon(hapticd, scene, folder):
    recording, table = folder / "run.h5", folder / "ticks.csv"
    subprocess.run([hapticd, "run", scene, "--virtual-time", "--for", SECONDS, "--record", recording], check=True,
                   capture_output=True)
    subprocess.run([hapticd, "export", recording, "--csv", table, "--stream", "ticks"], check=True, capture_output=True)
    return rows(line for line in table.read_text().splitlines() if not line.startswith("#"))


def compare(scene, linked, hapticd):
    with tempfile.TemporaryDirectory() as folder:
        expected = of_daemon(hapticd, scene, pathlib.Path(folder))
    run = subprocess.run([linked, scene, SECONDS], capture_output=True, text=True)
    if run.returncode != 0:
        return [f"{scene}: linked_run ended with {run.returncode}: {run.stderr}"]
    found = rows(run.stdout.splitlines())
    if len(found) != len(expected):
        return [f"{scene}: {len(found)} ticks, expected {len(expected)}"]
    # decimal digits that give every bit, so that equal numbers are equal bits; a negative zero is a zero
    values = [[[float(x) for x in row] for row in table] for table in (found, expected)]
    differ = [i for i, (a, b) in enumerate(zip(*values)) if a != b]
    felt = sum(any(x != 0 for x in row[:3]) for row in values[1])
    print(f"{pathlib.Path(scene).name}: {len(expected)} ticks, {felt} with a force, {len(differ)} differ")
    if felt == 0:
        return [f"{scene}: no force was felt, so nothing was compared"]
    return [f"{scene}: tick {i}: {found[i]}, expected {expected[i]}" for i in differ[:3]]


def main():
    linked, hapticd, source = sys.argv[1], sys.argv[2], pathlib.Path(sys.argv[3])
    wrong = [f"{linked}: lacks {name}" for name in sorted(set(ENTRIES) - names(linked))]
    wrong += [f"{linked}: needs {name}" for name in sorted(FORBIDDEN & names(linked, "-u"))]
    for name in ("sphere", "teapot", "button", "pendulum", "moving-box"):
        wrong += compare(str(source / f"config/scenes/{name}.yaml"), linked, hapticd)
    print("\n".join(wrong))
    return 1 if wrong else 0


sys.exit(main())
