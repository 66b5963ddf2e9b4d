#!/usr/bin/env python3
"""A model that the guard has silenced is seen at once: in top, ctl list and ctl status; ctl enable says what to do.

Usage: silenced.py HAPTICD TEST_SHAPES.so       exit 1 when one is off
"""
import json
import os
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "support"))
from e2e import check, finish, program

HAPTICD, SHAPES = sys.argv[1:3]

with tempfile.TemporaryDirectory(dir="/dev/shm") as folder:
    environment = dict(os.environ, RUNTIME_DIRECTORY=folder, STATE_DIRECTORY=folder, HAPTICD_PLUGIN_PATH=os.path.dirname(SHAPES))
    scene = os.path.join(folder, "scene.yaml")
    open(scene, "w").write("hapticd: 1\nhand: {script: none}\nmodels:\n  - {name: good, plugin: wall, pose: {position: [0, -0.2, 0]}}\n"
                           "  - {name: bad, plugin: misbehaving, parameters: {how: not_finite, after: 100, times: 10}}\n")

    def ask(*arguments):
        return program(HAPTICD, environment)(*(() if arguments[0] == "top" else ("ctl",)), *arguments, "--name", "hush")

    recorded = os.path.join(folder, "run.h5")
    program(HAPTICD, environment)("run", scene, "--virtual-time", "--for", "1", "--record", recorded)
    code, out, err = program(HAPTICD, environment)("explain", recorded)
    check("explain of a recording names a command that finds the file", "plugin check FILE.so (`hapticd plugin info misbehaving` names the file)" in out, (out, err))
    run = subprocess.Popen([HAPTICD, "run", scene, "--name", "hush", "--for", "60"], env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    try:
        silenced, deadline = [], time.monotonic() + 40
        while not silenced and time.monotonic() < deadline and run.poll() is None:
            code, out, err = ask("status")
            silenced = json.loads(out)["silenced"] if code == 0 else []
        check("status names the model and the reason", [s["model"] for s in silenced] == ["bad"] and "not finite" in silenced[0]["why"]
              and "find the step with: hapticd plugin check" in silenced[0]["why"], silenced)
        code, out, err = ask("list")
        by_name = {m["name"]: m["silenced"] for m in json.loads(out)["models"]} if code == 0 else {}
        check("list does", by_name.get("good", 1) is None and "not finite" in (by_name.get("bad") or ""), (by_name, err))
        code, out, err = ask("top", "--once")
        check("top does, in its line and below", "SILENCED" in out and "not finite" in out, out)
        code, out, err = ask("top", "--once", "--json")
        check("and as JSON", code == 0 and any(m["silenced"] and m["name"] == "bad" for m in json.loads(out)["models"]), out)
        code, out, err = ask("enable", "bad")
        check("enable refuses, and says what to do", code == 1 and "reload" in err, (code, err))
        check("a good one is enabled", ask("enable", "good")[0] == 0)
        lines = subprocess.Popen([HAPTICD, "top", "--json", "--every", "0.1", "--name", "hush"], env=environment, stdout=subprocess.PIPE, text=True)
        told = [json.loads(lines.stdout.readline()) for _ in range(3)]
        lines.terminate()
        lines.wait()
        frames = subprocess.Popen([HAPTICD, "top", "--name", "hush"], env=environment, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, text=True)
        first = frames.stdout.readline()
        frames.terminate()
        frames.communicate()
        check("the first view of top tells the rate so far", "Hz asked, " in first and ", 0 held" not in first, first)
        check("top --json is a stream of lines", told[0]["ticks"] <= told[1]["ticks"] <= told[2]["ticks"] and "held_hz" in told[2], told)
    finally:
        run.terminate()
        run.communicate()
finish()
