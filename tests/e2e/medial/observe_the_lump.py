#!/usr/bin/env python3
"""What is rendered carries the lump: an observer finds its place and size in the recorded forces of a stroking hand.

Usage: observe_the_lump.py HAPTICD CONFIG     prints one line per case; exit 1 when one is off.

A simulated hand strokes the palpation scene in rows 10 mm apart, in virtual time; its tip is what the arm's encoders
say (30 um a count). The observer knows the force, the depth below the surface that it sees at rest, and nothing of the
body's file. It fits F = (k + K exp(-((x - a)/s)^2/2 - ((y - b)/r)^2/2)) depth + c speed by least squares.
"""
import csv
import math
import os
import subprocess
import sys
import tempfile

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "support"))
from e2e import check, finish

HAPTICD, CONFIG = sys.argv[1], os.path.abspath(sys.argv[2])
SCENE = os.path.join(CONFIG, "scenes", "soft-palpation.yaml")
PLACE = (0.018, -0.009)  # generate-soft says so: exp(-(ds^2 + dt^2) / 0.012) of a pad of 120 x 90 mm
SIZE = (0.12 * math.sqrt(0.006), 0.09 * math.sqrt(0.006))
ARM = 0.09  # [m] the arm's origin above the world's


def strokes():
    """t, x, y, z of the hand, device frame: rows along y, pressing toward 8 mm below the pad's top."""
    t, x, side, rows = 0.0, -0.04, 1, []
    rows.append((t, x, -0.035, 0.06 - ARM))
    while x < 0.0451:
        t += 0.3
        rows.append((t, x, -0.035 * side, 0.030 - ARM))
        t += 1.0
        rows.append((t, x, 0.035 * side, 0.030 - ARM))
        side, x = -side, x + 0.01
    return rows


def recorded(folder):
    """Columns of every tenth tick in contact: x, y [m], depth [m], speed of closing [m/s], force along the normal [N]."""
    path, scene = os.path.join(folder, "path.csv"), os.path.join(folder, "scene.yaml")
    rows = strokes()
    with open(path, "w", encoding="utf-8") as out:
        out.write("t,x,y,z\n" + "".join("%.3f,%.6f,%.6f,%.6f\n" % row for row in rows))
    with open(SCENE, encoding="utf-8") as text, open(scene, "w", encoding="utf-8") as out:
        out.write(text.read().replace("../models", os.path.join(CONFIG, "models")) +
                  f"hand: {{script: path, path: {path}}}\n")
    run = subprocess.run([HAPTICD, "run", scene, "--virtual-time", "--for", f"{rows[-1][0]:.3f}", "--record",
                          os.path.join(folder, "run.h5"), "--name", f"lump{os.getpid()}"],
                         capture_output=True, text=True, timeout=300,
                         env=dict(os.environ, RUNTIME_DIRECTORY=folder, STATE_DIRECTORY=folder))
    check("the run ends in order", run.returncode == 0, run.stdout + run.stderr)
    subprocess.run([HAPTICD, "export", os.path.join(folder, "run.h5"), "--csv", os.path.join(folder, "all")], check=True,
                   stdout=subprocess.DEVNULL, timeout=120)
    tips, rows = {}, {}
    with open(os.path.join(folder, "all", "ticks.csv"), encoding="utf-8") as file:
        for row in csv.DictReader(file):
            tips[int(row["tick"])] = float(row["t"]), float(row["arm0_x"]), float(row["arm0_y"])
    with open(os.path.join(folder, "all", "contacts.csv"), encoding="utf-8") as file:
        for row in csv.DictReader(file):
            normal, force = ([float(row[kind + axis]) for axis in "xyz"] for kind in "nf")
            rows[int(row["tick"])] = float(row["depth"]), sum(f * n for f, n in zip(force, normal))
    samples = []
    for tick, (depth, force) in rows.items():
        if tick % 10 == 0 and depth > 1e-3 and tick - 5 in rows and tick + 5 in rows:
            speed = (rows[tick + 5][0] - rows[tick - 5][0]) / (tips[tick + 5][0] - tips[tick - 5][0])
            samples.append((*tips[tick][1:], depth, speed, force))
    return samples


def solved(a, b):
    """x of a x = b, by elimination with pivots."""
    n = len(b)
    a = [row[:] + [b[i]] for i, row in enumerate(a)]
    for i in range(n):
        p = max(range(i, n), key=lambda k: abs(a[k][i]))
        a[i], a[p] = a[p], a[i]
        for k in range(i + 1, n):
            f = a[k][i] / a[i][i]
            for j in range(i, n + 1):
                a[k][j] -= f * a[i][j]
    x = [0.0] * n
    for i in reversed(range(n)):
        x[i] = (a[i][n] - sum(a[i][j] * x[j] for j in range(i + 1, n))) / a[i][i]
    return x


def residuals(q, samples, slopes):
    """Errors of the model and, where asked for, their derivatives. Lengths in q are in mm, stiffness in N/mm."""
    k, lump, a, b, s, r, c = q
    out = []
    for x, y, depth, speed, force in samples:
        u, v, d = (1e3 * x - a) / s, (1e3 * y - b) / r, 1e3 * depth
        e = math.exp(-0.5 * (u * u + v * v))
        error = (k + lump * e) * d + c * speed - force
        g = lump * e * d
        out.append((error, (d, e * d, g * u / s, g * v / r, g * u * u / s, g * v * v / r, speed) if slopes else None))
    return out


def fitted(samples):
    """Levenberg and Marquardt, from the place that feels stiffest."""
    stiff = max(samples, key=lambda one: one[4] / one[2] if one[2] > 3e-3 else 0)
    q = [0.2, 0.5, 1e3 * stiff[0], 1e3 * stiff[1], 8.0, 8.0, 1.0]
    damping, now = 1e-3, sum(e * e for e, _ in residuals(q, samples, False))
    for _ in range(100):
        rows = residuals(q, samples, True)
        a = [[sum(j[m] * j[n] for _, j in rows) for n in range(7)] for m in range(7)]
        b = [-sum(e * j[m] for e, j in rows) for m in range(7)]
        for m in range(7):
            a[m][m] *= 1 + damping
        step = solved(a, b)
        tried = [p + d for p, d in zip(q, step)]
        then = sum(e * e for e, _ in residuals(tried, samples, False)) if min(tried[4:6]) > 1 else math.inf
        if then < now:
            done, q, now, damping = now - then < 1e-9 * now, tried, then, damping / 5
            if done:
                break
        else:
            damping *= 5
    return q, math.sqrt(now / len(samples))


with tempfile.TemporaryDirectory() as work:
    told = recorded(work)
    check("the hand was on the pad for most of the time", len(told) > 700, len(told))
    q, rms = fitted(told)
    away = math.dist((1e-3 * q[2], 1e-3 * q[3]), PLACE)
    sizes = [1e-3 * abs(size) / true for size, true in zip(q[4:6], SIZE)]
    text = (f"place ({q[2]:.2f}, {q[3]:.2f}) mm, {1e3 * away:.2f} mm off; sizes {abs(q[4]):.2f} and {abs(q[5]):.2f} mm, "
            f"{sizes[0]:.3f} and {sizes[1]:.3f} of the truth; pad {1e3 * q[0]:.1f} N/m, lump {1e3 * q[1]:.0f} N/m, "
            f"rms {1e3 * rms:.1f} mN over {len(told)} samples")
    print(text)
    check("the lump's place is found within 2 mm", away < 2e-3, text)
    check("its size is found within a fifth", all(0.8 < size < 1.2 for size in sizes), text)
finish()
