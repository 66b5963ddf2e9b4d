#!/usr/bin/env python3
"""A plugin that crashes, exits or never comes back in a command without a real arm: in virtual time, in trace, explain,
check, replay and tune, in a step and in the set-up. The plugin, its model, the call and the line of the scene are told, no
end is taken for success, and Ctrl-C ends what hangs.

Usage: simulated_ends_test.py HAPTICD RIG.so ENDING_SHAPES.so SOURCE     prints one line per check; exit 1 when one fails.
"""
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time

here = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(here, "..", "..", "support"))
from e2e import LONG, check, finish

HAPTICD, _, SHAPES, SOURCE = (os.path.abspath(argument) for argument in sys.argv[1:5])
FOLDER = tempfile.mkdtemp()
shutil.copyfile(SHAPES, os.path.join(FOLDER, "ending.so"))
ENVIRONMENT = dict(os.environ, HAPTICD_PLUGIN_PATH=FOLDER, STATE_DIRECTORY=FOLDER, RUNTIME_DIRECTORY=FOLDER)
PROBE = os.path.join(FOLDER, "probe.csv")
with open(PROBE, "w") as rows:
    rows.write("t,x,y,z\n" + "".join(f"{i / 1000},0,0,{0.05 - i * 1e-5}\n" for i in range(600)))
RUN, TRACE = ("run", "--virtual-time", "--for", "2"), ("trace", "--probe", PROBE, "--out", os.path.join(FOLDER, "out.csv"))
EXPLAIN, CHECK, TUNE = ("explain",), ("check",), ("tune", "--probe", PROBE)


def scene(plugin, parameters):
    """A model that is asked for in line 4."""
    file = os.path.join(FOLDER, "scene.yaml")
    with open(file, "w") as out:
        out.write("hapticd: 1\nmodels:\n  # the bad one\n"
                  f"  - {{name: bad, plugin: {plugin}, parameters: {{{parameters}}}}}\n")
    return file


def start(command, file):
    return subprocess.Popen([HAPTICD, command[0], file, *command[1:]], env=ENVIRONMENT, stdout=subprocess.PIPE,
                            stderr=subprocess.STDOUT, text=True)


def said_by(process, seconds=60):
    try:
        return process.communicate(timeout=seconds)[0]
    except subprocess.TimeoutExpired:
        process.kill()
        return process.communicate()[0] + "(it never ended)"


def quarantined():
    file = os.path.join(FOLDER, "quarantine")
    text = open(file).read() if os.path.exists(file) else ""
    if text:
        os.remove(file)
    return text


def ends(command, plugin, parameters, call, reason):
    process = start(command, scene(plugin, parameters))
    said, name = said_by(process), f"{command[0]}, {parameters}"
    check(f"{name}: exit code 1", process.returncode == (2 if command == CHECK else 1), (process.returncode, said))
    check(f"{name}: plugin, model, call, reason and place are told",
          all(word in said for word in (f"'{plugin}' of model 'bad'", call, reason, "scene.yaml:4")), said)
    kept = quarantined()
    check(f"{name}: {'in' if command == RUN else 'no'} quarantine", (plugin in kept) == (command == RUN), kept)


for command in (RUN, TRACE):
    ends(command, "ending", "how: segv, after: 40", "in a step", "SIGSEGV")
    ends(command, "ending", "how: plain_exit, after: 40", "in a step", "_exit()")
    ends(command, "ending", "how: exit, after: 40", "in a step", "exit()")
    ends(command, "ending", f"how: raise, signal: {int(signal.SIGTERM)}, after: 40", "in a step", "SIGTERM")
for command in (RUN, TRACE, EXPLAIN, TUNE):
    ends(command, "broken", "where: set_up", "in its activate()", "SIGSEGV")
    ends(command, "broken", "where: set_up_exit", "in its activate()", "_exit()")
ends(TUNE, "ending", "how: segv, after: 400", "in a step", "SIGSEGV")
ends(EXPLAIN, "ending", "how: segv, after: 40", "in a step", "SIGSEGV")
ends(CHECK, "broken", "where: set_up", "in its activate()", "Segmentation fault")
ends(CHECK, "broken", "where: set_up_exit", "in its activate()", "ended the process")


# Memory that a plugin overwrote ends the daemon's own code later: what does not ship with hapticd is named first.
process = start((*RUN,), scene("broken", "where: tears"))
said = said_by(process)
check("torn memory: exit code 1", process.returncode == 1, (process.returncode, said))
check("torn memory: the plugin that does not ship is named, and its check comes first",
      all(word in said for word in ("memory was overwritten, or freed twice", "does not ship with hapticd", "'broken' of model 'bad'", "hapticd plugin check")) and
      "doctor" not in said, said)
kept = quarantined()
check("torn memory: it is in quarantine", kept.startswith("broken\t") and "SIGABRT" in kept, kept)
sphere = os.path.join(SOURCE, "config", "models", "sphere.yaml")
with open(os.path.join(FOLDER, "ours.yaml"), "w") as out:
    out.write(f"hapticd: 1\nmodels:\n  - {{name: good, plugin: nurbs_rigid, parameters: {{geometry: {sphere}}}}}\n"
              "  - {name: bad, plugin: broken, parameters: {where: tears}}\n")
said = said_by(start((*RUN,), os.path.join(FOLDER, "ours.yaml")))
check("torn memory: a plugin that ships is not suspected", "'broken' of model 'bad'" in said and "'nurbs_rigid' of" not in said, said)
check("torn memory: nor left out", [line.split("\t")[0] for line in quarantined().splitlines()] == ["broken"])

# A step that never comes back ends by itself, after 5 s of processor time. Two ways watch it: a run's, and that of the others.
for command in (RUN, TRACE, EXPLAIN, TUNE) if LONG else (RUN, TRACE):
    ends(command, "ending", "how: loop, after: 40", "", "a step that did not return")


BUSY = 0.8  # [s] of processor time; until its loop a command takes less than half of that


def busy(process, seconds):
    """It has used so much processor time: it is in its loop."""
    end = time.monotonic() + 60
    while time.monotonic() < end and process.poll() is None:
        with open(f"/proc/{process.pid}/stat") as stat:
            words = stat.read().rsplit(")", 1)[1].split()
        if (int(words[11]) + int(words[12])) / os.sysconf("SC_CLK_TCK") > seconds:
            return True
        time.sleep(0.05)
    return False


def hangs(command, plugin, parameters, number):
    process, name = start(command, scene(plugin, parameters)), f"{command[0]}, {parameters}, {number.name}"
    begun = busy(process, BUSY)
    process.send_signal(number)
    said = said_by(process, 30)
    check(f"{name}: it ends and is no success", begun and "(it never ended)" not in said and process.returncode != 0,
          (begun, process.returncode, said))
    check(f"{name}: what kept it is named", f"'{plugin}' of model 'bad'" in said, said)
    quarantined()


for number in (signal.SIGTERM, signal.SIGINT):
    hangs(RUN, "ending", "how: loop, after: 40", number)
hangs(RUN, "broken", "where: set_up_loop", signal.SIGTERM)
hangs(TRACE, "ending", "how: loop, after: 40", signal.SIGINT)
hangs(EXPLAIN, "ending", "how: loop, after: 40", signal.SIGTERM)
hangs(TUNE, "ending", "how: loop, after: 400", signal.SIGTERM)

# A recording of a model that behaves is replayed with one that does not: parameters may be changed, choices by number.
recording = os.path.join(FOLDER, "run.h5")
good = start((*RUN, "--record", recording), scene("ending", "how: never, after: 40"))
said_by(good)
HOWS = ["never", "exit", "quick_exit", "exit_in_thread", "segv_in_thread", "abort_in_thread", "raise", "kill_itself", "timer",
        "masked_segv", "reset_segv", "plain_exit", "raw_exit", "loop", "segv"]
for how, word in (("segv", "SIGSEGV"), ("plain_exit", "_exit()")):
    again = start(("replay", "--set", f"bad.how={HOWS.index(how)}"), recording)
    said = said_by(again)
    check(f"replay, {how}: plugin, call and reason are told",
          again.returncode == 1 and all(w in said for w in ("'ending' of model 'bad'", "in a step", word)), (again.returncode, said))
again = start(("replay", "--set", f"bad.how={HOWS.index('loop')}"), recording)
begun = busy(again, BUSY)
again.terminate()
said = said_by(again, 30)
check("replay, loop: SIGTERM ends it, and its plugin is named", begun and again.returncode != 0 and "'ending' of model 'bad'" in said, said)
shutil.rmtree(FOLDER)
finish()
