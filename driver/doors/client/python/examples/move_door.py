#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Moves a kinematic model up and down, 60 times a second, as a game engine would.

    hapticd run SCENE        with a model that has `motion: kinematic`
    ./move_door.py door

The model follows with at most 1 m/s and 20 m/s^2; between two records it goes on with the velocity that came along.
"""
import argparse
import math
import time

import hapticd

parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
parser.add_argument("model", help="name of the model")
parser.add_argument("--name", default="hapticd", help="name of the daemon")
parser.add_argument("--travel", type=float, default=0.02, help="how far the model moves up and down [m]")
parser.add_argument("--seconds", type=float, default=10, help="duration of the motion [s]")
options = parser.parse_args()

try:
    h = hapticd.connect(options.name)
except hapticd.HapticdError as error:  # mostly because no daemon runs; its text says what to do
    raise SystemExit(f"error: {error}")

with h:
    x, y, z = h.models[options.model].position
    orientation = h.models[options.model].orientation
    with h.lead_model(options.model) as door:
        begun = time.monotonic()
        while (t := time.monotonic() - begun) < options.seconds:
            speed = 2 * math.pi * 0.5  # rad/s
            door.put([x, y + options.travel * math.sin(speed * t), z], orientation,
                     linear=[0, options.travel * speed * math.cos(speed * t), 0])
            time.sleep(1 / 60)
    print("the door stands at", h.models[options.model].position)
