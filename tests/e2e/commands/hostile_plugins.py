#!/usr/bin/env python3
"""Plugins that crash, end the process, sleep or never return: check, trace and explain name plugin, model and call, and end.

Usage: hostile_plugins.py HAPTICD SOURCE_DIR HARMFUL_SHAPES.so     exit 1 when a check fails
"""
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "support"))
from e2e import check, finish, program, until

HAPTICD, SOURCE, SHAPES = (os.path.abspath(argument) for argument in sys.argv[1:4])


def sceneOf(folder, how):
    """A good sphere, and the shape that harms its host, in line 4."""
    file = os.path.join(folder, how + ".yaml")
    sphere = os.path.join(SOURCE, "config", "models", "sphere.yaml")
    open(file, "w").write("hapticd: 1\nmodels:\n"
                          f"  - {{name: good, plugin: nurbs_rigid, parameters: {{geometry: {sphere}}}}}\n"
                          f"  - {{name: bad, plugin: harmful, parameters: {{how: {how}}}}}\n")
    return file


def walks(folder, hapticd):
    """What check says when the hand has met the plugin."""
    _, out, err = hapticd("check", sceneOf(folder, "good"))
    check("a good plugin is not blamed", "hand was moved" not in out and " wait" not in out and "process" not in out, (out, err))
    for how, words in (("pause", "did not return within 10 s, in its step()"), ("exit", "ended the process with code 0, in its step()"),
                       ("quick_exit", "ended the process with code 0, in its step()"), ("stack", "crashed: Segmentation fault, in its step()"),
                       ("thread", "crashed: Segmentation fault, in a thread that it had started")):
        code, out, err = hapticd("check", sceneOf(folder, how))
        check(f"{how}: check names model, end and call, at the name of the plugin",
              code == 0 and ":4:" in out and f"model bad: when the hand was moved, its plugin {words}" in out and "hapticd plugin check " in out, (code, out, err))
    code, out, err = hapticd("check", sceneOf(folder, "fork"))  # its child lives for 60 s, and is not waited for
    check("fork: check is not kept waiting", code == 0 and "took longer" not in out + err and "did not return" not in out + err, (code, out, err))
    code, out, err = hapticd("check", sceneOf(folder, "sleep"))
    check("sleep: check says that the steps wait, and in how many ticks",
          code == 0 and re.search(r":4:.*steps of bad wait, in \d+ of \d+ ticks", out) is not None and "hapticd plugin check " in out, (code, out, err))
    code, out, err = hapticd("check", sceneOf(folder, "close"))
    check("close: check says what happened, and which plugin is the likely cause",
          code == 0 and ":4:" in out and "closed a file that it had not opened" in out and "plugin 'harmful' of model bad" in out, (code, out, err))


def destructor(folder, hapticd):
    scene = sceneOf(folder, "destructor")
    code, out, err = hapticd("check", scene)
    check("destructor: check warns of the crash at the end", code == 0 and ":4:" in out and "plugin 'harmful' of model 'bad' crashes when the process ends" in out, (code, out, err))
    path = os.path.join(folder, "path.csv")
    open(path, "w").write("t,x,y,z\n0,0,0,0.2\n0.001,0,0,0.19\n")
    for command in (("trace", scene, "--probe", path, "--out", os.path.join(folder, "out.csv")), ("explain", scene)):
        code, out, err = hapticd(*command)
        check(f"destructor: {command[0]} names plugin and model", code == 1 and "plugin 'harmful' of model 'bad'" in err and "SIGSEGV" in err, (code, err))


def setUps(folder, environment, hapticd):
    """A set-up that never returns."""
    scene = sceneOf(folder, "loop")
    code, out, err = hapticd("check", "--setup-limit", "1", scene)
    check("loop: check ends it, and names plugin, model and call",
          code == 2 and ":4:" in out and "plugin 'harmful' of model 'bad' did not return within 1 s, in its activate()" in out and "--setup-limit" in out, (code, out, err))
    path = os.path.join(folder, "path.csv")
    for command, words in ((("check", scene), "harmful' has been in its activate() for "), (("explain", scene), "bad: plugin 'harmful' has been in its activate() for 10 s"),
                           (("trace", scene, "--probe", path, "--out", "-"), "bad: plugin 'harmful' has been in its activate() for 10 s"),
                           (("run", scene, "--virtual-time", "--for", "1"), "bad: plugin 'harmful' has been in its activate() for 10 s")):
        run = subprocess.Popen([HAPTICD, *command], env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
        os.set_blocking(run.stderr.fileno(), False)
        told = []
        check(f"loop: {command[0]} says what it waits for", until(lambda: told.append(run.stderr.read() or b"") or words in b"".join(told).decode(), 100), b"".join(told))
        run.send_signal(signal.SIGINT)
        check(f"loop: {command[0]} ends when it is told to", until(lambda: run.poll() is not None), run.poll())
        run.kill()
        run.wait()


def heldUp(folder, environment, hapticd):
    """A model that is added to a run, and whose set-up never returns."""
    log = os.path.join(folder, "held_up.log")
    run = subprocess.Popen([HAPTICD, "run", sceneOf(folder, "good"), "--name", "held_up"], env=environment, stdout=subprocess.DEVNULL, stderr=open(log, "w"))
    check("the run is ready", until(lambda: hapticd("ctl", "status", "--name", "held_up")[0] == 0), open(log).read())
    scene = os.path.join(folder, "added.yaml")
    open(scene, "w").write("hapticd: 1\nmodels:\n  - {name: late, plugin: harmful, parameters: {how: loop}}\n")
    add = subprocess.Popen([HAPTICD, "ctl", "add", scene, "--name", "held_up"], env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    check("added: the log of the run says what it waits for", until(lambda: "late: plugin 'harmful' has been in its activate() for 5 s; the other models are felt" in open(log).read(), 60), open(log).read())
    code, out, err = hapticd("ctl", "hold", "--name", "held_up")
    check("added: the arms can be held meanwhile", code == 0, (code, out, err))
    code, out, err = hapticd("ctl", "list", "--name", "held_up")
    check("added: another request says what it may wait for", code == 1 and "did not answer in time" in err and "setting up a model" in err, (code, out, err))
    code, out, err = hapticd("ctl", "stop", "--name", "held_up")
    told = add.communicate(timeout=60)[0]
    check("added: the run can be stopped", until(lambda: run.poll() is not None, 60), run.poll())
    check("added: the one who waits hears why, and that the run has ended", add.returncode == 1 and "still sets up the models" in told and "has ended without an answer" in told, told)


def orphan(folder, environment):
    """check is killed while its child moves the hand."""
    scene = sceneOf(folder, "pause")
    run = subprocess.Popen([HAPTICD, "check", scene], env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)

    def children():
        return [int(child) for child in open(f"/proc/{run.pid}/task/{run.pid}/children").read().split()]

    def walk():  # the child that lasts
        before = children()
        return before and not until(lambda: children() != before, 2)

    check("check moves the hand in a child", until(walk, 60))
    child = children()[0]
    run.kill()
    run.wait()

    def gone():
        try:
            return "\nState:\tZ" in open(f"/proc/{child}/status").read()
        except OSError:
            return True
    check("if check is killed, its child ends, too", until(gone))


with tempfile.TemporaryDirectory() as scratch:
    os.makedirs(os.path.join(scratch, "plugins"))
    shutil.copy(SHAPES, os.path.join(scratch, "plugins"))
    surroundings = dict(os.environ, HAPTICD_PLUGIN_PATH=os.path.join(scratch, "plugins"), XDG_STATE_HOME=os.path.join(scratch, "state"))
    surroundings.pop("STATE_DIRECTORY", None)
    caller = program(HAPTICD, surroundings, 300)
    walks(scratch, caller)
    destructor(scratch, caller)
    setUps(scratch, surroundings, caller)
    heldUp(scratch, surroundings, caller)
    orphan(scratch, surroundings)
finish()
