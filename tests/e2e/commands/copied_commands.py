#!/usr/bin/env python3
"""The commands that the program prints can be copied into a shell as they are, whatever the names of the files.

Usage: copied_commands.py HAPTICD SOURCE     prints one line per case; exit 1 when one is off.
"""
import os
import re
import shutil
import subprocess
import sys
import tempfile

HAPTICD, SOURCE = os.path.abspath(sys.argv[1]), os.path.abspath(sys.argv[2])
sys.path.insert(0, os.path.join(SOURCE, "tests", "support"))
from e2e import check, finish, write

FOLDER = "it's a $folder (1)"


def shell(command):
    """Runs a copied command as a user does. @returns the exit code and all that was printed"""
    done = subprocess.run(["sh", "-c", command], cwd=work, capture_output=True, text=True, timeout=120, stdin=subprocess.DEVNULL,
                          env=dict(os.environ, PATH=os.path.dirname(HAPTICD) + ":" + os.environ["PATH"], TMPDIR=work))
    return done.returncode, done.stdout + done.stderr


def copied(text, begin, replaced=()):
    """The printed command that begins like this, up to a comment or the words behind it."""
    found = re.search(re.escape(begin) + r"(?: +(?:'(?:[^']|\\'|'\\'')*'|[^\s';,]|'\\'')+)+", text)
    command = found[0] if found else ""
    for old, new in replaced:
        command = command.replace(old, new)
    return command


def tried(what, words, begin, expected=0, replaced=()):
    """A command prints another one, and this one finds its files. @returns what the first one printed"""
    done = subprocess.run([HAPTICD, *words], cwd=work, capture_output=True, text=True, timeout=120, stdin=subprocess.DEVNULL)
    text = done.stdout + done.stderr
    command = copied(text, begin, replaced)
    code, said = shell(command) if command else (-1, "")
    check(f"{what}: {begin} ... works as printed", code == expected and "no such file" not in said, (text, command, code, said))
    return text


def devices(folder):
    arm = os.path.join(folder, "my arm's.yaml")
    words = ["device", "new", "mine", "-o", arm]
    text = tried("a new device", words, "hapticd check")
    scene = write(os.path.join(work, folder), "plain.yaml", "hapticd: 1\nmodels: []\n")
    check("each of its commands has the whole name", text.count("'it'\\''s a $folder (1)/my arm'\\''s.yaml'") == 6, text)
    twin = os.path.join(folder, "my twin's.yaml")
    tried("a twin", ["device", "twin", os.path.join(SOURCE, "config", "devices", "premium15.yaml"), "-o", twin], "hapticd check SCENE.yaml --device",
          replaced=(("SCENE.yaml", os.path.relpath(scene, work).join("\"\"").replace("$", "\\$")),))


def plugins(folder):
    text = tried("a new plugin", ["plugin", "new", "my_shape", "--language", "c", "--dir", os.path.join(folder, "my shape")], "gcc -std=c11")
    code, said = shell(copied(text, "hapticd plugin check"))
    check("what was built is checked as printed", code == 0, said)


def models(folder):
    shutil.copy(os.path.join(SOURCE, "config", "models", "as1.hpart"), os.path.join(work, folder, "a part's.hpart"))
    part = os.path.join(folder, "a part's.hpart")
    tried("a part in place of a scene", ["run", part], "hapticd import", replaced=(("SCENE.yaml", "made.yaml"),))
    tried("an unknown feature", ["part", "info", part, "--feature", "none"], "hapticd part info", replaced=((" says which features each instance has", ""),))
    scene = os.path.join(folder, "a scene's.yaml")
    tried("a scene for a part", ["import", part, "--scene", scene], "hapticd check")
    text = open(os.path.join(work, scene)).read()
    check("the comments of the scene have whole words", "hapticd check 'a scene'\\''s.yaml'" in text and "hapticd import 'a part'\\''s.hpart' --scene" in text, text[:400])
    recording = os.path.join(folder, "a recording's.h5")
    subprocess.run([HAPTICD, "run", scene, "--virtual-time", "--for", "0.1", "--record", recording], cwd=work, check=True, capture_output=True)
    tried("a recording in place of a scene", ["run", recording], "hapticd replay")
    tried("numbers of a recording", ["explain", recording, "--cost"], "hapticd export", replaced=(("FOLDER", "tables"),))


with tempfile.TemporaryDirectory(prefix="hapticd-copied-") as work:
    os.makedirs(os.path.join(work, FOLDER))
    for case in (devices, plugins, models):
        case(FOLDER)
finish()
