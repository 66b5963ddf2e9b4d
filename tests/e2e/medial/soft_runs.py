# SPDX-License-Identifier: MIT
"""Runs a soft scene in virtual time and reads what was felt: for tests and for the pictures of deformable.md."""
import csv
import os
import subprocess
import tempfile


def run(hapticd, scene, seconds, changes=()):
    """Rows of each probe, in order: dictionaries of t, tip (m), depth (m), force (N), normal. `changes` are pairs of
    texts, the one in place of the other in the scene."""
    with tempfile.TemporaryDirectory() as folder:
        text = open(scene, encoding="utf-8").read()
        for old, new in changes:
            assert old in text, f"{scene} has no '{old}'"
            text = text.replace(old, new)
        here = os.path.dirname(os.path.abspath(scene))
        file = os.path.join(here, os.path.basename(scene))
        if changes:  # paths in a scene are relative to it
            file = os.path.join(folder, "scene.yaml")
            for key in ("geometry: ", "path: ", "file: "):
                text = text.replace(key, key + here + "/")
            open(file, "w", encoding="utf-8").write(text)
        record = os.path.join(folder, "run.h5")
        done = subprocess.run([hapticd, "run", file, "--virtual-time", "--for", str(seconds), "--record", record,
                               "--name", f"soft{os.getpid()}"], capture_output=True, text=True, timeout=300,
                              env=dict(os.environ, RUNTIME_DIRECTORY=folder, STATE_DIRECTORY=folder))
        assert done.returncode == 0, done.stdout + done.stderr
        subprocess.run([hapticd, "export", record, "--csv", os.path.join(folder, "all")], check=True,
                       stdout=subprocess.DEVNULL, timeout=120)
        return read(os.path.join(folder, "all"))


def read(folder):
    with open(os.path.join(folder, "ticks.csv"), encoding="utf-8") as file:
        ticks = {row["tick"]: row for row in csv.DictReader(file)}
    probes = {}
    with open(os.path.join(folder, "contacts.csv"), encoding="utf-8") as file:
        for row in csv.DictReader(file):
            tick, probe = ticks[row["tick"]], int(row["probe"])
            vector = lambda names: tuple(float(row[name]) for name in names)
            probes.setdefault(probe, []).append({
                "t": float(tick["t"]), "tip": tuple(float(tick[f"arm{probe}_{axis}"]) for axis in "xyz"),
                "depth": float(row["depth"]), "force": vector(("fx", "fy", "fz")), "normal": vector(("nx", "ny", "nz"))})
    return [probes[probe] for probe in sorted(probes)]


def along(row):
    """[N] the force along the normal."""
    return sum(f * n for f, n in zip(row["force"], row["normal"]))


def at(rows, t):
    return min(rows, key=lambda row: abs(row["t"] - t))
