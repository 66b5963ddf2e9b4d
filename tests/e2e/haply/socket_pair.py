"""A WebSocket of one thread, just enough for tests: text messages, client and server."""
import base64
import hashlib
import os
import socket
import struct

MAGIC = b"258EAFA5-E914-47DA-95CA-C5AB0DC85B11"


class Channel:
    def __init__(self, connection, masks):
        self.connection, self.masks = connection, masks
        self.bytes = b""

    def _take(self, count):
        while len(self.bytes) < count:
            more = self.connection.recv(65536)
            if not more:
                raise ConnectionError("closed")
            self.bytes += more
        taken, self.bytes = self.bytes[:count], self.bytes[count:]
        return taken

    def _head(self):
        while b"\r\n\r\n" not in self.bytes:
            more = self.connection.recv(65536)
            if not more:
                raise ConnectionError("closed")
            self.bytes += more
        head, self.bytes = self.bytes.split(b"\r\n\r\n", 1)
        return head.decode()

    def send(self, text, opcode=1):
        data = text.encode() if isinstance(text, str) else text
        mask = os.urandom(4) if self.masks else b""
        flag = 0x80 if self.masks else 0
        size = bytes([flag | len(data)]) if len(data) < 126 else bytes([flag | 126]) + struct.pack("!H", len(data))
        body = bytes(byte ^ mask[i % 4] for i, byte in enumerate(data)) if self.masks else data
        self.connection.sendall(bytes([0x80 | opcode]) + size + mask + body)

    def receive(self):
        while True:
            first, second = self._take(2)
            size = second & 0x7F
            size = struct.unpack("!H", self._take(2))[0] if size == 126 else size
            size = struct.unpack("!Q", self._take(8))[0] if size == 127 else size
            mask = self._take(4) if second & 0x80 else b""
            data = self._take(size)
            data = bytes(byte ^ mask[i % 4] for i, byte in enumerate(data)) if mask else data
            if first & 0x0F == 8:
                raise ConnectionError("closed")
            if first & 0x0F == 1:
                return data.decode()

    def close(self):
        self.connection.close()


def connect(port, origin=None, timeout=20):
    """None: it was refused."""
    channel = Channel(socket.create_connection(("127.0.0.1", port), timeout=timeout), True)
    key = base64.b64encode(os.urandom(16)).decode()
    head = (f"GET / HTTP/1.1\r\nHost: localhost:{port}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
            f"Sec-WebSocket-Key: {key}\r\nSec-WebSocket-Version: 13\r\n")
    channel.connection.sendall((head + (f"Origin: {origin}\r\n" if origin else "") + "\r\n").encode())
    try:
        return channel if " 101 " in channel._head().splitlines()[0] else None
    except (ConnectionError, OSError):
        return None


def accept(listener):
    connection, _ = listener.accept()
    channel = Channel(connection, False)
    lines = channel._head().splitlines()
    key = next(line.split(":", 1)[1].strip() for line in lines if line.lower().startswith("sec-websocket-key"))
    answer = base64.b64encode(hashlib.sha1(key.encode() + MAGIC).digest()).decode()
    connection.sendall(("HTTP/1.1 101 Switching Protocols\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
                        f"Sec-WebSocket-Accept: {answer}\r\n\r\n").encode())
    return channel
