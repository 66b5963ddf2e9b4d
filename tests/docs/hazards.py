#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Checks that every hazard of a page names a test, and that every test it names exists.

usage: hazards.py PAGE BUILD_DIR

A test is `PROGRAM: Suite.Name` (GoogleTest; the program lies in BUILD_DIR/tests) or `PROGRAM` (a test of ctest).
Exit 1: a row without a test, or a test that is not there. Exit 77: all that could be looked at is well, but a program
is not built.
"""
import json
import pathlib
import re
import subprocess
import sys

ROW = re.compile(r"^\| *([A-Z]+\d+) *\|.*\| *([^|]*) *\|$")


def rows_of(page):
    """The number of each hazard, and the tests in its last column."""
    for line in page.read_text().splitlines():
        if found := ROW.match(line):
            yield found.group(1), re.findall(r"`([^`]+)`", found.group(2))


def tests_of_ctest(build):
    """Name and command of each test that ctest knows."""
    done = subprocess.run(["ctest", "--test-dir", build, "--show-only=json-v1"], capture_output=True, text=True, check=True)
    return {test["name"]: test.get("command") for test in json.loads(done.stdout)["tests"]}


def tests_of_program(program):
    """Suite.Name of each test in a GoogleTest program, without what parameters add to it; disabled ones are none."""
    done = subprocess.run([program, "--gtest_list_tests"], capture_output=True, text=True, check=True)
    names, suite = set(), ""
    for line in done.stdout.splitlines():
        word = line.split("#")[0].strip()
        if not line.startswith(" "):
            suite = word.rstrip(".").split("/")[-1] if "/" in word else word.rstrip(".")
        elif "DISABLED_" not in suite + word:
            names.add(f"{suite}.{word.split('/')[0]}")
    return names


def main(page, build):
    known, listed, problems, missing, count = tests_of_ctest(build), {}, [], set(), 0
    for number, tests in rows_of(page):
        count += 1
        if not tests:
            problems.append(f"{number}: names no test; expected `PROGRAM: Suite.Name` in its last column")
        for test in tests:
            program, _, name = (part.strip() for part in test.partition(":"))
            if program not in known:
                problems.append(f"{number}: ctest knows no test '{program}'")
                continue
            if not name:
                continue
            file = build / "tests" / program
            if not file.exists():
                missing.add(program)
                continue
            listed.setdefault(program, None)
            if listed[program] is None:
                listed[program] = tests_of_program(file)
            if name not in listed[program]:
                problems.append(f"{number}: {program} has no test {name}")
    if count == 0:
        problems.append(f"{page}: no hazards found; expected rows that begin with | H1 |")
    for problem in problems:
        print(problem)
    if not problems:
        print(f"{count} hazards, {len(listed)} programs of tests")
    for program in sorted(missing):
        print(f"not built: {program}")
    return 1 if problems else 77 if missing else 0


if __name__ == "__main__":
    sys.exit(main(pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])))
