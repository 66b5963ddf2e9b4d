# SPDX-License-Identifier: MIT
"""A force loop of one's own: a thread that answers every tick."""
from __future__ import annotations

import os
import sys
import threading
import time
import warnings
from typing import TYPE_CHECKING, Callable, Optional, Sequence

from ._error import HapticdError
from ._lead import ForceLead
from ._state import Bell, State, StatePage

if TYPE_CHECKING:
    from ._client import Client

_TOO_OLD = 20_000_000  # ns: an answer so long after its tick is ignored
_LOOKS = 500_000_000  # ns without a tick, after which the daemon's lock is looked at
_PATIENCE = 0.1  # s between two looks at whether anything is alive

Force = Sequence[float]


class ForceThread:
    """Calls `callback(state)` in a thread once a tick; what it gives back, three numbers in N (or six with the torque in
    N m), pushes on the hand; None answers nothing. An exception in the callback ends the push: it is told on stderr at
    once, `error` has it, and `end()` raises it. `end()` warns where no tick was answered, or answers came too late to
    count. A fault that keeps the force from the hand is told on stderr when the push meets it."""

    def __init__(self, client: "Client", device: str, callback: Callable[[State], Optional[Force]], priority: int) -> None:
        self._lead: ForceLead = client.lead_force(device)
        self._page: StatePage = client._state_page()
        self._bell: Bell = client._bell()
        self._arm = client._arm(device)
        self._alive = client.alive
        self._callback, self._priority = callback, priority
        self._stop = threading.Event()
        self.answers = 0  #: ticks that were answered
        self.unanswered = 0  #: ticks to which the callback gave back None
        self.late = 0  #: answers that came more than 20 ms after their tick, which count for nothing
        self.real_time = False  #: the thread has the priority that was asked for
        self.error: Optional[BaseException] = None  #: that ended it
        self._thread = threading.Thread(target=self._run, name="hapticd-push", daemon=True)
        self._thread.start()

    def _run(self) -> None:
        try:
            os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(self._priority))  # 0: of this thread alone
            self.real_time = True
        except OSError:
            pass  # it works without; late answers ramp the force out
        try:
            self._answer()
        except BaseException as error:  # noqa: B902 - raised in end(), which may be far off
            self.error = error
            print(f"hapticd: the push ended, its force ramps out: {type(error).__name__}: {error}", file=sys.stderr)
        finally:
            self._bell.close()
            self._page.close()

    def _answer(self) -> None:
        seen, last, fault = self._bell.wait("state", -1, 0), -1, 0
        looked = time.monotonic_ns()
        while not self._stop.is_set():
            seen = self._bell.wait("state", seen, _PATIENCE)
            woke = time.monotonic_ns()
            state = self._page.read(self._arm)
            if state is None or state.tick == last:
                if time.monotonic_ns() - looked > _LOOKS:
                    looked = time.monotonic_ns()
                    if not self._alive():
                        raise HapticdError("the daemon is gone, so nothing is pushed any more")
                continue
            looked = time.monotonic_ns()
            last = state.tick
            if state.fault not in (0, fault):
                print(f"hapticd: no force reaches the hand (fault {state.fault}): hapticd ctl status says why, hapticd "
                      "ctl clear ends it", file=sys.stderr)
            fault = state.fault
            force = self._callback(state)
            if force is None:
                self.unanswered += 1
                continue
            self._lead.put(state.tick, force[:3], force[3:6] if len(force) >= 6 else (0.0, 0.0, 0.0), woke)
            self.answers += 1
            self.late += time.monotonic_ns() - woke > _TOO_OLD

    def end(self) -> None:
        """Ends the push: the force ramps out. Raises what the callback raised."""
        self._stop.set()
        if threading.current_thread() is not self._thread:
            self._thread.join()
        self._lead.end()
        if self.error is not None:
            raise self.error
        if self.answers == 0 and self.unanswered > 0:
            warnings.warn(f"the callback gave back None for all {self.unanswered} ticks, so nothing was pushed: is a "
                          "return missing?", stacklevel=2)
        if self.late > 0:
            warnings.warn(f"{self.late} of {self.answers} answers came more than 20 ms after their tick and were "
                          "ignored: the callback takes too long", stacklevel=2)

    def __enter__(self) -> "ForceThread":
        return self

    def __exit__(self, *_: object) -> None:
        self.end()
