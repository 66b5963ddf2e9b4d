#!/usr/bin/env python3
"""A program of another user opens the files that it names and passes them along; the daemon opens none for it by name.

Usage: another_user.py HAPTICD SCENES     prints a line a check; exit 1 when one is off, 77 without the right to be another user.
"""
import array
import json
import os
import shutil
import socket
import subprocess
import sys
import tempfile

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "support"))
from e2e import check, finish, until

HAPTICD, SCENES = os.path.abspath(sys.argv[1]), os.path.abspath(sys.argv[2])
NOBODY = 65534
SECRET = "hidden: the line of a file that root alone may read"
SPHERE = open(os.path.join(SCENES, "..", "models", "sphere.yaml")).read()

if os.geteuid() != 0:
    print("skipped: only root can be another user")
    sys.exit(77)


class Daemon:
    """As root, over a simulated arm; its socket's group is that of root, which the other user is a member of."""

    def __init__(self, folder):
        self.folder = folder
        self.program = shutil.copy(HAPTICD, os.path.join(folder, "hapticd"))  # where another user can run it
        os.chmod(self.program, 0o755)
        self.environment = dict(os.environ, RUNTIME_DIRECTORY=folder, STATE_DIRECTORY=folder)
        self.environment.pop("XDG_RUNTIME_DIR", None)
        self.socket = os.path.join(folder, "other.sock")
        self.sphere = self.write("shape.yaml", SPHERE)  # the checkout may be where another user cannot read
        self.run = subprocess.Popen([HAPTICD, "run", self.file("own", "sphere", 0o600), "--name", "other", "--for", "120", "--record", os.path.join(folder, "run.h5")],
                                    env=self.environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        until(lambda: os.path.exists(self.socket) and self.ctl("status", user=0)[0] == 0, 40)
        self.group = os.stat(self.socket).st_gid

    def write(self, name, text, mode=0o644, owner=0):
        file = os.path.join(self.folder, name)
        with open(file, "w") as out:
            out.write(text)
        os.chown(file, owner, owner)
        os.chmod(file, mode)
        return file

    def file(self, name, model, mode=0o644, owner=0, geometry=None):
        geometry = geometry or self.sphere
        return self.write(name + ".yaml", f"hapticd: 1\nmodels:\n  - {{name: {model}, plugin: nurbs_rigid, parameters: "
                          f"{{geometry: {geometry}}}}}\n", mode, owner)

    def ctl(self, *words, user=NOBODY):
        done = subprocess.run([self.program if user else HAPTICD, "ctl", "--name", "other", *words], env=self.environment,
                              capture_output=True, text=True, timeout=60, cwd="/",
                              **({"user": user, "group": self.group, "extra_groups": []} if user else {}))
        return done.returncode, done.stdout + done.stderr

    def ask(self, request, paths=(), flags=os.O_RDONLY):
        """A request of the other user's own program. @param paths of the files that it opens with these flags"""
        ours, theirs = os.pipe()
        child = os.fork()
        if child == 0:
            said = ""
            try:
                os.setgroups([])
                os.setgid(self.group)
                os.setuid(NOBODY)
                files = array.array("i", [os.open(path, flags) for path in paths])
                peer = socket.socket(socket.AF_UNIX)
                peer.connect(self.socket)
                rights = [(socket.SOL_SOCKET, socket.SCM_RIGHTS, files)] if paths else []
                peer.sendmsg([json.dumps(request).encode() + b"\n"], rights)
                peer.settimeout(30)
                said = peer.makefile().readline()
            except Exception as error:  # told to the parent
                said = json.dumps({"ok": False, "error": f"the program failed: {error!r}"})
            os.write(theirs, said.encode())
            os._exit(0)
        os.close(theirs)
        with os.fdopen(ours) as pipe:
            said = pipe.read()
        os.waitpid(child, 0)
        return json.loads(said)


def refused(name, answer, word):
    told = answer if isinstance(answer, dict) else {"ok": answer[0] == 0, "error": answer[1]}
    check(name, not told["ok"] and word in told["error"] and "hidden" not in told["error"], told)


def secrets(daemon):
    """Files that the daemon may read and the other user may not."""
    secret = daemon.write("secret.yaml", SECRET + "\n", 0o600)
    names_secret = daemon.file("names_secret", "a", geometry=secret)
    refused("by name alone nothing is opened", daemon.ask({"do": "add", "file": secret}), "does not open files for this program")
    refused("also nothing that all may read", daemon.ask({"do": "add", "file": names_secret}), "does not open files for this program")
    refused("nor by reload", daemon.ask({"do": "reload", "file": secret}), "does not open files for this program")
    refused("ctl cannot open it", daemon.ctl("add", secret), "Permission denied")
    refused("nor what a scene names", daemon.ctl("add", names_secret), "Permission denied")
    refused("a scene that is passed opens nothing by name",
            daemon.ask({"do": "add", "file": names_secret, "files": [names_secret]}, [names_secret]), "was not passed along")
    refused("a descriptor without a right to read gives none",
            daemon.ask({"do": "add", "file": secret, "files": [secret]}, [secret], os.O_PATH), "cannot be read")
    letterbox = daemon.write("letterbox.yaml", SECRET + "\n", 0o622)
    refused("nor does one to write",
            daemon.ask({"do": "add", "file": letterbox, "files": [letterbox]}, [letterbox], os.O_WRONLY), "cannot be read")
    typo = daemon.file("typo", "a", geometry=secret[:-1])
    answer = daemon.ask({"do": "add", "file": typo, "files": [typo]}, [typo])
    refused("names of neighbours are not told", answer, "was not passed along")
    check("not even as a suggestion", "secret.yaml" not in answer["error"].replace(secret[:-1], ""), answer)
    refused("a name needs its descriptor", daemon.ask({"do": "add", "file": typo, "files": [typo]}), "descriptors came")


def passes(daemon):
    """What the other user may read is added, wherever it is and whatever it is called."""
    own = daemon.write("mine.yaml", SPHERE, 0o600, NOBODY)
    scene = daemon.file("mine_scene", "mine", 0o600, NOBODY, own)
    code, said = daemon.ctl("add", scene)
    check("ctl adds the scene and the model of its user", code == 0, said)
    text = daemon.file("elsewhere", "there", geometry="models/there.yaml")
    answer = daemon.ask({"do": "add", "file": "/nowhere/scene.yaml", "files": ["/nowhere/scene.yaml", "/nowhere/models/there.yaml"]},
                        [text, own])
    check("names are the asking program's", answer["ok"], answer)
    bad = daemon.write("bad.yaml", "format: hapticd-model/1\nkind: [\n", 0o600, NOBODY)
    answer = daemon.ask({"do": "add", "file": "/nowhere/s.yaml", "files": ["/nowhere/s.yaml", "/nowhere/models/there.yaml"]},
                        [daemon.file("s", "worse", geometry="models/there.yaml"), bad])
    check("and messages tell them", not answer["ok"] and "/nowhere/models/there.yaml" in answer["error"] and "/proc/" not in answer["error"], answer)
    models = [m["name"] for m in json.loads(daemon.ctl("list")[1])["models"]]
    check("they are in the run", sorted(models) == ["mine", "sphere", "there"], models)


def reloads(daemon):
    code, said = daemon.ctl("reload")
    check("the daemon's own scene is loaded again by the daemon", code == 0, said)
    with open(os.path.join(daemon.folder, "own.yaml"), "a") as out:
        out.write(SECRET + "\n")
    refused("what is wrong with it is not told", daemon.ctl("reload"), "only the daemon's user may see")
    scene = daemon.file("next", "next", 0o600, NOBODY)
    code, said = daemon.ctl("reload", scene)
    check("another scene is passed along", code == 0, said)
    refused("and is not opened by its name later", daemon.ask({"do": "reload"}), "only a program can load it again")
    code, said = daemon.ctl("reload")
    check("ctl passes it again", code == 0, said)
    code, said = daemon.ctl("reload", daemon.file("roots", "root", 0o600), user=0)
    check("the daemon's user may all that", code == 0, said)


def replays(folder):
    """The recording has the hashes of what was passed, under the names of the asking program."""
    done = subprocess.run([HAPTICD, "replay", os.path.join(folder, "run.h5")], capture_output=True, text=True, timeout=60)
    check("a file that was passed and is there is the same for a replay", "has changed" not in done.stderr, done)
    check("one that is not there ends it", done.returncode == 3 and "\"there\" was added: " in done.stderr and "/nowhere/models/there.yaml" in done.stderr, done)


with tempfile.TemporaryDirectory(dir="/dev/shm") as folder:
    os.chmod(folder, 0o755)
    daemon = Daemon(folder)
    try:
        secrets(daemon)
        passes(daemon)
        reloads(daemon)
    finally:
        daemon.run.terminate()
        daemon.run.wait(60)
    replays(folder)
finish()
