"""Closed surfaces to make soft bodies of, and readers of what `hapticd import --medial` writes and says."""
import itertools
import math
import re


def obj(points, faces):
    return "".join(f"v {x:.9f} {y:.9f} {z:.9f}\n" for x, y, z in points) + "".join(
        "f " + " ".join(str(i + 1) for i in face) + "\n" for face in faces)


def turned(rows, columns, at, closed):
    """A surface of rows (closed or between two poles) and closed columns."""
    points = [at(i, j) for i in range(rows) for j in range(columns)]
    faces = []
    for i in range(rows if closed else rows - 1):
        for j in range(columns):
            k, l = (i + 1) % rows, (j + 1) % columns
            faces.append([i * columns + j, k * columns + j, k * columns + l, i * columns + l])
    if not closed:
        low, high = at(0, None), at(rows - 1, None)
        points += [low, high]
        for j in range(columns):
            l = (j + 1) % columns
            faces.append([len(points) - 2, j, l])
            faces.append([len(points) - 1, (rows - 1) * columns + l, (rows - 1) * columns + j])
    return points, faces


def torus(big, small, n=96, m=48):
    def at(i, j):
        a, b = 2 * math.pi * i / n, 2 * math.pi * j / m
        return ((big + small * math.cos(b)) * math.cos(a), (big + small * math.cos(b)) * math.sin(a),
                small * math.sin(b))
    return obj(*turned(n, m, at, True))


def capsule(length, radius, n=40, m=40):
    def at(i, j):
        a = math.pi * (i + 1) / (n + 1)
        z = (length if i >= n // 2 else 0) - radius * math.cos(a)
        if j is None:
            return (0, 0, -radius if i == 0 else length + radius)
        b = 2 * math.pi * j / m
        return (radius * math.sin(a) * math.cos(b), radius * math.sin(a) * math.sin(b), z)
    # a row every 2 mm along the cylinder would do; two rings at the ends do as well: quads may be long
    return obj(*turned(n, m, at, False))


def box(x, y, z):
    points = [(x * i, y * j, z * k) for i in (0, 1) for j in (0, 1) for k in (0, 1)]
    return obj(points, [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]])


def ellipsoid(a, b, c, n=60, m=60):
    def at(i, j):
        t = math.pi * (i + 1) / (n + 1)
        if j is None:
            return (0, 0, -c if i == 0 else c)
        f = 2 * math.pi * j / m
        return (a * math.sin(t) * math.cos(f), b * math.sin(t) * math.sin(f), -c * math.cos(t))
    return obj(*turned(n, m, at, False))


def cells(axis, spacing):
    """The cells of a grid whose middles are inside the body."""
    spheres, edges, triangles = axis
    solid = []
    for a, b in edges:
        solid += [[(1 - t / 8) * u + t / 8 * v for u, v in zip(spheres[a], spheres[b])] for t in range(9)]
    for a, b, c in triangles:
        for i in range(7):
            for j in range(7 - i):
                s, t = i / 6, j / 6
                solid.append([(1 - s - t) * u + s * v + t * w for u, v, w in zip(spheres[a], spheres[b], spheres[c])])
    inside = set()
    for *place, r in solid:
        ranges = [range(int(math.floor((q - r) / spacing)), int(math.ceil((q + r) / spacing)) + 1) for q in place]
        inside.update(cell for cell in itertools.product(*ranges) if math.dist([c * spacing for c in cell], place) <= r)
    return inside


def fill(inside):
    """Adds cells until none touches another by an edge or corner alone."""
    changed = True
    while changed:
        changed = False
        for cell in list(inside):
            for d in ((1, 1, 0), (1, -1, 0), (1, 0, 1), (1, 0, -1), (0, 1, 1), (0, 1, -1)):
                other = tuple(c + e for c, e in zip(cell, d))
                if other not in inside:
                    continue
                axes = [m for m in range(3) if d[m]]
                one, two = (tuple(c + (d[m] if m == axis else 0) for m, c in enumerate(cell)) for axis in axes)
                if one not in inside and two not in inside:
                    inside.add(one)
                    changed = True


def cubes(axis, spacing):
    """The surface of the little cubes whose middles are inside the body: stairs of `spacing`."""
    inside = cells(axis, spacing)
    fill(inside)
    points, index, faces = [], {}, []

    def corner(p):
        if p not in index:
            index[p] = len(points)
            points.append(tuple((q - .5) * spacing for q in p))
        return index[p]

    for cell in inside:
        for m, side in ((0, 0), (0, 1), (1, 0), (1, 1), (2, 0), (2, 1)):
            beside = list(cell)
            beside[m] += 1 if side else -1
            if tuple(beside) in inside:
                continue
            base = list(cell)
            base[m] += side
            square = []
            for da, db in ((0, 0), (1, 0), (1, 1), (0, 1)):
                p = list(base)
                p[(m + 1) % 3] += da
                p[(m + 2) % 3] += db
                square.append(corner(tuple(p)))
            faces.append(square if side else square[::-1])
    return obj(points, faces)


def read(file):
    spheres, edges, triangles = [], [], []
    for line in open(file, encoding="utf-8"):
        words = line.split()
        if words[0] == "v":
            spheres.append([float(w) for w in words[1:]])
        elif words[0] == "e":
            edges.append([int(w) for w in words[1:]])
        elif words[0] == "f":
            triangles.append([int(w) for w in words[1:]])
    return spheres, edges, triangles


def told(text):
    """Spheres, parts, and the two distances in m that the program reports."""
    found = re.search(r"(\d+) spheres, (\d+) edges, (\d+) triangles, (\d+) part", text)
    there = re.search(r"at most ([\d.]+) mm from the body", text)
    back = re.search(r"the body at most ([\d.]+) mm", text)
    return int(found[1]), int(found[4]), 1e-3 * float(there[1]), 1e-3 * float(back[1])
