#!/usr/bin/env python3
"""`hapticd top` and every `hapticd ctl` command on a running daemon, malformed requests, and a killed reader.

Usage: control_a_daemon.py HAPTICD SCENES     prints one line per case; exit 1 when one is off.
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

import h5py
import numpy

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "support"))
from e2e import check, finish, program

HAPTICD, SCENES = sys.argv[1], sys.argv[2]


def scene(name):
    return os.path.join(SCENES, name + ".yaml")


class Daemon:
    def __init__(self, folder):
        self.folder = folder
        self.environment = dict(os.environ, RUNTIME_DIRECTORY=folder, STATE_DIRECTORY=folder)
        self.run = subprocess.Popen([HAPTICD, "run", scene("teapot"), "--for", "100", "--name", "x", "--record", os.path.join(folder, "recording.h5"),
                                     "--log-file", os.path.join(folder, "run.log"),
                                     "--report", os.path.join(folder, "report.json")], env=self.environment,
                                    stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)

    def ask(self, *arguments):
        return program(HAPTICD, self.environment)(*(() if arguments[0] == "top" else ("ctl",)), *arguments, "--name", "x")

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
    path = os.path.join(daemon.folder, "x.sock")
    check("socket prints where the daemon listens", daemon.ask("socket") == (0, path + "\n", ""), daemon.ask("socket"))
    status = json.loads(daemon.ask("status")[1])
    check("and status has it", (status["name"], status["socket"]) == ("x", path), status)
    begin = [line for line in open(os.path.join(daemon.folder, "run.log")) if "runs as x:" in line]
    check("the log begins with what runs, once", len(begin) == 1 and all(word in begin[0] for word in (
        "model teapot on simulated Premium 1.5", "no program may push (clients: off)", path)), begin)
    for word in ("hold", "clear"):
        code, _, err = daemon.ask(word, "nobody")
        check(f"{word} of a device that is none names those that are", code == 2 and "expected one of: simulated Premium 1.5" in err, err)
    check("the hand comes to touch it", daemon.until(lambda: json.loads(daemon.ask("top", "--once", "--json")[1])["models"][0]["force_n"] > 0.3))
    feet = json.loads(daemon.ask("top", "--once", "--json")[1])["models"][0]["feet"]
    check("top counts what is known of its feet", set(feet) == {"nearest", "held", "degraded"} and feet["nearest"] + feet["held"] > 100, feet)
    daemon.expect(0, "disable", "teapot")
    check("a disabled model is listed so", daemon.until(lambda: not daemon.models()["teapot"]["enabled"]))
    daemon.expect(0, "enable", "teapot")
    daemon.expect(1, "set", "teapot", "stiffness", "600")
    daemon.expect(0, "set", "teapot", "stiffness", "600", "--consent")
    daemon.expect(2, "set", "nobody", "stiffness", "600", "--consent")
    daemon.expect(2, "set", "teapot", "stiffnes", "600", "--consent")
    daemon.expect(2, "set", "teapot", "stiffness", "1e9", "--consent")
    daemon.expect(2, "get", "teapot", "stiffnes")
    daemon.expect(2, "add", os.path.join(daemon.folder, "none.yaml"))
    daemon.expect(2, "lead", "nobody")
    daemon.expect(1, "move", "teapot", "--position", "0.1", "0", "0")
    daemon.expect(0, "add", scene("sphere"))
    check("an added model is listed", daemon.until(lambda: "sphere" in daemon.models()))
    daemon.expect(0, "remove", "sphere")
    check("a removed model goes", daemon.until(lambda: "sphere" not in daemon.models()))
    for command in (["reload"], ["hold"], ["clear"], ["dump"]):
        daemon.expect(0, *command)
        time.sleep({"reload": 1, "hold": 0.1}.get(command[0], 0))  # s: the new models push again; the ramp is over
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
    daemon.expect(0, "move", "door", "--position", "0.1", "0.02", "0", "--seconds", "0.5")
    time.sleep(0.8)  # s: it is there now, and stays
    daemon.expect(0, "move", "door", "--position", "0.1", "0.02", "0", "--orientation", "0", "0", "1", "0", "--seconds", "2")
    turned = lambda: abs(daemon.models().get("door", {"pose": {"orientation": [1, 0, 0, 0]}})["pose"]["orientation"][2]) > 0.999
    check("a model is turned, too", daemon.until(turned), daemon.models().get("door"))
    for place in ("0.9", "0.1"):  # each at once: neither where it was sent before nor the way back makes it faster
        answer = daemon.ask("move", "door", "--position", place, "0.02", "0", "--seconds", "0.05")
        check("a move that is too fast is slowed and says so",
              answer[0] == 0 and json.loads(answer[1])["seconds"] >= (1.4 if place == "0.9" else 0.05), answer)
    time.sleep(0.5)  # s
    daemon.expect(2, "move", "door", "--position", "nan", "0", "0")
    daemon.expect(0, "remove", "door")


def malformed(daemon):
    for line in (b"{", b"[]", b"7", b'{"do":7}', b'{"do":"fly"}', b'{"do":"set"}', b'{"do":"status","more":1}',
                 b"[" * 100, b"\xff\xfe"):
        check(f"{line[:24]} is refused", daemon.raw(line).get("ok") is False)
    check("the daemon answers after all that", daemon.ask("status")[0] == 0)


def bounds(daemon):
    """As many clients and as long a request as there may be, and one more."""
    most = 64 * 1024
    request = b'{"do":"status"}'
    check("a request of 64 KiB is answered", daemon.raw(request + b" " * (most - len(request))).get("ok") is True)
    check("a longer one is refused", daemon.raw(request + b" " * most).get("ok") is False)
    crowd = [socket.socket(socket.AF_UNIX) for _ in range(33)]
    for client in crowd:
        client.connect(os.path.join(daemon.folder, "x.sock"))
        client.settimeout(10)
    for client in crowd[:32]:
        client.sendall(request + b"\n")
    check("32 clients are answered at once", all(b'"ok"' in client.recv(65536) for client in crowd[:32]))
    crowd[32].sendall(request + b"\n")
    crowd[32].settimeout(1)
    try:
        early = crowd[32].recv(1)
    except TimeoutError:
        early = b""
    check("the 33rd waits", early == b"", early)
    crowd[0].close()
    crowd[32].settimeout(10)
    check("until one has gone", b'"ok"' in crowd[32].recv(65536))
    for client in crowd[1:]:
        client.close()


def effects(file):
    """What the recording says that orders did to the hand."""
    with h5py.File(file) as recording:
        ticks, orders, poses = (recording[name][:] for name in ("ticks", "orders", "poses"))
    force = numpy.stack([ticks["arm0_sent_f" + axis] for axis in "xyz"], axis=1)
    size = numpy.linalg.norm(force, axis=1)
    change = numpy.linalg.norm(numpy.diff(force, axis=0), axis=1)
    enable, disable, move, clear, hold, adopt, release = 1, 2, 3, 5, 6, 7, 8
    tickOf = lambda kind: [int(t) - int(ticks["tick"][0]) for t in orders["tick"][orders["kind"] == kind]]
    slew, window, period = 2000, 1e-3, 1e-3  # N/s, s, s
    check("there was a force to change", size.max() > 0.3, size.max())
    for kind, name in ((enable, "enable"), (disable, "disable"), (adopt, "adopt"), (release, "release")):
        steps = [change[max(t - 2, 0):t + 150].max() for t in tickOf(kind) if t < len(change)]
        check(f"no force steps beyond the slew limit at {name}", steps and max(steps) <= slew * (window + period), steps)
    at, end = tickOf(hold)[0], tickOf(clear)[0]
    check("hold ramps to zero within 20 ms and never pushes more",
          end > at + 22 and size[at + 21:end].max() == 0 and all(size[at:end] <= size[at - 1] + 1e-9), size[at - 1:at + 25])
    at = tickOf(move)[-1]
    door = orders["target"][orders["kind"] == move][-1]
    there = poses[(poses["model"] == door) & (poses["tick"] > ticks["tick"][0] + at)]
    place = numpy.array([[row["x"], row["y"], row["z"]] for row in there])
    step = numpy.linalg.norm(numpy.diff(place, axis=0), axis=1)
    check("a moved model goes there without a jump and stays",
          len(place) > 100 and numpy.allclose(place[len(place) * 3 // 4], [0.1, 0.02, 0], atol=1e-9) and step.max() < 2e-3,
          (len(place), place[:1], place[-1:], place[len(place) * 3 // 4], step.max()))


def reported(file):
    """Each model has its own figures, those that left too: the door, which took a place, was never touched."""
    models = json.load(open(file))["models"]
    ticks = {name: model["contact_ticks"] for name, model in models.items()}
    check("models that left are told as such", {"teapot", "teapot (removed)", "door (removed)"} <= set(ticks), ticks)
    check("a model does not inherit the figures of another", ticks.get("teapot (removed)", 0) > 0 and ticks.get("door (removed)") == 0, ticks)


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
        bounds(it)
        killedReader(it)
        it.expect(0, "stop")
        check("stop ends the run in order", it.run.wait(timeout=30) == 0)
        effects(os.path.join(scratch, "recording.h5"))
        reported(os.path.join(scratch, "report.json"))
        check("a run that ends in order leaves nothing shown", not [f for f in os.listdir(scratch) if f.startswith("x.")])
    finally:
        it.run.kill()
finish()
