#!/usr/bin/env python3
"""The page has words for every number of a fault and of a silenced model, and for every kind of event. Usage: words.py SOURCE"""
import os
import re
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "support"))
from e2e import check, finish

SOURCE = sys.argv[1]


def text_of(*parts):
    with open(os.path.join(SOURCE, "driver", *parts), encoding="utf-8") as file:
        return file.read()


def members(text, name):
    """The names of a C++ enumeration whose values count from 0."""
    body = re.sub(r"///.*|//.*", "", re.search(rf"enum class {name} : \w+ {{(.*?)}};", text, re.S)[1])
    return re.findall(r"k\w+", body)


def words(name):
    """The texts of a list of events.js."""
    return re.findall(r"'((?:[^'\\]|\\.)*)'", re.search(rf"const {name} = \[(.*?)\];", EVENTS, re.S)[1])


EVENTS = text_of("doors", "view", "page", "src", "events.js")
for name, enumeration, file in (("kFaults", "Fault", ("daemon", "servo", "safety", "fault.hpp")),
                                ("kSilenced", "ShapeFault", ("daemon", "servo", "safety", "guard.hpp"))):
    known, told = members(text_of(*file), enumeration), words(name)
    check(f"{name}: words for all of {enumeration}", len(told) == len(known), (len(told), known))
kinds = re.findall(r'"(\w+)"', re.search(r"kNames\[\] = {(.*?)};", text_of("daemon", "session", "telemetry", "event_finder.cpp"), re.S)[1])
described = re.findall(r"^  (\w+): {sort", EVENTS, re.M)
check("every kind of event has a sort and words", sorted(kinds) == sorted(described), (kinds, described))
finish()
