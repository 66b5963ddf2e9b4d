#!/usr/bin/env python3
"""The soft bodies of a recording have the shape that they had: what `hapticd view --file` draws meets the recorded contacts.

Usage: draw_a_recording.py HAPTICD CONFIG     prints one line per case; exit 1 when one is off.
"""
import csv
import glob
import json
import os
import signal
import socket
import subprocess
import sys
import tempfile
import time

import numpy as np

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "support"))
from e2e import check, finish

HAPTICD, CONFIG = sys.argv[1], os.path.abspath(sys.argv[2])
SECONDS, PATIENCE = 6, 60


def away(places, corners, point):
    """[m] Between a point and triangles, each sampled finely."""
    a, b, c = (places[corners[:, i]] for i in range(3))
    steps = [(i / 8, j / 8) for i in range(9) for j in range(9 - i)]
    return min(np.linalg.norm(a + u * (b - a) + v * (c - a) - point, axis=1).min() for u, v in steps)


class Models:
    """Asks the process that draws the models of a recording."""

    def __init__(self, file):
        self.socket = socket.socket(socket.AF_UNIX)
        self.socket.settimeout(PATIENCE)
        self.socket.connect(file)

    def ask(self, request):
        self.socket.sendall(json.dumps(request).encode() + b"\n")
        line, descriptors = b"", []
        while not line.endswith(b"\n"):
            data, more, _, _ = socket.recv_fds(self.socket, 1 << 16, 4)
            line, descriptors = line + data, descriptors + more
        return json.loads(line), descriptors

    def shape(self, model, t):
        answer, descriptors = self.ask({"do": "geometry", "model": model, "as": "memory", "at": t})
        data = os.pread(descriptors[0], answer["bytes"], 0)
        os.close(descriptors[0])
        places = np.frombuffer(data, "<f4", 3 * answer["vertices"]).reshape(-1, 3).astype(float)
        return places, np.frombuffer(data[-12 * answer["triangles"]:], "<u4").reshape(-1, 3)


def compare(models, contacts, tips):
    listed = models.ask({"do": "list"})[0]["models"][0]
    check("the list says that it deforms", listed["deforms"] is True, listed)
    rest, corners = models.shape("leaf", 0)
    deepest = max(contacts, key=lambda row: row["depth"])
    t, tip = deepest["tick"] / 1000, tips[int(deepest["tick"])] - POSE
    pressed, _ = models.shape("leaf", t)
    check("as many vertices as at rest", pressed.shape == rest.shape)
    moved = np.linalg.norm(pressed - rest, axis=1).max()
    check("it is pressed in", moved > 1e-3, moved)
    now, then = away(pressed, corners, tip), away(rest, corners, tip)
    check("the drawn surface has given way to the tip", now < 0.3 * then and then > 1e-3, (now, then, deepest["depth"]))
    models.shape("leaf", t + 1)
    again, _ = models.shape("leaf", t)
    check("the same after a jump back, but for what it forgot", np.abs(again - pressed).max() < 0.1 * moved, np.abs(again - pressed).max())
    back = np.abs(models.shape("leaf", 0)[0] - rest).max()
    check("at rest again where it begins", back < 1e-9, back)
    check("a time that is none", models.ask({"do": "geometry", "model": "leaf", "as": "memory", "at": 1e300})[0]["ok"])


POSE = np.array([0, 0, 0.03])  # of soft-leaf.yaml
with tempfile.TemporaryDirectory() as folder:
    run, rows = os.path.join(folder, "run.h5"), os.path.join(folder, "contacts.csv")
    environment = dict(os.environ, RUNTIME_DIRECTORY=folder, STATE_DIRECTORY=folder, TMPDIR=folder)
    subprocess.run([HAPTICD, "run", os.path.join(CONFIG, "scenes", "soft-leaf.yaml"), "--virtual-time", "--for", str(SECONDS), "--record", run],
                   env=environment, check=True, capture_output=True)
    subprocess.run([HAPTICD, "export", run, "--csv", rows, "--stream", "contacts"], env=environment, check=True, capture_output=True)
    ticks = os.path.join(folder, "ticks.csv")
    subprocess.run([HAPTICD, "export", run, "--csv", ticks, "--stream", "ticks"], env=environment, check=True, capture_output=True)
    tips = {int(row["tick"]): np.array([float(row[f"arm0_{axis}"]) for axis in "xyz"]) for row in csv.DictReader(open(ticks))}
    contacts = [{name: float(value) for name, value in row.items()} for row in csv.DictReader(open(rows))]
    view = subprocess.Popen([HAPTICD, "view", "--file", run], env=environment, stdout=subprocess.PIPE, text=True)
    try:
        check("it serves a page", "token=" in view.stdout.readline())
        sockets = []
        for _ in range(PATIENCE * 10):
            if sockets := glob.glob(os.path.join(folder, "hapticd-view-*", "models.sock")):
                break
            time.sleep(0.1)
        compare(Models(sockets[0]), contacts, tips)
    finally:
        view.send_signal(signal.SIGTERM)
        view.wait(PATIENCE)
finish()
