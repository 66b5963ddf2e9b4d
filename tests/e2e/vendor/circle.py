#!/usr/bin/env python3
"""The module `vendor_hd` on the HDAPI library that we have, our own: a daemon drives the simulated arm of another one.

Usage: circle.py HAPTICD SOURCE LIBHD     prints one line per case; exit 1 when one is off.
"""
import os
import signal
import sys
import tempfile

import numpy

HAPTICD, SOURCE, LIBRARY = sys.argv[1:4]
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
ARM = """hapticd-device: 1
module: vendor_hd
name: arm
parameters: {{library: "{library}", {more}}}
"""
LOST = 2  # the fault of a device that is gone


def daemon(folder, name, text, **more):
    return Daemon(HAPTICD, folder, name, text.format(source=SOURCE), "--allow-non-rt", **more)


def arm(folder, library=LIBRARY, more="force: 5"):
    with open(os.path.join(folder, "arm.yaml"), "w") as file:
        file.write(ARM.format(library=library, more=more))


def vector(rows, prefix):
    return numpy.stack([rows[prefix + c] for c in "xyz"], axis=1)


def fault(client):
    rows = client.rows("ticks", last=50)
    return rows["arm0_fault"][-1] if len(rows) else None


def pushed(client):
    rows = client.rows("ticks", last=50)
    return numpy.abs(vector(rows, "arm0_client_f")[-1]).max() if len(rows) else None


def closed(folder, near, far):
    """What the near daemon sees and sends is what the far one has and gets."""
    until(lambda: near.streams["ticks"].written > 5000, 60)
    seen, there = near.rows("ticks", last=3000), far.rows("ticks", last=6000)
    seen = seen[seen["arm0_valid"] == 1]
    places = {row.tobytes() for row in numpy.round(vector(there, "arm0_"), 9)}
    known = numpy.mean([row.tobytes() in places for row in numpy.round(vector(seen, "arm0_"), 9)])
    check("positions are those of the far arm, mm taken for mm", known > 0.95, known)
    fresh = numpy.diff(seen["arm0_sequence"].astype(numpy.int64)) > 0
    check("samples go on", fresh.sum() > 100, fresh.sum())
    sent, got = vector(seen, "arm0_sent_f"), vector(far.rows("pushes", last=6000), "f")
    check("the ball pushes", numpy.abs(sent).max() > 0.3, numpy.abs(sent).max())
    wanted = {row.tobytes() for row in numpy.round(sent, 6)}
    arrived = numpy.mean([row.tobytes() in wanted for row in numpy.round(got[-1500:-200], 6)])
    check("its forces arrive as they were sent", arrived > 0.8, arrived)
    felt = vector(far.rows("ticks", last=1000), "arm0_client_f")
    check("and are felt there", numpy.abs(felt).max() > 0.3, numpy.abs(felt).max())
    check("within the bound of the device file", numpy.linalg.norm(got, axis=1).max() <= 5.0001)


def main(folder):
    arm(folder)
    far_run = daemon(folder, "far", FAR)
    near_run = daemon(folder, "near", NEAR, HAPTICD_NAME="far")
    with far_run.connect() as far:
        with near_run.connect() as near:
            check("the arm says its vendor's name for it", near.about["devices"][0]["info"]["product"] == "PHANTOM Premium 1.5")
            closed(folder, near, far)
        near_run.stop(signal.SIGKILL)
        check("the far arm is free when the near daemon dies",
              until(lambda: pushed(far) == 0))
    near_run = daemon(folder, "near2", NEAR, HAPTICD_NAME="far")
    with near_run.connect() as near:
        check("the near daemon ticks again", until(lambda: near.streams["ticks"].written > 100))  # it can be asked before
        far_run.stop(signal.SIGKILL)
        check("the near daemon tells that the arm is lost", until(lambda: fault(near) == LOST), fault(near))
        check("and sends no force", until(lambda: numpy.abs(vector(near.rows("ticks", last=50), "arm0_sent_f")).max() == 0))
    near_run.stop()
    check("its log says what to do", "lost the arm" in near_run.log(), near_run.log())


def refused(folder):
    """What is missing is told with its cure."""
    arm(folder, "/no/such/libHD.so")
    run = daemon(folder, "none", NEAR)
    check("a library that is none", run.process.wait(timeout=30) != 0 and "install the vendor's driver" in run.log(),
          run.log())
    arm(folder)
    run = daemon(folder, "nobody", NEAR, HAPTICD_NAME="nobody")
    check("an arm that is none", run.process.wait(timeout=30) != 0 and "cannot open its default arm" in run.log(),
          run.log())


with tempfile.TemporaryDirectory(dir="/dev/shm") as place:
    main(place)
    refused(place)
finish()
