#!/usr/bin/env python3
"""Files with several mistakes of different kinds: one run of check tells all of them at their lines, and accuses nothing that is right.

A line of a file that ends with "# tell: WORDS && WORDS" must be told with each of the words, as a problem or as a warning; no other line may be
told. Tables, which have no comments at the end of a line, have lines "#> LINE: WORDS" instead.

Usage: all_at_once.py HAPTICD FOLDER       prints a line a file; exit 1 when one is off
"""
import glob
import os
import re
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "support"))
from e2e import check, finish, program

HAPTICD, FOLDER = sys.argv[1], os.path.abspath(sys.argv[2])
hapticd = program(HAPTICD)


def wanted(file):
    """The words by file and line: those of the file, and of the files in data/ that it names."""
    found = {}
    text = open(file).read()
    for number, line in enumerate(text.splitlines(), 1):
        if mark := re.search(r"# tell: (.*)$", line):
            found[file, number] = mark[1].split(" && ")
        if mark := re.match(r"#> (\d+): (.*)$", line):
            found.setdefault((file, int(mark[1])), []).append(mark[2])
    for name in re.findall(r"data/[\w.-]+", text):
        found.update(wanted(os.path.join(FOLDER, name)))
    return found


def told(file):
    done = hapticd("check", file)
    lines = {}
    for line in done.stdout.splitlines():
        if place := re.match(r"(/.*?):(\d+):\d+: (.*)$", line):
            lines.setdefault((os.path.realpath(place[1]), int(place[2])), []).append(place[3])
    return done, lines


files = sorted(glob.glob(os.path.join(FOLDER, "*.yaml")))
check("sixty of them", len(files) >= 60, len(files))
for file in files:
    done, lines = told(file)
    words = wanted(file)
    missing = [f"{os.path.basename(at)}:{line}: {one}" for (at, line), all in words.items() for one in all
               if not any(one in text for text in lines.get((os.path.realpath(at), line), []))]
    known = {(os.path.realpath(at), line) for at, line in words}
    more = [f"{os.path.basename(at)}:{line}: {text}" for (at, line), texts in lines.items() if (at, line) not in known for text in texts]
    check(os.path.basename(file), done.returncode in (0, 2) and words and not missing and not more, f"missing {missing}, more {more}\n{done.stdout}{done.stderr}")
finish()
