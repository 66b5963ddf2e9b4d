#!/usr/bin/env python3
"""However the process ends, the arm `rig` is left without a force, and who ended it is named.

Usage: ends_test.py HAPTICD RIG.so ENDING_SHAPES.so     prints one line per check; exit 1 when one fails.
"""
import os
import signal
import sys
import tempfile
import time
from multiprocessing.pool import ThreadPool

here = os.path.dirname(os.path.abspath(__file__))
sys.path[:0] = [here, os.path.join(here, "..", "..", "support"), os.path.join(here, "..", "..", "support", "rig")]
from daemon import Daemon
from e2e import check, finish, until, write
from rig import COMMAND, CUT

HAPTICD, MODULE, SHAPES = (os.path.abspath(argument) for argument in sys.argv[1:4])


def run_of(how, rig=None, **parameters):
    """One shape that pushes, and ends the process."""
    values = ", ".join(f"{key}: {value}" for key, value in dict(parameters, how=how).items())
    return Daemon(HAPTICD, [MODULE, SHAPES], [f"{{name: bad, plugin: ending, parameters: {{{values}}}}}"], rig=rig)


def last_word(arm):
    """The motors are free, and no torque came after the cut."""
    entries = arm.entries()
    cuts = [i for i, entry in enumerate(entries) if entry.kind == CUT]
    return not arm.motors_on() and cuts and not any(entry.on for entry in entries[cuts[0]:])


def by_plugin(case):
    """The process ends itself: the motors are cut, and the plugin is named and left out of the next start."""
    name, how, blamed, word, more = case
    run = run_of(how, **more)
    code, said = run.end()
    pushed = any(entry.on for entry in run.arm.entries())
    blame = ("'ending' of model 'bad'" in said and "ending" in run.quarantined()) if blamed else \
        ("the daemon itself" in said and run.quarantined() == "")
    return [(f"{name}: it pushed before", pushed, said), (f"{name}: the motors are cut", last_word(run.arm), said),
            (f"{name}: exit code 1", code == 1, (code, said)),
            (f"{name}: the message says why", word in said and "motors were switched off first" in said, said),
            (f"{name}: {'its plugin is' if blamed else 'nobody is'} blamed", blame, (said, run.quarantined()))]


def number(signal_number):
    return dict(signal=int(signal_number))


RAISED = {name: getattr(signal, name) for name in
          ("SIGUSR1", "SIGUSR2", "SIGALRM", "SIGVTALRM", "SIGPROF", "SIGTRAP", "SIGSYS", "SIGPOLL", "SIGTERM", "SIGINT")}
CASES = [("exit", "exit", True, "a call of exit()", {}),
         ("quick_exit", "quick_exit", True, "a call of exit()", {}),
         ("_exit", "plain_exit", True, "a call of _exit()", {}),
         ("SIGTERM to the process", "kill_itself", False, "SIGTERM", number(signal.SIGTERM)),
         ("exit in a thread of its own", "exit_in_thread", True, "a call of exit()", {}),
         ("a crash in a thread of its own", "segv_in_thread", True, "SIGSEGV", {}),
         ("an abort in a thread of its own", "abort_in_thread", True, "SIGABRT", {}),
         ("a cut that an I/O thread sends", "exit", True, "a call of exit()", {"rig": {"lazy": "true"}}),
         ("SIGUSR2 to the process", "kill_itself", False, "SIGUSR2", number(signal.SIGUSR2)),
         ("a timer", "timer", False, "SIGALRM", {}),
         ("the first real-time signal", "raise", True, "SIGRTMIN+00", number(signal.SIGRTMIN)),
         ("the last real-time signal", "raise", True, "SIGRTMIN+30", number(signal.SIGRTMAX))]
CASES += [(name, "raise", True, name, number(value)) for name, value in RAISED.items()]

for checks in ThreadPool(3).imap(by_plugin, CASES):
    for told in checks:
        check(*told)



def by_guard(case):
    """Nothing of the process is left that could switch the motors off."""
    name, how, more = case
    run = run_of(how, **more)
    if how == "never":
        run.arm.wait_for_force()
        run.process.kill()
    code, said = run.end()
    pushed = any(entry.on for entry in run.arm.entries())
    return [(f"{name}: it pushed before", pushed, said),
            (f"{name}: the guard switches the motors off", run.arm.silent_after(10) is not None and "the arms were switched off" in said,
             (code, said))]


for checks in ThreadPool(2).imap(by_guard, [("an end that no library sees", "raw_exit", {}), ("a masked SIGSEGV", "masked_segv", {}),
                                            ("a reset SIGSEGV", "reset_segv", {}), ("SIGKILL", "never", {})]):
    for told in checks:
        check(*told)

run = run_of("never")
check("SIGSTOP: a force comes", run.arm.wait_for_force())
run.process.send_signal(signal.SIGSTOP)
check("a daemon that stands still: the guard switches the motors off", run.arm.silent_after(20) is not None)
code, said = run.end()
check("and ends it after a while", code == -signal.SIGKILL and "the servo makes no more ticks" in said, (code, said))

def guards(run):
    """Processes whose parent is the daemon, and which are no zombies."""
    found = []
    for name in filter(str.isdigit, os.listdir("/proc")):
        try:
            with open(f"/proc/{name}/stat") as stat:
                state, parent = stat.read().rsplit(")", 1)[1].split()[:2]
        except OSError:
            continue
        if int(parent) == run.process.pid and state != "Z":
            found.append(int(name))
    return found


run = run_of("never")
check("a guard that dies: a force comes", run.arm.wait_for_force())
first = guards(run)
os.kill(first[0], signal.SIGKILL)
end = time.monotonic() + 20
while guards(run) in ([], first) and time.monotonic() < end:
    time.sleep(0.02)
time.sleep(1)  # until it has been told of the arm
check("another takes its place, and the force stays", len(guards(run)) == 1 and guards(run) != first and run.arm.motors_on(), (first, guards(run)))
run.process.kill()
code, said = run.end()
check("and switches the motors off", run.arm.silent_after(10) is not None and "the guard process ended; a new one has replaced it" in said, (code, said))

run = run_of("never", rig={"guarded": "false"})
check("without a guard: a force comes", run.arm.wait_for_force())
run.process.kill()
run.end()
check("without a guard the force stays: nothing else took it in the tests above", run.arm.silent_after(0.5) is None)

run = run_of("never")
check("outside: a force comes", run.arm.wait_for_force())
run.process.send_signal(signal.SIGUSR1)
code, said = run.end()
check("SIGUSR1 of another process ends the run in order, is named, and the guard rests", "guard:" not in said and code == 0 and "SIGUSR1" in said and not run.arm.motors_on(),
      (code, said))
forces = [abs(entry.force[1]) for entry in run.arm.entries() if entry.kind == COMMAND and entry.on]
check("the force ramps out", 0 < min(forces) < 0.1, min(forces))

for code, said in [run.end() for run in [Daemon(HAPTICD, [MODULE, SHAPES], ["{name: bad, plugin: ending, parameters: {how: never}}"],
                                                arguments=("--rate", "4000", "--for", length)) for length in ("0.41", "0.55", "0.6")]]:
    check("a run that ends as planned: the guard rests", "guard:" not in said and code == 0, (code, said))

run = run_of("never")
check("Ctrl-Z: a force comes", run.arm.wait_for_force())
run.process.send_signal(signal.SIGTSTP)
end = time.monotonic() + 20
while run.state() != "T" and time.monotonic() < end:
    time.sleep(0.01)
check("Ctrl-Z stops the process, and no force is left on", run.state() == "T" and not run.arm.motors_on(), run.state())
begun = time.monotonic_ns()
run.process.send_signal(signal.SIGCONT)
time.sleep(0.3)
check("continued it ticks, without a force", run.arm.entries()[-1].time_ns > begun and not run.arm.commands_after(begun),
      len(run.arm.commands_after(begun)))
run.process.terminate()
code, said = run.end()
check("and ends when it is told to", code == 0 and "ctl clear" in said, (code, said))


def walk(arm, begin, end):
    for i in range(101):
        arm.move(0, begin + (end - begin) * i / 100, 0)
        time.sleep(0.002)


with tempfile.TemporaryDirectory() as folder:
    sheet = write(folder, "sheet.yaml", "format: hapticd-model/1\nsurfaces:\n- {degree: [1, 1], knots: [[0, 0, 1, 1], [0, 0, 1, 1]], points: "
                  "[[-0.1, 0, -0.1], [-0.1, 0, 0.1], [0.1, 0, -0.1], [0.1, 0, 0.1]]}\n")
    run = Daemon(HAPTICD, [MODULE, SHAPES], [f"{{name: sheet, plugin: nurbs_rigid, parameters: {{geometry: {sheet}, sides: both}}}}"],
                 rig={"position": "[0, 0.02, 0]"}, arguments=("--rate", "1000"))
    until(lambda: run.arm.count() > 2100)  # after the dry cycles
    walk(run.arm, 0.02, -0.004)
    run.ctl("clear")  # of a busy machine's cut
    check("Ctrl-Z beside a sheet: it is felt from above", run.arm.wait_for_force())
    walk(run.arm, -0.004, 0.02)
    run.process.send_signal(signal.SIGTSTP)
    until(lambda: run.state() == "T")
    run.arm.move(0, -0.01, 0)  # round it, while no tick sees the way
    time.sleep(0.3)
    begun = time.monotonic_ns()
    run.process.send_signal(signal.SIGCONT)
    time.sleep(0.3)
    run.ctl("clear")
    time.sleep(0.5)
    check("a hand that came to its other side meanwhile is not pulled through it", not run.arm.commands_after(begun),
          [entry.force for entry in run.arm.commands_after(begun)[-1:]])
    walk(run.arm, -0.01, 0.004)
    check("and feels it from there", run.arm.wait_for_force() and run.arm.force()[1] < 0, run.arm.force())
    run.process.terminate()
    run.end()
finish()
