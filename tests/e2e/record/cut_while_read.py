#!/usr/bin/env python3
"""Another program cuts or overwrites a recording while a command reads it: the command says so, and no signal kills it.

Usage: cut_while_read.py HAPTICD SCENE     prints one line per case; exit 1 when one is off.
"""
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "support"))
from e2e import check, finish

HAPTICD, SCENE = sys.argv[1], sys.argv[2]
SECONDS, PATIENCE = 40, 60


def has_open(pid, file):
    """True if a process has a file open or mapped."""
    try:
        names = [os.readlink(f"/proc/{pid}/fd/{fd}") for fd in os.listdir(f"/proc/{pid}/fd")]
        return file in names or file in open(f"/proc/{pid}/maps").read()
    except OSError:
        return False


def spoiled(spoil, file, whole, command):
    """Exit code and messages of a command whose file is spoiled as soon as it is open. It is tried again where the command
    was faster."""
    for _ in range(20):
        shutil.copyfile(whole, file)
        time.sleep(0.02)  # the clock of file times has ticks
        code, said = spoiled_once(spoil, file, command)
        if code != 0:
            break
    return code, said


def spoiled_once(spoil, file, command):
    process = subprocess.Popen([HAPTICD, *command], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    while process.poll() is None and not has_open(process.pid, file):
        pass
    process.send_signal(signal.SIGSTOP)
    spoil(file)
    process.send_signal(signal.SIGCONT)
    said = process.communicate(timeout=PATIENCE)[1]
    return process.returncode, said


def cut(file):
    os.truncate(file, os.path.getsize(file) // 3)


def overwrite(file):
    with open(file, "r+b") as out:
        out.seek(os.path.getsize(file) // 3)
        out.write(os.urandom(1 << 20))


with tempfile.TemporaryDirectory() as folder:
    whole, file, out = (os.path.join(folder, name) for name in ("whole.h5", "run.h5", "out"))
    subprocess.run([HAPTICD, "run", SCENE, "--virtual-time", "--for", str(SECONDS), "--record", whole], check=True, capture_output=True)
    commands = {"export --csv": ["export", file, "--csv", f"{out}.csv", "--stream", "ticks"], "export --mcap": ["export", file, "--mcap", f"{out}.mcap"],
                "explain": ["explain", file], "plot": ["plot", file, "--out", f"{out}.svg"], "replay": ["replay", file],
                "tune": ["tune", SCENE, "--motion", file]}
    for name, command in commands.items():
        for spoil, word in ((cut, "cut"), (overwrite, "changed")):
            code, said = spoiled(spoil, file, whole, command)
            check(f"{name}: the file was {word}", code == (2 if name == "tune" else 1) and f"run.h5: was {word} by another program while it was read" in said, (code, said[-500:]))
    check("what was written of it was removed", not any(os.path.exists(out + ending) for ending in (".csv", ".mcap", ".svg")))
    shutil.copyfile(whole, file)
    view = subprocess.Popen([HAPTICD, "view", "--file", file], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    check("view: serves a page", "token=" in view.stdout.readline())
    cut(file)
    said = view.communicate(timeout=PATIENCE)[1]
    check("view: the file was cut", view.returncode == 1 and "was cut by another program" in said, (view.returncode, said))
finish()
