#!/usr/bin/env python3
"""A plugin that crashes the daemon, the quarantine that follows, and what the service manager is told meanwhile.

Usage: contain_a_plugin.py HAPTICD SOURCE_DIR TEST_SHAPES.so UNIT_FILE     prints one line per check; exit 1 when one fails.
"""
import json
import os
import re
import shutil
import socket
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "support"))
from e2e import check, finish, program

HAPTICD, SOURCE, SHAPES, UNIT = (os.path.abspath(argument) for argument in sys.argv[1:5])


def hapticd(environment, *arguments):
    return program(HAPTICD, environment)(*arguments)


def sceneOf(folder, how):
    """A good sphere, and the shape that does `how` in its tenth step."""
    file = os.path.join(folder, how + ".yaml")
    sphere = os.path.join(SOURCE, "config", "models", "sphere.yaml")
    open(file, "w").write("hapticd: 1\nmodels:\n"
                          f"  - {{name: good, plugin: nurbs_rigid, parameters: {{geometry: {sphere}}}}}\n"
                          f"  - {{name: bad, plugin: deadly, parameters: {{how: {how}}}}}\n")
    return file


def crash(folder, environment, how, reasons):
    """`reasons`: any of them; a step that does not end meets the watchdog or the kernel's limit first."""
    scene = sceneOf(folder, how)
    code, out, err = hapticd(environment, "check", scene)
    check(f"{how}: check warns of it before a run, at the name of the plugin",
          code == 0 and ":4:" in out and "model bad: when the hand was moved, its plugin " in out and f"plugin check {folder}" in out, (code, out, err))
    code, _, err = hapticd(environment, "run", scene, "--for", "1")
    check(f"{how}: exit code 1", code == 1, (code, err))
    check(f"{how}: the message names plugin, model, reason and cure",
          any(reason in err for reason in reasons) and all(word in err for word in ("'deadly'", "'bad'", "motors were switched off first", "plugin clear deadly",
                                                                                                 f"hapticd plugin check {os.path.join(folder, 'plugins', os.path.basename(SHAPES))}")), err)
    box = os.path.join(environment["STATE_DIRECTORY"], "black-box-deadly.flight")
    code, out, err = hapticd(environment, "plot", box, "--out", os.path.join(folder, how + ".svg"))
    check(f"{how}: the black box bears its name and can be drawn", code == 0, (code, out, err))
    code, out, err = hapticd(environment, "explain", box)
    check(f"{how}: and explain says that it ends in a crash", code == 0 and "no fault before its end, which was a crash" in out, (code, out, err))
    os.path.exists(box) and os.remove(box)
    code, _, err = hapticd(environment, "run", scene, "--for", "0.2", "--report", os.path.join(folder, "report.json"))
    models = json.load(open(os.path.join(folder, "report.json")))["models"]
    check(f"{how}: the next start leaves it out, says so, and runs the rest",
          list(models) == ["good"] and "model bad: plugin 'deadly'" in err and any(reason in err for reason in reasons), (code, err, list(models)))
    code, out, err = hapticd(environment, "check", "--files-only", scene)
    check(f"{how}: check of the scene says that the plugin is in quarantine, why, and how to clear it",
          code == 0 and ":4:" in out and all(word in out for word in ("deadly is in quarantine", "plugin clear deadly")) and any(reason in out for reason in reasons), (out, err))
    code, out, _ = hapticd(environment, "doctor", "--json", "--seconds", "0")
    line = next(c for c in json.loads(out)["checks"] if c["name"] == "quarantine")
    check(f"{how}: doctor warns of it", line["verdict"] == "warn" and "deadly" in line["state"], line)
    check(f"{how}: clear frees it", hapticd(environment, "plugin", "clear", "deadly")[0] == 0)
    check(f"{how}: then check is silent", "quarantine" not in hapticd(environment, "check", "--files-only", scene)[1])
    code, _, err = hapticd(environment, "run", scene, "--for", "0.5")
    check(f"{how}: and it is trusted again", code == 1 and "'deadly'" in err, (code, err))
    hapticd(environment, "plugin", "clear", "deadly")


def slow(folder, environment):
    scene = sceneOf(folder, "slow")
    code, out, err = hapticd(environment, "check", scene)
    check("slow: check says that it did not move the hand to the end, and why",
          code == 0 and ":4:" in out and "models[1].plugin: warning: the hand was not moved to the end" in out and re.search(r"of processor time, because a step of bad takes [\d.]+ ms", out)
          and "a run silences a plugin that needs more" in out and f"hapticd plugin check {folder}" in out, (code, out, err))


def builtAnew(folder, environment):
    """A file that was built after the crash is another plugin: it is tried, and what was known of it is told."""
    file, scene = os.path.join(folder, "plugins", os.path.basename(SHAPES)), sceneOf(folder, "segv")
    hapticd(environment, "run", scene, "--for", "1")
    code, _, err = hapticd(environment, "run", scene, "--for", "0.2")
    check("the same file is left out", code == 1 and "the model is left out" in err, (code, err))
    os.utime(file, ns=(1_700_000_000_000_000_000, 1_700_000_000_123_456_789))
    check("check of the scene does not say that a file that was built anew is in quarantine",
          "quarantine" not in hapticd(environment, "check", "--files-only", scene)[1])
    code, _, err = hapticd(environment, "run", scene, "--for", "1")
    check("a file that was built anew runs again, and the run says what its last build did",
          code == 1 and all(word in err for word in ("the file has changed since", file, "hapticd plugin check", "motors were switched off first")), (code, err))
    code, _, err = hapticd(environment, "run", scene, "--for", "0.2")
    check("if that one ends a run, it is left out too", code == 1 and "the model is left out" in err, (code, err))
    check("clear takes both builds out", hapticd(environment, "plugin", "clear", "deadly")[0] == 0 and
          hapticd(environment, "plugin", "clear", "deadly")[0] == 2)


def overwritten(folder, environment):
    """A file that is written in place takes the code away that runs. The plugin was good."""
    file, scene = os.path.join(folder, "plugins", os.path.basename(SHAPES)), os.path.join(folder, "good.yaml")
    with open(scene, "w") as out:
        out.write("hapticd: 1\nmodels:\n  - {name: fine, plugin: misbehaving, parameters: {after: 1000000000}}\n")
    run = subprocess.Popen([HAPTICD, "run", scene, "--for", "20"], env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    for line in run.stderr:
        if "runs as" in line:
            break
    time.sleep(0.5)
    os.truncate(file, 0)
    err = run.communicate(timeout=60)[1]
    check("a file that is written in place: the message says so, after the motors were switched off",
          run.returncode == 1 and "written in place" in err and "motors were switched off first" in err, (run.returncode, err))
    shutil.copy(SHAPES, file)
    hapticd(environment, "plugin", "clear", "misbehaving")


class Manager:
    """The service manager's end of the notification socket."""

    def __init__(self, folder):
        self.file = os.path.join(folder, "notify")
        self.socket = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)
        self.socket.bind(self.file)
        self.socket.settimeout(0.1)

    def listen(self, seconds, run, enough=lambda told: False):
        """(seconds since now, message) until the time is over, the run has ended, or `enough` has come."""
        begun, told = time.monotonic(), []
        while time.monotonic() - begun < seconds and not enough(told):
            try:
                told.append((time.monotonic() - begun, self.socket.recv(4096).decode()))
            except TimeoutError:
                if run.poll() is not None:
                    break
        return told

    def start(self, environment, scene):
        more = {"NOTIFY_SOCKET": self.file, "WATCHDOG_USEC": "400000"}
        return subprocess.Popen([HAPTICD, "run", scene, "--for", "60"], env=dict(environment, **more),
                                stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


def service(folder, environment):
    manager = Manager(folder)
    run = manager.start(environment, os.path.join(SOURCE, "config", "scenes", "teapot.yaml"))
    fed = lambda told: sum(text == "WATCHDOG=1" for _, text in told) >= 6
    told = manager.listen(30, run, fed)
    ready = [t for t, text in told if text.startswith("READY=1")]
    check("READY comes once, after 2000 dry cycles", len(ready) == 1 and ready[0] >= 2.0 and "of 2000 dry cycles" in str(told), told)
    check("the watchdog is fed while the servo ticks", fed(told), told)
    run.terminate()
    told = manager.listen(10, run)
    check("STOPPING is told at the end", any(text == "STOPPING=1" for _, text in told), told)
    run.wait(10)
    run = manager.start(environment, sceneOf(folder, "hang"))
    told = manager.listen(30, run)
    check("a stuck servo stops the feeding and ends", run.poll() == 1 and sum(t == "WATCHDOG=1" for _, t in told) <= 2,
          (run.poll(), told))
    run.kill()


def unit(folder):
    if shutil.which("systemd-analyze") is None:
        return print("skipped: the unit file, systemd-analyze is missing")
    text = [f"ExecStart={HAPTICD} run /etc/hapticd/scene.yaml" if line.startswith("ExecStart=") else
            "" if line.startswith(("User=", "Group=")) else line for line in open(UNIT).read().split("\n")]
    file = os.path.join(folder, "hapticd.service")
    open(file, "w").write("\n".join(text))
    done = subprocess.run(["systemd-analyze", "verify", "--man=no", file], capture_output=True, text=True, timeout=60)
    complaints = [line for line in done.stderr.split("\n") if "hapticd" in line]
    check("systemd takes the unit file without a complaint", not complaints, done.stderr)


with tempfile.TemporaryDirectory() as scratch:
    os.makedirs(os.path.join(scratch, "plugins"))
    os.makedirs(os.path.join(scratch, "state"))
    shutil.copy(SHAPES, os.path.join(scratch, "plugins"))
    surroundings = dict(os.environ, HAPTICD_PLUGIN_PATH=os.path.join(scratch, "plugins"), RUNTIME_DIRECTORY=scratch,
                        STATE_DIRECTORY=os.path.join(scratch, "state"))
    for signal, words in (("segv", ["SIGSEGV"]), ("fpe", ["SIGFPE"]), ("bus", ["SIGBUS"]), ("ill", ["SIGILL"]), ("abort", ["SIGABRT"]),
                          ("hang", ["did not return", "never slept"])):
        crash(scratch, surroundings, signal, words)
    slow(scratch, surroundings)
    builtAnew(scratch, surroundings)
    overwritten(scratch, surroundings)
    service(scratch, surroundings)
    unit(scratch)
finish()
