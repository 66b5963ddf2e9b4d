#!/usr/bin/env python3
"""Looks at running daemons from outside: threads and mapped libraries are those that the scene asks for, and a build
that has nothing but nurbs_rigid and its arm is no smaller. Usage: only_what_a_scene_needs.py HAPTICD SOURCE_DIR"""
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time

hapticd, source = sys.argv[1:3]
MEGABYTE = 1 << 20


def scene(name):
    return f"{source}/config/scenes/{name}.yaml"


def look(name):
    """Names of the threads and files of the libraries of a daemon that runs a scene."""
    with tempfile.TemporaryDirectory() as runtime:
        environment = {**os.environ, "XDG_RUNTIME_DIR": runtime, "XDG_STATE_HOME": runtime}
        daemon = subprocess.Popen([hapticd, "run", scene(name), "--name", f"needed-{os.getpid()}"], env=environment,
                                  stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        try:
            for _ in range(200):
                time.sleep(0.1)
                assert daemon.poll() is None, f"{name}: ended: {daemon.stderr.read()}"
                threads = {(task / "comm").read_text().strip() for task in pathlib.Path(f"/proc/{daemon.pid}/task").iterdir()}
                if "hapticd-servo" in threads:
                    break
            maps = pathlib.Path(f"/proc/{daemon.pid}/maps").read_text().split()
        finally:
            daemon.terminate()
            daemon.communicate(timeout=30)
    assert "hapticd-servo" in threads, f"{name}: no servo thread in {threads}"
    return threads, {os.path.basename(file) for file in maps if "/hapticd/plugins/" in file or "/hapticd/devices/" in file}


threads, modules = look("sphere")
assert modules == {"nurbs_rigid.so", "simulated.so"}, f"a scene of one sphere loads {modules}"
assert "hapticd-sim" not in threads, f"one small surface needs no thread of its own: {threads}"
threads, modules = look("teapot")
assert modules == {"nurbs_rigid.so", "simulated.so"}, modules
assert "hapticd-sim" in threads, f"many surfaces are searched on a thread of their own: {threads}"
threads, modules = look("soft-leaf")
assert modules == {"mat_deformable.so", "simulated.so"}, modules
assert "hapticd-sim" not in threads, f"no surfaces, no search: {threads}"

# What is set up for an arm or for programs is explained as well as what a model asks for.
with tempfile.TemporaryDirectory() as folder:
    arm, ball = f"{folder}/arm.yaml", f"{folder}/ball.yaml"
    for limits, clients, users in (("{force: 2}", "off", ()), ("{force: 2}", "add", ("clients",)), ("{power: 1}", "off", ("limits.power",)),
                                   ("{velocity: 1}", "off", ("limits.velocity",))):
        pathlib.Path(arm).write_text(f"hapticd-device: 1\nmodule: simulated\nname: arm\nmount: {{position: [0, 0, 0.09]}}\nlimits: {limits}\n")
        pathlib.Path(ball).write_text(f"hapticd: 1\ndevice: arm.yaml\nclients: {clients}\nmodels:\n  - {{name: ball, plugin: nurbs_rigid, "
                                      f"parameters: {{geometry: {source}/config/models/sphere.yaml}}}}\n")
        for option in ((), ("--cost",)):
            told = subprocess.run([hapticd, "explain", ball, *option], check=True, capture_output=True, text=True).stdout
            (line,) = [line for line in told.splitlines() if line.startswith("  velocity estimator")]
            assert all(user in line for user in users) and ("window" in line) == bool(users), f"{limits}, clients {clients}: {line}"

# Plugins are files: a build without the others is this one without their files.
with tempfile.TemporaryDirectory() as folder:
    build = pathlib.Path(hapticd).resolve().parent.parent
    for part in ("bin/hapticd", "lib/hapticd/plugins/nurbs_rigid.so", "lib/hapticd/devices/simulated.so"):
        target = pathlib.Path(folder) / part
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(build / part, target)
    resident, ticks = {}, {}
    for name, program in (("all", hapticd), ("alone", f"{folder}/bin/hapticd")):
        runs = []
        for _ in range(5):
            subprocess.run([program, "run", scene("sphere"), "--virtual-time", "--for", "3", "--report", f"{folder}/r.json"],
                           check=True, capture_output=True)
            runs.append(json.load(open(f"{folder}/r.json")))
        resident[name] = min(run["resident_bytes"] for run in runs)
        ticks[name] = min(run["models"]["sphere"]["step_ns"]["p50"] for run in runs)
    more = resident["all"] - resident["alone"]
    print(f"one sphere: {resident['all'] / MEGABYTE:.2f} MB resident, {resident['alone'] / MEGABYTE:.2f} MB in a build "
          f"of nurbs_rigid alone; a step {ticks['all']:.0f} ns and {ticks['alone']:.0f} ns")
    assert abs(more) < MEGABYTE, f"{more} bytes more for plugins that are not used"
