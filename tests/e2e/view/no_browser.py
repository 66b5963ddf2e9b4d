#!/usr/bin/env python3
"""A view that is to open a browser where there is none says so in one line. Usage: no_browser.py HAPTICD SCENE"""
import os
import subprocess
import sys
import tempfile

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "support"))
from e2e import check, finish, until

HAPTICD, SCENE = (os.path.abspath(argument) for argument in sys.argv[1:3])
FOUND_NONE = "#!/bin/sh\necho xdg-open: www-browser: not found >&2\necho xdg-open: no method available for opening \"$1\"\nexit 3\n"


def told(folder, recording, opener):
    """What a view with --open prints on its standard error within some seconds."""
    programs = os.path.join(folder, "bin")
    os.makedirs(programs, exist_ok=True)
    with open(os.path.join(programs, "xdg-open"), "w") as file:
        file.write(opener)
    os.chmod(file.name, 0o755 if opener else 0o644)
    said = os.path.join(folder, "said")
    with open(said, "w") as out:
        view = subprocess.Popen([HAPTICD, "view", recording, "--port", "0", "--open"], stdout=subprocess.DEVNULL, stderr=out,
                                env=dict(os.environ, RUNTIME_DIRECTORY=folder, PATH=programs))
    until(lambda: "browser" in open(said).read(), 10)
    view.terminate()
    view.wait(20)
    return open(said).read()


with tempfile.TemporaryDirectory(dir="/dev/shm") as scratch:
    run = os.path.join(scratch, "r.h5")
    subprocess.run([HAPTICD, "run", SCENE, "--virtual-time", "--for", "0.1", "--record", run], check=True, capture_output=True)
    for opener, why in ((FOUND_NONE, "xdg-open found none"), ("", "xdg-open is missing")):
        text = told(scratch, run, opener)
        check(f"{why}: one line says it, and what to do", text == f"no browser could be started ({why}): open the address above yourself\n", text)
finish()
