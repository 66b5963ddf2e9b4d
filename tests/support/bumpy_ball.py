"""A ball of 40 mm with bumps of 2 mm as a mesh, as large as one likes: a part with more triangles than a picture needs."""
import numpy as np

RADIUS, BUMP, WAVES = 0.04, 0.002, 9


def radius_at(polar, turn):
    """[m] The distance of the surface from the origin in a direction."""
    return RADIUS + BUMP * np.sin(WAVES * polar) ** 2 * np.sin(WAVES * turn)


def off(places):
    """[m] How far places are from the surface, along the line through the origin."""
    size = np.linalg.norm(places, axis=1)
    return np.abs(size - radius_at(np.arccos(np.clip(places[:, 1] / size, -1, 1)), np.arctan2(places[:, 2], places[:, 0])))


def mesh(rings):
    """Vertices [m] and triangles, 4 * rings * (rings - 1) of these, counter-clockwise from outside."""
    sides, inner = 2 * rings, rings - 1
    polar, turn = np.meshgrid(np.linspace(0, np.pi, rings + 1)[1:-1], np.arange(sides) * 2 * np.pi / sides, indexing="ij")
    size = radius_at(polar, turn)
    places = np.stack([size * np.sin(polar) * np.cos(turn), size * np.cos(polar), size * np.sin(polar) * np.sin(turn)], -1).reshape(-1, 3)
    places = np.vstack([places, [0, RADIUS, 0], [0, -RADIUS, 0]])
    ring, side = np.meshgrid(np.arange(inner - 1), np.arange(sides), indexing="ij")
    a, b = ring * sides + side, ring * sides + (side + 1) % sides
    squares = [np.stack([a, b, b + sides], -1).reshape(-1, 3), np.stack([a, b + sides, a + sides], -1).reshape(-1, 3)]
    k, last = np.arange(sides), (inner - 1) * sides
    top = np.stack([np.full(sides, len(places) - 2), (k + 1) % sides, k], -1)
    bottom = np.stack([np.full(sides, len(places) - 1), last + k, last + (k + 1) % sides], -1)
    return places, np.vstack([*squares, top, bottom])


def write_stl(file, places, triangles):
    """Writes a binary STL file."""
    rows = np.zeros(len(triangles), dtype=[("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
    rows["corners"] = places[triangles]
    with open(file, "wb") as out:
        out.write(bytes(80) + np.uint32(len(triangles)).tobytes() + rows.tobytes())
