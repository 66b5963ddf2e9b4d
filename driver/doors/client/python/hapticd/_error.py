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
