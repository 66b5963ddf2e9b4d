# SPDX-License-Identifier: MIT
"""What can go wrong."""
from __future__ import annotations


class HapticdError(Exception):
    """The daemon is not there, went away, or what it says cannot be understood."""


class Refused(HapticdError):
    """The daemon answered that it will not do it. `code` is one word for programs, the text is for people."""

    def __init__(self, text: str, code: str = "failed") -> None:
        super().__init__(text)
        self.code = code


class NoForceWarning(UserWarning):
    """A program pushes on an arm that gets no force: a fault is latched, or somebody holds it. The text says what to do."""


class Named(dict):  # type: ignore[type-arg]
    """A dictionary that says what there is where a name is not found."""

    def __init__(self, what: str, *parts: object) -> None:
        super().__init__(*parts)
        self._what = what

    def __missing__(self, name: object) -> None:
        raise KeyError(f"there is no {self._what} {name!r}; expected one of: {', '.join(map(str, self)) or 'there are none'}")
