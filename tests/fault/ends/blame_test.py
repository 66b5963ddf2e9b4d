#!/usr/bin/env python3
"""Who ended the process is named, wherever it was called, and nobody else; what is no answer harms nobody.

Usage: blame_test.py HAPTICD RIG.so ENDING_SHAPES.so SOURCE_DIR     prints one line per check; exit 1 when one fails.
"""
import os
import signal
import sys
import time
from multiprocessing.pool import ThreadPool

here = os.path.dirname(os.path.abspath(__file__))
sys.path[:0] = [here, os.path.join(here, "..", "..", "support"), os.path.join(here, "..", "..", "support", "rig")]
from daemon import Daemon
from e2e import check, finish, until
from rig import HANG_IN_READ, HANG_IN_WAIT, HANG_IN_WRITE

HAPTICD, *MODULES, SOURCE = (os.path.abspath(argument) for argument in sys.argv[1:5])
GOOD = ("{name: good, plugin: nurbs_rigid, pose: {position: [0, -0.05, 0]}, parameters: {geometry: " +
        os.path.join(SOURCE, "config", "models", "sphere.yaml") + ", stiffness: 500}}")
BAD = "{{name: bad, plugin: broken, parameters: {{where: {}}}}}"


def daemon(*models, **more):
    return Daemon(HAPTICD, MODULES, [GOOD, *models], **more)


def blamed(where):
    run = daemon(BAD.format(where), rig={"limits": "{ramp_in: 0.02, passivity: true}"})
    code, said = run.end()
    return [(f"{where}: its plugin is named, and the motors are off",
             code == 1 and "plugin 'broken' of model 'bad' was ended by" in said and not run.arm.motors_on(), (code, said)),
            (f"{where}: it alone is in quarantine", [line.split("\t")[0] for line in run.quarantined().splitlines()] == ["broken"],
             run.quarantined())]


def blamed_at_the_end(where):
    """After the motors are off, while the models are taken down; the report of the run is out before."""
    run = daemon(BAD.format(where), arguments=("--rate", "1000", "--for", "0.5"))
    code, said = run.end()
    return [(f"{where}: its plugin is named after the report", code == 1 and "plugin 'broken' of model 'bad' was ended by" in said and
             "good (nurbs_rigid)" in said and not run.arm.motors_on(), (code, said)),
            (f"{where}: it alone is in quarantine", [line.split("\t")[0] for line in run.quarantined().splitlines()] == ["broken"],
             run.quarantined())]


def device(fault):
    run = daemon(rig={"paces": "true"}, servo="{pace: device}", arguments=("--rate", "1000"))
    check(f"{fault[0]}: a force comes", run.arm.wait_for_force())
    run.arm.wish(fault[1])
    silent = run.arm.silent_after(5)
    code, said = run.end()
    return [(f"{fault[0]}: the motors are cut", silent is not None, said),
            (f"{fault[0]}: the device is named", code == 1 and "device module 'rig' of device 'rig' was ended by" in said, (code, said)),
            (f"{fault[0]}: no plugin is in quarantine", run.quarantined() == "", run.quarantined())]


def device_in_its_dry_cycles(fault):
    """Before READY, when no force was sent yet."""
    run = daemon(rig={"paces": "true"}, servo="{pace: device}", arguments=("--rate", "1000", "--for", "1"))
    until(lambda: run.arm.count() > 2)  # it has started, and gets commands
    run.arm.wish(fault[1])
    code, said = run.end()
    words = f"{fault[0]} in the dry cycles: "
    return [(words + "the device is named",
             code == 1 and "device module 'rig' of device 'rig' was ended by" in said and "ready" not in said, (code, said)),
            (words + "no force was sent", not any(entry.on for entry in run.arm.entries()), said)]


HANGS = (("a read that hangs", HANG_IN_READ), ("a write that hangs", HANG_IN_WRITE), ("a wait for samples that hangs", HANG_IN_WAIT))

for checks in ThreadPool(2).imap(lambda call: call[0](call[1]),
                                 [(blamed, where) for where in ("reset", "stored", "search", "start_tracing")] +
                                 [(blamed_at_the_end, where) for where in ("taken_down", "destroyed")] +
                                 [(call, fault) for call in (device, device_in_its_dry_cycles) for fault in HANGS]):
    for told in checks:
        check(*told)

run = daemon()
check("added: a force comes", run.arm.wait_for_force())
bad = run.write("bad", [BAD.format("set_up")])
run.ctl("add", bad)
code, said = run.end()
check("a plugin that crashes while it is added is named", code == 1 and "plugin 'broken' of model 'bad'" in said and not run.arm.motors_on(),
      (code, said))
again = daemon()
again.arm.wait_for_force()
with open(os.path.join(again.folder, "quarantine"), "w") as out:
    out.write("broken\tSIGSEGV\n")
code, told = again.ctl("add", again.write("bad", [BAD.format("nowhere")]))
check("one in quarantine cannot be added", code == 1 and "hapticd plugin clear broken" in told, (code, told))
again.process.send_signal(signal.SIGABRT)
code, said = again.end()
check("a signal from outside is nobody's fault", code == 1 and "the daemon itself was ended by" in said and
      again.quarantined() == "broken\tSIGSEGV\n", (code, said, again.quarantined()))

run = daemon(BAD.format("lies"))
check("surfaces that are none harm nobody", run.arm.wait_for_force() and not time.sleep(0.5) and run.process.poll() is None)
added = run.ctl("add", run.write("thread", [BAD.format("thread").replace("name: bad", "name: threads")]))
removed = run.ctl("remove", "threads")
time.sleep(0.3)
check("a plugin's thread outlives its model", added[0] == 0 and removed[0] == 0 and run.process.poll() is None, (added, removed))
run.process.terminate()
check("and the run ends in order", run.end()[0] in (0, 1) and "ended by" not in run.said, run.said)

run = daemon("{name: bad, plugin: broken, parameters: {surfaces: 2000000000}}")
code, said = run.end()
check("two thousand million surfaces are refused", code == 2 and "2000000000 surfaces" in said, (code, said))


def slow(processor):
    """Steps of 2.1 ms at 1 kHz, with everything on one processor: the watchdog interrupts each."""
    run = daemon("{name: bad, plugin: slow, parameters: {busy: 0.0021}}", simulated=True, arguments=("--for", "1.5"),
                 start=("taskset", "-c", str(processor)))
    code, said = run.end()
    return code, said


code, said = slow(min(os.sched_getaffinity(0)))
check("a slow plugin ends no run", "never slept" not in said and "motors" not in said, (code, said))
check("it is silenced and named", code == 1 and "bad" in said, (code, said))
finish()
