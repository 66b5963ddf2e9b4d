#!/usr/bin/env python3
"""The daemon with the module vme, against a controller board that runs beside it in real time, over a plain file in
place of the bus: contact as of the simulated arm in-process, by force and by compliance; a bus that falls silent.

Usage: vme_arm.py HAPTICD VME_BOARD SOURCE_DIR MODULE_DIR
"""
import json
import pathlib
import re
import subprocess
import sys
import tempfile

HAPTICD, BOARD, SOURCE, MODULES = sys.argv[1:5]
CONFIG = pathlib.Path(SOURCE) / "config"
TRIES = 8  # of a machine that stands still in the middle of a real-time run; any other failure counts at once
SKIPPED = 77  # for the test runner: nothing was found wrong, and nothing could be shown
LATE = 2e-3  # [s] the watchdog cuts a tick that is 3 ms old, and the board looks every 0.67 ms


def device(folder, window):
    text = (CONFIG / "devices/sarcos.yaml").read_text().replace("/dev/bus/vme/m0", str(window))
    text = text.replace("masses: [0, 0, 0, 0, 0, 0, 0, 0]", "masses: [1.0, 0.5, 2.0, 0.5, 1.2, 0.2, 0.3, 0.05]")  # the board's own
    file = folder / "sarcos.yaml"
    file.write_text(text)
    return file


def scene(folder, arm, admittance):
    file = folder / "scene.yaml"
    extra = "\n    admittance: {mass: 3, damping: 20}" if admittance else ""
    file.write_text(f"""hapticd: 1
servo: {{rate: 1500}}
devices:
  - file: {arm}
    mount: {{position: [0, 0, 0]}}   # of both arms: their tips are alike{extra}
models:
  - name: cylinder
    plugin: nurbs_rigid
    parameters: {{geometry: {CONFIG}/models/cylinder.yaml, stiffness: {2000 if admittance else 6000}}}
""")
    return file


def run(folder, arm, seconds, *more, admittance=False):
    report = folder / "report.json"
    done = subprocess.run([HAPTICD, "run", scene(folder, arm, admittance), "--for", str(seconds), "--report", report,
                           *more], capture_output=True, text=True, timeout=120)
    return done, json.loads(report.read_text())


told = []  # what each board said at its end


def late(report):
    """How the machine held up the daemon or the board; "": it did not."""
    worst = report["lateness_us"]["max"] * 1e-6
    board = float(re.search(r"longest cycle ([\d.]+) ms", told[-1])[1]) * 1e-3
    held_up = worst > LATE or report["missed_ticks"] > 0 or report["compute_us"]["max"] * 1e-6 > LATE or board > LATE
    return f"a tick {worst * 1e3:.1f} ms late, a board's cycle of {board * 1e3:.1f} ms" if held_up else ""


def with_board(folder, seconds, *fault, admittance=False):
    window = folder / "window"
    board = subprocess.Popen([BOARD, window, "--arm", CONFIG / "devices/simulated-sarcos.yaml", "--plugin-path", MODULES,
                              "--for", str(seconds + 20), *fault], stdout=subprocess.PIPE, text=True)
    assert board.stdout.readline() == "ready\n"
    try:
        return run(folder, device(folder, window), seconds, "--allow-non-rt", admittance=admittance)
    finally:
        board.terminate()
        told.append(board.communicate()[0])
        assert "commands" in told[-1], told[-1]


def contact(report):
    model = report["models"]["cylinder"]
    return model["contact_ticks"], model["penetration_mm"]["mean"], model["force_n"]["max"]


def alike(found, measure):
    # In real time the hand is on its way when the force comes in: the first contact is deeper.
    return (found[0] > 0.6 * measure[0] and 0.6 * measure[1] < found[1] < 1.7 * measure[1] and
            found[2] < 3 * measure[2])


def attempt(what, check):
    """0: shown; SKIPPED: the machine was late in every run. Ends the program where the arm is at fault."""
    for _ in range(TRIES):
        problem, report = check()
        if not problem:
            print(f"{what}: ok", flush=True)
            return 0
        if not (excuse := late(report)):
            sys.exit(f"{what}: {problem}")
        print(f"{what}: once more, the machine was late ({excuse}): {problem}", flush=True)
    print(f"{what}: SKIPPED, the machine was late in each of {TRIES} runs", flush=True)
    return SKIPPED


def main():
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        measure = {a: contact(run(folder, CONFIG / "devices/simulated-sarcos.yaml", 4, "--virtual-time",
                                  admittance=a)[1]) for a in (False, True)}

        def strokes(admittance):
            done, report = with_board(folder, 4, admittance=admittance)
            if done.returncode != 0 or report["faults"]:
                return done.stdout + done.stderr, report
            if not alike(contact(report), measure[admittance]):
                return f"contact {contact(report)}, of the simulated arm {measure[admittance]}", report
            return "", report

        def falls_silent():
            done, report = with_board(folder, 6, "--fault", "absent", "--at", "0.7", "--lasts", "0.3", "--in-force")
            faults = report["faults"]
            if done.returncode != 0:
                return done.stdout + done.stderr, report
            if len(faults) != 1 or "no board answers on the bus" not in faults[0] or "came back" not in faults[0]:
                return f"faults {faults}", report
            return "", report

        sys.exit(max([attempt("strokes a cylinder by force", lambda: strokes(False)),
                      attempt("strokes a cylinder by compliance", lambda: strokes(True)),
                      attempt("a bus that falls silent is named and survived", falls_silent)]))


main()
