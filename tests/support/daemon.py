# SPDX-License-Identifier: MIT
"""A running daemon, as the end-to-end tests use it. The folder of the Python package hapticd must be in sys.path."""
import atexit
import os
import signal
import socket
import subprocess

import hapticd
from e2e import check, program, until


class Daemon:
    """A run of a scene under its own name. Its sockets, its log and its other files are in the folder."""

    def __init__(self, program, folder, name, scene, *options, **environment):
        """Starts the daemon, and waits until it serves its socket or has ended. @param scene text of the scene @param options of
        `hapticd run` @param environment more variables"""
        self.hapticd, self.folder, self.name, self.options = program, folder, name, options
        self.environment = dict(os.environ, RUNTIME_DIRECTORY=folder, STATE_DIRECTORY=folder, **environment)
        self.socket = self.file(name + ".sock")
        self.scene = self.file(name + ".yaml")
        with open(self.scene, "w") as file:
            file.write(scene)
        self.start()

    def start(self):
        """Starts it again, with the same scene, after stop()."""
        with open(self.file(self.name + ".log"), "a") as log, open(self.file(self.name + ".out"), "a") as out:
            self.process = subprocess.Popen([self.hapticd, "run", self.scene, "--name", self.name, *self.options],
                                            env=self.environment, stdout=out, stderr=log)
        atexit.register(self.process.kill)
        until(lambda: self.serves() or self.process.poll() is not None, 40)

    def serves(self):
        with socket.socket(socket.AF_UNIX) as line:
            return line.connect_ex(self.socket) == 0

    def stop(self, how=signal.SIGTERM):
        """Returns the exit code."""
        self.process.send_signal(how)
        return self.process.wait(timeout=30)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        check(f"the run {self.name} ends in order", self.stop() == 0, self.log())

    def file(self, name):
        return os.path.join(self.folder, name)

    def connect(self):
        return hapticd.connect(self.name, folder=self.folder)

    def run(self, *arguments, given=""):
        """Runs hapticd beside the daemon: exit code, standard output and standard error. @param given its standard input"""
        return program(self.hapticd, self.environment)(*arguments, input=given)

    def ctl(self, *arguments, given=""):
        return self.run("ctl", "--name", self.name, *arguments, given=given)

    def log(self):
        """What the daemon has written to standard error so far."""
        with open(self.file(self.name + ".log")) as log:
            return log.read()

    def summary(self):
        """What it has written to standard output."""
        with open(self.file(self.name + ".out")) as out:
            return out.read()
