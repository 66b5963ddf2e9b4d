# SPDX-License-Identifier: MIT
"""Computes with CalculiX (ccx, from Debian's calculix-ccx) how the surface of axisymmetric elastic solids yields to a press.

This bench only starts the program CalculiX with an input file of its own; nothing of CalculiX is linked or shipped.
"""
import math
import os
import re
import resource
import subprocess
import time

WHOLE = 180  # ccx makes an axisymmetric element a wedge of two degrees, so forces of a whole turn are 180 times larger


def graded(places, counts):
    """Returns coordinates with counts[i] equal intervals between places[i] and places[i + 1]."""
    out = [places[0]]
    for a, b, n in zip(places, places[1:], counts):
        out += [a + (b - a) * (i + 1) / n for i in range(n)]
    return out


class Solid:
    """A grid of quadrilaterals with eight nodes. `at` maps a point of the grid to (r, z)."""

    def __init__(self, name, columns, rows, at, young, poisson):
        self.name, self.poisson = name, poisson
        self.nodes, self.number, self.elements = [], {}, []
        for i in range(len(columns) - 1):
            for j in range(len(rows) - 1):
                x, y = columns[i:i + 2], rows[j:j + 2]
                m, n = sum(x) / 2, sum(y) / 2
                corners = [(x[0], y[0]), (x[1], y[0]), (x[1], y[1]), (x[0], y[1]), (m, y[0]), (x[1], n), (m, y[1]),
                           (x[0], n)]
                self.elements.append(([self.node(at(*c)) for c in corners], young(*at(m, n))))

    def node(self, place):
        key = tuple(round(c, 10) for c in place)
        if key not in self.number:
            self.nodes.append(key)
            self.number[key] = len(self.nodes)
        return self.number[key]

    def where(self, holds):
        return [i + 1 for i, place in enumerate(self.nodes) if holds(*place)]

    def material(self, young, rubber):
        """Returns the input lines of a linear material, or of neo-Hookean rubber that has the same constants at small strain."""
        if not rubber:
            return f"*ELASTIC\n{young},{self.poisson}\n"
        shear, bulk = young / 2 / (1 + self.poisson), young / 3 / (1 - 2 * self.poisson)
        return f"*HYPERELASTIC,NEO HOOKE\n{shear / 2:.10g},{2 / bulk:.10g}\n"

    def solve(self, folder, fixed, presses, told, rubber=False):
        """Returns the displacements (r, z) [m] of the nodes `told` for each of `presses`, a list of (node, force along z [N]) or of
        (node, displacement along z [m], True); and the total force along z [N] on nodes that were displaced. With
        `rubber` the strain is large, and each press continues from the one before."""
        path = os.path.join(folder, self.name)
        listed = lambda nodes: "".join(f"{n}\n" for n in nodes)
        moved = sorted({p[0] for press in presses for p in press if len(p) > 2})
        with open(path + ".inp", "w", encoding="ascii") as out:
            out.write("*NODE,NSET=ALL\n" + "".join(f"{i + 1},{r:.10g},{z:.10g},0\n" for i, (r, z) in enumerate(self.nodes)))
            for k, young in enumerate(sorted({e for _, e in self.elements})):
                out.write(f"*ELEMENT,TYPE={'CAX8' if rubber else 'CAX8R'},ELSET=E{k}\n" + "".join(
                    f"{n + 1}," + ",".join(map(str, corners)) + "\n"
                    for n, (corners, e) in enumerate(self.elements) if e == young))
                out.write(f"*MATERIAL,NAME=M{k}\n{self.material(young, rubber)}*SOLID SECTION,ELSET=E{k},MATERIAL=M{k}\n")
            out.write("*NSET,NSET=TOLD\n" + listed(told) + "*NSET,NSET=FIXED\n" + listed(fixed))
            out.write("*NSET,NSET=AXIS\n" + listed(self.where(lambda r, z: abs(r) < 1e-9)))
            out.write(("*NSET,NSET=MOVED\n" + listed(moved)) if moved else "")
            out.write("*BOUNDARY\nFIXED,1,2\nAXIS,1\n")
            for press in presses:
                out.write("*STEP,NLGEOM,INC=1000\n*STATIC\n0.5,1.,1e-4\n" if rubber else "*STEP\n*STATIC\n")
                forces = [p for p in press if len(p) == 2]
                if forces:
                    out.write("*CLOAD,OP=NEW\n" + "".join(f"{n},2,{f / WHOLE:.10g}\n" for n, f in forces))
                if moved:
                    out.write("*BOUNDARY\n" + "".join(f"{p[0]},2,2,{p[1]:.10g}\n" for p in press if len(p) > 2))
                    out.write("*NODE PRINT,NSET=MOVED,TOTALS=ONLY,FREQUENCY=1000\nRF\n")
                out.write("*NODE PRINT,NSET=TOLD,FREQUENCY=1000\nU\n*END STEP\n")
        begun = time.monotonic()
        done = subprocess.run(["ccx", "-i", self.name], cwd=folder, capture_output=True, text=True, timeout=600, check=False)
        self.seconds = time.monotonic() - begun
        self.kilobytes = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss
        if done.returncode != 0 or not os.path.exists(path + ".dat"):
            raise RuntimeError("ccx: " + done.stdout[-2000:])
        with open(path + ".dat", encoding="ascii") as file:
            text = file.read()
        totals = [WHOLE * float(f) for f in re.findall(r"total force[^\n]*\n\s*\n\s*\S+\s+(\S+)", text)]
        yields = []
        for block in re.split(r"displacements \(vx,vy,vz\)[^\n]*\n", text)[1:]:
            rows = {}
            for line in block.splitlines():
                words = line.split()
                if len(words) == 4 and words[0].isdigit():
                    rows[int(words[0])] = (float(words[1]), float(words[2]))
                elif rows:
                    break
            yields.append([rows[n] for n in told])
        return yields, totals


TIP = 5e-3  # [m] radius of the flat tip and of the round tip


def layer(thickness=0.02, young=1e4, poisson=0.45, lump=None, coarse=0):
    """Returns a layer on a rigid base. `lump` is (height of its centre, radius, Young's modulus); `coarse` is the number of elements under the tip."""
    inside = lambda r, z: lump is not None and math.hypot(r, z - lump[0]) < lump[1]
    columns = graded([0, 0.8 * TIP, TIP, 1.2 * TIP, 2 * TIP, 0.08], [5, 5, 5, 5, 12])
    rows = graded([0, thickness - 2.5 * TIP, thickness - 0.5 * TIP, thickness - 0.1 * TIP, thickness], [5, 12, 4, 4])
    if coarse:  # no small elements at the edge of the tip, because they would fold in a deep press
        columns = graded([0, TIP, 2 * TIP, 0.08], [coarse, coarse, 8])
        rows = graded([0, thickness - 2 * TIP, thickness], [3, coarse + 2])
    solid = Solid("layer" if lump is None else "lump", columns, rows, lambda x, y: (x, y),
                  lambda r, z: lump[2] if inside(r, z) else young, poisson)
    return solid, solid.where(lambda r, z: z < 1e-9), solid.where(lambda r, z: abs(z - thickness) < 1e-9)


def ball(radius=0.025, foot=0.012, young=1e4, poisson=0.45):
    """Returns a ball that is bonded to a rigid base within the radius `foot` [m], and the nodes of its surface above 0.3 radii."""
    columns = graded([0.04, 1.0], [18])  # leaves a small hole in the middle, because elements there would have no width
    rows = graded([-1, -0.9, 0.9, 0.97, 1], [4, 16, 4, 4])

    def at(x, y):  # concentric arcs: maps the boundary of a half-square to a half-circle
        angle = y * math.pi / 2
        return radius * x * math.cos(angle), radius * (x * math.sin(angle))

    solid = Solid("ball", columns, rows, at, lambda r, z: young, poisson)
    on = lambda r, z: abs(math.hypot(r, z) - radius) < 1e-8
    return (solid, solid.where(lambda r, z: on(r, z) and z < 0 and r <= foot + 1e-9),
            solid.where(lambda r, z: on(r, z) and z > 0.3 * radius))


def flat(solid, fixed, surface, folder, depth=1e-4):
    """Returns the stiffness [N/m] under a flat frictionless tip, and the dent as (r, share of the depth) of the surface."""
    under = [n for n in surface if solid.nodes[n - 1][0] <= TIP + 1e-9]
    yields, totals = solid.solve(folder, fixed, [[(n, -depth, True) for n in under]], surface)
    dent = sorted((solid.nodes[n - 1][0], -u[1] / depth) for n, u in zip(surface, yields[0]))
    return -totals[0] / depth, dent


def far(solid, fixed, surface, folder, depths):
    """Returns, at each depth, the force [N] of a flat frictionless tip that goes deep into rubber, and the dent as in flat()."""
    under = [n for n in surface if solid.nodes[n - 1][0] <= TIP + 1e-9]
    yields, totals = solid.solve(folder, fixed, [[(n, -depth, True) for n in under] for depth in depths], surface, rubber=True)
    dents = [sorted((solid.nodes[n - 1][0] + u[0], -u[1] / depth) for n, u in zip(surface, at))
             for at, depth in zip(yields, depths)]
    return [-total for total in totals], dents
