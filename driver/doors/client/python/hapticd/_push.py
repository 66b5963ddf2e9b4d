# SPDX-License-Identifier: MIT
"""A force loop in Python: a thread that answers every tick with a force."""
from __future__ import annotations

import os
import sys
import threading
import time
import traceback
import warnings
from typing import TYPE_CHECKING, Callable, Optional, Sequence

from ._error import HapticdError, NoForceWarning, caller
from ._lead import Ending, ForceLead
from ._state import FAULTS, Bell, State, StatePage

if TYPE_CHECKING:
    from ._client import Client

_TOO_OLD = 20_000_000  # ns: the daemon ignores an answer that comes later than this after its tick
_FEW = 0.001  # share of late answers that is no fault of the callback: the machine was busy
_STOPPED = 8  # number of the fault of an arm that is held, or whose run ends
_NO_FORCES = (str, bytes, bytearray, dict, set)  # b"abc" would be 170 N
_PATIENCE = 0.1  # s: time between two checks whether the daemon still runs

Force = Sequence[float]


def _stopped(error: Optional[BaseException]) -> bool:
    """Returns whether the error is that the daemon ended in order, which is no failure of the program."""
    return isinstance(error, HapticdError) and error.stopped


class ForceThread(Ending):
    """Calls `callback(state)` in a thread once per tick. The callback returns the force on the hand, three numbers in N
    (or six with the torque in N m), or None for no answer to this tick. An exception in the callback ends the push: it
    is printed at once, stays in `error`, and `end()` raises it. If the daemon is killed or crashes, that is such an
    exception too. If the daemon ends in order, `error` has it, but it is not printed and not raised. `end()`
    warns if no tick was answered, or if more than one answer in a thousand came too late. A NoForceWarning comes each time the arm begins to get
    no force."""

    def __init__(self, client: "Client", device: str, callback: Callable[[State], Optional[Force]], priority: int) -> None:
        if not callable(callback):
            raise TypeError("push() expects a function that takes the state of the arm and returns its force, [x, y, z] in N, got "
                            f"{callback!r}")
        self._lead: ForceLead = client.lead_force(device)
        self._page: StatePage = client._state_page()
        self._bell: Bell = client._bell()
        self._arm = client._arm(device)
        self._client, self._device = client, device
        self._begun_at = caller()
        self._callback, self._priority = callback, priority
        self._stop = threading.Event()
        self.answers = 0  #: number of ticks that were answered
        self.unanswered = 0  #: number of ticks for which the callback returned None
        self.late = 0  #: number of answers that came more than 20 ms after their tick, and had no effect
        self.real_time = False  #: True if the thread has the requested priority
        self.error: Optional[BaseException] = None  #: the exception that ended the thread
        self._thread = threading.Thread(target=self._run, name="hapticd-push", daemon=True)
        self._thread.start()

    def _run(self) -> None:
        try:
            os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(self._priority))  # 0 means this thread only
            self.real_time = True
        except OSError:
            pass  # it also works without priority, but the force ramps out while answers are late
        try:
            self._answer()
        except BaseException as error:  # noqa: B902 - printed at once, and raised in end()
            if not _stopped(error):
                self._tell(error)
            self.error = error
            self._release()
        finally:
            self._bell.close()
            self._page.close()

    def _release(self) -> None:
        """Ends the lead at once, so that the next push on this arm need not wait until somebody calls end()."""
        try:
            self._lead.end()
        except (HapticdError, OSError):
            pass  # the daemon has ended, which self.error tells

    def _tell(self, error: BaseException) -> None:
        """Prints an error at once, because the main thread may call end() only much later."""
        shown = None if isinstance(error, HapticdError) else error.__traceback__
        text = "".join(traceback.format_exception(type(error), error, shown))
        print(f"hapticd: the push on {self._device} has ended, and its force ramps out:\n{text}", end="", file=sys.stderr)

    def _watch(self, state: State) -> None:
        """Warns if a fault begins. Another thread does it, because the text of the fault needs a request, which takes time."""
        if state.fault != self._fault and state.fault != 0:
            threading.Thread(target=self._tell_fault, args=(state.fault,), daemon=True).start()
        self._fault = state.fault

    def _tell_fault(self, fault: int) -> None:
        time.sleep(_PATIENCE)
        if self._client.ended():
            return  # the daemon ramped its forces out because it ended, which is reported elsewhere
        try:
            why = self._client._no_force(self._device)
        except (HapticdError, OSError):
            why = ""
        if not why and fault == _STOPPED:
            return  # the daemon is about to end
        # Without a registry the same warning is shown each time.
        warnings.warn_explicit(why or f"device {self._device}: a fault ({FAULTS[fault] if fault < len(FAULTS) else fault}) ended its forces; see: hapticd ctl status",
                               NoForceWarning, *self._begun_at)

    def _answer(self) -> None:
        seen, last = self._bell.wait("state", -1, 0), -1
        first = self._page.read(self._arm)
        self._fault = first.fault if first else 0  # lead_force() has warned of it already
        while not self._stop.is_set():
            seen = self._bell.wait("state", seen, _PATIENCE)
            woke = time.monotonic_ns()
            state = self._page.read(self._arm)
            if state is None or state.tick == last:
                self._client._check()
                continue
            last = state.tick
            self._watch(state)
            force = self._callback(state)
            if force is None:
                self.unanswered += 1
                continue
            if isinstance(force, _NO_FORCES) or not hasattr(force, "__len__"):
                raise ValueError(f"the callback returned {force!r}, expected 3 numbers ([x, y, z], the force in N) or 6 (and the torque in N m)")
            if len(force) not in (3, 6):
                raise ValueError(f"the callback returned {len(force)} numbers, expected 3 (the force in N) or 6 (and the torque in N m)")
            self._lead.put(state.tick, force[:3], force[3:] if len(force) == 6 else (0.0, 0.0, 0.0), woke)
            self.answers += 1
            self.late += time.monotonic_ns() - woke > _TOO_OLD

    def end(self) -> None:
        """Ends the push: the force ramps out. If the callback raised an exception, raises it again."""
        self._stop.set()
        if threading.current_thread() is not self._thread:
            self._thread.join()
        try:
            self._lead.end()
        except HapticdError:
            if self.error is None:
                raise
        if self.error is not None and not _stopped(self.error):
            raise self.error
        if self.answers == 0 and self.unanswered > 0:
            warnings.warn_explicit(f"the callback returned None for all {self.unanswered} ticks, so nothing was pushed: a "
                                   "return statement may be missing", UserWarning, *caller())
        if self.late > _FEW * self.answers:
            warnings.warn_explicit(f"{self.late} of {self.answers} answers came more than 20 ms after their tick and were "
                                   "ignored: the callback takes too long", UserWarning, *caller())

    def __enter__(self) -> "ForceThread":
        return self
