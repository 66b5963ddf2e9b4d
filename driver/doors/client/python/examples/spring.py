#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Pulls the hand to where it is now, with a spring of your own beside the models of the scene.

    hapticd run SCENE        with `clients: add` in the scene
    ./spring.py --stiffness 200

The force is computed here, a thousand times a second; the daemon bounds it, and takes it away within 20 ms when this
program hangs or dies.
"""
import argparse
import time

import hapticd

parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
parser.add_argument("--name", default="hapticd", help="name of the daemon")
parser.add_argument("--stiffness", type=float, default=200, help="stiffness of the spring [N/m]")
parser.add_argument("--damping", type=float, default=1, help="damping of the spring [N s/m]")
parser.add_argument("--seconds", type=float, default=10)
options = parser.parse_args()

try:
    h = hapticd.connect(options.name)
except hapticd.HapticdError as error:  # mostly because no daemon runs; its text says what to do
    raise SystemExit(f"error: {error}")

with h:
    arm = h.devices[0]
    rest = h.state(arm).position

    def spring(state):
        return [options.stiffness * (r - p) - options.damping * v for r, p, v in zip(rest, state.position, state.velocity)]

    with h.push(arm, spring) as push:
        end = time.monotonic() + options.seconds
        while time.monotonic() < end:
            time.sleep(min(1, options.seconds))
            row = h.rows("ticks", last=1)[0]
            print(f"{push.answers} answers, {row['arm0_client_fx']:+.2f} {row['arm0_client_fy']:+.2f} {row['arm0_client_fz']:+.2f} N")
        (client,) = h.status()["devices"][0]["clients"]
        print(f"{100 * client['same_tick']:.1f} % of the answers came in the tick that they answer")
