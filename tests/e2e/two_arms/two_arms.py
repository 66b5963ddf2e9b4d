#!/usr/bin/env python3
"""Two arms on one model: each is felt by itself, whichever of the hands stays away.

Usage: two_arms.py HAPTICD SOURCE_DIR
"""
import json
import pathlib
import subprocess
import sys
import tempfile

HAPTICD, SOURCE = sys.argv[1], pathlib.Path(sys.argv[2])
IN, AWAY = "hand: {radius: 0.046}", "hand: {radius: 0.07}"


def run(folder, right, left):
    text = (SOURCE / "config/scenes/two-arms.yaml").read_text().replace("../", f"{SOURCE}/config/")
    first, second, end = text.split(IN)
    scene, report = folder / "scene.yaml", folder / "report.json"
    scene.write_text(first + right + second + left + end)
    done = subprocess.run([HAPTICD, "run", scene, "--virtual-time", "--for", "3", "--report", report],
                          capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stdout + done.stderr
    result = json.loads(report.read_text())
    assert not result["faults"], result["faults"]
    assert len(result["limits"]) == 2, result["limits"]  # a row an arm
    model = result["models"]["sphere"]
    arms = model["arms"]
    assert len(arms) == 2, arms  # a row an arm
    for hand, arm in zip((right, left), arms.values()):
        assert (arm["contact_ticks"] > 2000) == (hand == IN), arms
        assert arm["force_n"]["max"] <= model["force_n"]["max"] + 1e-12, (arms, model["force_n"])
    assert all(f"ticks) by {name}" in done.stdout for name in arms), done.stdout
    return model["contact_ticks"], model["force_n"]["max"]


def main():
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        none, right, left, both = (run(folder, a, b) for a, b in ((AWAY, AWAY), (IN, AWAY), (AWAY, IN), (IN, IN)))
    print("contact ticks and largest force: none", none, "right", right, "left", left, "both", both)
    assert none == (0, 0)
    assert right[0] > 2000 and right[1] > 0.5
    assert abs(left[0] - right[0]) < 50 and abs(left[1] - right[1]) < 0.1 * right[1], "the left arm is the right one, turned"
    assert both[0] >= max(left[0], right[0]) and both[1] < 1.1 * max(left[1], right[1])


main()
