#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Gives the hand a short push upward when a button snaps in, and ends with the daemon.

    hapticd run config/scenes/programs/button.yaml     or a scene of yours with a button and `clients: add`
    ./button.py

If the daemon is stopped (hapticd ctl stop, Ctrl-C), the loop ends and so does this program. If the daemon was killed or
crashed, the loop raises hapticd.HapticdError.
"""
import argparse

import hapticd

FORCE, SECONDS = 0.5, 0.1  # N, s: the push

parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
parser.add_argument("--name", default="hapticd", help="name of the daemon")
options = parser.parse_args()

last = float("-inf")  # s: time of the last press


def push(state):
    return [0, FORCE if state.t - last < SECONDS else 0, 0]


try:
    h = hapticd.connect(options.name)
except hapticd.HapticdError as error:  # mostly because no daemon runs; its text says what to do
    raise SystemExit(f"error: {error}")

with h, h.push(h.devices[0], push):
    for event in h.events():
        if event["event"] == "click":
            print(f"{event['t']:.3f} s: {event['model']} snapped {event.get('snapped', '?')}", flush=True)
            if event.get("snapped") == "in":
                last = event["t"]
print("the daemon has ended")
