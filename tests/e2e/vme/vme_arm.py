#!/usr/bin/env python3
"""The daemon with the module vme, against a controller board that runs beside it in real time, over a plain file in
place of the bus: contact as of the simulated arm in-process, by force and by compliance; a bus that falls silent.

Usage: vme_arm.py HAPTICD VME_BOARD SOURCE_DIR MODULE_DIR
"""
import json
import pathlib
import subprocess
import sys
import tempfile

HAPTICD, BOARD, SOURCE, MODULES = sys.argv[1:5]
CONFIG = pathlib.Path(SOURCE) / "config"
TRIES = 4  # a machine that stands still for 15 ms in a real-time run without rights is no fault of ours


def device(folder, window):
    text = (CONFIG / "devices/sarcos.yaml").read_text().replace("/dev/bus/vme/m0", str(window))
    file = folder / "sarcos.yaml"
    file.write_text(text)
    return file


def scene(folder, arm, admittance):
    file = folder / "scene.yaml"
    extra = "\n    admittance: {mass: 3, damping: 20}" if admittance else ""
    file.write_text(f"""hapticd: 1
servo: {{rate: 1500}}
devices:
  - file: {arm}{extra}
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


def with_board(folder, seconds, *fault, admittance=False):
    window = folder / "window"
    board = subprocess.Popen([BOARD, window, "--arm", CONFIG / "devices/simulated-sarcos.yaml", "--plugin-path", MODULES,
                              "--for", str(seconds + 20), *fault], stdout=subprocess.PIPE, text=True)
    assert board.stdout.readline() == "ready\n"
    try:
        return run(folder, device(folder, window), seconds, "--allow-non-rt", admittance=admittance)
    finally:
        board.terminate()
        said = board.communicate()[0]
        assert "commands" in said, said


def contact(report):
    model = report["models"]["cylinder"]
    return model["contact_ticks"], model["penetration_mm"]["mean"], model["force_n"]["max"]


def alike(found, measure):
    # In real time the hand is on its way when the force comes in: the first contact is deeper.
    return (found[0] > 0.6 * measure[0] and 0.6 * measure[1] < found[1] < 1.7 * measure[1] and
            found[2] < 3 * measure[2])


def attempt(what, check):
    for _ in range(TRIES):
        problem = check()
        if not problem:
            return print(f"{what}: ok")
        print(f"{what}: once more: {problem}")
    sys.exit(f"{what}: {problem}")


def main():
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        measure = {a: contact(run(folder, CONFIG / "devices/simulated-sarcos.yaml", 4, "--virtual-time",
                                  admittance=a)[1]) for a in (False, True)}

        def strokes(admittance):
            done, report = with_board(folder, 4, admittance=admittance)
            if done.returncode != 0 or report["faults"]:
                return done.stdout + done.stderr
            if not alike(contact(report), measure[admittance]):
                return f"contact {contact(report)}, of the simulated arm {measure[admittance]}"
            return ""

        def falls_silent():
            done, report = with_board(folder, 5, "--fault", "absent", "--at", "2.5", "--lasts", "0.3")
            if done.returncode != 0:
                return done.stdout + done.stderr
            if len(report["faults"]) != 1 or "nobody answers on the bus" not in report["faults"][0]:
                return f"faults {report['faults']}"
            return "" if "came back" in report["faults"][0] else report["faults"][0]

        attempt("strokes a cylinder by force", lambda: strokes(False))
        attempt("strokes a cylinder by compliance", lambda: strokes(True))
        attempt("a bus that falls silent is named and survived", falls_silent)


main()
