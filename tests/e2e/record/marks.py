#!/usr/bin/env python3
"""Marks of programs: the tick and the text are in the recording, the events, the log, what explain says, the tables and the
black box, a text that is none is refused, and a replay is exact.

Usage: marks.py HAPTICD SOURCE     prints one line per case; exit 1 when one is off.
"""
import csv
import html
import json
import os
import subprocess
import sys
import tempfile

HAPTICD, SOURCE = sys.argv[1:3]
sys.path[:0] = [os.path.join(SOURCE, "tests", "support"), os.path.join(SOURCE, "driver", "doors", "client", "python")]
from e2e import check, finish, program, refused, until
import h5py
import hapticd

FIRST, SECOND, LONGEST = 'trial 7 "begins", \u00e4\U0001f590', "trial 7 ends", "x" * 95
NO_TEXTS = {"nothing": "", "two lines": "a\nb", "a control character": "a\x1b[2Jb", "one of Latin-1": "a\x9bb", "a turned direction": "a\u202eb", "96 bytes": "\u00e4" * 48}


def marks(ask):
    """Marks by the command and by Python. Returns the ticks that were told."""
    check("ctl waits for the daemon", ask("ctl", "--name", "marks", "--wait", "30", "status")[0] == 0)
    code, told = ask("ctl", "--name", "marks", "mark", FIRST)
    check("ctl marks a tick and tells it", code == 0 and json.loads(told)["ok"], told)
    ticks = [json.loads(told)["tick"]]
    for name, text in NO_TEXTS.items():
        code, told = ask("ctl", "--name", "marks", "mark", text)
        check(f"ctl refuses {name}", code == 2 and "expected 1 to 95 bytes of UTF-8" in told, told)
    done = subprocess.run([HAPTICD, "ctl", "--name", "marks", "mark", b"a\xffb"], capture_output=True, timeout=60)
    check("ctl refuses what is no UTF-8", done.returncode == 2 and b"expected 1 to 95 bytes of UTF-8" in done.stderr, done)
    with hapticd.connect("marks", wait=10) as h:
        events = h.events(timeout=20)
        ticks += [h.mark(SECOND), h.mark(LONGEST)]
        told = [next(events), next(events)]
        check("the events come with their texts", [(e["event"], e["tick"], e["text"]) for e in told] == [("mark", ticks[1], SECOND), ("mark", ticks[2], LONGEST)], told)
        for name, text in NO_TEXTS.items():
            check(f"the daemon refuses {name}", refused(lambda: h.mark(text), "1 to 95 bytes of UTF-8"))
        for wrong, kind in (("a\ud800", ValueError), (7, TypeError)):
            try:
                h.mark(wrong)
                check(f"mark({wrong!a}) raises", False)
            except kind:
                pass
        rows = h.rows("marks")
        check("the rows of a client have the texts", [row["text"].decode() for row in rows] == [FIRST, SECOND, LONGEST], rows)
        check("and its columns their type", [c.type for c in h.streams["marks"].columns] == ["u8", "f8", "i4", "u4", "s96"])
    return ticks


def areTold(file, ticks, folder, ask):
    """@param ticks what the daemon answered"""
    rows, run = h5py.File(file)["marks"][:], h5py.File(file)["ticks"][:]
    times = dict(zip(run["tick"].tolist(), run["t"].tolist()))  # a tick that the machine missed has no row
    check("the recording has them, with tick, time and text", rows["tick"].tolist() == ticks and [text.decode() for text in rows["text"]] == [FIRST, SECOND, LONGEST]
          and rows["t"].tolist() == [times[tick] for tick in ticks], rows)
    events = h5py.File(file)["events"][:]
    kinds = json.loads(h5py.File(file)["about"][()])["events"]
    found = events[events["kind"] == kinds.index("mark")]
    check("its events name the rows", found["code"].tolist() == [0, 1, 2] and found["tick"].tolist() == ticks, found)
    check("a mark is no order", len(h5py.File(file)["orders"]) == 0)
    code, told = ask("explain", file)
    check("explain tells them", code == 0 and f"{ticks[0] / 1000:.4f} s  {FIRST}\n" in told and f" s  {LONGEST}\n" in told, told)
    picture = os.path.join(folder, "marks.svg")
    code, told = ask("plot", file, "--out", picture)
    check("plot draws them", code == 0 and all(html.unescape(open(picture).read()).count(f">{text}<") == 1 for text in (FIRST, LONGEST)), told)
    code, told = ask("export", file, "--csv", os.path.join(folder, "tables"))
    with open(os.path.join(folder, "tables", "marks.csv"), newline="") as table:
        cells = list(csv.DictReader(table))
    check("marks.csv has them", code == 0 and [(int(c["tick"]), c["text"]) for c in cells] == list(zip(ticks, (FIRST, SECOND, LONGEST))), cells)


with tempfile.TemporaryDirectory() as scratch:
    environment = dict(os.environ, RUNTIME_DIRECTORY=scratch, STATE_DIRECTORY=scratch)
    os.environ.update(RUNTIME_DIRECTORY=scratch)
    ask = program(HAPTICD, environment, together=True)
    recorded, log = os.path.join(scratch, "run.h5"), os.path.join(scratch, "log")
    command = [HAPTICD, "run", os.path.join(SOURCE, "config", "scenes", "teapot.yaml"), "--for", "100", "--name", "marks", "--record", recorded]
    with open(log, "w") as out, subprocess.Popen(command, env=environment, stdout=out, stderr=out) as run:
        ticks = marks(ask)
        check("the log has them", until(lambda: f": {LONGEST}\n" in open(log).read()), open(log).read())
        code, told = ask("ctl", "--name", "marks", "dump")
        dumped = json.loads(told)["file"] if code == 0 else ""
        code, told = ask("ctl", "--name", "marks", "stop")
        check("the run ends well", code == 0 and run.wait(60) == 0, told)
    areTold(recorded, ticks, scratch, ask)
    code, told = ask("replay", recorded)
    check("it replays with every bit the same", code == 0 and "every bit is the same" in told, told)
    dump = h5py.File(dumped)["marks"][:]
    check("the black box has them", dump["tick"].tolist() == ticks and dump["text"][0].decode() == FIRST, dump)
finish()
