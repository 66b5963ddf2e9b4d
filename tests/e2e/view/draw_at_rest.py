#!/usr/bin/env python3
"""`hapticd view` shows a part, a model file, a mesh and a scene at rest: without an arm, and without a daemon.

Usage: draw_at_rest.py HAPTICD CONFIG     prints one line per case; exit 1 when one is off.
"""
import glob
import json
import os
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import threading

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "support"))
from e2e import check, finish, write

HAPTICD, CONFIG = sys.argv[1], os.path.abspath(sys.argv[2])
PATIENCE = 60  # s
CUBE = ("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
        "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n")


def ask(file, request):
    with socket.socket(socket.AF_UNIX) as connection:
        connection.settimeout(PATIENCE)
        connection.connect(file)
        connection.sendall(json.dumps(request).encode() + b"\n")
        line = b""
        while not line.endswith(b"\n"):
            data, descriptors, _, _ = socket.recv_fds(connection, 1 << 16, 4)
            line += data
            for descriptor in descriptors:
                os.close(descriptor)
        return json.loads(line)


def shows(file, models, command, *options):
    """The page is served, all models are drawn, and nothing is left behind."""
    name = os.path.basename(file)
    view = subprocess.Popen([HAPTICD, "view", file, *options], env=environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    patience = threading.Timer(PATIENCE, view.kill)
    patience.start()
    lines = []
    for line in iter(view.stdout.readline, ""):
        lines.append(line)
        if "token=" in line:
            break
    check(f"{name}: a page is served", lines and "token=" in lines[-1], lines)
    if name.endswith((".obj", ".bpt")):
        check(f"{name}: which unit was assumed is said unless one is given", any("states no unit" in line for line in lines) == (not options), lines)
    check(f"{name}: no temporary file is named", "hapticd-still" not in "".join(lines), lines)
    servers = glob.glob(os.path.join(folder, "hapticd-view-*", "models.sock"))
    listed = [model["name"] for model in ask(servers[0], {"do": "list"})["models"]] if servers else []
    check(f"{name}: its models are listed", listed == models, listed)
    for model in listed:
        answer = ask(servers[0], {"do": "geometry", "model": model, "as": "memory"})
        check(f"{name}: {model} is drawn", answer["ok"] and answer["triangles"] >= 12, answer)
    view.send_signal(signal.SIGTERM)
    error = view.communicate(timeout=PATIENCE)[1]
    patience.cancel()
    check(f"{name}: how to feel it is said", command in error, error)
    check(f"{name}: nor by a warning", "hapticd-still" not in error, error)
    check(f"{name}: nothing is left behind", not glob.glob(os.path.join(folder, "hapticd-*")), os.listdir(folder))


def refused(file, word, *options):
    done = subprocess.run([HAPTICD, "view", file, *options], env=environment, capture_output=True, text=True, timeout=PATIENCE)
    check(f"{os.path.basename(file)}: is refused with its reason", done.returncode == 2 and word in done.stderr and "token" not in done.stdout, done)
    check("and nothing is left behind", not glob.glob(os.path.join(folder, "hapticd-*")), os.listdir(folder))


with tempfile.TemporaryDirectory() as folder:
    environment = dict(os.environ, RUNTIME_DIRECTORY=folder, STATE_DIRECTORY=folder, TMPDIR=folder)
    models = lambda name: os.path.join(CONFIG, "models", name)
    shows(models("as1.hpart"), ["as1"], f"hapticd import {models('as1.hpart')} --scene SCENE.yaml")
    shows(models("goblet.yaml"), ["goblet"], f"hapticd import {models('goblet.yaml')} --scene SCENE.yaml")
    shows(models("leaf.yaml"), ["leaf"], "--scene SCENE.yaml")
    branch = os.path.join(folder, "it's mine.ma")
    shutil.copy(models("branch.ma"), branch)
    shows(branch, ["it's mine"], "it'\\''s mine.ma' --scene SCENE.yaml")
    shows(write(folder, "cube.obj", CUBE), ["cube"], f"hapticd import {folder}/cube.obj -o cube.hpart --scene SCENE.yaml")
    shows(os.path.join(folder, "cube.obj"), ["cube"], "cube.obj --scale 0.001 -o cube.hpart", "--scale", "0.001")
    shows(models("teapot.bpt"), ["teapot"], "teapot.bpt -o teapot.yaml --scene SCENE.yaml")
    shows(os.path.join(CONFIG, "scenes", "two-arms.yaml"), ["sphere"], "two-arms.yaml --view")  # its arms are not opened
    real = write(folder, "real.yaml", f"hapticd: 1\ndevice: {CONFIG}/devices/premium15.yaml\nmodels:\n"
                 f"  - {{name: one, plugin: nurbs_rigid, parameters: {{geometry: {models('sphere.yaml')}}}}}\n")
    shows(real, ["one"], f"hapticd run {real} --view")
    refused(write(folder, "bad.hpart", "no part"), "bad.hpart")
    refused(os.path.join(folder, "none.hpart"), f"error: {folder}/none.hpart: there is no such file")
    refused(write(folder, "program.py", "print()\n"), "program.py: holds nothing that can be shown, expected a recording or dump (.h5), a part (.hpart), ")
    refused(write(folder, "cube.txt", CUBE), "rename it to")
    refused(write(folder, "broken.h5", "print()\n"), "broken.h5: is not a recording")
    nowhere = subprocess.run([HAPTICD, "view", models("as1.hpart")], env=dict(environment, TMPDIR="/nowhere"), capture_output=True, text=True, timeout=PATIENCE)
    check("a folder for temporary files that is not there is named", nowhere.returncode == 1 and "TMPDIR: No such file" in nowhere.stderr, nowhere)
    refused(models("as1.hpart"), "--scale has an effect only with", "--scale", "0.5")
    refused(os.path.join(CONFIG, "devices", "premium15.yaml"), "expected a scene file")
    refused(write(folder, "open.yaml", "hapticd: 1\nmodels:\n  - {name: a, plugin: nurbs_rigid, parameters: {geometry: none.yaml}}\n"), "none.yaml")
finish()
