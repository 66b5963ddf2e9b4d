"""Functions that the end-to-end tests share. These tests use the program as a user does."""
import os
import re
import resource
import subprocess
import sys
import time
from typing import NamedTuple

LONG = "HAPTICD_LONG" in os.environ  # set by `tests/run long`: cover all of a sweep, and not only a representative part
failures = 0


def check(name, holds, told=""):
    """Prints one line for a check. If it fails, the line also has `told`."""
    global failures
    failures += not holds
    print(f"{'ok' if holds else 'FAILED':6} {name}{'' if holds else ': ' + str(told)}", flush=True)
    return holds


def finish():
    """Ends the test. The exit code is 0 if no check failed, else 1."""
    sys.exit(1 if failures else 0)


def until(predicate, seconds=20):
    """Waits until the predicate is true. Returns False if it did not become true in time."""
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        if predicate():
            return True
        time.sleep(0.01)
    return False


def refused(action, word):
    """True if the daemon refuses the action with a code and with a text that contains `word`. Needs the Python package hapticd."""
    import hapticd
    try:
        action()
    except hapticd.Refused as error:
        return word in str(error) and error.code != ""
    return False


def can_lock_memory():
    """True if a run may lock its memory, so that its ticks cause no page faults. Few containers give this right."""
    capabilities = int(re.search(r"CapEff:\s*(\w+)", open("/proc/self/status").read())[1], 16)
    cap_ipc_lock = 14
    return capabilities >> cap_ipc_lock & 1 == 1 or resource.getrlimit(resource.RLIMIT_MEMLOCK)[0] == resource.RLIM_INFINITY


def write(folder, name, content):
    """Writes a file of text or bytes. Returns its path."""
    file = os.path.join(folder, name)
    with open(file, "wb") as out:
        out.write(content if isinstance(content, bytes) else content.encode())
    return file


class Done(NamedTuple):
    """How a program ended, and what it printed."""
    returncode: int
    stdout: str
    stderr: str


def program(path, environment=None, timeout=300, together=False):
    """Returns a function that runs the program with the given arguments, and with options of subprocess.run() such as cwd or input. It
    returns exit code, standard output and standard error, as a Done; with `together` the exit code and both outputs as one text."""
    def run(*arguments, **options):
        done = subprocess.run([path, *arguments], env=environment, capture_output=True, text=True, timeout=timeout, **options)
        if together:
            return done.returncode, done.stdout + done.stderr
        return Done(done.returncode, done.stdout, done.stderr)
    return run
