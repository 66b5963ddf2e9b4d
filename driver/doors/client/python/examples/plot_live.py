#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Plots columns of the ticks as they come. Needs matplotlib (sudo apt install python3-matplotlib).

    ./plot_live.py arm0_sent_fx arm0_sent_fy arm0_sent_fz
    ./plot_live.py --list                    every column with its unit
    ./plot_live.py depth --save depth.png    one picture, no window
"""
import argparse

import hapticd

parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
parser.add_argument("columns", nargs="*", default=["arm0_sent_fx", "arm0_sent_fy", "arm0_sent_fz"],
                    help="columns of the ticks to draw; default: the force that is sent to the first arm")
parser.add_argument("--name", default="hapticd", help="name of the daemon")
parser.add_argument("--window", type=float, default=5, help="time that is shown [s]")
parser.add_argument("--save", metavar="FILE", help="write one picture instead of opening a window")
parser.add_argument("--list", action="store_true", help="print the columns of the ticks, with unit and meaning")
options = parser.parse_args()

try:
    h = hapticd.connect(options.name)
except hapticd.HapticdError as error:  # mostly because no daemon runs; its text says what to do
    raise SystemExit(f"error: {error}")

with h:
    ticks = h.streams["ticks"]
    units = {column.name: column.unit for column in ticks.columns}
    if options.list:
        for column in ticks.columns:
            print(f"{column.name:24} {column.unit:10} {column.doc}")
        raise SystemExit
    for name in options.columns:
        if name not in units:
            parser.error(f"there is no column {name}; --list prints them")
    if options.save:
        import matplotlib
        matplotlib.use("Agg")
    from matplotlib import animation, pyplot
    if not options.save and pyplot.get_backend().lower() == "agg":
        raise SystemExit("error: there is no display to open a window on; write a picture with --save FILE")

    figure, axes = pyplot.subplots()
    lines = [axes.plot([], [], label=f"{name} [{units[name]}]")[0] for name in options.columns]
    axes.legend(loc="upper left")
    axes.set_xlabel("t [s]")

    def draw(_=None):
        rows = h.rows("ticks", last=int(options.window * h.about["rate_hz"]))
        for name, line in zip(options.columns, lines):
            line.set_data(rows["t"], rows[name])
        axes.relim()
        axes.autoscale_view()
        return lines

    if options.save:
        h.wait(ticks.written + int(options.window * h.about["rate_hz"]), timeout=2 * options.window)
        draw()
        figure.savefig(options.save)
        print(f"{options.save}: {len(lines)} columns")
    else:
        moving = animation.FuncAnimation(figure, draw, interval=50, cache_frame_data=False)
        pyplot.show()
