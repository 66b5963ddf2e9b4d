# SPDX-License-Identifier: MIT
"""Computes with CalculiX, in three dimensions, how stiff a block of tissue with a hidden lump is under a flat tip at several places.

Usage: block.py OUT.csv     writes x, stiffness with the lump, stiffness without it. By symmetry only half of the block is
computed; the cut goes through the lump.
"""
import csv
import math
import os
import re
import subprocess
import sys
import tempfile

EDGE, TIP = 2.5e-3, 5e-3
CELLS = (34, 14, 8)          # elements of half a block of 85 x 70 x 20 mm
LOW = (-0.03, 0.0, 0.0)
LUMP, RADIUS = (0.0, 0.0, 0.011), 0.0055
YOUNG, LUMP_YOUNG, POISSON = 1e4, 1e5, 0.45
PLACES = [5e-3 * i for i in range(7)]


def deck(path, lump):
    number = {}

    def node(i, j, k):  # i, j, k count half edges of an element
        return number.setdefault((i, j, k), len(number) + 1)

    order = [(0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0), (0, 0, 2), (2, 0, 2), (2, 2, 2), (0, 2, 2), (1, 0, 0), (2, 1, 0),
             (1, 2, 0), (0, 1, 0), (1, 0, 2), (2, 1, 2), (1, 2, 2), (0, 1, 2), (0, 0, 1), (2, 0, 1), (2, 2, 1), (0, 2, 1)]
    kinds = ([], [])
    for i in range(CELLS[0]):
        for j in range(CELLS[1]):
            for k in range(CELLS[2]):
                corners = [node(2 * i + a, 2 * j + b, 2 * k + c) for a, b, c in order]
                middle = [low + (n + 0.5) * EDGE for low, n in zip(LOW, (i, j, k))]
                kinds[1 if lump and math.dist(middle, LUMP) < RADIUS else 0].append(corners)
    place = {n: tuple(low + 0.5 * EDGE * h for low, h in zip(LOW, half)) for half, n in number.items()}
    top = CELLS[2] * EDGE
    tips = [[n for n, p in place.items() if abs(p[2] - top) < 1e-9 and math.hypot(p[0] - x, p[1]) < TIP + 1e-9]
            for x in PLACES]
    with open(path + ".inp", "w", encoding="ascii") as out:
        out.write("*NODE,NSET=ALL\n" + "".join("%d,%.6g,%.6g,%.6g\n" % (n, *p) for n, p in place.items()))
        element = 0
        for k, young in ((0, YOUNG), (1, LUMP_YOUNG)):
            if not kinds[k]:
                continue
            out.write(f"*ELEMENT,TYPE=C3D20R,ELSET=E{k}\n")
            for c in kinds[k]:
                element += 1
                out.write(f"{element}," + ",".join(map(str, c[:15])) + ",\n" + ",".join(map(str, c[15:])) + "\n")
            out.write(f"*MATERIAL,NAME=M{k}\n*ELASTIC\n{young},{POISSON}\n*SOLID SECTION,ELSET=E{k},MATERIAL=M{k}\n")
        out.write("*NSET,NSET=FIXED\n" + "".join(f"{n}\n" for n, p in place.items() if p[2] < 1e-9))
        out.write("*NSET,NSET=CUT\n" + "".join(f"{n}\n" for n, p in place.items() if p[1] < 1e-9))
        for i, tip in enumerate(tips):
            out.write(f"*NSET,NSET=TIP{i}\n" + "".join(f"{n}\n" for n in tip))
        out.write("*BOUNDARY\nFIXED,1,3\nCUT,2\n")
        for i in range(len(tips)):  # each step starts from the undeformed block
            out.write("*STEP\n*STATIC\n*BOUNDARY,OP=NEW\nFIXED,1,3\nCUT,2\n"
                      f"TIP{i},3,3,{-1e-4}\n*NODE PRINT,NSET=TIP{i},TOTALS=ONLY\nRF\n*END STEP\n")


def stiffness(folder, lump):
    name = "block" + ("_lump" if lump else "")
    deck(os.path.join(folder, name), lump)
    subprocess.run(["ccx", "-i", name], cwd=folder, check=True, capture_output=True, timeout=3000)
    with open(os.path.join(folder, name + ".dat"), encoding="ascii") as file:
        found = re.findall(r"total force[^\n]*\n\s*\n\s*\S+\s+\S+\s+(\S+)", file.read())
    return [-2 * float(force) / 1e-4 for force in found]


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as work, open(sys.argv[1], "w", encoding="utf-8", newline="") as out:
        rows = csv.writer(out)
        rows.writerow(["x", "with_lump", "without"])
        for row in zip(PLACES, stiffness(work, True), stiffness(work, False)):
            rows.writerow(["%.4g" % v for v in row])
