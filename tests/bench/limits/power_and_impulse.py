#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Measures how well the shipped program keeps `limits.power` and `limits.impulse`, with a sphere, a simulated Premium with
exact encoders, and random hands. Prints for each kind of hand and each rate the worst power of a tick and of 10 ms, and the
worst impulse of 0.1 s, divided by their limits.

usage: power_and_impulse.py HAPTICD SOURCE [COUNT [SEED]]      COUNT hands of each kind at each rate (default 8)
Hands: `calm` moves by sines of at most 5 Hz, `quick` of at most 12 Hz (and both stop at 5 cm), the target of
`jumping` jumps within a tick, as no person could.
"""
import csv
import math
import os
import random
import subprocess
import sys
import tempfile

import numpy

HAPTICD, SOURCE = (os.path.abspath(argument) for argument in sys.argv[1:3])
COUNT = int(sys.argv[3]) if len(sys.argv) > 3 else 8
SEED = int(sys.argv[4]) if len(sys.argv) > 4 else 29
SECONDS, RATES = 3, (100, 250, 500, 1000, 4000)
HANDS = {"calm": (20, 5), "quick": (100, 12), "jumping": None}  # m/s^2 and Hz


def sines(chance, acceleration, fastest):
    """Yields the target of a hand for each millisecond, as a sum of sines."""
    parts = [(chance.uniform(0.5, fastest), chance.uniform(0, 2 * math.pi), chance.random()) for _ in range(5)]
    size = acceleration / sum(w * (2 * math.pi * f) ** 2 for f, _, w in parts)
    sizes = [size * chance.uniform(0.3, 1) for _ in range(3)]
    for k in range(1000 * SECONDS + 1):
        wave = [s * sum(w * math.sin(2 * math.pi * f * k / 1000 + p + axis) for f, p, w in parts) for axis, s in enumerate(sizes)]
        x, y, z = (max(-0.05, min(0.05, value)) for value in wave)
        yield k / 1000, x, y, 0.045 + z


def jumps(chance):
    """Yields targets that jump by centimetres."""
    t, place = 0, (0, 0, 0.05)
    while t < SECONDS:
        yield (t, *place)
        t += chance.choice([0.003, 0.01, 0.03, 0.1])
        place = (chance.uniform(-0.03, 0.03), chance.uniform(-0.03, 0.03), chance.uniform(0.02, 0.07))


def write(folder, chance, hand, rate, limit):
    path = jumps(chance) if HANDS[hand] is None else sines(chance, *HANDS[hand])
    with open(os.path.join(folder, "hand.csv"), "w") as out:
        out.write("t,x,y,z\n" + "".join("{:.5f},{:.6f},{:.6f},{:.6f}\n".format(*row) for row in path))
    arm = (f"stiffness: {chance.choice([500, 2000])}, damping: {chance.choice([5, 15])}, mass: {chance.choice([0.05, 0.2, 0.5])}")
    with open(os.path.join(folder, "arm.yaml"), "w") as out:
        out.write(f"hapticd-device: 1\nmodule: simulated\nlimits: {{force: 8.5, {limit}}}\nparameters:\n  arm: {{kind: premium15}}\n"
                  f"  joint: {{counts: [0]}}\nhand: {{script: path, path: hand.csv, {arm}, lead_in: 0.2}}\n")
    geometry = os.path.join(SOURCE, "config", "models", "sphere.yaml")
    with open(os.path.join(folder, "scene.yaml"), "w") as out:
        out.write(f"hapticd: 1\nservo: {{rate: {rate}}}\ndevice: arm.yaml\nmodels:\n  - {{name: ball, plugin: nurbs_rigid, "
                  f"parameters: {{geometry: {geometry}, stiffness: {chance.choice([300, 1000, 3000])}}}}}\n")


def ticks(folder):
    """Returns the forces as sent [N] and the positions of the tip [m], one row per tick."""
    for command in (["run", "scene.yaml", "--virtual-time", "--for", str(SECONDS), "--record", "run.h5"], ["export", "run.h5", "--csv", "."]):
        done = subprocess.run([HAPTICD, *command], cwd=folder, capture_output=True, text=True)
        if done.returncode != 0:
            sys.exit(f"hapticd {' '.join(command)}: {done.stderr}")
    with open(os.path.join(folder, "ticks.csv")) as file:
        rows = list(csv.DictReader(file))
    return (numpy.array([[float(row[f"arm0_{name}{axis}"]) for axis in "xyz"] for row in rows]) for name in ("sent_f", ""))


def play(hand, rate, number):
    """Returns power of a tick, power of 10 ms and impulse of 0.1 s, divided by their limit; 0 for what was not limited."""
    chance = random.Random(f"{SEED} {hand} {rate} {number}")
    most = chance.choice([0.05, 0.1, 0.3])
    kind = "power" if number % 2 else "impulse"
    with tempfile.TemporaryDirectory() as folder:
        write(folder, chance, hand, rate, f"{kind}: {most}")
        force, place = ticks(folder)
    if kind == "impulse":
        book = numpy.concatenate([[0], numpy.cumsum(numpy.linalg.norm(force, axis=1) / rate)])
        window = rate // 10
        return 0, 0, (book[window:] - book[:-window]).max() / most
    power = (force[:-1] * numpy.diff(place, axis=0)).sum(1) * rate
    window = max(1, rate // 100)
    mean = numpy.convolve(power, numpy.ones(window) / window, "valid")
    return power.max() / most, mean.max() / most, 0


print("hand       rate    power of a tick   of 10 ms   impulse of 0.1 s")
for hand in HANDS:
    for rate in RATES:
        worst = numpy.max([play(hand, rate, number) for number in range(COUNT)], axis=0)
        print(f"{hand:8} {rate:6}   {worst[0]:15.2f} {worst[1]:10.2f} {worst[2]:18.2f}", flush=True)
