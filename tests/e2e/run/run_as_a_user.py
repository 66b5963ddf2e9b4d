#!/usr/bin/env python3
"""`hapticd run` as a user and a service manager meet it: what it maps, how it stops, what it refuses.

Usage: run_as_a_user.py HAPTICD SOURCE_DIR       prints one line per check; exit 1 when one fails.
"""
import json
import os
import signal
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "support"))
from e2e import LONG, check, finish, program

HAPTICD, SOURCE = sys.argv[1], sys.argv[2]
hapticd = program(HAPTICD, timeout=120)
SCENES = os.path.join(SOURCE, "config", "scenes")


def started(scene, *more):
    """The running daemon, once its servo thread ticks."""
    daemon = subprocess.Popen([HAPTICD, "run", os.path.join(SCENES, scene), *more], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    deadline = time.monotonic() + 20
    while time.monotonic() < deadline and daemon.poll() is None:
        try:
            names = [open(f"/proc/{daemon.pid}/task/{t}/comm").read().strip() for t in os.listdir(f"/proc/{daemon.pid}/task")]
        except OSError:  # a thread ended while it was being read
            continue
        if "hapticd-servo" in names:
            time.sleep(0.3)
            break
        time.sleep(0.02)
    return daemon


def mapped(daemon):
    return {os.path.basename(line.split()[-1]) for line in open(f"/proc/{daemon.pid}/maps") if line.rstrip().endswith(".so") or ".so." in line}


def maps_what_it_needs():
    daemon = started("sphere.yaml")
    libraries = mapped(daemon)
    for unwanted in ("libusb", "hidapi", "mat_deformable", "push_button", "pendulum", "template", "usb_", "vme"):
        found = [library for library in libraries if unwanted in library]
        check(f"a scene of one sphere maps no {unwanted}", not found, found)
    check("and maps the one plugin that it names", "nurbs_rigid.so" in libraries, sorted(libraries))
    daemon.send_signal(signal.SIGTERM)
    daemon.wait(10)


def signalled():
    for sig in (signal.SIGINT, signal.SIGTERM):
        with tempfile.TemporaryDirectory() as folder:
            report = os.path.join(folder, "report.json")
            daemon = started("teapot.yaml", "--report", report)
            daemon.send_signal(sig)
            out, err = daemon.communicate(timeout=10)
            check(f"{sig.name} ends the run with exit code 0", daemon.returncode == 0, (daemon.returncode, err))
            written = os.path.exists(report) and json.load(open(report))
            check(f"{sig.name} still writes the report", bool(written) and written["ticks"] > 0)
            check(f"{sig.name} is no fault", written and written["faults"] == [], written and written["faults"])


def refused(name, *arguments):
    done = hapticd("run", *arguments)
    check(f"{name} is refused with exit code 2 and a reason", done.returncode == 2 and done.stderr.strip(), (done.returncode, done.stderr))


def bad_input():
    teapot = os.path.join(SCENES, "teapot.yaml")
    refused("--for -1", teapot, "--for", "-1")
    refused("--for 1s", teapot, "--for", "1s")
    done = hapticd("run", teapot, "--for", "1s")
    check("and says how to write it", "expected seconds, such as --for 10" in done.stderr + done.stdout, done.stderr)
    refused("a report that cannot be written", teapot, "--for", "1", "--report", "/dev/null/report.json")
    refused("a missing scene", "/nonexistent/scene.yaml")
    refused("a rate of nothing", teapot, "--rate", "0")
    with tempfile.TemporaryDirectory() as folder:
        device = os.path.join(folder, "device.yaml")
        open(device, "w").write("hapticd-device: 1\nmodule: no_such_module\nname: none\n")
        refused("a device of a missing module", teapot, "--device", device)


def many_models():
    with tempfile.TemporaryDirectory() as folder:
        scene = os.path.join(folder, "many.yaml")
        model = os.path.join(SOURCE, "config", "models", "sphere.yaml")
        with open(scene, "w") as out:
            out.write("hapticd: 1\nmodels:\n")
            models = 10000 if LONG else 2000
            for i in range(models):
                out.write(f"  - {{name: m{i}, plugin: nurbs_rigid, pose: {{position: [{i % 100}, {i // 100}, 0]}}, parameters: {{geometry: {model}}}}}\n")
        done = hapticd("run", scene, "--for", "0.2", "--virtual-time")
        check(f"a scene of {models} models runs, or says why not", done.returncode in (0, 2) and (done.returncode == 0 or done.stderr), (done.returncode, done.stderr[-300:]))


maps_what_it_needs()
signalled()
bad_input()
many_models()
finish()
