# SPDX-License-Identifier: MIT
"""Compares a deep press on a layer: the linear spring of a medial body, finite elements of rubber, and a closed form.

Usage: large_strain.py HAPTICD     prints the section of soft_methods.md; needs calculix-ccx, a minute
"""
import csv
import os
import subprocess
import sys
import tempfile

import solid

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "..")
THICK = 0.02  # [m] thickness of soft-plate.yaml
STIFFNESS = 200  # [N/m] stiffness of soft-plate.yaml
FOLDED = 0.1  # relative difference of two meshes above which one of them has folded at the edge of the tip


def pressed(hapticd, depths):
    """Returns (depth [m], force [N]) of the plate near these depths, by `hapticd trace`."""
    with tempfile.TemporaryDirectory() as folder:
        scene, probe, out = (os.path.join(folder, name) for name in ("scene.yaml", "probe.csv", "out.csv"))
        with open(scene, "w", encoding="utf-8") as file:
            file.write("hapticd: 1\nservo: {rate: 1000}\nmodels:\n  - name: plate\n    plugin: mat_deformable\n    parameters: "
                       f"{{geometry: {os.path.abspath(ROOT)}/config/models/soft-plate.yaml, shear_distance: 0.006, dynamics: 'off'}}\n")
        with open(probe, "w", encoding="utf-8") as file:
            file.write("t,x,y,z\n" + "".join(f"{0.001 * i},0,0,{0.0101 - 2e-6 * i:.7f}\n" for i in range(5100)))
        subprocess.run([hapticd, "trace", scene, "--probe", probe, "--out", out], check=True, timeout=60,
                       stdout=subprocess.DEVNULL)
        with open(out, encoding="utf-8") as file:
            rows = [(float(row["depth"]), float(row["fz"])) for row in csv.DictReader(file)]
    return [min(rows, key=lambda row: abs(row[0] - depth)) for depth in depths]


def rubber(strain):
    """Returns the force of an incompressible neo-Hookean block that slides at both faces, divided by that of the linear law."""
    stretch = 1 - strain
    return (stretch ** -2 - stretch) / (3 * strain)


def at(dent, r):
    """Returns the dent at r, interpolated between nodes."""
    for (a, x), (b, y) in zip(dent, dent[1:]):
        if a <= r <= b and b > a:
            return x + (y - x) * (r - a) / (b - a)
    return float("nan")


def elements(depths, coarse):
    """Returns for a flat tip on the layer, at each depth: force divided by that of the linear solution, the dent, seconds, megabytes."""
    found = []
    with tempfile.TemporaryDirectory() as folder:
        layer = solid.layer(coarse=coarse)
        stiffness, small = solid.flat(*layer, folder)
        for depth in depths:
            try:
                (force,), (dent,) = solid.far(*layer, folder, [depth])
            except RuntimeError:  # the mesh folds at the edge of the tip
                break
            found.append((force / stiffness / depth, dent, layer[0].seconds, layer[0].kilobytes / 1024))
    return small, found


def section(hapticd):
    depths = [0.0005, 0.001, 0.002, 0.003, 0.004, 0.005]
    small, found = elements(depths, 4)
    _, other = elements(depths, 2)
    agreed = [i for i, (fine, coarse) in enumerate(zip(found, other)) if abs(fine[0] / coarse[0] - 1) > FOLDED] or [len(depths)]
    found = found[:agreed[0]]
    lines = [f"""
## Far in

The spring of a place is linear at any depth. Beside it stands the same layer of rubber (neo-Hookean, nu = 0.45, 20 mm) under the
flat tip of 5 mm, in finite elements of large strain (CalculiX, NLGEOM), and a block of incompressible rubber that slides at both
faces, F = E A / 3 (s^-2 - s) at a stretch of s. All have 200 N/m at small strain; the forces of hapticd are those of
`soft-plate.yaml`, pressed by `hapticd trace`. The second column of ratios is of elements twice as large.

| depth | strain | hapticd | finite elements | hapticd over them | larger elements | rubber block | dent at 7.5 mm | at 10 mm | time |
|---|---|---|---|---|---|---|---|---|---|
| small | | | | | | | {at(small, 0.0075):.2f} | {at(small, 0.01):.2f} | |"""]
    for i, ((depth, force), (ratio, dent, seconds, _)) in enumerate(zip(pressed(hapticd, depths), found)):
        strain = depths[i] / THICK
        coarse = f"{force / (STIFFNESS * depth * other[i][0]):.3f}" if i < len(other) else ""
        lines.append(f"| {1e3 * depth:.1f} mm | {100 * strain:.0f} % | {force:.3f} N | {STIFFNESS * depth * ratio:.3f} N | "
                     f"{force / (STIFFNESS * depth * ratio):.3f} | {coarse} | {STIFFNESS * depth * rubber(strain):.3f} N | "
                     f"{at(dent, 0.0075):.2f} | {at(dent, 0.01):.2f} | {seconds:.1f} s |")
    lines.append(f"""
The elements take {found[0][3]:.0f} MB, a tick of hapticd some hundred nanoseconds. Deeper than {1e3 * depths[len(found) - 1]:.0f} mm \
their mesh folds at the sharp edge of the tip,
and nothing is said here. Under a tip that is narrow beside the layer the tissue gives way aside: at a strain of \
{100 * depths[len(found) - 1] / THICK:.0f} % the linear
spring is off by {100 * abs(1 - 1 / found[-1][0]):.0f} %, where the block, which has nowhere to go, is stiffer by more than a quarter. The block is the order of
what is left out where a tip is wide beside the layer; real tissue, with its collagen, stiffens faster than rubber. There a stiffness
that was measured at the depth in use serves better than one for small strain; `young` is for small strain.
""")
    return "\n".join(lines)


if __name__ == "__main__":
    print(section(sys.argv[1]))
