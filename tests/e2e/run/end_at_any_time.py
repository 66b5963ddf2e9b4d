#!/usr/bin/env python3
"""A daemon on an arm that is missing, silent, half there or lost, and stopped at any moment, once or again and again,
ends by itself with a message: no signal ever ends it, but the one that came before it could listen.

Usage: end_at_any_time.py HAPTICD VME_BOARD SOURCE_DIR MODULE_DIR [ROUNDS]
"""
import os
import pathlib
import random
import signal
import subprocess
import sys
import tempfile
import time

HAPTICD, BOARD, SOURCE, MODULES = sys.argv[1:5]
ROUNDS = int(sys.argv[5]) if len(sys.argv) > 5 else 6
CONFIG = pathlib.Path(SOURCE).resolve() / "config"
random.seed(1)
failures = 0


def scene(folder):
    text = (CONFIG / "devices/sarcos.yaml").read_text().replace("/dev/bus/vme/m0", str(folder / "window"))
    text = text.replace("masses: [0, 0, 0, 0, 0, 0, 0, 0]", "masses: [1.0, 0.5, 2.0, 0.5, 1.2, 0.2, 0.3, 0.05]")  # the board's own
    (folder / "sarcos.yaml").write_text(text)
    file = folder / "scene.yaml"
    file.write_text(f"hapticd: 1\nservo: {{rate: 1500}}\ndevice: {{file: sarcos.yaml, mount: {{position: [0, 0, 0]}}}}\n"
                    f"models:\n  - name: cylinder\n    plugin: nurbs_rigid\n"
                    f"    parameters: {{geometry: {CONFIG}/models/cylinder.yaml, stiffness: 6000}}\n")
    return file


def judge(what, daemon):
    global failures
    try:
        said = daemon.communicate(timeout=60)[0]
    except subprocess.TimeoutExpired:
        daemon.kill()
        said = "did not end\n" + daemon.communicate()[0]
    by_itself = daemon.returncode in (0, 1, 2) and "was ended by" not in said and "Sanitizer" not in said
    early = daemon.returncode in (-signal.SIGINT, -signal.SIGTERM)
    if not by_itself and not early:
        failures += 1
        print(f"FAILED {what}: exit code {daemon.returncode}\n{said}", flush=True)
    return said


def start(folder, seconds=1):
    environment = dict(os.environ, RUNTIME_DIRECTORY=str(folder), STATE_DIRECTORY=str(folder))
    return subprocess.Popen([HAPTICD, "run", scene(folder), "--for", str(seconds), "--allow-non-rt"], text=True,
                            env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)


def stop(daemon, after):
    time.sleep(after)
    for _ in range(400):  # again and again, up to the last moment of the process
        if daemon.poll() is not None:
            return
        daemon.send_signal(signal.SIGINT)
        time.sleep(0.002)


def with_board(folder, act):
    window = folder / "window"
    window.unlink(missing_ok=True)
    board = subprocess.Popen([BOARD, window, "--arm", CONFIG / "devices/simulated-sarcos.yaml", "--plugin-path", MODULES,
                              "--for", "60"], stdout=subprocess.PIPE, text=True)
    assert board.stdout.readline() == "ready\n"
    try:
        act(window)
    finally:
        board.terminate()
        board.communicate()


def absent(folder):
    """Windows on which no arm answers."""
    window = folder / "window"
    for what, content, names in (("no window", None, "there is no file"), ("a short window", b"\0" * 10, "ends after"),
                                 ("an empty window", b"", "returns no bytes"),
                                 ("a silent bus", b"\xff" * 65536, "no board answers"),
                                 ("a board that stands still", b"\0" * 65536, "the motors stay off")):
        window.unlink(missing_ok=True)
        if content is not None:
            window.write_bytes(content)
        said = judge(what, start(folder))
        global failures
        if names not in said:
            failures += 1
            print(f"FAILED {what}: not named:\n{said}")


def stopped(folder):
    for _ in range(ROUNDS):
        after = random.uniform(0, 2)
        with_board(folder, lambda _: (daemon := start(folder), stop(daemon, after),
                                      judge(f"stopped after {after:.2f} s", daemon)))


def lost(folder):
    """The window is cut short while the arm exchanges its dry cycles."""
    for _ in range(ROUNDS):
        after = random.uniform(0.1, 1.2)
        with_board(folder, lambda window: (daemon := start(folder), time.sleep(after), os.truncate(window, 0),
                                           judge(f"lost after {after:.2f} s", daemon)))


with tempfile.TemporaryDirectory() as name:
    for case in (absent, stopped, lost):
        case(pathlib.Path(name))
        print(f"{case.__name__}: {failures} failures so far", flush=True)
sys.exit(1 if failures else 0)
