#!/usr/bin/env python3
"""The module `vendor_dhd` on a library of the test's own that has the functions of DHD.

Usage: dhd.py HAPTICD SOURCE LIBDHD     prints one line per case; exit 1 when one is off.
"""
import os
import sys
import tempfile

import numpy

HAPTICD, SOURCE, LIBRARY = sys.argv[1:4]
sys.path.insert(0, os.path.join(SOURCE, "tests", "support"))
sys.path.insert(0, os.path.join(SOURCE, "driver", "doors", "client", "python"))
from daemon import Daemon
from e2e import check, finish, until

SCENE = """hapticd: 1
device: arm.yaml
models:
  - name: ball
    plugin: nurbs_rigid
    parameters: {{geometry: {source}/config/models/sphere.yaml, stiffness: 500}}
"""
ARM = """hapticd-device: 1
module: vendor_dhd
name: omega
parameters: {{library: "{library}", force: 3, index: {index}}}
"""
LOST = 2  # the fault of a device that is gone


def start(folder, name, library=LIBRARY, index=0, **more):
    with open(os.path.join(folder, "arm.yaml"), "w") as file:
        file.write(ARM.format(library=library, index=index))
    return Daemon(HAPTICD, folder, name, SCENE.format(source=SOURCE), "--allow-non-rt", FAKE_DHD_LOG=os.path.join(folder, name + ".calls"), **more)


def text(folder, file):
    with open(os.path.join(folder, file)) as opened:
        return opened.read()


def presses(folder):
    run = start(folder, "dhd")
    with run.connect() as client:
        check("the arm says its name", client.about["devices"][0]["info"]["product"] == "fake omega")
        until(lambda: client.streams["ticks"].written > 4000, 60)
        row = client.rows("ticks", last=50)[-1]
        check("x to the user is the world's z, y its x, z its y", row["arm0_x"] == 0.003 and row["arm0_y"] == -0.002 and
              0.04 < row["arm0_z"] < 0.06, row)
        check("buttons are told", row["arm0_buttons"] == 2)
    check("the run ends in order", run.stop() == 0)
    lines = text(folder, "dhd.calls").splitlines()
    check("forces are on from the start and off at the end, when the arm is closed",
          lines[0] == "enable 1" and lines[-2:] == ["enable 0", "close"], lines[-3:])
    rows = numpy.array([[float(word) for word in line.split()] for line in lines if line[0].isdigit()])
    pushes = rows[rows[:, 1] > 0.2]
    check("the ball pushes toward the user", len(pushes) > 50 and rows[:, 1].min() > -1e-6, len(pushes))
    along = numpy.abs(pushes[:, 2] / pushes[:, 1] - 0.003 / pushes[:, 0]).max() if len(pushes) else None
    check("along its normal in the device's frame", along is not None and along < 0.05, along)
    check("within the bound of the device file", numpy.linalg.norm(rows[:, 1:], axis=1).max() <= 3.0001)
    check("the last force is none", (rows[-1, 1:] == 0).all(), rows[-1])


def is_lost(folder):
    run = start(folder, "lost", FAKE_DHD_LOST="3000")
    with run.connect() as client:
        check("an arm that is unplugged is lost", until(lambda: LOST in client.rows("ticks", last=50)["arm0_fault"]))
        forces = [line.split()[1:] for line in text(folder, "lost.calls").split("lost\n")[0].splitlines() if line[0].isdigit()]
        check("while it pushed", abs(float(forces[-1][0])) > 0.2, forces[-1])
        check("and is told at once to let go", until(lambda: "0.000000000 0.000000000 0.000000000\n" in text(folder, "lost.calls").split("lost\n")[-1]),
              text(folder, "lost.calls").split("lost\n")[-1])
    run.stop()
    check("which is told", "lost the arm" in run.log(), run.log())


def refused(folder):
    run = start(folder, "none", library="/no/such/libdhd.so")
    check("a library that is none", run.process.wait(timeout=30) != 0 and "install the vendor's driver" in run.log(),
          run.log())
    run = start(folder, "other", index=3)
    check("an arm that is none", run.process.wait(timeout=30) != 0 and "no such arm" in run.log(),
          run.log())


with tempfile.TemporaryDirectory(dir="/dev/shm") as place:
    presses(place)
    is_lost(place)
    refused(place)
finish()
