#!/usr/bin/env python3
"""Haply's interface from both sides: the module `haply_service` on a service that speaks as the vendor's documentation
says, `hapticd-inverse-service` for a program that does, and the two with each other (a circle of two daemons).

Usage: inverse_service.py HAPTICD SOURCE SERVICE     prints a line a case; exit 1 when one is off.
"""
import json
import os
import re
import signal
import socket
import subprocess
import sys
import tempfile
import threading

import numpy

import socket_pair

HAPTICD, SOURCE, SERVICE = sys.argv[1:4]
sys.path.insert(0, os.path.join(SOURCE, "tests", "support"))
sys.path.insert(0, os.path.join(SOURCE, "driver", "doors", "client", "python"))
from daemon import Daemon
from e2e import check, finish, until

FAR = """hapticd: 1
device: {source}/config/devices/simulated-premium15.yaml
clients: add
models: []
"""
NEAR = """hapticd: 1
device: arm.yaml
models:
  - name: ball
    plugin: nurbs_rigid
    parameters: {{geometry: {source}/config/models/sphere.yaml, stiffness: 100}}
"""
ARM = "hapticd-device: 1\nmodule: haply_service\nname: arm\nparameters: {{port: {port}, force: 3{more}}}\n"
NAME = "simulated Premium 1.5"
LOST, FAULTY, ZERO = 2, 3, {"x": 0, "y": 0, "z": 0}


class Documented:
    """A service as docs.haply.co describes it for 3.5: an inventory first, then one state for each message."""

    def __init__(self, position, lost_after=None, garbles=False, **status):
        self.listener = socket.create_server(("127.0.0.1", 0))
        self.port = self.listener.getsockname()[1]
        self.position, self.lost_after, self.heard, self.status = position, lost_after, [], status
        self.garbles = garbles  # from the moment on at which the arm pushes
        self.thread = threading.Thread(target=self.serve, daemon=True)
        self.thread.start()

    def message(self, first):
        x, y, z = self.position
        arm = {"device_id": "049D", "state": {"cursor_position": {"x": x, "y": y, "z": z}, "cursor_velocity": ZERO,
                                              "angular_position": {"a0": 0, "a1": 0, "a2": 0}, "control_domain": "cartesian",
                                              "control_mode": "force"}}
        if self.status:
            arm["status"] = self.status
        if first:
            arm["config"] = {"type": "inverse3", "handedness": "right", "basis": {"permutation": "XYZ"}}
        other = {"device_id": "0001", "state": {"cursor_position": {"x": 9, "y": 9, "z": 9}}}
        grip = {"device_id": "61576", "state": {"orientation": {"w": 1, "x": 0, "y": 0, "z": 0},
                                                "buttons": {"a": False, "b": True, "c": False}}}
        return json.dumps({"session_id": 7, "inverse3": [arm, other], "wireless_verse_grip": [grip]})

    def serve(self):
        try:
            channel = socket_pair.accept(self.listener)
            channel.send(self.message(True))
            while self.lost_after is None or len(self.heard) < self.lost_after:
                self.heard.append(json.loads(channel.receive()))
                force = self.heard[-1]["inverse3"][0]["commands"]["set_cursor_force"]["values"]
                channel.send("[" if self.garbles and force["y"] < -0.1 else self.message(False))
            channel.close()
        except (ConnectionError, OSError):
            pass


def daemon(folder, name, text, port=0, more=""):
    with open(os.path.join(folder, "arm.yaml"), "w") as file:
        file.write(ARM.format(port=port, more=more))
    return Daemon(HAPTICD, folder, name, text.format(source=SOURCE), "--allow-non-rt")


def last(client, *columns):
    until(lambda: client.streams["ticks"].written > 0, 60)
    rows = client.rows("ticks", last=50)
    return [float(rows[column][-1]) for column in columns]


def asked_for(client, service):
    """How far the force that the service was asked for is from the one that the daemon sent."""
    sent = last(client, "arm0_sent_fx", "arm0_sent_fy", "arm0_sent_fz")
    heard = service.heard[-1]["inverse3"][0]
    values = heard["commands"]["set_cursor_force"]["values"]
    off = max(abs(values["x"] - sent[0]), abs(values["y"] + sent[2]), abs(values["z"] - sent[1]))
    return (off if heard["device_id"] == "049D" else float("inf")), (values, sent)


def module(folder):
    """The documented messages become an arm, and its forces the documented commands."""
    service = Documented((0.003, -0.045, -0.002))  # right, away, up: 45 mm toward the user
    run = daemon(folder, "module", NEAR, service.port)
    with run.connect() as client:
        until(lambda: client.streams["ticks"].written > 1000, 60)
        check("x is right, z up there, and what is away is behind here", last(client, "arm0_x", "arm0_y", "arm0_z") == [0.003, -0.002, 0.045],
              last(client, "arm0_x", "arm0_y", "arm0_z"))
        check("buttons of the handle are told", last(client, "arm0_buttons") == [2])
        check("the ball pushes", until(lambda: last(client, "arm0_sent_fz")[0] > 0.3), last(client, "arm0_sent_fz"))
        until(lambda: asked_for(client, service)[0] < 1e-6)  # once the ramp is over, nothing moves any more
        off, told = asked_for(client, service)
        check("its force is asked for in their axes", off < 1e-6, told)
    check("the run ends in order", run.stop() == 0, run.log())
    check("it introduces itself once", "session" in service.heard[0] and "session" not in service.heard[1])
    check("the last force is none", service.heard[-1]["inverse3"][0]["commands"]["set_cursor_force"]["values"] == ZERO,
          service.heard[-1])


def troubles(folder):
    service = Documented((0, -0.06, 0), lost_after=2000)
    run = daemon(folder, "lost", NEAR, service.port)
    with run.connect() as client:
        check("a service that goes is an arm that is lost", until(lambda: last(client, "arm0_fault") == [LOST], 60))
    run.stop()
    service = Documented((0, -0.045, 0), garbles=True)
    run = daemon(folder, "garbled", NEAR, service.port)
    with run.connect() as client:
        check("one that answers nonsense, too", until(lambda: last(client, "arm0_fault") == [LOST], 60))
        check("and is asked to let go, and left", until(lambda: not service.thread.is_alive()) and service.heard[-1]["inverse3"][0]
              ["commands"]["set_cursor_force"]["values"] == ZERO, service.heard[-1])
    run.stop()
    service = Documented((0, -0.06, 0), power_supply=False)
    run = daemon(folder, "dark", NEAR, service.port)
    with run.connect() as client:
        check("one without power gives no force", until(lambda: last(client, "arm0_fault")[0] == FAULTY), last(client, "arm0_fault"))
    run.stop()
    service = Documented((0, 0, 0))
    run = daemon(folder, "other", NEAR, service.port, ', device_id: "077"')
    check("an arm that is not there is told", run.process.wait(timeout=30) != 0 and '"049D", "0001"' in run.log(), run.log())
    run = daemon(folder, "nobody", NEAR, 1)
    check("no service is told with its cure", run.process.wait(timeout=30) != 0 and "haply-inverse-service" in run.log(),
          run.log())


class Service:
    """hapticd-inverse-service on a free port."""

    def __init__(self, folder, name):
        environment = dict(os.environ, RUNTIME_DIRECTORY=folder)
        self.run = subprocess.Popen([SERVICE, "--name", name, "--port", "0"], env=environment, stdout=subprocess.PIPE,
                                    stderr=subprocess.PIPE, text=True)
        self.port = int(re.search(r":(\d+)$", self.run.stdout.readline().strip()).group(1))

    def end(self):
        self.run.terminate()
        _, told = self.run.communicate(timeout=30)
        return told


def ask(channel, message):
    channel.send(json.dumps(message))
    return json.loads(channel.receive())


def command(force, name=NAME):
    return {"inverse3": [{"device_id": name, "commands": {"set_cursor_force": {"values": dict(zip("xyz", force))}}}]}


def offers(folder, far):
    """A program of Haply's interface feels and pushes an arm of ours."""
    service = Service(folder, "far")
    channel = socket_pair.connect(service.port)
    first = json.loads(channel.receive())
    arm = first["inverse3"][0]
    check("the inventory names the arm, with config, state and status", arm["device_id"] == NAME and
          {"config", "state", "status"} <= set(arm) and arm["config"]["type"] == "inverse3", first)
    check("and a handle with buttons and orientation",
          set(first["wireless_verse_grip"][0]["state"]["buttons"]) == {"a", "b", "c"}, first)
    state = ask(channel, {"inverse3": [{"device_id": NAME, "commands": {"probe_position": {}}}]})
    there = far.rows("ticks", last=3000)
    at = state["inverse3"][0]["state"]["cursor_position"]
    close = numpy.abs(numpy.stack([there["arm0_x"] - at["x"], there["arm0_z"] + at["y"], there["arm0_y"] - at["z"]])).max(axis=0)
    check("a state for a message, in their axes", close.min() < 1e-9 and "config" not in state["inverse3"][0], close.min())
    check("a program that only looks pushes nothing", len(far.status()["devices"][0]["clients"]) == 0)

    def pushes(wanted, force, messages=400):
        for _ in range(messages):
            answer = ask(channel, command(force))
        got = last(far, "arm0_client_fx", "arm0_client_fy", "arm0_client_fz")
        return max(abs(g - w) for g, w in zip(got, wanted)) < 1e-9, got, answer
    good = until(lambda: pushes([0.1, 0.3, -0.2], [0.1, 0.2, 0.3])[0])
    check("its force is felt, away and up", good, last(far, "arm0_client_fx", "arm0_client_fy", "arm0_client_fz"))
    ask(channel, {"session": {"configure": {"basis": {"permutation": "XZ-Y"}}}})  # x right, y up, z to the user
    good = until(lambda: pushes([0.1, 0.2, 0.3], [0.1, 0.2, 0.3])[0])
    check("in the axes that it chose too", good, last(far, "arm0_client_fx", "arm0_client_fy", "arm0_client_fz"))
    check("a force ends when the program falls silent",
          until(lambda: last(far, "arm0_client_fx", "arm0_client_fy", "arm0_client_fz") == [0, 0, 0]))
    for bad in ("not json", "[]", '{"inverse3": 3}', '{"inverse3": [{"device_id": "x"}]}', json.dumps(command([1e999, 0, 0])),
                '{"inverse3": [{"device_id": "%s", "commands": {"set_cursor_force": {"values": {"x": 1}}}}]}' % NAME,
                '{"session": {"configure": {"basis": {"permutation": "XXY"}}}}'):
        channel.send(bad)
        json.loads(channel.receive())
    check("nonsense is answered with the state, and moves nothing", last(far, "arm0_client_fx") == [0])
    check("a page of a browser from elsewhere is refused", socket_pair.connect(service.port, "https://example.org") is None)
    own = socket_pair.connect(service.port, "http://localhost:3000")
    check("one of this machine is not", own is not None and "inverse3" in own.receive())
    own.close()
    ask(channel, command([0.5, 0, 0]))
    channel.close()
    check("a program that leaves frees the arm", until(lambda: far.status()["devices"][0]["clients"] == []))
    told = service.end()
    check("what was wrong is told once", told.count("program 1:") == 1, told)


def circle(folder, far):
    """A daemon drives the arm of another one, through both."""
    service = Service(folder, "far")
    near_run = daemon(folder, "near", NEAR, service.port)
    with near_run.connect() as near:
        until(lambda: near.streams["ticks"].written > 4000, 60)
        seen, there = near.rows("ticks", last=2000), far.rows("ticks", last=6000)
        places = {row.tobytes() for row in numpy.round(numpy.stack([there["arm0_" + c] for c in "xyz"], axis=1), 9)}
        known = numpy.mean([row.tobytes() in places for row in numpy.round(numpy.stack([seen["arm0_" + c] for c in "xyz"], axis=1), 9)])
        check("positions are those of the far arm", known > 0.95, known)
        felt = until(lambda: numpy.abs(far.rows("ticks", last=1000)["arm0_client_fz"]).max() > 0.2)
        check("the near ball is felt there", felt, numpy.abs(far.rows("ticks", last=1000)["arm0_client_fz"]).max())
    near_run.stop(signal.SIGKILL)
    check("the far arm is free when the near daemon dies",
          until(lambda: last(far, "arm0_client_fx", "arm0_client_fy", "arm0_client_fz") == [0, 0, 0]))
    service.end()


with tempfile.TemporaryDirectory(dir="/dev/shm") as place:
    module(place)
    troubles(place)
    far_run = daemon(place, "far", FAR)
    with far_run.connect() as far_client:
        offers(place, far_client)
        circle(place, far_client)
    check("the far run ends in order", far_run.stop() == 0)
finish()
