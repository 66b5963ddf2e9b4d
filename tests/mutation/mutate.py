#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Changes the servo's safety code one operator, constant or condition at a time, and counts what its tests notice.

usage: mutate.py BUILD_DIR [--count 300] [--seed 1] [--report FILE.md] [--list] [--only FILE]

Each mutant compiles one file (without optimisation, with a precompiled header) and links the program safety_test anew,
which must have been built before:  ninja -C BUILD_DIR safety_test
A mutant is killed when a test fails, crashes or does not end. What does not compile is not counted. Mutants that change
nothing that anybody can see stand in explained.txt beside this file, each with the reason; they are told apart. An
explanation of a mutant that does not exist, or that a test kills, is an error.
--only runs those of the sample that FILE names (lines of --list, or of a report).
Exit 1: fewer than 95 % of those that are not explained were killed, or explained.txt is wrong.
"""
import argparse
import collections
import json
import pathlib
import random
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
import time

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
SAFETY = "driver/daemon/servo/safety"
# The tests that look at a unit; others cannot notice it.
TESTS = {
    "claim": "Claim.*:PullsIn.*",
    "fault": "FaultWords.*",
    "guard": "Guard.*",
    "held_command": "HeldCommand.*",
    "limiter": "Limiter.*",
    "motor_heat": "MotorHeat.*",
    "power_bound": "PowerBound.*:Limiter.Power*",
    "sample_speed": "SampleSpeed.*",
}
SWAPS = [
    (r" <= ", " < "), (r" < ", " <= "), (r" >= ", " > "), (r" > ", " >= "), (r" == ", " != "), (r" != ", " == "),
    (r" && ", " || "), (r" \|\| ", " && "), (r" \+ ", " - "), (r" - ", " + "), (r" \* ", " / "), (r" / ", " * "),
    (r" \+= ", " -= "), (r" -= ", " += "), (r" \*= ", " /= "), (r"\+\+(?=\w)", "--"), (r"--(?=\w)", "++"),
    (r"std::min\b", "std::max"), (r"std::max\b", "std::min"), (r"(?<![\w!])!(?=[\w(])", ""),
    (r"(?<=[(,] )-(?=\w)", ""), (r"\btrue\b", "false"), (r"\bfalse\b", "true"), (r"\|= ", "&= "),
]
NUMBER = re.compile(r"(?<![\w.'\"])(\d+(?:\.\d+)?(?:e-?\d+)?)(?![\w.'\"])")
CONDITION = re.compile(r"\bif (?:constexpr )?\(")
Mutant = collections.namedtuple("Mutant", "file line column old new nth", defaults=[1])


def code_of(text):
    """The text with comments, strings and directives blanked, so that columns stay."""
    def blank(found):
        return re.sub(r"[^\n]", "~", found.group(0))
    pattern = r'//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\])*"|^\s*#[^\n]*|\bHSP_RT\b|static_assert[^;]*;|operator=|case [\w:]+:'
    return re.sub(pattern, blank, text, flags=re.S | re.M)


def closing(code, at):
    """Where the bracket that opens at `at` closes."""
    depth = 0
    for i in range(at, len(code)):
        depth += {"(": 1, ")": -1}.get(code[i], 0)
        if depth == 0:
            return i
    return None


def mutants_of(file):
    text = (ROOT / file).read_text()
    code = code_of(text)
    found = []

    def add(begin, end, new):
        line = text.count("\n", 0, begin) + 1
        found.append(Mutant(file, line, begin, text[begin:end], new))

    for pattern, new in SWAPS:
        for at in re.finditer(pattern, code):
            add(at.start(), at.end(), new)
    for at in NUMBER.finditer(code):
        value = at.group(1)
        add(at.start(), at.end(), "1" if float(value) == 0 else f"(2 * {value})")
    for at in CONDITION.finditer(code):
        opens = at.end() - 1
        if (closes := closing(code, opens)) and ";" not in code[opens:closes]:
            inside = text[opens + 1:closes]
            add(opens, closes + 1, f"(!({inside}))")
    counted, nth = collections.Counter(), {}
    for mutant in sorted(found, key=lambda m: m.column):  # which of the same changes in a line
        same = (mutant.line, mutant.old, mutant.new)
        counted[same] += 1
        nth[mutant] = counted[same]
    return [mutant._replace(nth=nth[mutant]) for mutant in found]


class Bench:
    """What is needed to make and to run a mutant."""

    def __init__(self, build):
        self.build = build
        self.work = pathlib.Path(tempfile.mkdtemp(prefix="mutants-"))
        compdb = subprocess.run(["ninja", "-C", build, "-t", "compdb"], capture_output=True, text=True, check=True)
        self.compiles = {}
        for entry in json.loads(compdb.stdout):
            file = pathlib.Path(entry["directory"], entry["file"]).resolve()
            if SAFETY in str(file) and str(file).startswith(str(ROOT)) and "-c" in entry["command"]:
                self.compiles[str(file.relative_to(ROOT))] = shlex.split(entry["command"])
        commands = subprocess.run(["ninja", "-C", build, "-t", "commands", "tests/safety_test"], capture_output=True,
                                  text=True, check=True).stdout.splitlines()
        link = next(line for line in reversed(commands) if "-o tests/safety_test" in line)
        self.link = shlex.split(re.sub(r"^: && | && :$", "", link))
        self.header()

    def compile_command(self, source, out, shadow):
        command = self.compiles[source][:]
        command = command[next(i for i, word in enumerate(command) if re.search(r"(g\+\+|c\+\+|clang\+\+)[-\d]*$", word)):]
        kept, skip = [], False
        for word in command:
            if skip or word.startswith("-O") or word in ("-Werror", "-c", "-MD"):
                skip = False
                continue
            if word in ("-o", "-MT", "-MF"):
                skip = True
                continue
            if word.endswith(".cpp"):
                continue
            kept.append(word)
        return kept[:1] + [f"-I{shadow}"] + kept[1:] + ["-O0", "-w", "-o", str(out), "-c"]

    def header(self):
        """Eigen and the library, read once."""
        some = f"{SAFETY}/limiter.cpp"
        text = "#include <Eigen/Core>\n#include <algorithm>\n#include <array>\n#include <cmath>\n#include <vector>\n"
        header = self.work / "once.hpp"
        header.write_text(text)
        command = self.compile_command(some, self.work / "once.hpp.gch", self.work)
        subprocess.run(command + ["-x", "c++-header", str(header)], cwd=self.build, check=True)

    def run(self, mutant, seconds):
        """killed, survived or broken (does not compile)."""
        text = (ROOT / mutant.file).read_text()
        end = mutant.column + len(mutant.old)
        text = text[:mutant.column] + mutant.new + text[end:]
        shadow = self.work / "shadow"
        shutil.rmtree(shadow, ignore_errors=True)
        name = pathlib.Path(mutant.file)
        source = shadow / name.with_suffix(".cpp").name
        (shadow / "servo/safety").mkdir(parents=True)
        if name.suffix == ".hpp":
            (shadow / "servo/safety" / name.name).write_text(text)
            shutil.copy(ROOT / name.with_suffix(".cpp"), source)
        else:
            source.write_text(text)
        made = self.work / "mutant.o"
        command = self.compile_command(str(name.with_suffix(".cpp")), made, shadow)
        command += ["-include", str(self.work / "once.hpp"), str(source)]
        if subprocess.run(command, cwd=self.build, capture_output=True).returncode != 0:
            return "broken"
        program = self.work / "safety_test"
        tests = self.anew(name.stem, shadow) if name.suffix == ".hpp" else {}
        if tests is None:
            return "broken"
        link = [tests.get(pathlib.Path(word).name, word) for word in self.link]
        at = link.index("-o")
        link = link[:at] + [str(made)] + link[at:]
        link[link.index("-o") + 1] = str(program)
        if subprocess.run(link, cwd=self.build, capture_output=True).returncode != 0:
            return "broken"
        return self.test(program, name.stem, seconds)

    def anew(self, unit, shadow):
        """The unit's tests compiled with the changed header, by the name of the object that each replaces: what stands in
        a header is compiled into them. None: it does not compile."""
        objects = {}
        for source in sorted((ROOT / "tests/unit" / SAFETY).glob(f"{unit}*_test.cpp")):
            made = self.work / f"{source.name}.o"
            command = self.compile_command(str(source.relative_to(ROOT)), made, shadow) + [str(source)]
            if subprocess.run(command, cwd=self.build, capture_output=True).returncode != 0:
                return None
            objects[made.name] = str(made)
        return objects

    def test(self, program, unit, seconds):
        command = [str(program), "--gtest_fail_fast", "--gtest_brief=1", f"--gtest_filter={TESTS[unit]}"]
        try:
            done = subprocess.run(command, capture_output=True, timeout=seconds)
        except subprocess.TimeoutExpired:
            return "killed"
        return "survived" if done.returncode == 0 else "killed"


def explanations():
    """Of survivors, by key_of(): why no test can notice them. A line each: KEY :: WHY."""
    explained = {}
    file = HERE / "explained.txt"
    for line in file.read_text().splitlines() if file.exists() else []:
        if line and not line.startswith("#"):
            key, _, why = line.partition(" :: ")
            explained[key.strip()] = why.strip()
    return explained


def key_of(mutant):
    """FILE: line of code: old -> new, and which of them if the line has several."""
    line = (ROOT / mutant.file).read_text().splitlines()[mutant.line - 1].strip()
    nth = f" (no. {mutant.nth})" if mutant.nth > 1 else ""
    return f"{pathlib.Path(mutant.file).name}: {line}: {mutant.old.strip()} -> {mutant.new.strip()}{nth}".replace("\n", " ")


def wrong_explanations(every, results):
    """What is wrong with explained.txt."""
    known = {key_of(mutant) for mutant in every}
    killed = {key_of(mutant) for mutant, kind in results if kind == "killed"}
    for key, why in explanations().items():
        if key not in known:
            yield f"explained.txt: there is no such mutant (any more): {key}"
        elif not why:
            yield f"explained.txt: no reason is given: {key}"
        elif key in killed:
            yield f"explained.txt: a test kills it: {key}"


def report(results, seconds):
    kinds, explained = collections.Counter(kind for _, kind in results), explanations()
    same = sum(kind == "survived" and key_of(mutant) in explained for mutant, kind in results)
    counted = kinds["killed"] + kinds["survived"]
    part = kinds["killed"] / max(1, counted - same)
    lines = ["# Mutants of the servo's safety code", "",
             f"`tests/mutation/mutate.py` changed one operator, constant or condition at a time in `{SAFETY}`, and ran the "
             "tests of that file in `safety_test`. Other tests (hand_test, servo_test, soak) were not asked.", "",
             f"**{kinds['killed']} of {counted} mutants were killed: {100 * kinds['killed'] / max(1, counted):.1f} %; "
             f"{100 * part:.1f} % of the {counted - same} that change what anybody can see.** {same} survivors change "
             f"nothing, each for the reason given below. {kinds['broken']} more did not compile and are not counted. "
             f"{seconds:.0f} s.", "",
             "| file | killed | survived |", "|---|---|---|"]
    for file in sorted({mutant.file for mutant, _ in results}):
        per = collections.Counter(kind for mutant, kind in results if mutant.file == file)
        lines.append(f"| {pathlib.Path(file).name} | {per['killed']} | {per['survived']} |")
    lines += ["", "## Survivors", ""]
    for mutant, kind in results:
        if kind == "survived":
            key = key_of(mutant)
            lines.append(f"- `{key}` (line {mutant.line}): {explained.get(key, 'not explained')}")
    return "\n".join(lines) + "\n", part


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--count", type=int, default=300)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--report", type=pathlib.Path)
    parser.add_argument("--list", action="store_true")
    parser.add_argument("--only", type=pathlib.Path)
    options = parser.parse_args()
    files = [f"{SAFETY}/{unit}{suffix}" for unit in TESTS for suffix in (".cpp", ".hpp")]
    every = [mutant for file in files for mutant in mutants_of(file)]
    chosen = random.Random(options.seed).sample(every, min(options.count, len(every)))
    if options.only:
        wanted = options.only.read_text()
        chosen = [mutant for mutant in chosen if key_of(mutant) in wanted]
    if options.list:
        print("\n".join(key_of(mutant) for mutant in chosen))
        return 0
    bench, results, begun = Bench(options.build.resolve()), [], time.monotonic()
    plain = bench.run(Mutant(files[0], 1, 0, "", ""), 600)
    if plain != "survived":
        sys.exit(f"the tests of the code as it is: {plain}; expected them to pass")
    for index, mutant in enumerate(chosen):
        kind = bench.run(mutant, 60)
        results.append((mutant, kind))
        print(f"{index + 1}/{len(chosen)} {kind}: {key_of(mutant)}", flush=True)
    text, part = report(results, time.monotonic() - begun)
    shutil.rmtree(bench.work)
    print(text)
    if options.report:
        options.report.write_text(text)
    wrong = list(wrong_explanations(every, results))
    print("\n".join(wrong))
    return 0 if part >= 0.95 and not wrong else 1


if __name__ == "__main__":
    sys.exit(main())
