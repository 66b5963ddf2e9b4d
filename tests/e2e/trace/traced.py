# SPDX-License-Identifier: MIT
"""What the tests of `hapticd trace` share: blocks, and a probe that is moved over them."""
import csv
import json
import os
import tempfile

from e2e import program, write

STIFFNESS = 1000  # N/m


def quad(corner, side_u, side_v, name):
    add = lambda a, b: [x + y for x, y in zip(a, b)]
    return {"name": name, "degree": [1, 1], "knots": [[0, 0, 1, 1], [0, 0, 1, 1]],
            "points": [corner, add(corner, side_v), add(corner, side_u), add(add(corner, side_u), side_v)]}


def block(low, high):
    """The six faces of a box between two corners."""
    (x, y, z), (right, top, front) = low, high
    dx, dy, dz = right - x, top - y, front - z
    return [quad([x, y, front], [dx, 0, 0], [0, dy, 0], "front"), quad([right, y, z], [-dx, 0, 0], [0, dy, 0], "back"),
            quad([right, y, front], [0, 0, -dz], [0, dy, 0], "right"), quad([x, y, z], [0, 0, dz], [0, dy, 0], "left"),
            quad([x, top, front], [dx, 0, 0], [0, 0, -dz], "top"), quad([x, y, z], [dx, 0, 0], [0, 0, dz], "bottom")]


def trace(hapticd, surfaces, samples, parameters=None, path=None, **keys):
    """Moves a probe over samples (t, x, y, z). Returns a row of numbers for each, and the warnings. @param path rows of poses along which
    the model moves @param keys more keys of the model"""
    with tempfile.TemporaryDirectory() as folder:
        table = lambda name, header, rows: write(folder, name, header + "\n" + "".join(",".join(map(repr, row)) + "\n" for row in rows))
        write(folder, "model.json", json.dumps({"format": "hapticd-model/1", "surfaces": surfaces}))
        if path:
            keys.update(motion="kinematic", path=table("path.csv", "t,x,y,z,qw,qx,qy,qz", path))
        model = {"name": "thing", "plugin": "nurbs_rigid",
                 "parameters": {"geometry": "model.json", "stiffness": STIFFNESS, "damping": 0, **(parameters or {})}, **keys}
        scene, out = write(folder, "scene.yaml", json.dumps({"hapticd": 1, "models": [model]})), os.path.join(folder, "out.csv")
        code, _, err = program(hapticd)("trace", scene, "--probe", table("probe.csv", "t,x,y,z", samples), "--out", out)
        assert code == 0, err
        with open(out) as file:
            rows = [{key: value if key == "model" else float(value) for key, value in row.items()} for row in csv.DictReader(file)]
        assert len(rows) == len(samples), f"{len(rows)} rows for {len(samples)} samples"
        return rows, err
