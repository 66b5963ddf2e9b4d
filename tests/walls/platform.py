#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""What runs in virtual time needs no operating system: outside of *_posix files, these rooms include the standard library,
a few portable libraries and each other, and nothing else.

Usage: platform.py SOURCE_DIR
"""
import pathlib
import re
import sys

ROOMS = ["driver/base", "driver/document", "driver/elementary", "driver/include", "driver/daemon/description",
         "driver/daemon/drawing", "driver/daemon/host", "driver/daemon/link", "driver/daemon/scene", "driver/daemon/servo", "driver/daemon/sim",
         "driver/daemon/world", "plugins", "devices/simulated", "devices/support/kinematics"]
# First part of an #include "..." that leads into another folder than these rooms.
FOREIGN = {"control", "log", "record", "session", "status", "watch", "cli", "wire_arm", "codec", "vendor_arm"}
PORTABLE = re.compile(r"(Eigen|nlohmann|yaml-cpp|fmt)/|sanitizer/rtsan_interface\.h$|std(int|def)\.h$")
STANDARD = re.compile(r"[a-z_]+$")  # the C++ library: a name without a folder or an ending
OF_C = re.compile(r"(math|stdlib|string)\.h$")  # the C library, for files in plain C
NOT_PORTABLE = {"csignal", "thread", "semaphore"}  # standard, but there may be neither signals nor threads


def problem_of(line, plain_c=False):
    """Why a line may not stand in these rooms; "": it may."""
    system = re.match(r"\s*#\s*include\s*<([^>]+)>", line)
    own = re.match(r'\s*#\s*include\s*"([^"]+)"', line)
    of_c = system and plain_c and OF_C.match(system[1])
    if system and not of_c and not PORTABLE.match(system[1]) and (not STANDARD.match(system[1]) or system[1] in NOT_PORTABLE):
        return f"includes <{system[1]}>, which is the operating system's"
    if own and (own[1].split("/")[0] in FOREIGN or "_posix" in own[1]):
        return f'includes "{own[1]}", which needs an operating system'
    return ""


def check(source):
    wrong, count = [], 0
    for room in ROOMS:
        files = [f for f in (source / room).rglob("*") if f.suffix in (".hpp", ".cpp", ".h", ".c") and "_posix" not in f.name]
        if not files:
            wrong.append(f"{room}: has no sources, expected a room")
        count += len(files)
        for file in files:
            for number, line in enumerate(file.read_text().splitlines(), 1):
                if problem := problem_of(line, file.suffix == ".c"):
                    wrong.append(f"{file.relative_to(source)}:{number}: {problem}\n  fix: put it into a *_posix.cpp behind a header of ours")
    print(f"{count} files of {len(ROOMS)} rooms")
    return wrong


def check_itself():
    """Lines that must be found, and lines that must not."""
    bad = ["#include <unistd.h>", "#include <sys/stat.h>", "# include <pthread.h>", "#include <dlfcn.h>", "#include <csignal>",
           '#include "base/fatal_signals_posix.hpp"', '#include "session/run/runner.hpp"', "#include <time.h>"]
    good = ["#include <cmath>", "#include <Eigen/Core>", '#include "base/os.hpp"', "#include <stdint.h>", "#include <filesystem>"]
    of_c = ["#include <math.h>", "#include <string.h>"]
    missed = [line for line in bad if not problem_of(line) or not problem_of(line, plain_c=True)]
    return [f"not found: {line}" for line in missed + [line for line in of_c if not problem_of(line)]] + [f"refused: {line}" for line in of_c if problem_of(line, plain_c=True)] + [f"refused: {line}" for line in good if problem_of(line)]


def main():
    wrong = check_itself() + check(pathlib.Path(sys.argv[1]))
    print("\n".join(wrong))
    return 1 if wrong else 0


sys.exit(main())
