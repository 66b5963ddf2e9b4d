#!/usr/bin/env python3
"""`hapticd top` and every `hapticd ctl` command on a running daemon, malformed requests, and a killed reader.

Usage: control_a_daemon.py HAPTICD SCENES     prints a line a case; exit 1 when one is off.
"""
import json
import os
import pty
import select
import socket
import subprocess
import sys
import tempfile
import time

HAPTICD, SCENES = sys.argv[1], sys.argv[2]
failures = 0


def check(name, good, told=""):
    global failures
    failures += not good
    print("ok  " if good else "FAIL", name, "" if good else told, flush=True)


def scene(name):
    return os.path.join(SCENES, name + ".yaml")


class Daemon:
    def __init__(self, folder):
        self.folder = folder
        self.environment = dict(os.environ, RUNTIME_DIRECTORY=folder, STATE_DIRECTORY=folder)
        self.run = subprocess.Popen([HAPTICD, "run", scene("teapot"), "--for", "100", "--name", "x"], env=self.environment,
                                    stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)

    def ask(self, *arguments):
        done = subprocess.run([HAPTICD, *arguments, "--name", "x"] if arguments[0] == "top" else
                              [HAPTICD, "ctl", "--name", "x", *arguments], env=self.environment, capture_output=True,
                              text=True, timeout=30)
        return done.returncode, done.stdout, done.stderr

    def until(self, predicate):
        end = time.monotonic() + 30
        while time.monotonic() < end and self.run.poll() is None:
            if predicate():
                return True
            time.sleep(0.1)
        return False

    def models(self):
        code, out, _ = self.ask("list")
        return {m["name"]: m for m in json.loads(out)["models"]} if code == 0 else {}

    def expect(self, code, *arguments):
        got = self.ask(*arguments)
        check(" ".join(a.replace(SCENES, "") for a in arguments) + f" answers {code}", got[0] == code, got)

    def raw(self, line):
        with socket.socket(socket.AF_UNIX) as client:
            client.settimeout(30)
            client.connect(os.path.join(self.folder, "x.sock"))
            client.sendall(line + b"\n")
            return json.loads(client.makefile().readline())


def commands(daemon):
    check("top tells of the model", "teapot" in daemon.ask("top", "--once", "--json")[1])
    check("list tells of the model", "teapot" in daemon.models())
    daemon.expect(0, "disable", "teapot")
    check("a disabled model is listed so", daemon.until(lambda: not daemon.models()["teapot"]["enabled"]))
    daemon.expect(0, "enable", "teapot")
    daemon.expect(1, "set", "teapot", "stiffness", "600")
    daemon.expect(0, "set", "teapot", "stiffness", "600", "--consent")
    daemon.expect(1, "set", "nobody", "stiffness", "600")
    daemon.expect(1, "move", "teapot", "--position", "0.1", "0", "0")
    daemon.expect(0, "add", scene("sphere"))
    check("an added model is listed", daemon.until(lambda: "sphere" in daemon.models()))
    daemon.expect(0, "remove", "sphere")
    check("a removed model goes", daemon.until(lambda: "sphere" not in daemon.models()))
    for command in (["reload"], ["hold"], ["clear"], ["dump"]):
        daemon.expect(0, *command)
    dumps = [f for f in os.listdir(daemon.folder) if f.startswith("blackbox-")]
    check("a dump is a file", len(dumps) == 1, dumps)


def kinematic(daemon):
    file = os.path.join(daemon.folder, "door.yaml")
    box = os.path.join(SCENES, "..", "models", "box.yaml")
    with open(os.path.join(daemon.folder, "path.csv"), "w") as out:
        out.write("t,x,y,z,qw,qx,qy,qz\n0,0.2,0,0,1,0,0,0\n1,0.2,0,0,1,0,0,0\n")
    with open(file, "w") as out:
        out.write(f"hapticd: 1\nmodels:\n  - name: door\n    plugin: nurbs_rigid\n    motion: kinematic\n    path: path.csv\n"
                  f"    parameters: {{geometry: {box}}}\n")
    daemon.expect(0, "add", file, "door")
    check("a kinematic model is listed so",
          daemon.until(lambda: daemon.models().get("door", {}).get("kinematic") is True))
    daemon.expect(0, "move", "door", "--position", "0.1", "0", "0", "--seconds", "0.5")
    daemon.expect(1, "move", "door", "--position", "nan", "0", "0")
    daemon.expect(0, "remove", "door")


def malformed(daemon):
    for line in (b"{", b"[]", b"7", b'{"do":7}', b'{"do":"fly"}', b'{"do":"set"}', b'{"do":"status","more":1}',
                 b"[" * 100, b"\xff\xfe"):
        check(f"{line[:24]} is refused", daemon.raw(line).get("ok") is False)
    check("the daemon answers after all that", daemon.ask("status")[0] == 0)


def killedReader(daemon):
    mine, its = pty.openpty()
    reader = subprocess.Popen([HAPTICD, "top", "--name", "x"], env=dict(daemon.environment, TERM="xterm"), stdin=its,
                              stdout=its, stderr=its)
    shown = select.select([mine], [], [], 30)[0]
    check("a reader shows the daemon", bool(shown) and reader.poll() is None)
    reader.kill()
    reader.wait()
    os.close(mine)
    os.close(its)
    before = json.loads(daemon.ask("status")[1])["tick"]
    check("the servo ticks on when a reader is killed",
          daemon.until(lambda: json.loads(daemon.ask("status")[1])["tick"] > before))


with tempfile.TemporaryDirectory() as scratch:
    it = Daemon(scratch)
    try:
        check("the daemon answers", it.until(lambda: it.ask("status")[0] == 0))
        commands(it)
        kinematic(it)
        malformed(it)
        killedReader(it)
        it.expect(0, "stop")
        check("stop ends the run in order", it.run.wait(timeout=30) == 0)
        check("a run that ends in order leaves nothing shown", not [f for f in os.listdir(scratch) if f.startswith("x.")])
    finally:
        it.run.kill()
sys.exit(1 if failures else 0)
