# SPDX-License-Identifier: MIT
"""Leads: memory that this program writes and the servo looks at once a tick."""
from __future__ import annotations

import mmap
import os
import struct
import time
from typing import Any, Callable, Optional, Sequence

_TARGET = struct.Struct("<14d")
_COUNT = struct.Struct("<Q")


class _Slot:
    """A record behind a count that is odd while the record is written."""

    def __init__(self, fd: int, size: int) -> None:
        try:
            self._memory = mmap.mmap(fd, size)
        finally:
            os.close(fd)
        self._count = _COUNT.unpack_from(self._memory, 0)[0]

    def put(self, record: bytes) -> None:
        # Plain stores: ordered as written on x86-64; elsewhere a torn record is refused or followed within its bounds.
        even = (self._count + 1) & ~1
        _COUNT.pack_into(self._memory, 0, even + 1)
        self._memory[8:8 + len(record)] = record
        self._count = even + 2
        _COUNT.pack_into(self._memory, 0, self._count)

    def close(self) -> None:
        self._memory.close()


class PoseLead:
    """Leads a kinematic model, or the hand of a simulated arm. Ends with `end()`, with the client, or with `with`."""

    def __init__(self, fd: int, size: int, unlead: Callable[[], Any]) -> None:
        self._slot: Optional[_Slot] = _Slot(fd, size)
        self._unlead = unlead

    def put(self, position: Sequence[float], orientation: Sequence[float] = (1.0, 0.0, 0.0, 0.0),
            linear: Sequence[float] = (0.0, 0.0, 0.0), angular: Sequence[float] = (0.0, 0.0, 0.0),
            when: Optional[float] = None) -> None:
        """Where it shall be: position [m], orientation (a unit quaternion w, x, y, z), and how it moves there: linear
        [m/s] and angular [rad/s] velocity, in the world frame. `when` [s] on the clock of `time.monotonic()` says for
        which moment; without it, for now. Newest wins; nothing here waits."""
        if self._slot is None:
            raise ValueError("the lead has ended")
        stamp = time.monotonic() if when is None else when
        self._slot.put(_TARGET.pack(*position, *orientation, *linear, *angular, stamp))

    def end(self) -> None:
        """The model brakes and stays."""
        if self._slot is None:
            return
        self._slot.close()
        self._slot = None
        self._unlead()

    def __enter__(self) -> "PoseLead":
        return self

    def __exit__(self, *_: object) -> None:
        self.end()
