# SPDX-License-Identifier: MIT
"""Leads: memory that this program writes and the servo reads once per tick."""
from __future__ import annotations

import math
import mmap
import struct
import time
import warnings
from typing import Any, Callable, Optional, Sequence

from ._error import HapticdError

_TARGET = struct.Struct("<14d")
_PUSH = struct.Struct("<Q6dQQ")
_COUNT = struct.Struct("<Q")
LEAD_BYTES = 4096  # size of the memory of a lead


_UNIT = 1e-3  # largest error of a quaternion's length, as in the daemon
_FAR = 10.0  # m: largest coordinate of a position, as in the daemon
_ROUNDING = 1e-3  # tolerance for a program that limits its force to max_force by itself
_LARGEST = 1e6  # N and N m: largest number of a force or torque, as in the daemon


def _finite(what: str, *numbers: float) -> None:
    if not all(math.isfinite(number) for number in numbers):
        raise ValueError(f"{what} is not finite: {list(numbers)}; the daemon would refuse it")


class _Slot:
    """The memory of a lead: a count, which is odd while the record is being written, and then the record."""

    def __init__(self, memory: mmap.mmap) -> None:
        self._memory = memory
        self._count = _COUNT.unpack_from(self._memory, 0)[0]

    def put(self, record: bytes) -> None:
        # These are plain stores. On x86-64 they are seen in this order. On other processors the
        # daemon may read a half-written record, which it refuses or follows within its bounds.
        even = (self._count + 1) & ~1
        _COUNT.pack_into(self._memory, 0, even + 1)
        self._memory[8:8 + len(record)] = record
        self._count = even + 2
        _COUNT.pack_into(self._memory, 0, self._count)

    def close(self) -> None:
        self._memory.close()


class Ending:
    """Calls `end()` at the end of a `with` block. If the daemon ends in order, the block ends with it: the error of the
    call that noticed it does not leave the block. The error that the daemon was killed or crashed does."""

    def end(self) -> None:
        raise NotImplementedError

    def __exit__(self, kind: object, error: object, *_: object) -> bool:
        try:
            self.end()
        except HapticdError:
            if kind is None:
                raise  # only if there is no other error, so that the first error is not hidden
        return isinstance(error, HapticdError) and error.stopped  # True: the end of the daemon ends the block quietly


class Lead(Ending):
    """A lead of this program. It ends with `end()`, with the client, or at the end of a `with` block."""

    def __init__(self, memory: mmap.mmap, unlead: Callable[[], Any],
                 lost: Callable[[], Optional[HapticdError]] = lambda: None) -> None:
        self._slot: Optional[_Slot] = _Slot(memory)
        self._unlead = unlead
        self._lost = lost  # returns why the lead has no effect any more, or None

    def _put(self, record: bytes) -> None:
        if self._slot is None:
            raise ValueError("this lead has ended, so nothing can be put into it; begin a new lead")
        if lost := self._lost():
            raise lost
        self._slot.put(record)

    def end(self) -> None:
        """Ends the lead: a model brakes and stays, a force ramps out. Raises HapticdError if the daemon was killed or
        crashed, and nothing if it ended in order."""
        if self._slot is None:
            return
        self._slot.close()
        self._slot = None
        try:
            if lost := self._lost():
                raise lost
            self._unlead()
        except HapticdError as error:
            if not error.stopped:
                raise

    def __enter__(self) -> "Lead":
        return self


class PoseLead(Lead):
    """Leads a kinematic model, or the hand of a simulated arm."""

    def put(self, position: Sequence[float], orientation: Sequence[float] = (1.0, 0.0, 0.0, 0.0),
            linear: Sequence[float] = (0.0, 0.0, 0.0), angular: Sequence[float] = (0.0, 0.0, 0.0),
            when: Optional[float] = None) -> None:
        """Sets where the model or hand must go: position [m], orientation (a unit quaternion w, x, y, z), and its linear
        [m/s] and angular [rad/s] velocity there, in the world frame. `when` [s] is the time for which they hold, on the
        clock of `time.monotonic()`; the default is now. The newest target wins. It never waits."""
        stamp = time.monotonic() if when is None else when
        try:
            record = _TARGET.pack(*position, *orientation, *linear, *angular, stamp)
        except (struct.error, TypeError) as error:
            raise (TypeError if isinstance(error, TypeError) else ValueError)(
                "put() expects position [x, y, z] in m, orientation [w, x, y, z], linear [x, y, z] in m/s, angular [x, y, z] in "
                f"rad/s and when in s, got {position!r}, {orientation!r}, {linear!r}, {angular!r} and {when!r}") from None
        _finite("the target", *position, *orientation, *linear, *angular, stamp)
        if max(map(abs, position)) > _FAR:
            raise ValueError(f"the position {list(position)} is farther than {_FAR:g} m from the world's origin; the daemon would "
                             f"refuse it; the position must be in m")
        if abs(math.hypot(*orientation) - 1) > _UNIT:
            raise ValueError(f"the orientation {list(orientation)} has length {math.hypot(*orientation):g}, expected a "
                             f"unit quaternion w, x, y, z")
        self._put(record)

    def __enter__(self) -> "PoseLead":
        return self


class ForceLead(Lead):
    """A force on the hand of an arm. 3 ms after the last answer the force ramps out; after 20 ms it is zero."""

    def __init__(self, memory: mmap.mmap, unlead: Callable[[], Any], lost: Callable[[], Optional[HapticdError]] = lambda: None,
                 max_force: float = math.inf) -> None:
        super().__init__(memory, unlead, lost)
        self.max_force = max_force  #: N: largest force that the scene and the device allow this program
        self._warned = False

    def put(self, tick: int, force: Sequence[float], torque: Sequence[float] = (0.0, 0.0, 0.0),
            woke_ns: int = 0) -> None:
        """Answers a tick (the `tick` of the newest state) with a force [N] and a torque [N m] on the hand, world frame.
        `woke_ns` is time.monotonic_ns() when the program learnt of that tick, for the recording. Warns once if the force is
        larger than `max_force`: the daemon makes it smaller."""
        try:
            record = _PUSH.pack(tick, *force, *torque, woke_ns, time.monotonic_ns())
        except (struct.error, TypeError) as error:
            raise (TypeError if isinstance(error, TypeError) else ValueError)(
                "put() expects the number of a tick from 0 on, force [x, y, z] in N and torque [x, y, z] in N m, got "
                f"{tick!r}, {force!r} and {torque!r}") from None
        _finite("the force or torque", *force, *torque)
        if max(map(abs, (*force, *torque))) > _LARGEST:
            raise ValueError(f"{list(force)} N and {list(torque)} N m: a number is beyond {_LARGEST:g}; the daemon would refuse "
                             f"it; the force must be in N")
        if not self._warned and math.hypot(*force) > self.max_force * (1 + _ROUNDING):
            self._warned = True
            warnings.warn(f"a force of {math.hypot(*force):.3g} N was asked for, but the arm gets {self.max_force:.3g} N at most "
                          "(clients.max_force in the scene, or the limit of the device)", stacklevel=2)
        self._put(record)

    def __enter__(self) -> "ForceLead":
        return self
