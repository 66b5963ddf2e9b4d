#!/usr/bin/env python3
"""A replay is exact, a changed stiffness is found, and a kill leaves a file that can be replayed and drawn.

Usage: record_and_replay.py HAPTICD SCENES     prints one line per case; exit 1 when one is off.
"""
import csv
import json
import os
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "support"))
from e2e import check, finish, program, until

HAPTICD, SCENES = sys.argv[1], sys.argv[2]
hapticd = program(HAPTICD, together=True)
FAULT = 3  # HAPTICD_FAULT


def replayIsExact(folder, scene, seconds="1"):
    file = os.path.join(folder, scene + ".h5")
    code, told = hapticd("run", os.path.join(SCENES, scene + ".yaml"), "--for", seconds, "--virtual-time", "--record", file)
    check(scene + " is recorded", code == 0 and os.path.isfile(file), told)
    code, told = hapticd("replay", file)
    check(scene + " replays with every bit the same", code == 0, told)
    return file


def bothForcesAreWritten(folder, recording):
    """`replay --csv`: each tick as it was, and as it is with the other parameter. Without friction a wall that is half as stiff pushes half as much."""
    table, ticks = os.path.join(folder, "both.csv"), os.path.join(folder, "ticks.csv")
    hapticd("export", recording, "--csv", ticks, "--stream", "ticks")
    then = list(csv.DictReader(open(ticks)))
    code, told = hapticd("replay", recording, "--csv", table)
    same = list(csv.DictReader(open(table))) if code == 0 else []
    names = ["depth", "arm0_sent_fx", "arm0_sent_fy", "arm0_sent_fz"]
    check("--csv has each tick as it was", [[row["tick"], row["t"], *(row[f"{name}_recorded"] for name in names)] for row in same]
          == [[row["tick"], row["t"], *(row[name] for name in names)] for row in then] and same, told)
    check("and the same again where nothing was changed", all(row[f"{name}_recorded"] == row[f"{name}_replayed"] for row in same for name in names))
    code, told = hapticd("replay", recording, "--set", "teapot.stiffness=400", "--set", "teapot.damping=0", "--csv", table)
    force = lambda row, which: sum(float(row[f"arm0_sent_f{axis}_{which}"]) ** 2 for axis in "xyz") ** 0.5
    rows = [row for row in csv.DictReader(open(table)) if float(row["depth_recorded"]) > 1e-3 and 0.8 < float(row["t"]) < 0.95]  # no ramp
    off = [abs(force(row, "replayed") / (400 * float(row["depth_replayed"])) - 1) for row in rows]
    check("a change is beside it", code == 1 and len(rows) > 50 and max(off) < 1e-6, (told, len(rows), max(off, default=0)))
    for wrong in (recording, "-", os.path.join(folder, "no", "folder.csv")):
        code, told = hapticd("replay", recording, "--csv", wrong)
        check(f"--csv {os.path.basename(wrong)} is bad input", code == 2 and "error: " in told, told)


def arrivalsAt(ticks, there):
    """The ticks in which a joint comes to an end where it was not for the last 50 ms. One that begins there has not come."""
    last, found = None, []
    for tick in ticks[there].tolist():
        if last is None and tick > ticks[0] or last is not None and tick - last >= 50:
            found.append(tick)
        last = tick
    return found


def aDoorStandsAtItsStop(folder):
    """The hand of the shipped door opens it to its end stop, presses beyond, and lets it close."""
    import h5py
    import numpy
    file = replayIsExact(folder, "door", "4")
    recording = h5py.File(file)
    poses, contacts = recording["poses"][:], recording["contacts"][:]
    angles = 2 * numpy.arctan2(poses["qy"], poses["qw"])
    check("the door stays between its stops, and comes to both", angles.min() == 0 and abs(angles.max() - 0.6) < 1e-12, (angles.min(), angles.max()))
    open_ = numpy.isin(contacts["tick"], poses["tick"][abs(angles - 0.6) < 1e-12])
    still = contacts[open_ & (contacts["depth"] > 0)][50:-50]  # its damper acts on the hand that arrives and leaves
    force = numpy.linalg.norm([still["fx"], still["fy"], still["fz"]], axis=0)
    share = force / (800 * still["depth"])
    check("there it is a wall of its full stiffness", len(still) > 200 and abs(numpy.median(share) - 1) < 0.01, (len(still), numpy.median(share)))
    check("and does not tremble", not poses["wy"][abs(angles - 0.6) < 1e-12].any(), poses["wy"])
    gone = numpy.diff(numpy.concatenate(([0], force)))
    check("no kick as the hand lets go", gone[len(gone) // 2:].max() < 0.1, gone.max())
    code, told = hapticd("explain", file)
    check("explain tells of the stops", code == 0 and "door: turned from 0 to 0.6 rad; at its stop at 0 rad for " in told
          and "at its stop at 0.6 rad for " in told and "(1 time: " in told, told)
    first = poses["tick"][abs(angles - 0.6) < 1e-12][0] / 1000
    check("and when", f"(1 time: {first:.4g} to " in told, (first, told))
    about, events = json.loads(recording["about"][()]), recording["events"][:]
    stops = events[events["kind"] == about["events"].index("end_stop")]
    arrivals = [tick for stop in (0, 0.6) for tick in arrivalsAt(poses["tick"], abs(angles - stop) < 1e-9)]
    check("an event tells each time that it comes to an end", len(stops) > 1 and sorted(stops["tick"].tolist()) == sorted(arrivals), (stops, arrivals))
    check("and which end", all(abs(angles[poses["tick"] == row["tick"]][0] - (0, 0.6)[row["code"] - 1]) < 1e-9 for row in stops), stops)
    check("contacts do not have it", not (contacts["flags"] & 0x180).any())
    table = os.path.join(folder, "door-tables")
    code, told = hapticd("export", file, "--csv", table)
    joints = numpy.genfromtxt(os.path.join(table, "joints.csv"), delimiter=",", names=True, dtype=None, encoding=None)
    check("joints.csv has the angle and the stops by name", code == 0 and set(joints["name"]) == {"door"} and set(joints["unit"]) == {"rad"}
          and abs(joints["position"] - angles).max() < 1e-12 and set(joints["stop"][joints["position"] > 0.6 - 1e-12]) == {1}
          and set(joints["stop"]) == {-1, 0, 1} and abs(joints["t"] - joints["tick"] / 1000).max() < 1e-9, told)
    picture = os.path.join(folder, "door.svg")
    code, told = hapticd("plot", file, "--out", picture)
    drawn = open(picture).read() if code == 0 else ""
    check("plot draws the angle and the stops", ">angle of door<" in drawn and ">end stop: 0 rad<" in drawn and ">end stop: 0.6 rad<" in drawn, told)
    check("models.csv has the names of the numbers", open(os.path.join(table, "models.csv")).read() == "model,name,plugin,from_tick\n0,door,nurbs_rigid,0\n")
    with open(os.path.join(table, "columns.csv"), newline="", encoding="utf-8") as rows:
        units = {(row["stream"], row["column"]): (row["unit"], row["meaning"]) for row in csv.DictReader(rows)}
    expected = {(stream, one["name"]): (one["unit"], one["doc"]) for stream, columns in about["columns"].items() for one in columns}
    check("columns.csv has unit and meaning of every column", units == expected, set(units.items()) ^ set(expected.items()))
    code, told = hapticd("explain", file, "--json")
    check("explain of a recording refuses --json", code == 2 and "explained in words alone" in told, told)


def theManualReadsIt(file):
    """The Python of the manual, run as it stands there."""
    manual = open(os.path.join(SCENES, "..", "..", "driver", "docs", "recording.md")).read()
    lines = manual.split("## Reading one")[1].split("\n    ticks = h5read")[0].split("\n")
    code = "\n".join(line[4:] for line in lines if line.startswith("    ")).replace("run.h5", file)
    names = {}
    exec(code, names)
    ticks = names["ticks"]
    check("the manual's Python reads a recording",
          len(ticks) == 1000 and ticks["arm0_fx"].shape == (1000,) and "columns" in names["about"], ticks.dtype)
    check("a planned end is no event of a fault", FAULT not in names["file"]["events"]["kind"], names["file"]["events"][:])


def ordersAreTold(folder, environment):
    """What people and programs ordered, and a contact that gave no force, because the model was disabled."""
    file = os.path.join(folder, "told.h5")
    command = [HAPTICD, "run", os.path.join(SCENES, "teapot.yaml"), "--for", "60", "--name", "told", "--record", file]
    with subprocess.Popen(command, env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as run:
        ask = program(HAPTICD, environment, together=True)
        code, told = ask("ctl", "--name", "told", "--wait", "30", "set", "teapot", "stiffness", "600", "--consent")
        check("a parameter is set", code == 0, told)
        code, told = ask("ctl", "--name", "told", "set", "teapot", "texture.wavelength", "0.003", "--consent")
        check("and one that the scene does not give", code == 0, told)
        check("a model is disabled", ask("ctl", "--name", "told", "disable", "teapot")[0] == 0)
        time.sleep(1.5)
        ask("ctl", "--name", "told", "stop")
        run.wait(60)
    code, told = hapticd("explain", file)
    for words in (" s  set teapot stiffness 600\n", " s  set teapot texture.wavelength 0.003\n", " s  disable teapot\n", " of it the model gave no force (it was disabled"):
        check(f"explain tells: {words.strip()}", code == 0 and words in told, told)


def aStopIsTold(folder, environment):
    """While a door stands at its end stop, top and list say so, and subscribers hear of it."""
    with subprocess.Popen([HAPTICD, "run", os.path.join(SCENES, "door.yaml"), "--for", "100", "--name", "stop"], env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as run:
        ask = program(HAPTICD, environment, together=True)
        check("the run starts", ask("ctl", "--name", "stop", "--wait", "30", "status")[0] == 0)
        tops, lists = set(), set()
        def bothSeen():
            code, told = ask("top", "--name", "stop", "--once", "--json")
            if code == 0:
                tops.add(json.loads(told)["models"][0]["end"])
            code, told = ask("ctl", "--name", "stop", "list")
            if code == 0:
                lists.add(json.loads(told)["models"][0]["end"])
            return {"lowest", "highest"} <= tops and {"lowest", "highest"} <= lists
        check("top and list tell at which end the door stands", until(bothSeen, 60), (tops, lists))
        ends = lambda: {e.get("end") for e in map(json.loads, ask("ctl", "--name", "stop", "events")[1].splitlines()) if e["event"] == "end_stop"}
        check("the events tell both ends", until(lambda: ends() == {"lowest", "highest"}, 30), ends())
        check("top says it in words", until(lambda: "at its highest end" in ask("top", "--name", "stop", "--once")[1], 60))
        run.terminate()


def aHoldIsAFault(folder, environment):
    """What takes the forces away before the end is told, and once."""
    import h5py
    file = os.path.join(folder, "held.h5")
    command = [HAPTICD, "run", os.path.join(SCENES, "teapot.yaml"), "--for", "60", "--name", "held", "--record", file]
    with subprocess.Popen(command, env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as run:
        ask = program(HAPTICD, environment, together=True)
        end = time.monotonic() + 30
        while time.monotonic() < end and ask("ctl", "--name", "held", "hold")[0] != 0:
            time.sleep(0.2)
        time.sleep(0.3)
        code, told = ask("top", "--name", "nobody", "--once")
        check("top names the daemons that run, as ctl does", code == 1 and all(words in told for words in ("no daemon named nobody runs", "these run: held", "name one of these with --name")), told)
        code, told = ask("ctl", "--name", "held", "stop")
        check("the run that is held ends", code == 0 and run.wait(60) == 0, told)
    events = h5py.File(file)["events"][:]
    faults = events[events["kind"] == FAULT]
    check("a hold is an event of a fault, once", len(faults) == 1 and faults["code"][0] == 8, faults)


def ticksOf(folder, table):
    with open(os.path.join(folder, table, "ticks.csv")) as file:
        return [int(row["tick"]) for row in csv.DictReader(file)]


def exportsADaemon(name, folder, environment):
    """A running daemon is named as ctl, top and view name it, and its last seconds are exported."""
    ask = program(HAPTICD, environment, together=True)
    code, told = ask("export", "--name", name, "--csv", os.path.join(folder, "now"))
    check("export takes the last seconds of a running daemon", code == 0 and "the last seconds of a run" in told, told)
    ticks = ticksOf(folder, "now")
    check("it gives its ticks in order, each once", len(ticks) > 100 and ticks == list(range(ticks[0], ticks[0] + len(ticks))), ticks[:5])
    code, told = ask("export", "--name", "nobody", "--csv", os.path.join(folder, "none"))
    check("export names the daemons that run, as ctl does", code == 1 and all(words in told for words in ("no daemon named nobody runs", f"these run: {name}", "name one of these with --name")), told)
    code, told = ask("export", "--mcap", os.path.join(folder, "none.mcap"))
    check("without a recording it takes the daemon of the default name", code == 1 and "no recording is given (hapticd export RECORDING), and no daemon named hapticd runs" in told, told)
    code, told = ask("export", os.path.join(folder, "killed.h5"), "--name", name, "--csv", os.path.join(folder, "none"))
    check("a recording and a daemon together are refused", code == 2 and "--name" in told and "recording" in told, told)


def killLeavesAReadableFile(folder, environment):
    file = os.path.join(folder, "killed.h5")
    command = [HAPTICD, "run", os.path.join(SCENES, "teapot.yaml"), "--for", "60", "--name", "killed", "--record", file]
    with subprocess.Popen(command, env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as run:
        end = time.monotonic() + 30
        while time.monotonic() < end and run.poll() is None:
            if os.path.isfile(file) and hapticd("replay", file)[0] == 0:
                break
            time.sleep(0.2)
        for command in (("plot", file, "--out", os.path.join(folder, "live.svg")), ("replay", file), ("export", file, "--csv", os.path.join(folder, "live"))):
            code, told = hapticd(*command)
            check(f"{command[0]} of what is still being written says by whom", code == 0 and f"still being written by process {run.pid};" in told
                  and "was killed" not in told and "lost" not in told, told)
        exportsADaemon("killed", folder, environment)
        alive = run.poll() is None
        run.kill()
    check("the run was alive when it was killed", alive)
    code, told = program(HAPTICD, environment, together=True)("export", "--name", "killed", "--csv", os.path.join(folder, "left"))
    check("export takes what a killed daemon left", code == 0 and ticksOf(folder, "left"), told)
    code, told = hapticd("replay", file)
    check("what a kill left replays with every bit the same", code == 0, told)
    picture = os.path.join(folder, "killed.svg")
    code, told = hapticd("plot", file, "--out", picture)
    check("what a kill left can be drawn, and says that it ends early",
          code == 0 and os.path.isfile(picture) and "ends early" in told, told)


with tempfile.TemporaryDirectory() as scratch:
    teapot = replayIsExact(scratch, "teapot")
    replayIsExact(scratch, "moving-box")
    aDoorStandsAtItsStop(scratch)
    theManualReadsIt(teapot)
    status, text = hapticd("plot", teapot, "--from", "2", "--to", "1")
    check("--from after --to is refused by its name", status == 2 and "--from 2 is not before --to 1" in text, text)
    status, text = hapticd("plot", teapot, "--from", "50")
    check("a time beyond the recording is refused with the times it has", status == 2 and "the recording covers" in text, text)
    check("and leaves no picture", not os.path.exists(teapot + ".svg"))
    status, text = hapticd("plot", teapot, "--out", os.path.join(scratch, "teapot.svg"))
    picture = open(os.path.join(scratch, "teapot.svg")).read() if status == 0 else text
    for words in (">teapot<", "asked for by the models", "sent to the arm", "penetration depth", "x of the tip", "% of the ticks"):
        check(f"the picture says {words}", words in picture, picture[:200])
    status, text = hapticd("plot", teapot, "--out", "/dev/null/a.svg")
    check("a picture that cannot be written is bad input, as it is to run", status == 2 and "cannot be written" in text, text)
    status, text = hapticd("replay", teapot, "--set", "teapot.stiffness=900")
    check("a changed stiffness is found", status == 1 and "differ" in text, text)
    bothForcesAreWritten(scratch, teapot)
    environment = dict(os.environ, RUNTIME_DIRECTORY=scratch, STATE_DIRECTORY=scratch)
    ordersAreTold(scratch, environment)
    aStopIsTold(scratch, environment)
    aHoldIsAFault(scratch, environment)
    killLeavesAReadableFile(scratch, environment)
finish()
