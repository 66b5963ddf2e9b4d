"""What the scripts share that meet the program as a user does."""
import os
import re
import resource
import subprocess
import sys
import time

LONG = "HAPTICD_LONG" in os.environ  # tests/run long: all of a sweep, not the part that stands for it
failures = 0


def check(name, holds, told=""):
    """A line a check; what was told is shown where it fails."""
    global failures
    failures += not holds
    print(f"{'ok' if holds else 'FAILED':6} {name}{'' if holds else ': ' + str(told)}", flush=True)
    return holds


def finish():
    """The exit code says whether all held."""
    sys.exit(1 if failures else 0)


def until(predicate, seconds=20):
    """True once it holds; False: it did not in time."""
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        if predicate():
            return True
        time.sleep(0.01)
    return False


def refused(action, word):
    """The daemon refuses it with a code, and a text that has the word. The package hapticd must be found."""
    import hapticd
    try:
        action()
    except hapticd.Refused as error:
        return word in str(error) and error.code != ""
    return False


def can_lock_memory():
    """True if a run can lock its memory, so that its ticks fault no page: a right that few containers give."""
    capabilities = int(re.search(r"CapEff:\s*(\w+)", open("/proc/self/status").read())[1], 16)
    cap_ipc_lock = 14
    return capabilities >> cap_ipc_lock & 1 == 1 or resource.getrlimit(resource.RLIMIT_MEMLOCK)[0] == resource.RLIM_INFINITY


def program(path, environment=None, timeout=120, together=False):
    """A function that runs the program with its arguments: exit code, standard output and error, or both in one text."""
    def run(*arguments):
        done = subprocess.run([path, *arguments], env=environment, capture_output=True, text=True, timeout=timeout)
        if together:
            return done.returncode, done.stdout + done.stderr
        return done.returncode, done.stdout, done.stderr
    return run
