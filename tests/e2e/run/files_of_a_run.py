#!/usr/bin/env python3
"""The files that a run writes, and what it says where it may not.

Usage: files_of_a_run.py HAPTICD SOURCE_DIR     prints one line per check; exit 1 when one fails.
"""
import json
import os
import resource
import stat
import subprocess
import sys
import tempfile

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "support"))
from e2e import check, finish, program

HAPTICD, SOURCE = (os.path.abspath(argument) for argument in sys.argv[1:3])
SCENE = os.path.join(SOURCE, "config", "scenes", "sphere.yaml")
hapticd = program(HAPTICD, together=True)
QUICK = (SCENE, "--virtual-time", "--for", "0.1")


def special(folder):
    """What is no file is written into, never replaced."""
    pipe = os.path.join(folder, "pipe")
    os.mkfifo(pipe)
    code, told = hapticd("run", *QUICK, "--report", pipe)
    check("a pipe that nobody reads is refused", code == 2 and "cannot be written" in told, (code, told))
    reader = subprocess.Popen(["cat", pipe], stdout=subprocess.PIPE, text=True)
    writer = os.open(pipe, os.O_WRONLY)  # so that the reader waits for the report
    code, told = hapticd("run", *QUICK, "--report", pipe)
    os.close(writer)
    out = reader.communicate(timeout=20)[0]
    check("a pipe is given the report", code == 0 and json.loads(out)["ticks"] == 100, (code, told, out))
    check("and is still a pipe", stat.S_ISFIFO(os.stat(pipe).st_mode))
    full = os.path.join(folder, "full")
    os.symlink("/dev/full", full)
    for what in ("--report", "--picture"):
        code, told = hapticd("run", *QUICK, what, full)
        check(f"{what}: a full disk is told", code == 1 and "No space left" in told, (code, told))
    check("and the link is still one", os.path.islink(full) and sorted(os.listdir(folder)) == ["full", "pipe"], os.listdir(folder))


def fullDisk(folder):
    """A recording that cannot grow on costs neither the summary nor the report."""
    limit = lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (4 << 20, 4 << 20))
    record, report = os.path.join(folder, "run.h5"), os.path.join(folder, "report.json")
    done = subprocess.run([HAPTICD, "run", SCENE, "--virtual-time", "--for", "20", "--record", record, "--report", report],
                          capture_output=True, text=True, timeout=300, preexec_fn=limit, restore_signals=False)
    check("a recording on a full disk is told", done.returncode == 1 and "ends with its last complete row" in done.stderr, done)
    check("its run has a summary", "20000 ticks" in done.stdout, done)
    check("and a report", os.path.exists(report) and json.load(open(report))["ticks"] == 20000, os.listdir(folder))
    code, told = hapticd("replay", record)
    check("what was recorded replays", code == 0 and "every bit is the same" in told, (code, told))


def same(folder):
    file, other = os.path.join(folder, "same"), os.path.join(folder, "..", os.path.basename(folder), "same")
    for what in (("--report", file, "--record", file), ("--picture", file, "--report", other)):
        code, told = hapticd("run", *QUICK, *what)
        check("a file that is named twice is refused", code == 2 and "named twice" in told, (code, told))
    check("nothing is written", not os.listdir(folder), os.listdir(folder))
    scene = os.path.join(folder, "scene.yaml")
    text = open(SCENE).read()
    open(scene, "w").write(text)
    check("nor is the scene overwritten", hapticd("run", scene, "--report", scene)[0] == 2 and open(scene).read() == text)
    nowhere = os.path.join(folder, "nowhere")  # never a device by its own name: a program that replaced it would harm the machine
    os.symlink("/dev/null", nowhere)
    code, told = hapticd("run", *QUICK, "--report", nowhere, "--picture", nowhere)
    check("a device may be named twice", code == 0, (code, told))


def nothing(folder):
    files = [part for what in ("report", "record", "picture") for part in ("--" + what, os.path.join(folder, what))]
    code, told = hapticd("run", "/nonexist.yaml", *files)
    check("a run that does not come leaves no file", code == 2 and not os.listdir(folder), (code, told, os.listdir(folder)))


def noStateFolder(folder):
    """A list of quarantine that can be read is heeded, also where nothing can be written."""
    bare = {key: value for key, value in os.environ.items() if key not in ("HOME", "XDG_STATE_HOME", "STATE_DIRECTORY")}
    code, told = program(HAPTICD, bare, together=True)("run", *QUICK)
    check("a run without a state folder says so", code == 0 and "no state folder" in told, (code, told))
    told = program(HAPTICD, bare)("doctor", "--json", "--seconds", "0")[1]
    line = next(c for c in json.loads(told)["checks"] if c["name"] == "quarantine")
    check("and so does the doctor", line["verdict"] == "warn", line)
    state = os.path.join(folder, "state")
    os.mkdir(state)
    open(os.path.join(state, "quarantine"), "w").write("nurbs_rigid\tSIGSEGV\n")
    os.chmod(state, 0o555)
    code, told = program(HAPTICD, dict(bare, STATE_DIRECTORY=state), together=True)("run", *QUICK)
    check("a list in a folder that cannot be written is heeded", "the model is left out" in told, (code, told))


def noRuntimeFolder(folder):
    """Where the folder in /dev/shm belongs to somebody else the run says that it cannot be watched."""
    try:
        os.setuid(0)
    except PermissionError:
        return print("skipped: no runtime folder, needs root")
    if subprocess.run(["cat", SCENE], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, user=54321).returncode != 0:
        return print("skipped: no runtime folder, other users cannot enter the folder of the checkout")
    own = "/dev/shm/hapticd-54321"
    open(own, "w").close()
    os.chmod(folder, 0o755)
    bare = {key: value for key, value in os.environ.items() if key not in ("RUNTIME_DIRECTORY", "XDG_RUNTIME_DIR")}
    try:
        done = subprocess.run([HAPTICD, "run", SCENE, "--for", "0.1"], env=bare, capture_output=True, text=True, timeout=60, user=54321)
        check("a run without a runtime folder says so", done.returncode == 0 and "can watch or change this run" in done.stderr, done)
    finally:
        os.remove(own)


for case in (special, fullDisk, same, nothing, noStateFolder, noRuntimeFolder):
    with tempfile.TemporaryDirectory() as scratch:
        case(scratch)
finish()
