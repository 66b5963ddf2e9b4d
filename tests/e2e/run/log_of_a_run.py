#!/usr/bin/env python3
"""The log tells of a silenced model while the run goes on, in words and as JSON, and refuses a file that it cannot write.

Usage: log_of_a_run.py HAPTICD SOURCE_DIR TEST_SHAPES.so     prints one line per check; exit 1 when one fails.
"""
import json
import os
import shutil
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "support"))
from e2e import check, finish, program

HAPTICD, SOURCE, SHAPES = (os.path.abspath(argument) for argument in sys.argv[1:4])


def sceneOf(folder):
    """A shape that answers nonsense from its three hundredth step on."""
    file = os.path.join(folder, "scene.yaml")
    open(file, "w").write("hapticd: 1\nmodels:\n"
                          "  - {name: bad, plugin: misbehaving, parameters: {how: bad_status, after: 300, times: 100000}}\n")
    return file


def linesOf(file):
    return open(file).read().splitlines() if os.path.exists(file) else []


def waitFor(file, words, run, seconds=60):
    """The first line with all these words that is there while the run is alive; None: there was none."""
    end = time.monotonic() + seconds
    while time.monotonic() < end and run.poll() is None:
        for line in linesOf(file):
            if all(word in line for word in words):
                return line if run.poll() is None else None
        time.sleep(0.05)
    return None


def tellsWhenItHappens(folder, environment, scene):
    log = os.path.join(folder, "run.log")
    with subprocess.Popen([HAPTICD, "run", scene, "--for", "600", "--log-file", log], env=environment,
                          stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True) as run:
        line = waitFor(log, ("error:", "model bad", "silenced"), run)
        run.terminate()
        err = run.communicate()[1]
    check("the log tells of a silenced model while the run goes on", line is not None, (linesOf(log), err))
    check("and so does stderr", "model bad: its plugin returned status -77" in err, err)


def tellsAsJson(folder, environment, scene):
    log = os.path.join(folder, "run.jsonl")
    with subprocess.Popen([HAPTICD, "run", scene, "--for", "600", "--log-file", log, "--log-json", "--log-level", "error"],
                          env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as run:
        line = waitFor(log, ("silenced",), run)
        run.terminate()
    told = [json.loads(one) for one in linesOf(log)]
    check("--log-json writes an object a line", line is not None and all({"time", "level", "who", "text"} == set(one) for one in told), told)
    check("--log-level error leaves the rest out", {one["level"] for one in told} == {"error"}, told)


with tempfile.TemporaryDirectory() as scratch:
    plugins = os.path.join(scratch, "plugins")
    os.makedirs(plugins)
    shutil.copy(SHAPES, plugins)
    around = dict(os.environ, RUNTIME_DIRECTORY=scratch, STATE_DIRECTORY=scratch, HAPTICD_PLUGIN_PATH=plugins)
    bad = sceneOf(scratch)
    tellsWhenItHappens(scratch, around, bad)
    tellsAsJson(scratch, around, bad)
    hapticd = program(HAPTICD, around, together=True)
    code, text = hapticd("run", bad, "--for", "1", "--virtual-time", "--log-file", "/dev/null/no.log")
    check("a log that cannot be written is bad input", code == 2 and "/dev/null/no.log: cannot be written" in text, text)
    code, text = hapticd("run", bad, "--for", "1", "--log-level", "loud")
    check("a level that is none is bad usage", code == 2 and "loud" in text, text)
finish()
