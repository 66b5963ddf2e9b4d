#!/usr/bin/env python3
"""Programs of the HDAPI, run by `hapticd client` on the simulated arm of a daemon; what they pushed is in its rows.

Usage: run_the_programs.py HAPTICD SOURCE PROGRAMS     prints one line per case; exit 1 when one is off.
PROGRAMS is the folder of the built hd_... programs.
"""
import contextlib
import os
import re
import signal
import subprocess
import sys
import tempfile
import time

import numpy

HAPTICD, SOURCE, PROGRAMS = sys.argv[1:4]
HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(SOURCE, "tests", "support"))
sys.path.insert(0, os.path.join(SOURCE, "driver", "doors", "client", "python"))
from daemon import Daemon
from e2e import check, finish, until

HEAD = """hapticd: 1
servo: {{rate: 1000}}
device: {source}/config/devices/simulated-premium15.yaml
hand: {hand}
clients: {clients}
models: {models}
"""
STROKES = "{radius: 0.02}"
SPHERE = """
  - name: ball
    plugin: nurbs_rigid
    parameters: {{geometry: {source}/config/models/sphere.yaml, stiffness: 800}}
"""
TWO = """hapticd: 1
servo: {{rate: 1000}}
devices:
  - {{file: {source}/config/devices/simulated-premium15.yaml, name: left, mount: {{position: [-0.1, 0, 0.09]}}}}
  - {{file: {source}/config/devices/simulated-premium15.yaml, name: right, mount: {{position: [0.1, 0, 0.09]}}}}
clients: add
models: []
"""
SIX_ARM = """hapticd-device: 1
module: simulated
name: six
mount: {position: [0.1, 0.2, 0.3], orientation: [0.7071067811865476, 0, 0.7071067811865476, 0]}
limits: {force: 20, torque: 1, weight: 0, passivity: false}
hd:
  model: PHANTOM Premium 1.5 6DOF
  vendor: a workshop
  serial: S6
  joints: [[0, -1], [1, 1, 0.25], [2], [3], [4], [5]]
parameters:
  seed: 1
  arm:
    kind: chain
    dh: [[0, 1.5707963267948966, 0, 0], [0.2, 0, 0, 0], [0, 1.5707963267948966, 0, 0],
         [0, -1.5707963267948966, 0.2, 0], [0, 1.5707963267948966, 0, 0], [0, 0, 0.05, 0]]
    limits: [[-1.5, 1.5], [0.2, 1.4], [-1, 1], [-1.5, 1.5], [0.2, 1.6], [-2, 2]]
    base_position: [-0.332395801, 0, -0.010572101]
  joint: {counts: 1000000, damping: 5, max_torque: 10, rotor: 0.01}
  device: {max_force: 20, mass: 0.5}
hand: {script: guided, tremor: 0, wander: 0, stiffness: 500}
"""
SIX = """hapticd: 1
servo: {{rate: 1000}}
device: {folder}/six-arm.yaml
clients: {{mode: add, frame: device, origin: [0, 0, 0.1]}}
models: []
"""
ARM = "simulated Premium 1.5"


class ArmDaemon(Daemon):
    """A daemon on whose arm programs of the HDAPI are run."""

    def __init__(self, folder, name, text):
        super().__init__(HAPTICD, folder, name, text)

    def command(self, program, *arguments):
        return [HAPTICD, "client", "--name", self.name, os.path.join(PROGRAMS, "hd_" + program), *arguments]

    def program(self, name, *arguments):
        """Runs a program and shows its own checks."""
        done = subprocess.run(self.command(name, *arguments), env=self.environment, capture_output=True, text=True,
                              timeout=120)
        print(done.stdout, end="")
        check(f"{name} {' '.join(arguments)}", done.returncode == 0, done)
        return done


def scene(models="[]", clients="add", hand=STROKES):
    return HEAD.format(source=SOURCE, hand=hand, clients=clients, models=models.format(source=SOURCE))


def pushes_of(daemon, program, *arguments):
    """Answers that a program gave, and the ticks that they are about: [N], [m]."""
    with daemon.connect() as client:
        first_push, first_tick = client.streams["pushes"].written, client.streams["ticks"].written
        daemon.program(program, *arguments)
        pushes, ticks = client.streams["pushes"].read(first_push)[1], client.streams["ticks"].read(first_tick)[1]
    both, at_push, at_tick = numpy.intersect1d(pushes["answers"], ticks["tick"], return_indices=True)
    pushes, ticks = pushes[at_push], ticks[at_tick]
    force = numpy.stack([pushes["f" + c] for c in "xyz"], axis=1)
    position = numpy.stack([ticks["arm0_" + c] for c in "xyz"], axis=1)
    return force, position, pushes, ticks


def plain(daemon):
    """Programs that check themselves."""
    for program in ("hello", "hello98"):
        daemon.program(program, "PHANTOM Premium 1.5")
    daemon.program("names", os.path.join(HERE, "functions.txt"))
    for program in ("hdu", "values", "constructor"):
        daemon.program(program)
    told = daemon.program("scheduler").stderr
    check("a second frame in a tick is told once, with two ways out", told.count("HD_ONE_FRAME_LIMIT allows one frame") == 1
          and "the last one hdEndFrame" in told and "hdDisable(HD_ONE_FRAME_LIMIT)" in told, told)


def client_force(daemon):
    """[N] that programs push with now."""
    with daemon.connect() as client:
        row = client.rows("ticks", last=50)[-1]
        return max(abs(row["arm0_client_f" + c]) for c in "xyz")


def python(daemon):
    done = subprocess.run([HAPTICD, "client", "--name", daemon.name, sys.executable,
                           os.path.join(HERE, "ctypes_program.py")], env=daemon.environment, capture_output=True,
                          text=True, timeout=120)
    print(done.stdout, end="")
    check("a program in Python", done.returncode == 0, done)


def spring(daemon):
    force, position, pushes, _ = pushes_of(daemon, "forces", "spring", "2")
    check("a spring answers ticks", len(pushes) > 500, len(pushes))
    full = pushes["answers"] > pushes["answers"][0] + 60  # the library's own ramp is over
    off = abs(force + 200 * position)[full].max()
    check("0.2 N/mm over millimetres is 200 N/m of that tick's position", off < 1e-9, off)
    check("no force stays behind", until(lambda: client_force(daemon) == 0))
    check("a program that closes its device ends in order", until(lambda: "(hd_forces) no longer pushes on it" in daemon.log()), daemon.log())


def sleeps_by_the_clock(daemon, listen):
    """Share of the looks at which the program's servo loop slept until a time; else it waited for the daemon's bell."""
    clock = {"x86_64": "230", "aarch64": "115"}[os.uname().machine]
    program = subprocess.Popen(daemon.command("forces", "spring", "1"), stdout=subprocess.DEVNULL,
                               env=dict(daemon.environment, HAPTICD_LISTEN=listen))
    seen = []
    while program.poll() is None:
        for thread in os.listdir(f"/proc/{program.pid}/task"):
            if int(thread) != program.pid:
                with contextlib.suppress(OSError), open(f"/proc/{program.pid}/task/{thread}/syscall") as file:
                    seen.append(file.read().split()[0])
        time.sleep(0.0007)
    asleep = [call for call in seen if call != "running"]
    return sum(call == clock for call in asleep) / max(1, len(asleep))


def listens(daemon):
    """HAPTICD_LISTEN: the servo loop sleeps until shortly before a tick and looks for it, so that nobody need wake it."""
    if not os.access("/proc/self/syscall", os.R_OK):
        return print("SKIPPED: this kernel does not tell what a thread waits for")
    check("without listening it waits for the bell alone", sleeps_by_the_clock(daemon, "0") == 0)
    share = sleeps_by_the_clock(daemon, "100")
    check("with HAPTICD_LISTEN it sleeps by the clock", share > 0.2, share)
    done = subprocess.run(daemon.command("forces", "spring", "0.1"), capture_output=True, text=True, timeout=60,
                          env=dict(daemon.environment, HAPTICD_LISTEN="soon"))
    check("what is no number is told and ignored",
          done.returncode == 0 and "HAPTICD_LISTEN is ignored: it is not a number of microseconds" in done.stderr, done)


def clamp(daemon):
    force, *_ = pushes_of(daemon, "forces", "clamp", "1")
    largest = numpy.linalg.norm(force, axis=1).max()
    check("a force is clamped to what the device bears", abs(largest - 8.5) < 1e-9, largest)


def poll(daemon):
    force, _, pushes, _ = pushes_of(daemon, "forces", "poll", "2")
    pushing = pushes["answers"][force[:, 0] > 0]
    check("a force that is set 60 times a second holds between", len(pushing) > 0.2 * (pushing[-1] - pushing[0]),
          (len(pushing), pushing[-1] - pushing[0]))
    rest = pushes["answers"][-1] - pushing[-1]
    check("and ends after the last, while the program lives", rest > 100 and force[-1][0] == 0, rest)


def sphere(folder):
    """The program's ball and the scene's, which is as large and as stiff, are felt at the same place."""
    hand = "{script: guided, tremor: 0, wander: 0}"
    with ArmDaemon(folder, "ball", scene(SPHERE, hand=hand)) as daemon, daemon.connect() as client:
        with client.lead_hand(ARM) as lead:
            for step in range(100):
                lead.put([0.004 * step / 100, 0.003, 0.06 - 0.013 * step / 100])
                time.sleep(0.01)
            force, _, _, ticks = pushes_of(daemon, "forces", "sphere", "1")
    shape = numpy.stack([ticks["arm0_f" + c] for c in "xyz"], axis=1)
    inside = numpy.linalg.norm(shape, axis=1) > 0.05
    inside[:60] = False
    check("both balls push", inside.sum() > 100, inside.sum())
    off = abs(force - shape)[inside].max() if inside.any() else None
    check("the same force within 1 mN, place for place", off is not None and off < 1e-3, off)


def wall(daemon):
    """A wall far stiffer than the rate allows: the daemon's limits hold whatever the program asks."""
    *_, ticks = pushes_of(daemon, "forces", "wall", "2")
    sent = numpy.sqrt(sum(ticks["arm0_sent_f" + c] ** 2 for c in "xyz"))
    check("10 N/mm stays within the force limit", 0 < sent.max() <= 8.5 * 1.0001, sent.max())
    check("without a fault", (ticks["arm0_fault"] == 0).all())


def two_arms(folder):
    with ArmDaemon(folder, "two", TWO.format(source=SOURCE)) as daemon, daemon.connect() as client:
        daemon.program("two_arms", "left", "right")
        pushes = client.rows("pushes", last=2000)
        left, right = pushes[pushes["arm"] == 0], pushes[pushes["arm"] == 1]
        check("each arm gets its own force", len(left) > 100 and len(right) > 100 and (left["fy"] == 0).all() and
              (right["fx"] == 0).all() and left["fx"].max() == 0.5 and right["fy"].max() == 0.25)


def six(folder):
    """Torques of joints reach the motors as they were asked for; coordinates are those that the scene and the device say."""
    with open(os.path.join(folder, "six-arm.yaml"), "w") as file:
        file.write(SIX_ARM)
    with ArmDaemon(folder, "six", SIX.format(folder=folder)) as daemon, daemon.connect() as client:
        done = daemon.program("six_joints")
        ticks, pushes = client.rows("ticks", last=5000), client.rows("pushes", last=1000)
    saw = [float(word) for word in done.stdout.split("saw ")[1].split()]
    _, at_push, at_tick = numpy.intersect1d(pushes["tick"], ticks["tick"], return_indices=True)
    pushes, ticks = pushes[at_push], ticks[at_tick]
    whole = sum(abs(ticks["arm0_client_f" + c] - pushes["f" + c]) for c in "xyz") < 1e-9  # it is not faded
    ticks = ticks[whole & (pushes["fx"] != 0)]
    check("six joints are pushed", len(ticks) > 50, len(ticks))
    joints = numpy.stack([ticks[f"arm0_q{i}"] for i in range(6)], axis=1)
    told = joints * [-1, 1, 1, 1, 1, 1] + [0, 0.25, 0, 0, 0, 0]
    check("joints have their signs and offsets", abs(told - saw[3:]).max() < 0.05, (told[-1], saw))
    x, y, z = (ticks[f"arm0_{c}"][-1] - at for c, at in zip("xyz", (0.1, 0.2, 0.3)))
    off = numpy.abs(numpy.array([-z, y, x - 0.1]) * 1000 - saw[:3]).max()
    check("the position is that of the mount, about the scene's origin", off < 2, (x, y, z, saw))
    asked = numpy.array([-40, -30, 20, 6, -4, 2]) * 1e-3
    command = numpy.stack([ticks[f"arm0_command{i}"] for i in range(6)], axis=1)
    off = numpy.quantile(abs(command - asked).max(axis=1), 0.9)  # a late tick of a busy machine may fade
    check("the motors get the torques that were asked for", off < 0.02 * 0.04, (off, command[-1]))


def outage(folder):
    daemon = ArmDaemon(folder, "short", scene())
    program = subprocess.Popen(daemon.command("outage"), env=daemon.environment, stdin=subprocess.PIPE,
                               stdout=subprocess.PIPE, text=True)
    check("it is ready", program.stdout.readline() == "ready\n")
    daemon.stop(signal.SIGKILL)
    program.stdin.write("gone\n")
    program.stdin.flush()
    while (line := program.stdout.readline()) not in ("gone\n", ""):
        print(line, end="")
    daemon.start()
    rest, _ = program.communicate("back\n", timeout=60)
    print(rest, end="")
    check("outage", program.returncode == 0, program.returncode)
    daemon.stop()


def unfeltForce(folder):
    """A hold, and a force beyond the limit."""
    with ArmDaemon(folder, "unfelt-force", scene(hand="{script: guided}")) as daemon, daemon.connect() as client:
        daemon.program("unfelt_force", "limit")
        client.clear()
        program = subprocess.Popen(daemon.command("unfelt_force", "hold"), env=daemon.environment, stdout=subprocess.PIPE,
                                   stderr=subprocess.PIPE, text=True)
        while (line := program.stdout.readline()) not in ("ready\n", ""):
            print(line, end="")
        client.clear()
        client.hold()
        rest, hints = program.communicate(timeout=60)
        if "held" not in (client.status()["devices"][0]["no_force"] or ""):
            return print("SKIPPED: the machine stood still, and a fault of that came before the hold")
        print(rest, end="")
        check("unfelt_force hold", program.returncode == 0, program.returncode)
        check("stderr says what to do about a hold", "is held" in hints and "hapticd ctl clear" in hints, hints)
        client.clear()


def lost(folder):
    with ArmDaemon(folder, "lost", scene(hand="{radius: 0.02, unplugged: [[3, 8]]}")) as daemon, daemon.connect() as client:
        program = subprocess.run(daemon.command("unfelt_force", "lost"), env=daemon.environment, capture_output=True, text=True)
        print(program.stdout, end="")
        check("unfelt_force lost", program.returncode == 0, program.returncode)
        check("stderr says that the force comes back by itself", re.search("is lost.*\n.*by itself", program.stderr), program.stderr)
        check("and so it does", until(lambda: client.status()["devices"][0]["no_force"] is None, 60))


def killed(folder):
    """`hapticd client` is killed: the daemon that it started ends, and so does the program."""
    environment = dict(os.environ, RUNTIME_DIRECTORY=folder, STATE_DIRECTORY=folder)
    command = [HAPTICD, "client", "--name", "orphan", os.path.join(PROGRAMS, "hd_forces"), "spring", "60"]
    wrapper = subprocess.Popen(command, env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    sock = os.path.join(folder, "orphan.sock")
    check("it starts a daemon", until(lambda: os.path.exists(sock), 60))
    wrapper.kill()
    wrapper.wait()
    check("kill -9 of hapticd client ends the daemon that it started", until(lambda: not os.path.exists(sock), 60))


def refused(folder):
    """What a program and its user are told where it cannot work."""
    with ArmDaemon(folder, "off", scene(clients="off")) as daemon:
        done = subprocess.run(daemon.command("forces", "spring", "0.2"), env=daemon.environment, capture_output=True,
                              text=True, timeout=60)
        check("a scene that lets nobody push is an error of forces, with a cure",
              "the force cannot be applied" in done.stdout and "clients: add" in done.stderr, done)
        daemon.program("hello", "PHANTOM Premium 1.5")
    environment = dict(os.environ, RUNTIME_DIRECTORY=folder, HAPTICD_NAME="nobody",
                       LD_LIBRARY_PATH=os.path.join(os.path.dirname(HAPTICD), "..", "lib", "hapticd", "hdapi"))
    done = subprocess.run([os.path.join(PROGRAMS, "hd_forces")], env=environment, capture_output=True, text=True,
                          timeout=60)
    check("no daemon is told with its cure", done.returncode == 1 and "hapticd_connect" not in done.stderr
          and all(words in done.stderr for words in ("no daemon named nobody runs", "hapticd client PROGRAM", "hapticd run", "$HAPTICD_NAME")), done)


def command(folder):
    """`hapticd client` itself."""
    environment = dict(os.environ, RUNTIME_DIRECTORY=folder, STATE_DIRECTORY=folder)

    def run(*arguments):
        return subprocess.run([HAPTICD, "client", "--name", "own", *arguments], env=environment, capture_output=True,
                              text=True, timeout=120)
    done = run(os.path.join(PROGRAMS, "hd_forces"), "spring", "0.5")
    check("a daemon is started where none runs", done.returncode == 0 and "starting one" in done.stderr, done)
    check("and ends with the program", not os.path.exists(os.path.join(folder, "own.sock")))
    done = run("sh", "-c", "exit 7")
    check("the exit code is the program's", done.returncode == 7, done)
    done = run("--nmae", "own", "true")
    check("a mistyped option is told", done.returncode == 2 and "--nmae: unknown option" in done.stderr, done)
    done = run("--env")
    check("--env prints what a shell needs", "hdapi" in done.stdout and "HAPTICD_NAME='own'" in done.stdout, done)
    done = run()
    check("a program must be named", done.returncode == 2 and "PROGRAM" in done.stderr, done)
    done = run("/no/such/program")
    check("a program that is none is told", done.returncode == 2 and "/no/such/program" in done.stderr, done)
    for program in ("/no/such/program", "./nosuch", "no-such-program", "/"):
        done = run(program)
        check(f"{program}: before a daemon is started for it", done.returncode == 2 and f"{program}: " in done.stderr and "starting one" not in done.stderr, done)
    done = run("--scene", os.path.join(folder, "none.yaml"), "true")
    check("a scene that is none is bad input, as for run", done.returncode == 2 and "none.yaml" in done.stderr, done)


with tempfile.TemporaryDirectory(dir="/dev/shm") as place:
    with ArmDaemon(place, "plain", scene()) as plain_daemon:
        plain(plain_daemon)
        if not os.environ.get("HAPTICD_SANITIZE"):  # Python lacks the runtime that such a library needs
            python(plain_daemon)
        spring(plain_daemon)
        listens(plain_daemon)
        clamp(plain_daemon)
        poll(plain_daemon)
        wall(plain_daemon)
    sphere(place)
    two_arms(place)
    six(place)
    outage(place)
    lost(place)
    unfeltForce(place)
    refused(place)
    command(place)
    killed(place)
finish()
