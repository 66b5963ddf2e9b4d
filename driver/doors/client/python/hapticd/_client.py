# SPDX-License-Identifier: MIT
"""The connection to a daemon."""
from __future__ import annotations

import array
import fcntl
import math
import mmap
import os
import time
import warnings
from typing import Any, Callable, Iterator, Optional, Sequence

from ._error import CLOSED, HapticdError, Named, NoForceWarning, Refused, caller, meant
from ._folder import runtime_folder
from ._lead import LEAD_BYTES, ForceLead, PoseLead
from ._line import Line
from ._models import Model
from ._push import ForceThread
from ._rows import BlackBox, Stream
from ._state import BELL_BYTES, Bell, State, StatePage

_TAKES_TO_END = 0.5  # s: at most, until a process whose sockets are closed has ended


class Events:
    """An iterator over the events of a daemon, as they happen."""

    def __init__(self, line: Line, patience: float, timeout: Optional[float], died: Callable[[], bool]) -> None:
        self._line, self._timeout, self._died = line, timeout, died
        line.say({"do": "subscribe"})
        answer = line.hear(patience)
        if answer is None or not answer.get("ok"):
            line.close()
            raise Refused((answer or {}).get("error", "no answer"), (answer or {}).get("code", "timeout"))

    def __iter__(self) -> "Events":
        return self

    def __next__(self) -> dict[str, Any]:
        try:
            event = self._line.hear(self._timeout)
        except HapticdError:
            self.close()
            if self._died():
                raise HapticdError("the daemon is gone: it was killed, or it crashed", "gone") from None
            raise StopIteration from None
        if event is None:
            self.close()
            raise StopIteration
        return event

    def close(self) -> None:
        """Ends the subscription."""
        self._line.close()


class Client:
    """A connection to a running daemon. Its leads end with it. Only one thread at a time may use it."""

    def __init__(self, name: str = "hapticd", folder: Optional[str] = None, timeout: float = 10) -> None:
        if not isinstance(name, str):
            raise TypeError(f"connect() expects the name of a daemon (hapticd run --name NAME), got {name!r}")
        self.name, self.timeout = name, timeout
        self._folder = folder or runtime_folder(name)
        self._base = os.path.join(self._folder, name)
        self._line = Line(self._base + ".sock")
        try:
            self._box = BlackBox(self._base + ".blackbox.h5")
            self._box_file = self._file_of_box()
        except HapticdError:
            self._line.close()
            raise
        self._asked = 0
        self._states: Optional[StatePage] = None
        self._rings: Optional[Bell] = None

    # ---- rows

    @property
    def about(self) -> dict[str, Any]:
        """The daemon's description of itself: versions, scene, devices, and unit and meaning of every column."""
        return self._box.about

    @property
    def streams(self) -> dict[str, Stream]:
        """All streams, by name."""
        return self._box.streams

    def rows(self, stream: str = "ticks", last: int = 1000) -> Any:
        """Returns the newest rows of a stream, oldest first, as a numpy structured array. Raises HapticdError if the daemon has
        ended, because its rows are old then (`streams[stream].last(last)` still reads them)."""
        self._check()
        return self._box.streams[stream].last(last)

    def follow(self, stream: str = "ticks", timeout: Optional[float] = None, pause: float = 0.01) -> Iterator[Any]:
        """Yields new rows as arrays of one row or more. There are no gaps if the caller takes each array before its rows
        are overwritten. It ends with the daemon, or if no row came for `timeout` seconds. If the daemon was killed or
        crashed, it raises HapticdError after the last row."""
        rows = self._box.streams[stream]
        at, since = rows.written, time.monotonic()
        while True:
            at, news = rows.read(at)
            if len(news):
                at += len(news)
                since = time.monotonic()
                yield news
            elif self.died():
                raise self._gone()
            elif timeout is not None and time.monotonic() - since > timeout or self.ended():
                return
            else:
                time.sleep(pause)

    def alive(self) -> bool:
        """Returns whether the daemon runs: a running daemon holds the lock on its name."""
        try:
            with open(self._base + ".lock", "rb") as lock:
                fcntl.flock(lock, fcntl.LOCK_SH | fcntl.LOCK_NB)
                return False
        except PermissionError:  # the lock belongs to another user, so only the socket shows whether the daemon runs
            return os.path.exists(self._base + ".sock")
        except BlockingIOError:
            return True
        except OSError:
            return False

    def _file_of_box(self) -> Optional[tuple[int, int]]:
        try:
            info = os.stat(self._base + ".blackbox.h5")
            return info.st_dev, info.st_ino
        except OSError:
            return None

    def ended(self) -> bool:
        """Returns whether the daemon of this client has ended, even if another daemon has its name now. It also is after
        `close`."""
        return (self._line.closed() or self._line.ended()) and (
            self._box.ended() or self._file_of_box() != self._box_file or not self.alive())

    def died(self) -> bool:
        """Returns whether the daemon was killed or crashed. It is False while the daemon runs, and after it ended in order
        (`hapticd ctl stop`, Ctrl-C, the end of `--for`)."""
        # An older daemon does not note its end, but it removes its socket if it ends in order.
        return self.ended() and not self._box.ended() and os.path.exists(self._base + ".sock")

    def _ends(self) -> bool:
        """Like ended(), for a connection that has just ended: a process that is killed closes its sockets before it frees
        its name, so this waits a little."""
        end = time.monotonic() + _TAKES_TO_END
        while not self.ended() and time.monotonic() < end:
            time.sleep(0.01)
        return self.ended()

    def _gone(self) -> HapticdError:
        died = self.died()
        return HapticdError(f"the daemon is gone: {self.name} " + ("was killed, or it crashed" if died else "has ended")
                            + "\n  fix: start it again with hapticd run, then connect again", "gone", not died)

    def _check(self) -> None:
        if self._line.closed():
            raise HapticdError(CLOSED, "closed")
        if self.ended():
            raise self._gone()

    # ---- requests

    def ask(self, **request: Any) -> dict[str, Any]:
        """Sends any request of control.md, such as ask(do="set", model="teapot", ...). Raises Refused if the daemon
        refuses it."""
        self._asked += 1
        try:
            return self._answered(dict(request, id=self._asked))
        except Refused:
            raise
        except HapticdError:
            if lost := self._lost():
                raise lost from None
            raise

    def _answered(self, request: dict[str, Any]) -> dict[str, Any]:
        self._line.say(request)
        end = time.monotonic() + self.timeout
        while True:
            left = end - time.monotonic()
            answer = self._line.hear(max(left, 0))
            if answer is None or (left < 0 and answer.get("id") != self._asked):
                raise HapticdError(f"the daemon did not answer within {self.timeout:g} s; it may hang\n  fix: hapticd ctl status, or connect with a longer timeout", "timeout")
            if answer.get("id") != self._asked:
                continue  # an answer that came too late, after its request had timed out
            if not answer.get("ok"):
                raise Refused(answer.get("error", "refused"), answer.get("code", "failed"))
            return answer

    @property
    def models(self) -> dict[str, Model]:
        """The models and their present state, by name."""
        answer = self.ask(do="list")
        try:
            return Named("model", {facts["name"]: Model(self, facts) for facts in answer["models"]})
        except (KeyError, TypeError) as error:
            raise HapticdError(f"the daemon's list of models cannot be understood: {error!r}; it may be of another version", "damaged") from None

    def status(self) -> dict[str, Any]:
        """Returns the daemon's status: time, missed ticks, devices with their faults, models that are not felt."""
        return self.ask(do="status")

    def snapshot(self) -> dict[str, Any]:
        """Returns a point at which to begin to read: the next row of each stream, every model with its pose, every device."""
        return self.ask(do="snapshot")

    def hold(self, device: Optional[str] = None) -> None:
        """Ramps the force of a device out until the hold is cleared. Without a name, it does so for all devices."""
        self.ask(do="hold", **({"device": device} if device else {}))

    def clear(self, device: Optional[str] = None) -> None:
        """Clears a latched fault or a hold: the force ramps in."""
        self.ask(do="clear", **({"device": device} if device else {}))

    def mark(self, text: str) -> int:
        """Writes a text of at most 95 bytes into the recording, the black box and the events, such as "trial 7 begins".
        Returns the number of the tick that has it."""
        if not isinstance(text, str):
            raise TypeError(f"mark() expects a text, got {text!r}")
        return self.ask(do="mark", text=text)["tick"]

    def events(self, timeout: Optional[float] = None) -> "Events":
        """Returns the events from now on, as an iterator over dicts with `event`, `tick`, `t` and further keys of the
        event. It ends with the daemon, or if no event came for `timeout` seconds. It raises HapticdError if the
        daemon was killed or crashed. It uses a separate connection."""
        return Events(Line(self._base + ".sock"), self.timeout, timeout, lambda: self._ends() and self.died())

    # ---- leads

    def lead_model(self, model: str) -> PoseLead:
        """Leads a kinematic model: it follows with at most 1 m/s and 20 m/s^2."""
        return self._lead({"model": model})

    def lead_hand(self, device: str) -> PoseLead:
        """Leads the hand of a simulated arm whose script is `guided`."""
        return self._lead({"hand": device})

    def _lead(self, target: dict[str, str]) -> PoseLead:
        answer = self._begin(target)
        return PoseLead(self._line.memory(answer, LEAD_BYTES), lambda: self._unlead(target), self._lost_lead)

    def _begin(self, target: dict[str, str]) -> dict[str, Any]:
        try:
            return self.ask(do="lead", **target)
        except Refused:
            raise
        except HapticdError:
            if not self._line.ended():
                self._line.say({"do": "unlead", **target})  # the lead may have begun, so it is ended
            raise

    def lead_force(self, device: str) -> ForceLead:
        """Pushes on the hand of an arm, tick by tick; `push` does it in a thread. The scene must allow it (`clients`).
        Warns (NoForceWarning) if the arm gets no force now, and once if a force is larger than the scene allows."""
        target = {"force": device}
        answer = self._begin(target)
        if answer.get("no_force"):
            warnings.warn_explicit(answer["no_force"], NoForceWarning, *caller())
        return ForceLead(self._line.memory(answer, LEAD_BYTES), lambda: self._unlead(target), self._lost_lead,
                         answer.get("max_force", math.inf))

    def _lost_lead(self) -> Optional[HapticdError]:
        """Returns why the leads of this connection have no effect any more, or None if they have."""
        if not self._line.ended():
            return None
        return self._gone() if self._ends() else HapticdError("the daemon closed the connection, which ended this lead; connect again", "too_many")

    def _lost(self) -> Optional[HapticdError]:
        """Returns why no answer can come on this connection, or None if one may still come."""
        if not self._line.ended():
            return None
        if self._ends() or not os.path.exists(self._base + ".sock"):
            return self._gone()
        return HapticdError("the daemon closed this connection, because it was silent and other programs needed its place\n"
                            "  fix: connect again", "too_many")

    def _no_force(self, device: str) -> str:
        """[any thread] Returns the daemon's reason why an arm gets no force now, or "" if it gets its force. It is "" too
        if the run ends, because nobody need do anything about that."""
        line = Line(self._base + ".sock")
        try:
            line.say({"do": "status"})
            answer = line.hear(self.timeout) or {}
        finally:
            line.close()
        return "" if answer.get("ends") else next((d.get("no_force") or "" for d in answer.get("devices", []) if d["name"] == device), "")

    def push(self, device: str, callback: Callable[[State], Optional[Sequence[float]]], priority: int = 70) -> ForceThread:
        """Calls `callback(state)` once per tick in a separate thread (SCHED_FIFO `priority` if that is allowed); the
        force [N, world frame] that it returns is added to the force of the models. Warns (NoForceWarning) if the arm gets
        no force now, and each time this begins."""
        return ForceThread(self, device, callback, priority)

    def state(self, device: str) -> State:
        """Returns the state of the arm in the newest tick. The first call waits for the next tick, at most `timeout` of
        the client. Raises HapticdError if the daemon has ended, because its newest tick is old then."""
        self._check()
        if self._states is None:
            self._states = self._state_page()
        end, seen = time.monotonic() + self.timeout, 0
        while (state := self._states.read(self._arm(device))) is None:
            if time.monotonic() > end:
                raise HapticdError(f"the daemon reported no tick within {self.timeout:g} s; it may have ended", "timeout")
            seen = self._ring().wait("state", seen, 0.1)
        return state

    def _state_page(self) -> StatePage:
        answer = self.ask(do="state")
        return StatePage(self._line.memory(answer, mmap.PAGESIZE, prot=mmap.PROT_READ))

    def _bell(self) -> Bell:
        answer = self.ask(do="bell")
        return Bell(self._line.memory(answer, BELL_BYTES))

    def _arm(self, device: str) -> int:
        names = [d["name"] for d in self.about["devices"]]
        if device not in names:
            raise Refused(f"there is no device {device!r}, expected one of: {', '.join(names)}{meant(device, names)}", "unknown")
        return names.index(device)

    @property
    def devices(self) -> list[str]:
        """The names of the arms, in the order of the columns arm0_, arm1_, ..."""
        return [d["name"] for d in self.about["devices"]]

    def wait(self, tick: int, timeout: float = 1.0) -> bool:
        """Sleeps until the rows of this tick are written, at most `timeout` seconds. Returns True if they are. Raises
        HapticdError if the daemon ends before."""
        end = time.monotonic() + timeout
        rows = self._box.streams["ticks"]
        seen = rows.written
        while seen <= tick and (left := end - time.monotonic()) > 0:
            self._check()
            self._ring().wait("rows", seen, min(left, 0.1))
            seen = rows.written
        return seen > tick

    def _ring(self) -> Bell:
        if self._rings is None:
            self._rings = self._bell()
        return self._rings

    def _unlead(self, target: dict[str, str]) -> None:
        try:
            self.ask(do="unlead", **target)
        except Refused:
            pass  # it has ended with the model

    def close(self) -> None:
        """Ends all leads of this connection. After it only `about`, `devices`, `alive`, `ended` and `died` can be asked."""
        self._line.close()
        for memory in (self._states, self._rings):
            if memory is not None:
                memory.close()
        self._box.close()

    def __enter__(self) -> "Client":
        return self

    def __exit__(self, kind: object, *_: object) -> None:
        gone = self._gone() if kind is None and self.died() else None
        self.close()
        if gone:
            raise gone


def connect(name: str = "hapticd", folder: Optional[str] = None, timeout: float = 10, wait: float = 0) -> Client:
    """Connects to the daemon `name`. `folder` is its runtime folder, which is found if it is not given; `timeout` is
    the longest time for an answer in seconds. If no daemon of this name runs yet, it tries again for `wait` seconds."""
    end = time.monotonic() + wait
    while True:
        try:
            return Client(name, folder, timeout)
        except HapticdError:
            if time.monotonic() >= end:
                raise
        time.sleep(0.02)
