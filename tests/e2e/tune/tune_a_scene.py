#!/usr/bin/env python3
"""Tunes a scene and checks the choice independently: over another motion, `hapticd trace` with the chosen settings stays
within the tolerance of a converged run in every sample. Usage: tune_a_scene.py HAPTICD SOURCE_DIR"""
import csv
import json
import math
import os
import re
import signal
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "support"))
from e2e import LONG

hapticd, source = sys.argv[1:3]
TOLERANCE = 1e-6  # [m]


def run(*words, code=0):
    done = subprocess.run([hapticd, *words], capture_output=True, text=True)
    assert done.returncode == code, f"{words}: exit {done.returncode}, expected {code}\n{done.stdout}{done.stderr}"
    return done.stdout + done.stderr


def scene(folder, name, parameters):
    text = open(f"{source}/config/scenes/{name}.yaml").read().replace("../", f"{source}/config/")
    text = re.sub(r"(parameters: \{[^}]*)\}", lambda m: m.group(1) + parameters + "}", text)
    path = f"{folder}/{name}.yaml"
    open(path, "w").write(text)
    return path


def keeps_its_word(told, text, picture):
    """What the table claims holds in the JSON, and its rows are the points of the picture."""
    def errors(c):
        geometry = 1e6 if c["untraced"] else max(c["foot_um"], c["depth_um"])
        return max(geometry, told["noise"]["foot_um"]), max(c["force_n"], told["noise"]["force_n"])

    for kept in (c for c in told["candidates"] if c["on_front"]):
        better = [c for c in told["candidates"] if c["p50_interval_ns"][1] < kept["p50_interval_ns"][0] and
                  errors(c)[0] <= errors(kept)[0] and errors(c)[1] <= errors(kept)[1]]
        assert not better, f"{kept} is called unbeaten, but {better}"
    shown = sorted(c["point"] for c in told["candidates"] if c["point"])
    assert shown == list(range(1, len(shown) + 1)), shown
    for number in shown:
        assert re.search(rf"^ *{number}[> ][* ] +\d+-\d+ ", text, re.M), f"no row {number} in the table:\n{text}"
        assert f">{number}</text>" in picture, f"no point {number} in the picture"
    assert "noise:" in text and "(chosen)</text>" in picture
    assert "and that at 10000 Hz)" in text, "the error of a held force is one against another rate, not against truth"
    axis = picture.index("median of a tick [ns]")
    assert picture[:axis].count('text-anchor="middle"') >= 3, "the axis of the costs has hardly a tick"


def another_motion(path, radius=0.052):
    with open(path, "w") as out:
        out.write("t,x,y,z\n")
        for i in range(3000):
            t = i * 1e-3
            a, b = 2.1 * t + 0.4, 1.3 * t
            r = radius + 0.004 * math.sin(9 * t)
            out.write(f"{t:.17g},{r * math.sin(a) * math.cos(b):.17g},{r * math.sin(b):.17g},{r * math.cos(a) * math.cos(b):.17g}\n")


def feet(scene_file, probe, folder):
    run("trace", scene_file, "--probe", probe, "--out", f"{folder}/out.csv")
    with open(f"{folder}/out.csv") as f:
        return [[float(row[k]) for k in ("px", "py", "pz", "depth")] for row in csv.DictReader(f)]


def holds_over_another_motion(folder, name, file, radius):
    tuned, probe = f"{folder}/{name}.tuned.yaml", f"{folder}/probe.csv"
    run("check", tuned)
    another_motion(probe, radius)
    chosen = feet(tuned, probe, folder)
    converged = feet(scene(folder, name, ", tolerance: 1e-12"), probe, folder)
    wrong = 0
    for a, b in zip(chosen, converged):
        if math.isnan(b[0]) and math.isnan(a[0]):
            continue
        apart = math.dist(a[:3], b[:3])
        # Another foot that is as near, or nearer than the reference's, is no error of the choice.
        if not apart <= TOLERANCE and not a[3] > b[3] - 1e-9:
            wrong += 1
    assert len(chosen) == 3000 and wrong == 0, f"{name}: {wrong} of {len(chosen)} samples beyond the tolerance"


with tempfile.TemporaryDirectory() as folder:
    file = scene(folder, "teapot", "")
    text = run("tune", file, "--motion-seconds", "2" if LONG else "1", "--limit-seconds", "20" if LONG else "10", "--write", "--json", f"{folder}/t.json",
               "--page", f"{folder}/t.html", "--picture", f"{folder}/t.svg")
    for word in ("chosen:", "p50 ns", "rate Hz", "velocity estimator"):
        assert word in text, f"no {word!r} in the table:\n{text}"
    told = json.load(open(f"{folder}/t.json"))
    assert told["reached"]
    methods = {c["settings"]["nurbs_rigid.method"] for c in told["candidates"]}
    hurried = not told["complete"] and len(told["candidates"]) < 30  # a machine that is busy with other things
    assert methods == {"dpt", "newton"} or hurried, methods
    worst = {m: max(c["foot_um"] for c in told["candidates"] if c["settings"]["nurbs_rigid.method"] == m) for m in methods}
    assert hurried or worst["dpt"] > 10 * worst["newton"], f"one step of the paper's method is no faster setting here: {worst}"
    keeps_its_word(told, text, open(f"{folder}/t.svg").read())
    page = open(f"{folder}/t.html").read()
    assert "<svg" in page and "http" not in page.replace("http://www.w3.org/2000/svg", ""), "the page needs a network"

    tuned = f"{folder}/teapot.tuned.yaml"
    holds_over_another_motion(folder, "teapot", file, 0.052)

    # Other scenes keep what was promised too.
    for name, radius in (("sphere", 0.049), ("torus", 0.066)) if LONG else (("torus", 0.066),):
        other = scene(folder, name, "")
        run("tune", other, "--motion-seconds", "1", "--limit-seconds", "8" if LONG else "4", "--write")
        holds_over_another_motion(folder, name, other, radius)

    file = scene(folder, "teapot", "")  # as it was
    # The motion of a recording does as well as that of the hand.
    run("run", file, "--virtual-time", "--for", "1", "--record", f"{folder}/run.h5")
    text = run("tune", file, "--motion", f"{folder}/run.h5", "--limit-seconds", "2")
    assert "run.h5, 1000 ticks" in text, text
    run("tune", file, "--motion", f"{folder}/t.json", code=2)
    with open(f"{folder}/run.h5", "r+b") as cut:  # as a kill leaves it: never marked as closed (driver/docs/recording.md)
        cut.seek(512 + 24 + 8)
        cut.write(bytes(4))
    # Alone, --json prints; the limit of time is named where it stopped the search.
    done = subprocess.run([hapticd, "tune", file, "--motion", f"{folder}/run.h5", "--limit-seconds", "1", "--json"], capture_output=True, text=True)
    assert done.returncode in (0, 1) and "ends early" in done.stderr, done.stderr
    hasty = json.loads(done.stdout)
    assert hasty["complete"] or "after the 1 s of --limit-seconds: " in hasty["stopped"], hasty["stopped"]

    # Ctrl-C keeps what was measured.
    stopped = subprocess.Popen([hapticd, "tune", file, "--motion-seconds", "5", "--json", f"{folder}/stopped.json"],
                               stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    time.sleep(4)
    stopped.send_signal(signal.SIGINT)
    out, err = stopped.communicate(timeout=60)
    assert stopped.returncode in (0, 1), f"exit {stopped.returncode}: {err}"
    told = json.load(open(f"{folder}/stopped.json"))
    assert "stopped early" in out and not told["complete"] and len(told["candidates"]) >= 1, out

    # A motion without contact has no errors: zeros would be taken for perfection.
    with open(f"{folder}/far.csv", "w") as far:
        far.write("t,x,y,z\n" + "".join(f"{i * 1e-3:.3f},1,1,1\n" for i in range(1000)))
    assert "comes near no model" in run("tune", file, "--probe", f"{folder}/far.csv", code=1)

    # Nor has one that comes near and touches nothing, which is told.
    with open(f"{folder}/near.csv", "w") as near:
        near.write("t,x,y,z\n" + "".join(f"{i * 1e-3:.3f},{0.06 + i * 1e-6!r},0,0\n" for i in range(1000)))
    text = run("tune", file, "--probe", f"{folder}/near.csv", "--limit-seconds", "2", "--json", f"{folder}/near.json", "--page", f"{folder}/near.html")
    assert '<p class="warning">' in open(f"{folder}/near.html").read() and ".warning{white-space:pre-line}" in open(f"{folder}/near.html").read()
    touches = json.load(open(f"{folder}/near.json"))["touches"]
    assert "warning: the motion does not touch" in text and "no force is compared" in text, text
    assert [t["ticks"] for t in touches] == [0] and touches[0]["nearest_m"] > 0, touches
    assert "does not touch" not in out, out

    # A tolerance of the force is a goal of its own: a setting that misses it is not good enough, however far off a foot may be.
    coarse = scene(folder, "teapot", ", method: dpt")
    for most in (1e-6, 10.0):
        subprocess.run([hapticd, "tune", coarse, "--motion", f"{folder}/run.h5", "--limit-seconds", "4", "--tolerance-um", "1e5", "--force-tolerance-n", f"{most}",
                        "--json", f"{folder}/force.json"], capture_output=True)
        told = json.load(open(f"{folder}/force.json"))
        forces, chosen = [c["force_n"] for c in told["candidates"]], told["candidates"][told["chosen"]]
        assert 1e-6 < forces[0] < 10, f"the scene as it is has an error of {forces[0]} N"
        assert told["reached"] == (min(forces) <= most) and (chosen["force_n"] <= most or not told["reached"]), (most, told["reached"], forces, chosen)

    # A goal that nothing reaches: the nearest is chosen, and the exit code says so.
    assert "none of" in run("tune", file, "--motion-seconds", "0.5", "--limit-seconds", "2", "--budget-us", "0.001", code=1)
    open(f"{folder}/empty.yaml", "w").write("hapticd: 1\nmodels: []\n")
    assert "expected one to tune" in run("tune", f"{folder}/empty.yaml", code=2)
print("tuned; the choice holds over another motion")
