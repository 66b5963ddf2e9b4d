"""What the scripts share that meet the program as a user does."""
import subprocess
import sys

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


def program(path, environment=None, timeout=120, together=False):
    """A function that runs the program with its arguments: exit code, standard output and error, or both in one text."""
    def run(*arguments):
        done = subprocess.run([path, *arguments], env=environment, capture_output=True, text=True, timeout=timeout)
        if together:
            return done.returncode, done.stdout + done.stderr
        return done.returncode, done.stdout, done.stderr
    return run
