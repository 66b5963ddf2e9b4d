#!/usr/bin/env python3
"""Programs that use the client libraries live through whatever answers under a daemon's name: another version, a damaged
black box, hostile answers, memory that is none, a daemon that dies between two steps. They get errors with a code.

Usage: fake_daemon.py HAPTICD SOURCE CALLS     prints one line per case; exit 1 when one is off. HAPTICD_FUZZ=N: so many black boxes.
"""
import array
import contextlib
import fcntl
import json
import os
import random
import shutil
import socket
import struct
import subprocess
import sys
import tempfile
import threading

HAPTICD, SOURCE, CALLS = sys.argv[1:4]
CLIENT = os.path.join(SOURCE, "driver", "doors", "client", "python")
sys.path.insert(0, os.path.join(SOURCE, "tests", "support"))
sys.path.insert(0, CLIENT)
from daemon import Daemon
from e2e import check, finish

BOXES = int(os.environ.get("HAPTICD_FUZZ", "60"))
NAME, ARM, MODEL = "fake", "simulated Premium 1.5", "ball"
PATIENCE = 60
ABOUT_AT = 552  # in a black box: place of the description, its size, place of the blocks
SCENE = f"""hapticd: 1
device: {SOURCE}/config/devices/simulated-premium15.yaml
models: [{{name: ball, plugin: nurbs_rigid, parameters: {{geometry: {SOURCE}/config/models/sphere.yaml}}}}]
"""
# What a program does with the library. Each call either works or raises an error of the package.
PROGRAM = f"""
import sys, hapticd
def attempt(what, call):
    try:
        call()
        print(what + ": ok")
    except hapticd.HapticdError as error:
        print(what + ":", error.code)
try:
    h = hapticd.connect("{NAME}", timeout=0.3)
except hapticd.HapticdError as error:
    sys.exit(print("connect:", error.code))
def lead(of):
    with of as one:
        one.put(*([1, [0, 0, 0]] if isinstance(one, hapticd.ForceLead) else [[0, 0, 0]]))
for name, stream in h.streams.items():
    attempt(name, lambda: (stream.last(8), stream.read(0, 8), stream.read(2**40, 8)))
attempt("ask", h.status)
attempt("models", lambda: h.models)
attempt("state", lambda: h.state("{ARM}") if "{ARM}" in h.devices else None)
attempt("wait", lambda: h.wait(h.streams["ticks"].written, 0.05) if "ticks" in h.streams else None)
for name, stream in h.streams.items():
    attempt("again", lambda: (stream.last(8), stream.read(0, 8)))
for of in (lambda: h.lead_model("{MODEL}"), lambda: h.lead_hand("{ARM}"), lambda: h.lead_force("{ARM}")):
    attempt("lead", lambda: lead(of()))
h.close()
"""


def memory(size, seals=0x2, data=b""):
    """A memory file. @param seals 0x2: it cannot shrink"""
    fd = os.memfd_create("fake", os.MFD_ALLOW_SEALING)
    os.truncate(fd, size)
    os.pwrite(fd, data, 0)
    if seals:
        fcntl.fcntl(fd, 1033, seals)
    return fd


class Fake:
    """Answers each line by `answer(line)`: bytes, descriptors, and whether the connection ends then."""

    def __init__(self, folder, answer):
        self.answer, self.file = answer, os.path.join(folder, NAME + ".sock")
        with contextlib.suppress(FileNotFoundError):
            os.remove(self.file)
        self.server = socket.socket(socket.AF_UNIX)
        self.server.bind(self.file)
        self.server.listen(8)
        threading.Thread(target=self.serve, daemon=True).start()

    def serve(self):
        while True:
            try:
                connection = self.server.accept()[0]
            except OSError:
                return
            threading.Thread(target=self.talk, args=(connection,), daemon=True).start()

    def talk(self, connection):
        rest = b""
        with contextlib.suppress(OSError), connection:
            while more := connection.recv(65536):
                *lines, rest = (rest + more).split(b"\n")
                for line in lines:
                    data, descriptors, ends = self.answer(json.loads(line))
                    if descriptors:
                        connection.sendmsg([data[:1]], [(socket.SOL_SOCKET, socket.SCM_RIGHTS, array.array("i", descriptors))])
                        data = data[1:]
                    for fd in descriptors:
                        os.close(fd)
                    connection.sendall(data)
                    if ends:
                        return

    def close(self):
        self.server.close()


def programs(folder, before=lambda: None):
    """What both programs print, and their exit codes. @param before prepares the run of each"""
    environment = dict(os.environ, RUNTIME_DIRECTORY=folder, PYTHONPATH=CLIENT)
    for words in ([CALLS, NAME, ARM, MODEL], [sys.executable, "-c", PROGRAM]):
        before()
        done = subprocess.run(words, env=environment, capture_output=True, text=True, timeout=PATIENCE)
        yield words[0], done.returncode, done.stdout, done.stderr


def survives(what, folder, answer, lacks=(), before=lambda: None):
    """Both programs end by themselves. @param lacks calls that must not have worked"""
    fake = Fake(folder, answer)
    try:
        for program, code, out, err in programs(folder, before):
            worked = [word for word in lacks if f"{word}: ok" in out]
            check(f"{what}, {os.path.basename(program)}", code == 0 and not worked, (code, out, err[-1500:]))
    except subprocess.TimeoutExpired as error:
        check(what, False, error)
    finally:
        fake.close()


def line(**answer):
    return json.dumps(answer).encode() + b"\n"


def good(request, **more):
    return line(ok=True, id=request.get("id"), **more)


def with_memory(make, size=4096):
    """Answers that pass memory along, where a daemon would."""
    def answer(request):
        if request["do"] in ("state", "bell", "lead"):
            return good(request, bytes=size), [make()], False
        return good(request, models=[]), [], False
    return answer


def answers(folder):
    deep = b"[" * 200000 + b"]" * 200000 + b"\n"
    for what, data in (("an answer that is no JSON", b"\x00\xff{\n"), ("an empty line", b"\n"), ("a list", b"[1, 2]\n"), ("a deep list", deep),
                       ("a long line", b"x" * (70 << 20) + b"\n"), ("words instead of numbers", b'{"ok": "yes", "id": "no", "code": 7, "error": []}\n')):
        survives(what, folder, lambda request, data=data: (data, [], False), ("ask", "state", "lead model", "lead"))
    survives("models of another kind", folder, lambda r: (good(r, models=[{"name": 1}, 7]), [], False), ("models", "state"))
    survives("no answer at all", folder, lambda r: (b"", [], True), ("ask", "state", "lead"))
    survives("half an answer", folder, lambda r: (b'{"ok": tr', [], True), ("ask", "state", "lead"))
    survives("events without end", folder, lambda r: (b'{"event": "touch"}\n' * 20000, [], True), ("ask", "state"))


def memories(folder):
    calls = ("state", "lead", "lead model", "lead hand", "lead force")
    full = struct.pack("<II", 1, 4032)
    for what, make, size in (
            ("no memory file", lambda: os.open("/dev/null", os.O_RDWR), 4096), ("a folder", lambda: os.open("/", os.O_RDONLY), 4096),
            ("a pipe", lambda: os.pipe()[0], 4096), ("a file of the disk", lambda: os.open(__file__, os.O_RDONLY), 4096),
            ("memory that may shrink", lambda: memory(4096, 0, full), 4096), ("short memory", lambda: memory(16), 4096),
            ("empty memory", lambda: memory(0), 4096), ("memory without a size", lambda: memory(16), None)):
        survives(what, folder, with_memory(make, size), calls)
    for what, size in (("memory of another size", 1 << 60), ("memory of a negative size", -1)):  # C does not ask for the size
        survives(what, folder, with_memory(lambda: memory(4096), size), ("state", "lead"))
    for what, head in (("states of many arms", (0xFFFFFFFF, 4032)), ("states of a huge stride", (3, 0xFFFFFFF8)), ("states of an odd stride", (3, 331)),
                       ("states of stride 0", (3, 0))):
        survives(what, folder, with_memory(lambda head=head: memory(8192, 0x2, struct.pack("<II", *head)), 8192))
    survives("memory that cannot be written", folder, with_memory(lambda: memory(4096, 0x2 | 0x10)), ("lead", "lead hand"))
    survives("many descriptors", folder, lambda r: (good(r, bytes=4096), [memory(4096) for _ in range(250)], False))


def cutting(file, size):
    """Cuts the black box as soon as the program asks for the status, which it does between two looks at the rows."""
    def answer(request):
        if request["do"] == "status":
            os.truncate(file, size)
        return good(request, models=[]), [], False
    return answer


def boxes(folder, whole):
    """Black boxes with changed bytes, of another version, cut."""
    file, chance = os.path.join(folder, NAME + ".blackbox.h5"), random.Random(1)
    data = open(whole, "rb").read()
    about_at, about_bytes, blocks_at = struct.unpack_from("<QQQ", data, ABOUT_AT)
    places = list(range(512, 1024)) + list(range(blocks_at, blocks_at + 16)) + list(range(about_at, about_at + about_bytes))

    def write(content):
        with open(file + ".new", "wb") as out:
            out.write(content)
        os.replace(file + ".new", file)

    def changed(at, new):
        return data[:at] + new + data[at + len(new):]

    quiet = lambda r: (good(r, models=[]), [], False)
    for what, content in (("no black box", b""), ("a short black box", data[:700]), ("half a black box", data[:about_at + 100]),
                          ("another version", changed(512, b"hapticd-recording/2\0")), ("rows cut away", data[:blocks_at + 64])):
        write(content)
        survives(what, folder, quiet, ("connect",))
    for what, size in (("nothing is left", 0), ("the description is left", blocks_at), ("half of the rows", len(data) // 2)):
        survives(f"a black box that is cut while it is read: {what}", folder, cutting(file, size), before=lambda: write(data))
    newer = json.loads(data[about_at:about_at + about_bytes])
    for column in newer["columns"]["events"]:
        column["since"] = "2.0"
    newer["columns"]["ticks"][-1]["type"] = "q9"
    text = json.dumps(newer).encode()
    write(changed(ABOUT_AT, struct.pack("<QQ", len(data), len(text))) + text)
    fake = Fake(folder, quiet)
    for program, code, out, err in programs(folder):
        check(f"a newer daemon is read, {os.path.basename(program)}", code == 0 and "connect:" not in out.replace("connect: ok", "") and "ask: ok" in out, (code, out, err))
    fake.close()
    lost = 0
    fake = Fake(folder, quiet)
    for _ in range(BOXES):
        content = bytearray(data)
        for _ in range(chance.choice((1, 3, 30))):
            content[chance.choice(places)] = chance.choice((0, 1, 0x7F, 0x80, 0xFF, chance.randrange(256)))
        write(bytes(content))
        for program, code, out, err in programs(folder):
            if code != 0:
                lost += 1
                print(program, code, out, err[-1500:])
    fake.close()
    check(f"{BOXES} black boxes with changed bytes end no program", lost == 0, lost)


with tempfile.TemporaryDirectory(dir="/dev/shm") as folder:
    real = Daemon(HAPTICD, folder, NAME, SCENE)
    box, whole = os.path.join(folder, NAME + ".blackbox.h5"), os.path.join(folder, "whole")
    with real.connect() as client:
        client.wait(200, 20)
    shutil.copyfile(box, whole)
    real.stop()
    shutil.copyfile(whole, box)
    answers(folder)
    memories(folder)
    boxes(folder, whole)
finish()
