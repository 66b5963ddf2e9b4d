"""A daemon over a rig of its own, for the tests of its end."""
import atexit
import json
import os
import shutil
import socket
import subprocess
import tempfile
import time

from rig import Rig


class Daemon:
    """Runs a scene of `models` (lines of YAML) until it is told to end; `arm` is its rig, unless it is simulated."""

    def __init__(self, hapticd, modules, models, rig=None, arguments=("--rate", "4000"), servo="", simulated=False, start=()):
        self.hapticd, self.folder = hapticd, tempfile.mkdtemp()
        atexit.register(self.leave)
        self.arm = None if simulated else Rig(self.folder, **(rig or {}))
        self.scene = self.write("scene", models, servo)
        for name, file in zip(("rig", "ending", "slow", "broken"), (*modules, modules[-1], modules[-1])):
            shutil.copyfile(file, os.path.join(self.folder, name + ".so"))  # found by name; each loaded for itself
        self.environment = dict(os.environ, HAPTICD_PLUGIN_PATH=self.folder, STATE_DIRECTORY=self.folder, RUNTIME_DIRECTORY=self.folder)
        device = [] if simulated else ["--device", self.arm.device, "--allow-non-rt"]
        self.process = subprocess.Popen([*start, hapticd, "run", self.scene, *device, *arguments], env=self.environment,
                                        stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)

    def leave(self):
        if self.process.poll() is None:
            self.process.kill()
        shutil.rmtree(self.folder, ignore_errors=True)

    def write(self, name, models, servo=""):
        """A scene file. @return its path"""
        file = os.path.join(self.folder, name + ".yaml")
        with open(file, "w") as out:
            out.write("hapticd: 1\n" + (f"servo: {servo}\n" if servo else "") + "models:\n" + "".join(f"  - {m}\n" for m in models))
        return file

    def end(self, timeout=60):
        """Waits for the end. @return exit code and what it said"""
        try:
            self.said, _ = self.process.communicate(timeout=timeout)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.said, _ = self.process.communicate()
            self.said += "(it never ended)"
        return self.process.returncode, self.said

    def quarantined(self):
        file = os.path.join(self.folder, "quarantine")
        return open(file).read() if os.path.exists(file) else ""

    def state(self):
        """A letter of /proc: R or S it runs, T it is stopped."""
        with open(f"/proc/{self.process.pid}/stat") as stat:
            return stat.read().rsplit(")", 1)[1].split()[0]

    def ctl(self, *arguments, timeout=60):
        done = subprocess.run([self.hapticd, "ctl", *arguments], env=self.environment, capture_output=True, text=True, timeout=timeout)
        return done.returncode, done.stdout + done.stderr

    def started(self, *arguments):
        """The same, not waited for."""
        return subprocess.Popen([self.hapticd, "ctl", *arguments], env=self.environment, stdout=subprocess.PIPE,
                                stderr=subprocess.STDOUT, text=True)

    def connect(self, timeout=20):
        """A connection to the control socket, once it is served."""
        end = time.monotonic() + timeout
        while True:
            connection = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
            try:
                connection.connect(os.path.join(self.folder, "hapticd.sock"))
                return connection
            except OSError:
                connection.close()
                if time.monotonic() > end:
                    raise
                time.sleep(0.02)


def say(connection, **request):
    connection.sendall((json.dumps(request) + "\n").encode())


def hear(connection, timeout=30):
    """The next answer, a line; nothing: none came. Answers that came together wait for their turn."""
    connection.settimeout(timeout)
    text = b""
    try:
        while not text.endswith(b"\n"):
            waiting = connection.recv(65536, socket.MSG_PEEK)
            if not waiting:
                return None
            text += connection.recv(waiting.find(b"\n") + 1 or len(waiting))
    except OSError:
        return None
    return json.loads(text)
