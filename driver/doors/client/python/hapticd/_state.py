# SPDX-License-Identifier: MIT
"""The states of the arms in the current tick, and the bell that wakes a waiting program."""
from __future__ import annotations

import ctypes
import mmap
import os
import platform
import struct
from typing import NamedTuple, Optional

from ._error import HapticdError

_PAGE = struct.Struct("<II")
_FIRST = 64
_COUNT = struct.Struct("<Q")
_STATE = struct.Struct("<QQdd3d4d3d16d3dIIII")
_FUTEX_WAIT = 0
_FUTEX = {"x86_64": 202, "aarch64": 98, "riscv64": 98}  # number of the system call
_WORD = {"rows": 0, "state": 64}  # places in hapticd_bell, each with its flag behind it


#: Words for the numbers of `State.fault` and of `code` in events of kind `fault`.
FAULTS = ("", "not finite", "device lost", "device at fault", "stale samples", "too fast", "too late", "not calibrated",
          "held or stopped", "stuck", "overheated", "jumped", "orientation not of length 1")


class State(NamedTuple):
    """The state of an arm at the start of a tick, before the shapes are stepped. SI units, world frame."""

    tick: int
    time_ns: int  #: CLOCK_MONOTONIC of the tick's deadline
    t: float  #: s since the first tick
    dt: float  #: s since the tick before
    position: tuple[float, float, float]  #: m, position of the tip
    orientation: tuple[float, float, float, float]  #: w, x, y, z
    velocity: tuple[float, float, float]  #: m/s
    joints: tuple[float, ...]  #: rad or m
    sent: tuple[float, float, float]  #: N, force that the previous tick sent
    good: bool  #: True if the sample was good; if not, the pose is older
    buttons: int  #: bit i: button i is down
    fault: int  #: why the arm gets no force, 0 if it gets its force; `fault_name` has the name

    @property
    def fault_name(self) -> str:
        """"too fast", ...; "": a force flows. `h.status()` has the whole reason and its cure, as `no_force`."""
        return FAULTS[self.fault] if self.fault < len(FAULTS) else f"fault {self.fault}"


class StatePage:
    """Memory that the servo writes once a tick."""

    def __init__(self, fd: int, size: int) -> None:
        try:
            self._memory = mmap.mmap(fd, size, prot=mmap.PROT_READ)
        finally:
            os.close(fd)
        self.arms, self._stride = _PAGE.unpack_from(self._memory, 0)

    def read(self, arm: int) -> Optional[State]:
        """Returns the newest record, or None if there was none yet."""
        at = _FIRST + arm * self._stride
        for _ in range(1000):  # the servo writes for less than a microsecond
            count = _COUNT.unpack_from(self._memory, at)[0]
            data = self._memory[at + 8:at + 8 + _STATE.size]
            if count % 2 == 0 and _COUNT.unpack_from(self._memory, at)[0] == count:
                return None if count == 0 else self._parsed(_STATE.unpack(data))
        return None

    @staticmethod
    def _parsed(v: tuple) -> State:
        return State(v[0], v[1], v[2], v[3], v[4:7], v[7:11], v[11:14], v[14:14 + v[36]], v[30:33], bool(v[33] & 1), v[34],
                     v[35])

    def close(self) -> None:
        self._memory.close()


class Bell:
    """Words that the servo counts up. It wakes programs that wait for them."""

    def __init__(self, fd: int, size: int) -> None:
        try:
            self._memory = mmap.mmap(fd, size)
        finally:
            os.close(fd)
        self._number = _FUTEX.get(platform.machine())
        if self._number is None:
            raise HapticdError(f"waiting for ticks is not known on {platform.machine()}; ask for rows now and then instead")
        self._libc = ctypes.CDLL(None, use_errno=True)
        self._words = {name: (ctypes.c_uint32.from_buffer(self._memory, at),
                              ctypes.c_uint32.from_buffer(self._memory, at + 4)) for name, at in _WORD.items()}

    def wait(self, which: str, seen: int, timeout: float) -> int:
        """Sleeps until the word is not `seen` (low 32 bits of the ticks told), at most `timeout` seconds; gives it back."""
        word, waiting = self._words[which]
        seen &= 0xFFFFFFFF
        if word.value == seen:
            waiting.value = 1
            seconds = int(timeout)
            limit = struct.pack("@ll", seconds, int((timeout - seconds) * 1e9))
            # the kernel looks at the word again, behind a full barrier; the call lets other Python threads run
            self._libc.syscall(ctypes.c_long(self._number), ctypes.byref(word), _FUTEX_WAIT, ctypes.c_uint32(seen), limit,
                               None, 0)
        return word.value

    def close(self) -> None:
        self._words = {}
        self._memory.close()
