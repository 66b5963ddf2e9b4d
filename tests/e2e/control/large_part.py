#!/usr/bin/env python3
"""A part of a million triangles is drawn in an answer that has no room for them, and the answer says how coarse it is.

Usage: large_part.py HAPTICD CONFIG     prints one line per case; exit 1 when one fails.
"""
import json
import os
import re
import socket
import subprocess
import sys
import tempfile
from functools import partial

import numpy as np

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "support"))
import bumpy_ball
from e2e import check, finish, program, until

HAPTICD, CONFIG = sys.argv[1], os.path.abspath(sys.argv[2])
RINGS = 500
FULL = 4 * RINGS * (RINGS - 1)


def away(points, a, b, c):
    """[m] The distance of each point from the nearest of the triangles."""
    def to_segment(p, a, b):
        along = b - a
        share = np.clip(((p - a) * along).sum(1) / np.maximum((along * along).sum(1), 1e-30), 0, 1)
        return np.linalg.norm(a + share[:, None] * along - p, axis=1)
    normal = np.cross(b - a, c - a)
    size = np.maximum(np.linalg.norm(normal, axis=1), 1e-30)
    nearest = []
    for p in points:
        above = np.all([(np.cross(end - begin, p - begin) * normal).sum(1) >= 0 for begin, end in ((a, b), (b, c), (c, a))], axis=0)
        plane = np.where(above, np.abs(((p - a) * normal).sum(1)) / size, np.inf)
        nearest.append(min(plane.min(), *(to_segment(p, begin, end).min() for begin, end in ((a, b), (b, c), (c, a)))))
    return np.array(nearest)


class Daemon:
    """The control socket of a daemon."""

    def __init__(self, file):
        self.socket = socket.socket(socket.AF_UNIX)
        self.socket.settimeout(120)
        self.socket.connect(file)

    def ask(self, **request):
        """The line of the answer, and the memory that came with it."""
        self.socket.sendall(json.dumps({"do": "geometry", "model": "ball", **request}).encode() + b"\n")
        line, memory = b"", []
        while not line.endswith(b"\n"):
            data, more, _, _ = socket.recv_fds(self.socket, 1 << 16, 4)
            line, memory = line + data, memory + more
        return line, memory

    def in_memory(self, **request):
        """The answer, places, normals and triangles."""
        line, memory = self.ask(**{"as": "memory"}, **request)
        answer = json.loads(line)
        data = os.pread(memory[0], answer["bytes"], 0)
        os.close(memory[0])
        count = answer["vertices"]
        places, normals = (np.frombuffer(data, "<f4", 3 * count, 12 * count * i).reshape(-1, 3).astype(float) for i in range(2))
        return answer, places, normals, np.frombuffer(data[-12 * answer["triangles"]:], "<u4").reshape(-1, 3)


def as_text(daemon, part):
    line, _ = daemon.ask()
    answer = json.loads(line)
    places, triangles = np.reshape(answer["xyz"], (-1, 3)), np.reshape(answer["triangles"], (-1, 3))
    check("without a tolerance it is drawn, in one answer", answer["ok"] and len(line) <= 1 << 20, line[:300])
    check("most of the answer is used", len(triangles) > 20000, len(triangles))
    check("it says of how many triangles, and how far it is off", answer["full_triangles"] == FULL and 0 < answer["off"] < answer["tolerance"] < 2e-3 and
          f"{len(triangles)} of {FULL}" in answer["note"] and "felt" in answer["note"], {k: v for k, v in answer.items() if k not in ("xyz", "triangles")})
    check("its vertices are on the surface", bumpy_ball.off(places).max() < 1e-7, bumpy_ball.off(places).max())
    some = part[np.random.default_rng(5).choice(len(part), 150, replace=False)]
    farthest = away(some, *(places[triangles[:, i]] for i in range(3))).max()
    check("no corner of the part is farther away than it says", farthest <= answer["off"] * 1.01, (farthest, answer["off"]))
    middle = bumpy_ball.off(places[triangles].mean(axis=1))
    check("nor is the middle of a triangle farther than the tolerance", middle.max() <= answer["tolerance"], middle.max())
    check("the same question has the same answer", daemon.ask()[0] == line)


def in_memory(daemon):
    answer, places, _, triangles = daemon.in_memory()
    check("in memory all of it has room, and no note", len(triangles) == FULL and "note" not in answer, answer)
    check("with its places", len(places) == 2 * RINGS * (RINGS - 1) + 2 and bumpy_ball.off(places).max() < 1e-7)
    answer, places, normals, triangles = daemon.in_memory(triangles=20000)
    check("a client chooses how many triangles it gets", 10000 < len(triangles) <= 20000 and answer["full_triangles"] == FULL and "note" in answer, answer)
    a, b, c = (places[triangles[:, i]] for i in range(3))
    up = np.cross(b - a, c - a)
    check("their normals are unit vectors that point outward", np.abs(np.linalg.norm(normals, axis=1) - 1).max() < 1e-5 and
          ((normals * places).sum(1) > 0).mean() > 0.99)
    check("and no triangle is turned over", ((up * normals[triangles].sum(axis=1)).sum(1) >= 0).all())
    volume = (a * np.cross(b, c)).sum() / 6
    check("they enclose what the part does", abs(volume / 2.68456e-4 - 1) < 0.03, volume)
    refused = json.loads(daemon.ask(triangles=999)[0])
    check("999 triangles are refused with the range", not refused["ok"] and "from 1000 to 16777216" in refused["error"], refused)


def by_hand(ctl, folder):
    code, out, err = ctl("geometry", "ball")
    check("hapticd ctl prints it, and its note where it is no output", code == 0 and json.loads(out)["ok"] and err.startswith("note: drawn with "), err)
    code, out, err = ctl("geometry", "ball", "--tolerance", "0.00002")
    found = re.search(r"larger tolerance, such as ([0-9.e-]+) m", err)
    check("a tolerance that needs too many triangles is refused with one that works", code == 1 and found is not None, err)
    if found:
        code, out, err = ctl("geometry", "ball", "--tolerance", found[1])
        check("which works", code == 0 and json.loads(out)["tolerance"] <= float(found[1]) * (1 + 1e-5), err)
    file = os.path.join(folder, "ball.obj")
    code, out, err = ctl("geometry", "ball", "--obj", file)
    rows = open(file, encoding="utf-8").read().splitlines() if code == 0 else []
    check("an OBJ file holds all of it", sum(row[0] == "f" for row in rows) == FULL and err == "", (out, err))


def main(folder):
    places, triangles = bumpy_ball.mesh(RINGS)
    stl, part, scene, record = (os.path.join(folder, name) for name in ("ball.stl", "ball.hpart", "ball.yaml", "run.h5"))
    bumpy_ball.write_stl(stl, places, triangles)
    subprocess.run([HAPTICD, "import", stl, "-o", part], check=True, capture_output=True)
    with open(scene, "w", encoding="utf-8") as out:
        out.write(f"hapticd: 1\nservo: {{rate: 1000}}\ndevice: {CONFIG}/devices/simulated-premium15.yaml\nhand: {{radius: 0.038}}\n"
                  f"models:\n  - {{name: ball, plugin: nurbs_rigid, parameters: {{geometry: {part}, stiffness: 600}}}}\n")
    environment = {**os.environ, "RUNTIME_DIRECTORY": folder, "STATE_DIRECTORY": folder, "XDG_STATE_HOME": folder}
    ctl = partial(program(HAPTICD, environment), "ctl", "--name", "large")
    run = subprocess.Popen([HAPTICD, "run", scene, "--name", "large", "--for", "600", "--record", record], env=environment,
                           stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    try:
        check("the daemon answers", until(lambda: ctl("status")[0] == 0, 60))
        daemon = Daemon(os.path.join(folder, "large.sock"))
        as_text(daemon, places)
        in_memory(daemon)
        by_hand(ctl, folder)
        check("the run ends in order", ctl("stop")[0] == 0 and run.wait(timeout=60) == 0)
        again = program(HAPTICD, environment)("replay", record)
        check("what was felt meanwhile is what is felt without a drawing", again.returncode == 0, again.stdout + again.stderr)
    finally:
        run.kill()


with tempfile.TemporaryDirectory(dir=os.environ.get("HAPTICD_TEST_MEMORY", "/dev/shm")) as place:
    main(place)
finish()
