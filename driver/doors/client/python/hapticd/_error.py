# SPDX-License-Identifier: MIT
"""The exceptions and warnings of this package."""
from __future__ import annotations

import os
import sys
from typing import Any, Iterable


CLOSED = ("this client is closed, by close() or because its with block has ended"
          "\n  fix: read within the block, or connect again")


class HapticdError(Exception):
    """There is no daemon, it has ended, or its answer cannot be understood. `code` is one word for programs, as in C:
    `gone` (no daemon runs under the name, or the daemon has ended), `damaged`, `timeout`, `too_many`, `closed` (by this
    program) or `failed`. `stopped` is True if the daemon ended in order, and False if it was killed or crashed."""

    def __init__(self, text: str, code: str = "failed", stopped: bool = False) -> None:
        super().__init__(text)
        self.code, self.stopped = code, stopped


class Refused(HapticdError):
    """The daemon refused a request. `code` is one of the words of control.md, the text is for people."""


class NoForceWarning(UserWarning):
    """A program pushes on an arm that gets no force (a fault is latched, or somebody holds it), or has enabled a model that
    gives none, because a tip is inside it. The text says what to do."""


def known(kind: Any, facts: dict[str, Any]) -> Any:
    """Makes a dataclass of what the daemon said. A newer daemon may say more."""
    return kind(**{field: facts[field] for field in kind.__dataclass_fields__})


def caller() -> tuple[str, int]:
    """Returns the file and the line of the program that called this package, for warnings."""
    frame = sys._getframe()
    while frame.f_back is not None and os.path.dirname(frame.f_code.co_filename) == os.path.dirname(__file__):
        frame = frame.f_back
    return frame.f_code.co_filename, frame.f_lineno


def meant(name: object, known: Iterable[object]) -> str:
    """Returns ' (did you mean "stiffness"?)', or "" if no known name is similar."""
    import difflib  # only after a mistake, because the import takes time
    similar = difflib.get_close_matches(str(name), [str(one) for one in known], 1)
    return f' (did you mean "{similar[0]}"?)' if similar else ""


class UnknownName(KeyError):
    """A KeyError whose text is not printed with quotes and backslashes."""

    def __str__(self) -> str:
        return str(self.args[0])


class Named(dict):  # type: ignore[type-arg]
    """A dictionary whose error for an unknown name lists the known names."""

    def __init__(self, what: str, *parts: object) -> None:
        super().__init__(*parts)
        self._what = what

    def __missing__(self, name: object) -> None:
        known = f"expected one of: {', '.join(map(str, self))}{meant(name, self)}" if self else "nor any other"
        raise UnknownName(f"there is no {self._what} {name!r}, {known}")
