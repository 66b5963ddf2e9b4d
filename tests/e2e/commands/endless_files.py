#!/usr/bin/env python3
"""Inputs that never end, or that are no files: each command refuses them at once and says what they are.

Usage: endless_files.py HAPTICD SOURCE_DIR     prints one line per check; exit 1 when one fails.
"""
import os
import resource
import subprocess
import sys
import tempfile
import threading

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "support"))
from e2e import check, finish

HAPTICD, SOURCE = (os.path.abspath(argument) for argument in sys.argv[1:3])
FALCON = os.path.join(SOURCE, "config", "devices", "falcon.yaml")


def bound_memory():
    resource.setrlimit(resource.RLIMIT_AS, (2 << 30, 2 << 30))


def ask(*words, **more):
    try:
        done = subprocess.run([HAPTICD, *words], capture_output=True, text=True, timeout=120, preexec_fn=bound_memory, **more)
    except subprocess.TimeoutExpired:
        return "it waits for ever", ""
    return done.returncode, done.stdout + done.stderr


with tempfile.TemporaryDirectory() as folder:
    pipe = os.path.join(folder, "pipe")
    os.mkfifo(pipe)
    for file, what in (("/dev/zero", "is a device"), (folder, "is a folder"), (pipe, "is a pipe")):
        for command in ("check", "explain"):
            code, told = ask(command, file)
            check(f"{command} refuses what {what}", code == 2 and what in told, (code, told))
        arm = os.path.join(folder, "arm.yaml")
        with open(arm, "w") as out:
            out.write(open(FALCON).read().replace("# firmware: novint.bin", f"firmware: {file}"))
        code, told = ask("check", arm)
        check(f"check refuses firmware that {what}", code == 2 and what in told, (code, told))
        if file == pipe:
            continue
        for words in (("decode", FALCON, file), ("encode", FALCON, file), ("kinematics", FALCON, "--joints", file)):
            code, told = ask("device", *words)
            check(f"device {words[0]} refuses what {what}", code == 2 and f"{file}: {what}" in told, (code, told))
    with open("/dev/zero") as endless:
        code, told = ask("device", "decode", FALCON, stdin=endless)
    check("device decode ends an input that never ends", code == 2 and "256 MiB" in told, (code, told))

    def write():
        with open(pipe, "w") as out:
            out.write("q1,q2,q3\n0.1,0.1,0.1\n")
    writer = threading.Thread(target=write, daemon=True)
    writer.start()
    code, told = ask("device", "kinematics", FALCON, "--joints", pipe)
    check("device kinematics reads a pipe that has a writer", code == 0 and "0.1" in told, (code, told))
    writer.join(timeout=20)
finish()
