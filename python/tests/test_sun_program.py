"""tenebra sun on a block of houses against a caster of numpy's: the same sums but for ties."""

import os
import subprocess

import numpy as np
import pytest

PROGRAM = os.environ.get("TENEBRA_PROGRAM")


def houses(random):
    """Boxes on a grid, Z up: vertices and triangles."""
    corners = np.array([[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 1)], float)
    quads = [(0, 1, 5, 4), (1, 3, 7, 5), (3, 2, 6, 7), (2, 0, 4, 6), (4, 5, 7, 6)]
    faces = np.array([t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))])
    vertices, triangles = [], []
    for i in range(16):
        size = np.array([random.integers(6, 11), random.integers(6, 11), random.integers(3, 20)])
        triangles.append(faces + 8 * i)
        vertices.append(corners * size + [16 * (i % 4), 16 * (i // 4), 0])
    return np.concatenate(vertices), np.concatenate(triangles)


def blocked(points, way, corners):
    """Möller and Trumbore: whether each point's ray crosses a triangle, and whether one nearly does."""
    a, e, f = corners[:, 0], corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    p = np.cross(way, f)
    determinant = np.sum(e * p, axis=1)
    determinant[determinant == 0] = np.nan
    s = points[:, None] - a
    u = np.sum(s * p, axis=2) / determinant
    q = np.cross(s, e)
    v = q @ way / determinant
    t = np.sum(f * q, axis=2) / determinant
    least = np.minimum.reduce([u, v, 1 - u - v, t])
    return np.any(least > 0, axis=1), np.any(np.abs(least) < 1e-5, axis=1)


@pytest.mark.skipif(not PROGRAM, reason="TENEBRA_PROGRAM does not name the program")
def test_a_block_of_houses(tmp_path):
    random = np.random.default_rng(55)
    vertices, triangles = houses(random)
    with open(tmp_path / "houses.obj", "w") as obj:
        obj.writelines("v %d %d %d\n" % tuple(v) for v in vertices)
        obj.writelines("f %d %d %d\n" % tuple(t + 1) for t in triangles)
    azimuth, altitude = np.radians(random.uniform(0, 360, 50)), np.radians(random.uniform(3, 80, 50))
    suns = np.stack([np.sin(azimuth) * np.cos(altitude), np.cos(azimuth) * np.cos(altitude), np.sin(altitude)], 1)
    points = np.column_stack([random.uniform(-5, 65, (200, 2)), np.full(200, 0.5)])
    np.savetxt(tmp_path / "suns.csv", suns, "%.17g", ",", header="x,y,z", comments="")
    np.savetxt(tmp_path / "points.csv", points, "%.17g", ",", header="x,y,z", comments="")
    subprocess.run([PROGRAM, "sun", "houses.obj", "--up-axis", "z", "--suns", "suns.csv", "--points", "points.csv",
                    "--csv", "sums.csv", "--quiet"], cwd=tmp_path, check=True)
    found = np.genfromtxt(tmp_path / "sums.csv", delimiter=",", names=True)["sum"]
    seen, ties = np.zeros(200), np.zeros(200)
    for sun in suns:
        hit, tie = blocked(points, sun, vertices[triangles])
        seen += ~hit & ~tie
        ties += tie
    assert np.all((found >= seen) & (found <= seen + ties))
    assert ties.sum() < 20
    assert len(np.unique(found)) > 10
