#!/usr/bin/env python3
"""A view that is attacked over its port: wrong tokens, origins and hosts, what is too long, too slow, malformed or never read.

Usage: attacks.py HAPTICD SCENES     prints one line per case; exit 1 when one is off.
The codes are those of driver/docs/view.md. Nothing here may end the view, let its memory grow, or reach the daemon.
"""
import base64
import json
import os
import random
import re
import socket
import struct
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "support"))
from e2e import check, finish

HAPTICD, SCENES = sys.argv[1], sys.argv[2]
MUTATED = int(os.environ.get("HAPTICD_MUTATED_FRAMES", "4000"))


class View:
    def __init__(self, folder, *arguments):
        self.environment = dict(os.environ, RUNTIME_DIRECTORY=folder, STATE_DIRECTORY=folder)
        self.run = subprocess.Popen([HAPTICD, "run", os.path.join(SCENES, "teapot.yaml"), "--name", "x", "--for", "300"],
                                    env=self.environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        while not os.path.exists(os.path.join(folder, "x.sock")):
            time.sleep(0.05)
        self.view = subprocess.Popen([HAPTICD, "view", "--name", "x", *arguments], env=self.environment, text=True,
                                     stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        self.url = self.view.stdout.readline().strip()
        found = re.match(r"http://127\.0\.0\.1:(\d+)/\?token=([0-9a-f]{32})$", self.url)
        self.port, self.token = int(found[1]), found[2]

    def connect(self):
        return socket.create_connection(("127.0.0.1", self.port), timeout=20)

    def request(self, target="/", host=None, method="GET", **fields):
        """The status and the head of the answer."""
        head = f"{method} {target} HTTP/1.1\r\nHost: {host or f'127.0.0.1:{self.port}'}\r\n"
        head += "".join(f"{key.replace('_', '-')}: {value}\r\n" for key, value in fields.items())
        return self.raw((head + "Connection: close\r\n\r\n").encode())

    def raw(self, data):
        with self.connect() as s:
            s.sendall(data)
            answer = b""
            try:
                while more := s.recv(65536):
                    answer += more
            except OSError:
                pass
        status = re.match(rb"HTTP/1\.1 (\d+)", answer)
        return (int(status[1]) if status else 0), answer.decode("latin-1")

    def socket(self, protocol="hapticd.1", **fields):
        """An open WebSocket."""
        s = self.connect()
        key = base64.b64encode(os.urandom(16)).decode()
        extra = "".join(f"{k.replace('_', '-')}: {v}\r\n" for k, v in fields.items())
        s.sendall((f"GET /?token={self.token} HTTP/1.1\r\nHost: 127.0.0.1:{self.port}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
                   f"Sec-WebSocket-Key: {key}\r\nSec-WebSocket-Version: 13\r\nSec-WebSocket-Protocol: {protocol}\r\n{extra}\r\n").encode())
        head = b""
        while b"\r\n\r\n" not in head:
            more = s.recv(1)
            if not more:
                break
            head += more
        return s, head

    def resident_kb(self):
        with open(f"/proc/{self.view.pid}/status") as status:
            return int(re.search(r"VmRSS:\s+(\d+)", status.read())[1])

    def lives(self):
        return self.view.poll() is None and self.request(f"/?token={self.token}")[0] == 200

    def end(self):
        self.view.terminate()
        self.view.wait(20)
        self.run.terminate()
        self.run.wait(20)


def frame(data, opcode=1, mask=True, length=None):
    """A frame of a client; `length` lies about its size."""
    size = len(data) if length is None else length
    head = bytes([0x80 | opcode])
    bit = 0x80 if mask else 0
    if size < 126:
        head += bytes([bit | size])
    elif size < 65536:
        head += bytes([bit | 126]) + struct.pack(">H", size)
    else:
        head += bytes([bit | 127]) + struct.pack(">Q", size)
    key = os.urandom(4) if mask else b""
    return head + key + (bytes(b ^ key[i % 4] for i, b in enumerate(data)) if mask else data)


def read_messages(s, seconds):
    """The texts that come within a time."""
    data, texts, end = b"", [], time.monotonic() + seconds
    s.settimeout(0.2)
    while time.monotonic() < end:
        try:
            more = s.recv(1 << 16)
        except socket.timeout:
            continue
        except OSError:
            break
        if not more:
            break
        data += more
        while len(data) >= 2:
            size, at = data[1] & 127, 2
            if size == 126 and len(data) >= 4:
                size, at = struct.unpack(">H", data[2:4])[0], 4
            elif size == 127 and len(data) >= 10:
                size, at = struct.unpack(">Q", data[2:10])[0], 10
            elif size > 125:
                break
            if len(data) < at + size:
                break
            if data[0] & 15 == 1:
                texts.append(json.loads(data[at:at + size]))
            data = data[at + size:]
    return texts


def codes(view):
    good = f"/?token={view.token}"
    status, answer = view.request(good)
    check("the token opens the page", status == 200 and "<!doctype html>" in answer, status)
    cookie = re.search(r"Set-Cookie: ([^;]+); Path=/; HttpOnly; SameSite=Strict", answer)
    check("and gives a cookie that scripts and other sites do not get", cookie is not None, answer[:600])
    check("which is not the token", cookie and view.token not in cookie[1])
    check("the page may run no code of others", "default-src 'none'; script-src 'self'" in answer and "unsafe" not in answer.split("\r\n\r\n")[0])
    check("the cookie opens the script", view.request("/app.js", Cookie=cookie[1])[0] == 200)
    for name, want, got in [
        ("no token", 401, view.request("/")),
        ("a wrong token", 401, view.request("/?token=" + "0" * 32)),
        ("half a token", 401, view.request("/?token=" + view.token[:16])),
        ("a token of another name", 401, view.request("/?atoken=" + view.token)),
        ("a wrong cookie", 401, view.request("/app.js", Cookie=cookie[1][:-1] + "x")),
        ("no token for a file that is not there", 401, view.request("/etc/passwd")),
        ("a page of another origin, by cookie", 403, view.request("/", Origin="http://evil.example", Cookie=cookie[1])),
        ("a page of another origin, by token", 403, view.request(good, Origin="http://evil.example")),
        ("a page of another port of this machine", 403, view.request(good, Origin="http://127.0.0.1:1")),
        ("an opaque origin", 403, view.request(good, Origin="null")),
        ("a host of another name", 421, view.request(good, host="evil.example")),
        ("a host that begins like ours", 421, view.request(good, host="127.0.0.1.evil.example")),
        ("a host that begins like localhost", 421, view.request(good, host="localhost:80.evil.example")),
        ("an empty host", 421, view.raw(f"GET {good} HTTP/1.1\r\nHost:\r\n\r\n".encode())),
        ("localhost", 200, view.request(good, host=f"localhost:{view.port}")),
        ("a tunnel's port", 200, view.request(good, host="localhost:9999")),
        ("a path out of the folder", 404, view.request("/../../../etc/passwd", Cookie=cookie[1])),
        ("the same, encoded", 404, view.request("/%2e%2e/%2e%2e/etc/passwd", Cookie=cookie[1])),
        ("an absolute address", 404, view.request("http://127.0.0.1/app.js", Cookie=cookie[1])),
        ("POST", 405, view.request("/", method="POST", Cookie=cookie[1])),
        ("a body", 413, view.raw(f"POST {good} HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Length: 100000\r\n\r\n".encode() + b"x" * 1000)),
        ("a head of 9 KiB", 431, view.request(good, X_Long="x" * 9000)),
        ("what is not HTTP", 400, view.raw(b"\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03 hello\r\n\r\n")),
    ]:
        check(f"{name}: {want}", got[0] == want, got[0])


def sockets(view):
    s, head = view.socket("unknown.7")
    check("a WebSocket of another protocol: 400", b" 400 " in head, head[:80])
    s, head = view.socket(Origin="http://evil.example")
    check("a WebSocket of another origin: 403", b" 403 " in head, head[:80])
    s, head = view.socket("foxglove.sdk.v1", Origin="https://app.foxglove.dev")
    check("Foxglove of another origin, with the token: opens", b" 101 " in head, head[:80])
    status, _ = view.request("/", Upgrade="websocket", Connection="Upgrade", Sec_WebSocket_Key="MDEyMzQ1Njc4OWFiY2RlZg==",
                             Sec_WebSocket_Version="13", Sec_WebSocket_Protocol="foxglove.sdk.v1", Origin="https://app.foxglove.dev")
    check("Foxglove of another origin without it: 401 or 403", status in (401, 403), status)

    s, head = view.socket()
    check("a WebSocket opens", b" 101 " in head and b"hapticd.1" in head, head)
    for line in ['{"do":"stop","id":1}', '{"do":"set","model":"teapot","parameter":"stiffness","value":1,"consent":true,"id":2}',
                 '{"do":"lead","hand":"simulated-premium15","id":3}', '{"do":"reload","file":"/etc/passwd","id":4}', '{"do":"vertices","model":"teapot","id":5}',
                 "[]", "{}", "null", "{", '{"do":7,"id":6}', '{"do":"stop","do":"status","id":7}', '{"do":"geometry","model":["a"],"id":8}', '{"do":"unlead","lead":-1,"id":9}']:
        s.sendall(frame(line.encode()))
    answers = {a.get("id"): a for a in read_messages(s, 3) if a.get("type") == "answer"}
    check("a view that only looks changes nothing", all(not answers.get(i, {"ok": True})["ok"] for i in (1, 2, 3, 4)), answers)
    check("and says what helps", "--control" in answers.get(1, {}).get("error", ""), answers.get(1))
    check("malformed requests are refused", None in answers and all(not answers.get(i, {"ok": True})["ok"] for i in (6, 8, 9)), answers)
    check("the daemon runs", view.run.poll() is None)

    s.sendall(frame(b"x" * 200_000))
    s.settimeout(10)
    try:
        while s.recv(1 << 16):
            pass
        ended = True
    except OSError as error:
        ended = not isinstance(error, socket.timeout)
    check("a message of 200 kB ends its connection", ended)


def crowds(view):
    held = [view.socket()[0] for _ in range(8)]
    status = view.socket()[1]
    check("a ninth WebSocket: 503", b" 503 " in status, status[:60])
    time.sleep(3)  # none of them reads what comes: 8 x 0.4 MB a second
    check("eight that never read do not let it grow", view.resident_kb() < 40_000, f"{view.resident_kb()} kB")
    for s in held:
        s.close()
    time.sleep(0.5)

    slow = [view.connect() for _ in range(40)]
    for s in slow:
        s.sendall(b"GET / HTTP/1.1\r\nHost: 127.0.0.1\r\nX-")
    status = view.request(f"/?token={view.token}")[0]
    check("forty of them keep no page out", status == 200, status)
    time.sleep(11)
    closed = 0
    for s in slow:
        s.settimeout(0.5)
        try:
            closed += s.recv(100) == b""
        except ConnectionError:
            closed += 1
        except OSError:
            pass
    check("heads that never end are dropped within 10 s", closed == len(slow), f"{closed} of {len(slow)}")
    for s in slow:
        s.close()


def mutated(view):
    chance = random.Random(7)
    seeds = [json.dumps(r).encode() for r in ({"do": "status", "id": 1}, {"do": "geometry", "model": "teapot", "id": 2}, {"do": "list", "id": 3},
             {"do": "seek", "t": 1e300, "id": 4}, {"op": "subscribe", "subscriptions": [{"id": 1, "channelId": 1}]}, {"do": "lead", "hand": "a", "id": 5})]
    sent = 0
    while sent < MUTATED:
        s, _ = view.socket(chance.choice(["hapticd.1", "foxglove.sdk.v1"]))
        s.settimeout(2)
        try:
            for _ in range(50):
                data = bytearray(chance.choice(seeds))
                for _ in range(chance.randint(0, 6)):
                    data[chance.randrange(len(data))] = chance.randrange(256)
                whole = bytearray(frame(bytes(data), chance.choice([1, 1, 1, 2, 2, 0, 8, 9, 10, 3]), chance.random() > 0.05))
                if chance.random() < 0.1:
                    whole[chance.randrange(len(whole))] ^= 1 << chance.randrange(8)
                s.sendall(bytes(whole))
                sent += 1
        except OSError:
            pass
        s.close()
    check(f"{sent} mutated frames", view.lives())
    check("its memory does not grow", view.resident_kb() < 60_000, f"{view.resident_kb()} kB")


def waits(view):
    """A view of a daemon that does not run says so at once."""
    with subprocess.Popen([HAPTICD, "view", "--name", "nobody"], env=view.environment, text=True, stdout=subprocess.PIPE, stderr=subprocess.PIPE) as other:
        address = other.stdout.readline()
        other.terminate()
        told = other.stderr.read()
    check("a view says that it waits, what for, and what runs", address.startswith("http") and all(words in told for words in (
        "no daemon named nobody runs yet, so the page waits for it", "these run: x", "hapticd run SCENE --name nobody")), told)


with tempfile.TemporaryDirectory(dir="/dev/shm") as folder:
    view = View(folder)
    try:
        waits(view)
        codes(view)
        sockets(view)
        crowds(view)
        mutated(view)
        check("the view serves on", view.lives())
        check("the token is nowhere but in the printed address", view.token not in " ".join(open(f"/proc/{view.view.pid}/cmdline").read().split("\0")))
        pages = [view.socket(protocol)[0] for protocol in ("hapticd.1", "foxglove.sdk.v1") * 4]
    finally:
        view.end()
    check("it ends in order while pages are open", view.view.returncode == 0, view.view.returncode)
    check("what it printed is the address alone", view.view.stdout.read() == "")
finish()
