# SPDX-License-Identifier: MIT
"""The exceptions and warnings of this package."""
from __future__ import annotations

from typing import Iterable


class HapticdError(Exception):
    """There is no daemon, it has ended, or its answer cannot be understood."""


class Refused(HapticdError):
    """The daemon refused a request. `code` is one word for programs, the text is for people."""

    def __init__(self, text: str, code: str = "failed") -> None:
        super().__init__(text)
        self.code = code


class NoForceWarning(UserWarning):
    """A program pushes on an arm that gets no force: a fault is latched, or somebody holds it. The text says what to do."""


def meant(name: object, known: Iterable[object]) -> str:
    """Returns ' (did you mean "stiffness"?)', or "" if no known name is similar."""
    import difflib  # only after a mistake, because the import takes time
    similar = difflib.get_close_matches(str(name), [str(one) for one in known], 1)
    return f' (did you mean "{similar[0]}"?)' if similar else ""


class Named(dict):  # type: ignore[type-arg]
    """A dictionary whose error for an unknown name lists the known names."""

    def __init__(self, what: str, *parts: object) -> None:
        super().__init__(*parts)
        self._what = what

    def __missing__(self, name: object) -> None:
        known = f"expected one of: {', '.join(map(str, self))}{meant(name, self)}" if self else "nor any other"
        raise KeyError(f"there is no {self._what} {name!r}, {known}")
