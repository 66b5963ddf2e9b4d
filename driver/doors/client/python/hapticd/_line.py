# SPDX-License-Identifier: MIT
"""The socket to a daemon, with lines of JSON."""
from __future__ import annotations

import array
import fcntl
import json
import math
import mmap
import os
import select
import socket
import time
from collections import deque
from typing import Any, Optional

from ._error import CLOSED, HapticdError

_MOST_LINE = 1 << 24
_F_GET_SEALS, _F_SEAL_SHRINK = 1034, 2  # the module fcntl has them from Python 3.8 on, but not everywhere


def _plain(value: Any) -> Any:
    """Converts numbers and arrays of numpy, which the module json does not know."""
    if hasattr(value, "tolist"):
        return value.tolist()
    raise TypeError(f"a request has only texts, numbers, lists of numbers, True and False, got {value!r} ({type(value).__name__})")


class Line:
    """A socket with lines of JSON, and with the descriptors that come with them."""

    def __init__(self, file: str) -> None:
        self._socket = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
        try:
            self._socket.connect(file)
        except OSError as error:
            self._socket.close()
            foreign = isinstance(error, PermissionError)
            cure = ("be the daemon's user or in its group: only they may connect" if foreign
                    else "start the daemon with hapticd run")
            raise HapticdError(f"no daemon answers at {file}: {error.strerror}\n  fix: {cure}",
                               "failed" if foreign else "gone") from None
        self._begun = b""  # the beginning of a line that is not yet complete
        self._begun_with: list[int] = []  # the descriptors that came with this beginning
        self._lines: deque[tuple[bytes, list[int]]] = deque()
        self._descriptors: list[int] = []  # descriptors of the last line that was returned

    def say(self, request: dict[str, Any]) -> None:
        try:
            line = json.dumps(request, allow_nan=False, default=_plain, ensure_ascii=False).encode()
        except UnicodeEncodeError:  # the daemon takes no such line, and could not say whose answer its refusal is
            raise ValueError(f"a text of the request has half a character of UTF-16, which UTF-8 cannot have: {request!a}") from None
        except ValueError:
            raise ValueError(f"a number of the request is not finite, expected finite numbers: {request}") from None
        if self.closed():
            raise HapticdError(CLOSED, "closed")
        try:
            self._socket.sendall(line + b"\n")
        except OSError as error:
            raise HapticdError(f"the daemon is gone: {error.strerror}", "gone") from None

    def hear(self, timeout: Optional[float]) -> Optional[dict[str, Any]]:
        """Returns the next line, or None if none came in time."""
        end = None if timeout is None else time.monotonic() + timeout
        while not self._lines:
            if self.closed():
                return None
            left = None if end is None else max(end - time.monotonic(), 0)
            ready = select.poll()  # select.select() cannot wait for a descriptor above 1023
            ready.register(self._socket, select.POLLIN)
            if not ready.poll(None if left is None else math.ceil(left * 1e3)) or (left == 0 and self._begun):
                return None  # nothing came, or a line without an end
            self._receive()
        line, descriptors = self._lines.popleft()
        self._forget()
        self._descriptors = descriptors
        try:
            answer = json.loads(line)
        except (ValueError, RecursionError):
            answer = None
        if not isinstance(answer, dict):
            raise HapticdError(f"the daemon's answer is not a JSON object: {line[:100]!r}; it may be of another version", "damaged")
        return answer

    def _receive(self) -> None:
        try:
            data, ancillary, _, _ = self._socket.recvmsg(1 << 16, socket.CMSG_SPACE(16), socket.MSG_CMSG_CLOEXEC)
        except OSError as error:
            raise HapticdError(f"the daemon is gone: {error.strerror}", "gone") from None
        fds = array.array("i")
        for level, kind, content in ancillary:
            if level == socket.SOL_SOCKET and kind == socket.SCM_RIGHTS:
                fds.frombytes(content[:len(content) - len(content) % fds.itemsize])
        if not data or len(self._begun) > _MOST_LINE:
            raise HapticdError("the daemon is gone", "gone")
        *whole, rest = data.split(b"\n")
        for number, part in enumerate(whole):
            # A descriptor arrives with the first byte of its line, so it belongs to the last line of this message.
            last = not rest and number + 1 == len(whole)
            self._lines.append((self._begun + part, self._begun_with + (list(fds) if last else [])))
            self._begun, self._begun_with = b"", []
        self._begun += rest
        if rest:
            self._begun_with += fds

    def closed(self) -> bool:
        """Returns whether this end is closed."""
        return self._socket.fileno() < 0

    def ended(self) -> bool:
        """Returns whether the other end is closed. The kernel reports this at once, even if the process was killed."""
        if self.closed():
            return False
        socket_ = select.poll()
        socket_.register(self._socket, 0)
        return bool(socket_.poll(0))

    def descriptor(self) -> int:
        """Returns the descriptor that came with the last line."""
        if not self._descriptors:
            raise HapticdError("the daemon sent no shared memory with its answer; it may be of another version\n  fix: restart the daemon", "damaged")
        return self._descriptors.pop(0)

    def memory(self, answer: dict[str, Any], least: int, **how: int) -> mmap.mmap:
        """Maps the memory that came with the last line, at least so many bytes. It must be sealed against shrinking: else
        this process could be killed while it reads."""
        fd = self.descriptor()
        try:
            if not fcntl.fcntl(fd, _F_GET_SEALS) & _F_SEAL_SHRINK:
                raise ValueError("it is not sealed")
            memory = mmap.mmap(fd, answer.get("bytes", 0), **how)
            if len(memory) < least:
                raise ValueError(f"it has {len(memory)} bytes, expected {least}")
            return memory
        except (OSError, ValueError, TypeError, OverflowError) as error:
            raise HapticdError(f"the shared memory that the daemon sent cannot be used: {error}; it may be of another version\n"
                               "  fix: restart the daemon", "damaged") from None
        finally:
            os.close(fd)

    def _forget(self) -> None:
        for fd in self._descriptors:
            os.close(fd)
        self._descriptors = []

    def close(self) -> None:
        self._socket.close()
        self._forget()
        for fd in self._begun_with + [fd for _, fds in self._lines for fd in fds]:
            os.close(fd)
        self._begun_with = []
        self._lines.clear()
