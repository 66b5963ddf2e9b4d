#!/usr/bin/env python3
"""What a person who writes a plugin is told: of words for choices, of values that are none, of a library that was built
anew under a running daemon, of a model whose steps ask for memory, and of the line that a plugin's words are about.

Usage: messages_to_plugin_authors.py HAPTICD WORDY_SHAPE.so SOURCE     prints one line per check; exit 1 when one fails.
"""
import json
import os
import shutil
import subprocess
import sys
import tempfile

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "support"))
from e2e import check, finish, program, until

HAPTICD, SHAPE, SOURCE = (os.path.abspath(argument) for argument in sys.argv[1:4])


def scene(folder, parameters):
    file = os.path.join(folder, "scene.yaml")
    with open(file, "w") as out:
        out.write(f"hapticd: 1\nmodels:\n  - name: donut\n    plugin: wordy\n    parameters: {{\n{parameters}}}\n")
    return file


def words(ask):
    ask_value = lambda name: json.loads(ask("get", "donut", name)[1])["value"]
    for word, value in (("hertz", "hertz"), ("0", "linear"), ("1", "hertz")):
        code, out, err = ask("set", "donut", "law", word)
        check(f"law is set to {word}", code == 0 and ask_value("law") == value, (code, out, err))
    for word, value in (("true", True), ("off", False), ("1", True)):
        code, out, err = ask("set", "donut", "loud", word)
        check(f"loud is set to {word}", code == 0 and ask_value("loud") is value, (code, out, err))
    code, out, err = ask("set", "donut", "push", "0.25")
    check("push is set to a number", code == 0 and ask_value("push") == 0.25, (code, out, err))
    for parameter, word, expected in (("law", "herz", "expected one of linear, hertz"), ("law", "2", "expected one of linear, hertz"),
                                      ("loud", "maybe", "expected true or false"), ("push", "abc", "\"abc\" is not a number, expected a number from 0 to 3 N"),
                                      ("push", "7", "7 is out of range, expected a number from 0 to 3 N"), ("whole", "1.5", "expected a whole number from 0 to 9"),
                                      ("fixed", "abc", "cannot change while the model runs"), ("file", "x.csv", "cannot change while the model runs"),
                                      ("lw", "hertz", "did you mean \"law\"?"), ("fixd", "1", "not live change in the scene, then: hapticd ctl reload")):
        code, out, err = ask("set", "donut", parameter, word)
        check(f"{parameter} {word} is refused in words", code == (1 if "cannot change" in expected else 2) and expected in err and "Could not" not in err, (code, out, err))
    live = {p["id"]: p for p in json.loads(ask("list")[1])["models"][0]["live_parameters"]}
    check("list has the words of the choice, and nothing that cannot change", live["law"].get("choices") == ["linear", "hertz"] and
          set(live) == {"law", "loud", "push", "whole"}, live)
    code, out, err = ask("feature", "donut", "few")
    check("a number that is none is told so", code == 2 and "expected a whole number" in err and "Could not" not in err, (code, err))


def builtAnew(ask, library):
    code, out, err = ask("reload")
    check("a library that is as it was is no news", code == 0 and "notes" not in json.loads(out), (code, out, err))
    shutil.copyfile(SHAPE, library + ".new")
    os.replace(library + ".new", library)
    code, out, err = ask("reload")
    check("a library that was built anew is told by reload", code == 0 and "this run goes on with the old code" in "".join(json.loads(out).get("notes", [])) and
          "'wordy'" in out, (code, out, err))
    ask("remove", "donut")
    code, out, err = ask("add", scene(os.path.dirname(library), ""))
    check("and by add, where nobody used it meanwhile", code == 0 and "this run goes on with the old code" in out, (code, out, err))


def withADaemon(folder, environment, library):
    run = subprocess.Popen([HAPTICD, "run", scene(folder, ""), "--name", "w", "--for", "100", "--log-file", os.path.join(folder, "run.log")],
                           env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    ask = lambda *arguments: program(HAPTICD, environment)("ctl", "--name", "w", *arguments)
    try:
        check("the daemon runs", until(lambda: ask("status")[0] == 0))
        words(ask)
        builtAnew(ask, library)
        with open(os.path.join(folder, "run.log")) as log:
            check("the log has it", "has changed since this daemon loaded it" in log.read())
    finally:
        run.terminate()
        run.wait(60)


def places(folder, hapticd):
    code, out, err = hapticd("check", scene(folder, "law: 1"))
    check("a number in place of a word is no slip of a comma", code == 2 and ":6:6: models[0].parameters.law: " in out and "expected one of linear, hertz" in out and
          "comma" not in out, out)
    code, out, err = hapticd("check", scene(folder, "file: 3"))
    check("nor in place of a file", code == 2 and "there is no file" in out and "comma" not in out, out)
    code, out, err = hapticd("check", scene(folder, "push: 1,\nrefuses: true"))
    check("what a plugin says of a parameter stands at its line", code == 2 and ":7:10: models[0].parameters.refuses: " in out and "it was told to" in out, out)
    mesh = os.path.join(SOURCE, "config", "models", "leaf.yaml")
    soft = os.path.join(folder, "soft.yaml")
    with open(soft, "w") as out:
        out.write(f"hapticd: 1\nmodels:\n  - name: body\n    plugin: mat_deformable\n    parameters:\n      geometry: {mesh}\n      stiffness: 900\n")
    code, out, err = hapticd("check", soft)
    check("a stiffness that the body's file overrides is told at its line", ":7:18: models[0].parameters.stiffness: warning: has no effect: " in out, (code, out, err))


def memory(folder, hapticd):
    code, out, err = hapticd("check", scene(folder, "allocates: 2"))
    check("check warns of a plugin that allocates in a step", code == 0 and "models[0].plugin: warning: steps of donut allocate memory" in out, (out, err))
    code, out, err = hapticd("check", scene(folder, ""))
    check("and of no other", "allocate" not in out, (out, err))
    code, out, err = hapticd("run", scene(folder, "allocates: 2"), "--virtual-time", "--for", "1")
    check("steps that ask for memory name their model", "mostly in the plugin wordy (donut)" in out + err, (code, out, err))
    code, out, err = hapticd("run", scene(folder, ""), "--virtual-time", "--for", "1")
    check("others do not", code == 0 and "allocated memory" not in out + err, (code, out, err))


with tempfile.TemporaryDirectory(dir="/dev/shm") as scratch:
    copy = os.path.join(scratch, "wordy.so")
    shutil.copyfile(SHAPE, copy)
    surroundings = dict(os.environ, RUNTIME_DIRECTORY=scratch, STATE_DIRECTORY=scratch, HAPTICD_PLUGIN_PATH=scratch)
    places(scratch, program(HAPTICD, surroundings))
    if "--without-counters" not in sys.argv:
        memory(scratch, program(HAPTICD, surroundings))
    withADaemon(scratch, surroundings, copy)
finish()
