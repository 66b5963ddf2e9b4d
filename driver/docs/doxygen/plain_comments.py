#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Prints a C header with the comment marks that Doxygen looks for, as its input filter.

A comment on lines of its own documents what follows. Behind code it documents what stands before it, and behind the
opening brace of a struct, the struct. The comment that begins with the file's name documents the file. Titles of sections
(`/* ---- ... */`), the licence and comments within a list of arguments stay plain. The number of lines does not change."""
import pathlib
import re
import sys

COMMENT = re.compile(r"(?P<code>[^\n]*?)/\*(?![*!])(?P<body>.*?)\*/", re.DOTALL)


def mark(match, name):
    code, body = match["code"], match["body"]
    if body.startswith((" ----", " SPDX")) or code.rstrip().endswith(("(", ",")) and code.count("(") > code.count(")"):
        return match[0]
    body = re.sub(r"^ >", r" \\>", body)  # Markdown takes it for a quotation
    if body.lstrip().startswith(f"{name} -"):
        return f"/** @file {name} @brief {body.lstrip()[len(name):].lstrip(' -')}*/"
    if code.rstrip().endswith("{"):
        return f"/**{body}*/ {code}"
    return f"{code}/**{'<' if code.strip() else ''}{body}*/"


def filtered(text, name):
    return COMMENT.sub(lambda match: mark(match, name), text)


if __name__ == "__main__":
    file = pathlib.Path(sys.argv[1])
    sys.stdout.write(filtered(file.read_text(), file.name))
