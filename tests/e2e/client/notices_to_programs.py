#!/usr/bin/env python3
"""A program is told that nobody feels its force, and that its daemon is gone; the daemon's log tells what programs did.

Usage: notices_to_programs.py HAPTICD SOURCE OUTLIVES     prints one line per case; exit 1 when one is off.
"""
import contextlib
import os
import resource
import signal
import socket
import subprocess
import sys
import tempfile
import time
import warnings

HAPTICD, SOURCE, OUTLIVES = sys.argv[1:4]
CLIENT = os.path.join(SOURCE, "driver", "doors", "client", "python")
sys.path.insert(0, os.path.join(SOURCE, "tests", "support"))
sys.path.insert(0, CLIENT)
import hapticd
from daemon import Daemon
from e2e import check, finish, until

SCENE = f"""hapticd: 1
servo: {{rate: 1000}}
device: {SOURCE}/config/devices/simulated-premium15.yaml
hand: {{script: guided, tremor: 0, wander: 0}}
clients: {{mode: add, max_force: 3}}
models:
  - name: door
    plugin: nurbs_rigid
    motion: kinematic
    pose: {{position: [0, -0.3, 0]}}
    parameters: {{geometry: {SOURCE}/config/models/box.yaml, stiffness: 500}}
"""
ARM = "simulated Premium 1.5"
PROGRAM = """
import sys, time
import hapticd
with hapticd.connect("trouble") as h:
    with h.push(h.devices[0], lambda state: [0, 0, float(sys.argv[1])]):
        time.sleep(1000)
"""


def start(folder):
    daemon = Daemon(HAPTICD, folder, "trouble", SCENE)
    daemon.environment["PYTHONPATH"] = CLIENT
    return daemon


def says(daemon, *words):
    """The log has a line with all of these words."""
    return until(lambda: any(all(word in line for word in words) for line in daemon.log().splitlines()), 30)


def warned(action):
    """Texts of the warnings that nobody feels a force."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        action(caught)
    return [str(w.message) for w in caught if issubclass(w.category, hapticd.NoForceWarning)]


def held(daemon):
    """A hold before the push, and one that begins while it pushes."""
    with daemon.connect() as h:
        h.clear()  # a busy machine may have latched a fault

        def begins(caught):
            with h.push(ARM, lambda state: [0, 0, 1]) as push:
                until(lambda: push.answers > 0)
                h.hold()
                until(lambda: len(caught) > 0)
        texts = warned(begins)
        if "held" not in (h.status()["devices"][0]["no_force"] or ""):
            h.clear()
            return print("SKIPPED: the machine stood still, and a fault of that came before the hold")
        check("a hold while it pushes is a warning with its cure", any("held" in t and "hapticd ctl clear" in t for t in texts), texts)
        check("status has the words too", "held" in (h.status()["devices"][0]["no_force"] or ""), h.status())
        texts = warned(lambda _: h.lead_force(ARM).end())
        check("who begins on an arm that is held is warned", any("held" in t and "hapticd ctl clear" in t for t in texts), texts)
        h.clear()
        check("the log tells of the hold", says(daemon, ARM, "the arm is held") and says(daemon, "hapticd ctl clear"), daemon.log())
        check("and of its end in matching words", says(daemon, ARM, "the hold is over"), daemon.log())


def logged(daemon):
    """Who pushes, asks for more than it gets, falls silent, and dies."""
    victim = subprocess.Popen([sys.executable, "-c", PROGRAM, "100"], env=daemon.environment)
    name = f"process {victim.pid} (python"
    check("the log names the program that pushes", says(daemon, ARM, name, "pushes on it"), daemon.log())
    check("it tells who asks for more than it gets", says(daemon, name, "asked for 100 N and gets 3 N at most"), daemon.log())
    victim.send_signal(signal.SIGSTOP)
    check("and who fell silent", says(daemon, name, "fell silent while it pushed with 3 N"), daemon.log())
    victim.send_signal(signal.SIGCONT)
    check("and that it came back", says(daemon, name, "answers again"), daemon.log())
    with daemon.connect() as h:
        until(lambda: h.status()["devices"][0]["clients"][0]["force_n"] > 0)
    victim.kill()
    victim.wait()
    check("and what it did as it died", says(daemon, name, "ended"), daemon.log())
    with daemon.connect() as h:
        lost = [e for e in h.ask(do="events")["events"] if e["event"] == "lost" and e.get("pid") == victim.pid]
        check("events name the program, and what it did", lost and "python" in lost[-1]["program"] and lost[-1]["does"] == "pushes", lost)


def refused(daemon):
    with daemon.connect() as h, h.lead_force(ARM) as lead:
        lead._slot.put(hapticd._lead._PUSH.pack(h.state(ARM).tick, float("nan"), 0, 0, 0, 0, 0, 0, 0))
        check("a refused answer is told with its process and reason",
              says(daemon, f"process {os.getpid()}", "refused so far: a number is not finite"), daemon.log())
        told = [e for e in h.ask(do="events")["events"] if e["event"] == "refused"]
        check("also by events", told and told[-1]["pid"] == os.getpid() and "not finite" in told[-1]["why"], told)
    check("who ends in order is told so", says(daemon, f"process {os.getpid()}", "no longer pushes on it"), daemon.log())


def pushed_again(daemon):
    """A push whose callback failed keeps no other one from this arm."""
    with daemon.connect() as h:
        h.clear()
        with contextlib.redirect_stderr(None):
            failed = h.push(ARM, lambda state: 1 / 0)
            failed._thread.join(30)
        for answer in (b"abc", "abc", {"x": 1, "y": 2, "z": 3}, 5):
            with contextlib.redirect_stderr(None):
                push = h.push(ARM, lambda state, answer=answer: answer)
                push._thread.join(10)
                push._stop.set()
            check(f"{answer!r} is no force", "expected 3 numbers" in str(push.error), push.error)
            with contextlib.suppress(Exception):
                push.end()
        again = h.push(ARM, lambda state: [0, 0, 1])
        check("an arm can be pushed on again after a callback failed", until(lambda: again.answers > 0))
        check("a program learns the largest force that it gets", again._lead.max_force == 3, again._lead.max_force)
        again.end()
        try:
            h.push(ARM, 5)
            check("what is no function is refused", False)
        except TypeError as error:
            check("what is no function is refused", "got 5" in str(error), str(error))


def raises(action, word="gone"):
    try:
        action()
    except hapticd.HapticdError as error:
        return word in str(error)
    return False


def moves(h, lead, y):
    """The door goes where its leader says."""
    def there():
        lead.put([0, y, 0])
        return abs(h.models["door"].position[1] - y) < 1e-3
    return until(there)


def late(daemon):
    """An answer that came too late for its request is no other's, and brings no memory for another."""
    with daemon.connect() as h:
        h.timeout = 0.2
        daemon.process.send_signal(signal.SIGSTOP)
        given_up = raises(lambda: h.lead_model("door"), "did not answer")
        daemon.process.send_signal(signal.SIGCONT)
        h.timeout = 10
        h.ask(do="geometry", model="door", **{"as": "memory"})
        h.clear()
        with h.lead_model("door") as lead:
            check("a model whose lead was given up can be led, by its own memory", given_up and moves(h, lead, -0.31))


def forgotten(daemon):
    """One that was silent while others wait for a place is told so, and not that the daemon is gone."""
    with daemon.connect() as h:
        lines = []

        def full():
            lines.append(socket.socket(socket.AF_UNIX))
            with contextlib.suppress(OSError):  # others are sent away too
                lines[-1].connect(daemon.socket)
                lines[-1].sendall(b'{"do":"snapshot"}\n')
            time.sleep(0.05)
            return h._line.ended()
        check("a silent client makes room", until(full, 60))
        check("and is told why", raises(h.status, "other programs needed its place"))
        for line in lines:
            line.close()


def many_files(daemon):
    """A program may have more open files than select() can tell of."""
    limits = resource.getrlimit(resource.RLIMIT_NOFILE)
    if limits[1] < 2048:
        return print("skipped: more files than select() can tell of, because this machine allows fewer (ulimit -Hn)")
    resource.setrlimit(resource.RLIMIT_NOFILE, (2048, limits[1]))
    files = [os.open(os.devnull, os.O_RDONLY) for _ in range(1100)]
    with daemon.connect() as h:
        check("more files than select() can tell of are no trouble", h.status()["ok"])
    for file in files:
        os.close(file)
    resource.setrlimit(resource.RLIMIT_NOFILE, limits)


def closed(daemon):
    """Who reads from a client that is closed is told so."""
    with daemon.connect() as h:
        follow, stream = h.follow("ticks"), h.streams["ticks"]
        next(follow)
        h.state(ARM)
    check("a daemon that runs has not ended, also for a closed client", not h.ended() and not h.died() and h.alive())
    for name, action in (("rows", lambda: h.rows("ticks")), ("rows of a stream", lambda: stream.last(1)),
                         ("rows that it follows", lambda: next(follow)), ("the state", lambda: h.state(ARM)),
                         ("a tick that it waits for", lambda: h.wait(1 << 40)), ("requests", h.status)):
        check(f"a closed client says so of {name}", raises(action, "this client is closed"))


def told_by_ctl(daemon):
    """`ctl lead` outlives its daemon."""
    line = subprocess.Popen([HAPTICD, "ctl", "--name", "trouble", "lead", "door"], env=daemon.environment, stdin=subprocess.PIPE,
                            stderr=subprocess.PIPE, text=True)
    with daemon.connect() as h:
        until(lambda: h.models["door"].leader == line.pid)
    daemon.process.kill()
    daemon.process.wait()
    _, told = line.communicate("0 -0.3 0\n", timeout=60)
    check("ctl lead fails where its daemon was killed", line.returncode == 1 and "has ended" in told, (line.returncode, told))


def dies(daemon):
    """The daemon is killed under a program in C and one in Python."""
    with daemon.connect() as h:
        h.hold()
    program = subprocess.Popen([OUTLIVES, "trouble", "door"], env=daemon.environment, stdin=subprocess.PIPE,
                               stdout=subprocess.PIPE, text=True)
    while (line := program.stdout.readline()) not in ("ready\n", ""):
        print(line, end="")
    with daemon.connect() as h:
        h.clear()
        program.stdin.flush()
    h = daemon.connect()
    lead, rows, events = h.lead_hand(ARM), h.follow("ticks"), h.events()
    next(rows)
    push = h.push(ARM, lambda state: [0, 0, 1])
    until(lambda: push.answers > 0)
    daemon.process.kill()
    daemon.process.wait()
    check("a push learns that its daemon is gone", until(lambda: push.error is not None))
    check("and raises it", raises(push.end))
    check("old rows are not given out as new ones", raises(lambda: h.rows("ticks", last=1)))
    check("nor an old state", raises(lambda: h.state(ARM)))
    check("nor is a tick waited for", raises(lambda: h.wait(1 << 40)))
    check("a lead tells it", raises(lambda: lead.put([0, 0, 0])))
    check("and its end", raises(lead.end))
    check("who follows gets the last rows, then the news", raises(lambda: [None for _ in rows]))
    check("who waits for events too", raises(lambda: [None for _ in events]))
    check("leaving the with tells it", raises(lambda: h.__exit__(None, None, None)))
    check("and a closed client knows that its daemon ended", h.ended() and h.died())
    another = start(daemon.folder)  # of the same name
    rest, _ = program.communicate("\n", timeout=120)
    told_by_ctl(another)
    print(rest, end="")
    check("and every call in C", program.returncode == 0, rest)


with tempfile.TemporaryDirectory(dir="/dev/shm") as scratch:
    one = start(scratch)
    try:
        for case in (held, logged, refused, pushed_again, late, forgotten, many_files, closed, dies):
            case(one)
    finally:
        one.process.kill()  # also where a case did not come to its end
finish()
