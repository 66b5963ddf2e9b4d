#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Proves that the walls between rooms hold.

Usage: walls.py SOURCE_DIR BUILD_DIR

1. A file that includes across a wall finds no header, with the flags of a real file of that room.
2. The rooms form no cycle.
3. No source reaches another folder by "../".
4. A library whose headers cost seconds is included by one source alone.
"""
import json
import pathlib
import re
import shlex
import subprocess
import sys

# A file of the room, a header that it may include, and headers that it may not.
WALLS = [
    ("devices/usb_hid/usb_hid.cpp", "wire_arm/session.hpp", ["servo/core/core.hpp", "host/catalog.hpp", "session/run/runner.hpp"]),
    ("devices/support/kinematics/arm.cpp", "kinematics/arm.hpp", ["base/os.hpp", "hapticd/device.h"]),
    ("plugins/nurbs_rigid/nurbs_rigid.cpp", "kernels/trace/model.hpp", ["servo/core/core.hpp", "host/catalog.hpp", "simulated/hand.hpp"]),
    ("plugins/kernels/part/check.cpp", "kernels/part/part.hpp", ["kernels/brep/geometry/geometry.hpp", "document/node.hpp"]),
    ("plugins/kernels/brep/tree/row_disc.cpp", "kernels/brep/geometry/geometry.hpp", ["kernels/brep/elements/elements.hpp", "kernels/brep/search/search.hpp"]),
    ("plugins/kernels/brep/search/near.cpp", "kernels/brep/model/model.hpp", ["kernels/brep/contact/tracer.hpp", "hapticd/shape.h"]),
    ("plugins/kernels/trace/model.cpp", "kernels/spline/surface.hpp", ["hapticd/shape.h", "document/node.hpp", "kernels/medial/skeleton.hpp"]),
    ("driver/document/node.cpp", "base/result.hpp", ["description/scene.hpp", "host/catalog.hpp", "scene/load.hpp"]),
    ("driver/daemon/host/catalog.cpp", "description/class_info.hpp", ["scene/load.hpp", "servo/core/core.hpp"]),
    ("driver/daemon/scene/load.cpp", "host/catalog.hpp", ["servo/core/core.hpp", "session/run/runner.hpp"]),
    ("driver/daemon/sim/proximity.cpp", "link/link.hpp", ["servo/core/core.hpp", "servo/loop/loop.hpp"]),
    ("driver/daemon/servo/core/core.cpp", "servo/safety/guard.hpp", ["record/recording.hpp", "control/server.hpp", "servo/arm/arm.hpp", "sim/proximity.hpp", "scene/load.hpp"]),
    ("driver/daemon/servo/loop/loop.cpp", "servo/arm/arm.hpp", ["session/telemetry/telemetry.hpp", "record/recording.hpp", "status/page.hpp", "watch/watchdog.hpp"]),
    ("driver/daemon/watch/watchdog.cpp", "watch/watch_target.hpp", ["servo/loop/loop.hpp", "session/run/runner.hpp"]),
    ("driver/daemon/control/server.cpp", "base/os.hpp", ["session/requests/request_handler.hpp", "servo/core/core.hpp"]),
    ("driver/daemon/world/world.cpp", "servo/core/core.hpp", ["session/run/runner.hpp", "record/recording.hpp", "scene/load.hpp"]),
    ("driver/command_line/command_line.cpp", "command_line/command_line.hpp", ["cli/support/command.hpp", "base/result.hpp", "host/catalog.hpp"]),
    ("driver/daemon/drawing/coarse_mesh.cpp", "hapticd/shape.h", ["host/shape_instance.hpp", "session/run/runner.hpp", "control/server.hpp"]),
    ("driver/daemon/session/messages/event_log.cpp", "session/telemetry/flight.hpp", ["session/replay/about.hpp", "session/run/runner.hpp"]),
    ("driver/daemon/session/replay/replay.cpp", "session/messages/setup_watch.hpp", ["session/run/runner.hpp", "session/requests/answers.hpp"]),
    ("driver/daemon/session/run/runner.cpp", "servo/loop/loop.hpp", ["session/requests/request_handler.hpp", "cli/support/command.hpp", "tune/knob.hpp", "kernels/trace/model.hpp"]),
    ("driver/tools/diagnostics/reading/unread_keys.cpp", "description/class_info.hpp", ["diagnostics/scene/given_model.hpp", "host/catalog.hpp", "scene/load.hpp"]),
    ("driver/tools/diagnostics/device/device_warnings.cpp", "diagnostics/reading/given_values.hpp", ["diagnostics/scene/model_trial.hpp", "diagnostics/hand/hand_script.hpp", "session/run/runner.hpp"]),
    ("driver/tools/diagnostics/scene/value_plausibility.cpp", "diagnostics/reading/key_place.hpp", ["diagnostics/device/arm_reach.hpp", "diagnostics/hand/hand_script.hpp"]),
    ("driver/tools/diagnostics/hand/hand_start.cpp", "diagnostics/scene/nearest_model.hpp", ["diagnostics/check/judge_file.hpp", "cli/support/command.hpp"]),
    ("driver/tools/diagnostics/check/judge_file.cpp", "diagnostics/hand/hand_start.hpp", ["diagnostics/machine/doctor_checks.hpp", "cli/support/command.hpp"]),
]


# Headers that take seconds to parse, and the one source that may include them.
ONE_PLACE = {"CLI/": "driver/command_line/command_line.cpp", "spdlog/": "driver/daemon/log/log.cpp"}


def finds(command, header):
    """Returns whether a file with this one include has all its headers, and what the compiler said. The preprocessor alone tells.

    A header that is installed in /usr/local is found from everywhere, so it does not count."""
    run = subprocess.run(command + ["-E", "-H", "-o", "/dev/null", "-x", "c++", "-"], input=f'#include "{header}"\n',
                         capture_output=True, text=True)
    place = next((line[2:] for line in run.stderr.splitlines() if line.startswith(". ")), "")
    if run.returncode == 0 and place.startswith("/usr/"):
        return False, f"{header}: No such file in the sources"
    said = "\n".join(line for line in run.stderr.splitlines() if not re.match(r"\.+ |[!x]", line))
    return run.returncode == 0, said


def flags_of(entry):
    """The compiler and its flags, without launcher, input and output."""
    words = shlex.split(entry["command"])
    start = next(i for i, word in enumerate(words) if re.search(r"(c\+\+|g\+\+|clang\+\+)(-\d+)?$", word))
    out, skip = [], False
    for word in words[start:]:
        if skip or word in ("-c", entry["file"]):
            skip = False
        elif word in ("-o", "-MF", "-MT", "-MD", "-include"):  # what is precompiled are headers of libraries
            skip = word != "-MD"
        else:
            out.append(word)
    return out


def entries_of(build):
    """What is compiled -> how. A unity build compiles files that include the sources."""
    entries = {}
    for entry in json.loads((build / "compile_commands.json").read_text()):
        file = pathlib.Path(entry["file"])
        included = re.findall(r'#include "(.+)"', file.read_text()) if "/Unity/" in entry["file"] else [file]
        entries.update({pathlib.Path(one).resolve(): entry for one in included})
    return entries


def check_walls(source, build):
    entries = entries_of(build)
    wrong = []
    for file, allowed, forbidden in WALLS:
        entry = entries.get((source / file).resolve())
        if entry is None:
            wrong.append(f"{file}: is not compiled, expected a file of the build")
            continue
        command = flags_of(entry)
        good, said = finds(command, allowed)
        if not good:
            wrong.append(f"{file}: cannot include {allowed}, which it should: {said.splitlines()[0]}")
        for header in forbidden:
            if not list(source.rglob("*/" + header)):
                wrong.append(f"{header}: is nowhere in the sources, so the wall of {file} is not tested")
            good, said = finds(command, header)
            if good or f"{header}: No such file" not in said and f"'{header}' file not found" not in said:
                wrong.append(f"{file}: can include {header}, expected a wall")
    return wrong


def rooms_of(source, build):
    """Include prefix -> folder of every room, from the links in the build folder."""
    rooms = {}
    for root in (build / "rooms").iterdir():
        for link in root.rglob("*"):
            if link.is_symlink():
                rooms[str(link.relative_to(root))] = link.resolve()
    return rooms


def check_cycles(source, build):
    rooms = rooms_of(source, build)
    arrows = {name: set() for name in rooms}
    for name, folder in rooms.items():
        for file in list(folder.glob("*.cpp")) + list(folder.glob("*.hpp")):
            for header in re.findall(r'#include "([^"]+)/[^"/]+"', file.read_text()):
                if header in rooms and header != name:
                    arrows[name].add(header)
    done, path, wrong = set(), [], []

    def walk(room):
        if room in path:
            wrong.append("rooms include each other: " + " -> ".join(path[path.index(room):] + [room]))
            return
        if room in done:
            return
        path.append(room)
        for other in sorted(arrows[room]):
            walk(other)
        path.pop()
        done.add(room)

    for room in sorted(arrows):
        walk(room)
    print(f"{len(arrows)} rooms, {sum(map(len, arrows.values()))} arrows")
    return wrong


def check_paths(source):
    wrong = []
    for top in ("driver", "plugins", "devices"):
        for file in (source / top).rglob("*.[ch]pp"):
            if re.search(r'#include "\.\./', file.read_text()):
                wrong.append(f'{file.relative_to(source)}: includes by "../", which goes round every wall')
    return wrong


def check_one_place(source):
    """A header of ONE_PLACE is included where it should be, and nowhere else."""
    wrong, seen = [], set()
    for top in ("driver", "plugins", "devices", "tests"):
        for file in [f for ending in ("cpp", "hpp", "h") for f in (source / top).rglob("*." + ending)]:
            name = str(file.relative_to(source))
            for library, place in ONE_PLACE.items():
                if f"#include <{library}" not in file.read_text():
                    continue
                seen.add(library)
                if name != place:
                    wrong.append(f"{name}: includes <{library}...>, expected in {place} alone\n  fix: use the header beside that file")
    return wrong + [f"<{library}...>: is included nowhere, so {place} proves nothing" for library, place in ONE_PLACE.items() if library not in seen]


def main():
    source, build = map(pathlib.Path, sys.argv[1:3])
    wrong = check_walls(source, build) + check_cycles(source, build) + check_paths(source) + check_one_place(source)
    print("\n".join(wrong) if wrong else f"{sum(len(w[2]) for w in WALLS)} includes across walls find no header")
    return 1 if wrong else 0


sys.exit(main())
