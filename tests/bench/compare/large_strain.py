# SPDX-License-Identifier: MIT
"""A layer that is pressed far: the linear spring of a medial body beside rubber, in closed form.

Usage: large_strain.py HAPTICD     prints the section of soft_methods.md
"""
import csv
import os
import subprocess
import sys
import tempfile

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "..")
THICK = 0.02  # m, of soft-plate.yaml
STIFFNESS = 200  # N/m, of soft-plate.yaml


def pressed(hapticd, depths):
    """[N] the force of the plate at these depths, by `hapticd trace`."""
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
    """Force over that of the linear law, of an incompressible neo-Hookean block that slides at both faces."""
    stretch = 1 - strain
    return (stretch ** -2 - stretch) / (3 * strain)


def section(hapticd):
    lines = ["""
## Far in

The spring of a place is linear at any depth; tissue stiffens. Beside it stands a block of incompressible rubber (neo-Hookean) that
slides at both faces, F = E A / 3 (s^-2 - s) at a stretch of s, in closed form. A flat tip on a layer stiffens more slowly at its
rim and faster over a thin layer; real tissue, with its collagen, stiffens faster than either. So this shows the order of what a
linear spring leaves out. The forces are those of `soft-plate.yaml` (20 mm thick, 200 N/m), pressed by `hapticd trace`.

| depth | strain | hapticd | rubber of the same stiffness | hapticd is too soft by |
|---|---|---|---|---|"""]
    for depth, force in pressed(hapticd, [0.0005, 0.001, 0.002, 0.004, 0.006, 0.008, 0.0099]):
        strain = depth / THICK
        truth = STIFFNESS * depth * rubber(strain)
        lines.append(f"| {1e3 * depth:.1f} mm | {100 * strain:.0f} % | {force:.3f} N | {truth:.3f} N | "
                     f"{100 * (1 - force / truth):.0f} % |")
    lines.append("""
So it holds within 5 % to a strain of 5 %, and within a tenth to one of 10 %. Where a hand presses deeper, a stiffness that was
measured at the depth in use serves better than one for small strain; `young` is for small strain.

Springs along the surface cannot be fitted to presses of a tip that slides: the force along the normal does not depend on
`shear_distance`, and a flat tip without friction feels no force aside. They are a choice of feel.
""")
    return "\n".join(lines)


if __name__ == "__main__":
    print(section(sys.argv[1]))
