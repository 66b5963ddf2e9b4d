# SPDX-License-Identifier: MIT
"""The states of the arms in the current tick, and the bell that wakes a waiting program."""
from __future__ import annotations

import ctypes
import mmap
import platform
import struct
from typing import NamedTuple, Optional

from ._error import HapticdError

_PAGE = struct.Struct("<II")
_FIRST = 64
BELL_BYTES = 128
_COUNT = struct.Struct("<Q")
_STATE = struct.Struct("<QQdd3d4d3d16d3dIIII")
_FUTEX_WAIT = 0
_FUTEX = {"x86_64": 202, "aarch64": 98, "riscv64": 98}  # number of the system call
_WORD = {"rows": 0, "state": 64}  # offset of each word in hapticd_bell [bytes]; its flag `..._waiting` follows it


#: Words for the numbers of `State.fault` and of `code` in events of kind `fault`.
FAULTS = ("", "not finite", "device lost", "device at fault", "stale samples", "too fast", "too late", "not calibrated",
          "held or stopped", "stuck", "overheated", "jumped", "orientation not of length 1")


class State(NamedTuple):
    """The state of an arm at the start of a tick, before the shapes are stepped. SI units, world frame."""

    tick: int
    time_ns: int  #: CLOCK_MONOTONIC of the tick's deadline
    t: float  #: s since the first tick
    dt: float  #: s since the previous tick
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
        """Why the arm gets no force, such as "too fast"; "" if it gets its force. `no_force` in `status()` says more."""
        return FAULTS[self.fault] if self.fault < len(FAULTS) else f"fault {self.fault}"


class StatePage:
    """The memory with the states of the arms, which the servo writes once per tick."""

    def __init__(self, memory: mmap.mmap) -> None:
        self._memory = memory
        self.arms, self._stride = _PAGE.unpack_from(self._memory, 0)
        if self._stride < 8 + _STATE.size or _FIRST + self.arms * self._stride > len(memory):
            raise HapticdError("the states that the daemon sent are not those of its arms; it may be of another version\n"
                               "  fix: restart the daemon", "damaged")

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
    """The memory with the words that the servo counts up. The servo wakes programs that wait for a word to change."""

    def __init__(self, memory: mmap.mmap) -> None:
        self._memory = memory
        self._number = _FUTEX.get(platform.machine())
        if self._number is None:
            raise HapticdError(f"this package cannot wait for ticks on {platform.machine()}\n  fix: read the rows from time to time instead")
        self._libc = ctypes.CDLL(None, use_errno=True)
        self._words = {name: (ctypes.c_uint32.from_buffer(self._memory, at),
                              ctypes.c_uint32.from_buffer(self._memory, at + 4)) for name, at in _WORD.items()}

    def wait(self, which: str, seen: int, timeout: float) -> int:
        """Sleeps until the word (the low 32 bits of a count of ticks) is not `seen`, at most `timeout` seconds. Returns
        the word."""
        word, waiting = self._words[which]
        seen &= 0xFFFFFFFF
        if word.value == seen:
            waiting.value = 1
            seconds = int(timeout)
            limit = struct.pack("@ll", seconds, int((timeout - seconds) * 1e9))
            # The kernel reads the word again, after a full memory barrier. Other Python threads run meanwhile.
            self._libc.syscall(ctypes.c_long(self._number), ctypes.byref(word), _FUTEX_WAIT, ctypes.c_uint32(seen), limit,
                               None, 0)
        return word.value

    def close(self) -> None:
        self._words = {}
        self._memory.close()
