"""A cloud of shards that gathers into two forms: a torus knot and a sphere, each shard moving on its own.

Core glTF in few bytes: the shards are one skinned mesh whose rest pose is the first form. The joints only
translate. At rest they are all at the origin; in the second form joint j stands on point j of a coarse lattice
that spans all displacements. The displacement of a vertex lies in one tetrahedron of the lattice, so four joints
with its barycentric coordinates as weights take it exactly (to a 255th of a cell) from the first form to its place
in the second. Which shard goes where is random: neighbours part, every shard has a path of its own."""

import math
import random

from . import vector as v

KNOT_STEPS, KNOT_SIDES, SPHERE_CELLS = 675, 18, 45
SHARD_COUNT = 2 * KNOT_STEPS * KNOT_SIDES  # = 12 * SPHERE_CELLS ** 2
SHRINK = 0.86                              # a shard's size in its cell, so that gaps show
LATTICE = (6, 6, 7)                        # 252 joints: one byte each


def torus_knot(t):
    """The (2, 3) knot around the y axis at 0 <= t < 1."""
    a = 2 * math.pi * t
    r = 0.95 + 0.42 * math.cos(3 * a)
    return (r * math.cos(2 * a), 0.62 * math.sin(3 * a), r * math.sin(2 * a))


def knot_point(i, s):
    t = (i % KNOT_STEPS) / KNOT_STEPS
    centre = torus_knot(t)
    along = v.normalize(v.sub(torus_knot(t + 1e-4), torus_knot(t - 1e-4)))
    x = v.normalize(v.cross((0, 1, 0), along))
    a = 2 * math.pi * s / KNOT_SIDES
    out = v.add(v.scale(x, math.cos(a)), v.scale(v.cross(along, x), math.sin(a)))
    return v.add(centre, v.scale(out, 0.24))


def knot_shards():
    for i in range(KNOT_STEPS):
        for s in range(KNOT_SIDES):
            a, b = knot_point(i, s), knot_point(i, s + 1)
            c, d = knot_point(i + 1, s + 1), knot_point(i + 1, s)
            yield a, b, c
            yield a, c, d


def sphere_point(face, i, j):
    """Point (i, j) of the grid on a face of the cube, on the sphere; evenly spread by the tangent."""
    x, y = (math.tan(math.pi / 4 * (2 * k / SPHERE_CELLS - 1)) for k in (i, j))
    axis, sign = face // 2, 1 - 2 * (face % 2)
    p = {axis: sign, (axis + 1) % 3: x * sign, (axis + 2) % 3: y}
    return v.scale(v.normalize((p[0], p[1], p[2])), 1.3)


def sphere_shards():
    for face in range(6):
        for i in range(SPHERE_CELLS):
            for j in range(SPHERE_CELLS):
                a, b = sphere_point(face, i, j), sphere_point(face, i + 1, j)
                c, d = sphere_point(face, i + 1, j + 1), sphere_point(face, i, j + 1)
                yield a, b, c
                yield a, c, d


def shrunk(shard):
    centre = v.scale(v.add(v.add(shard[0], shard[1]), shard[2]), 1 / 3)
    return [v.mix(centre, p, SHRINK) for p in shard]


class Lattice:
    """The joints' places in the second form, and the weights that reproduce any displacement inside."""

    def __init__(self, displacements):
        columns = list(zip(*displacements))
        self.low = tuple(min(c) for c in columns)
        self.cell = tuple((max(c) - min(c)) / (n - 1) for c, n in zip(columns, LATTICE))

    def points(self):
        nx, ny, nz = LATTICE
        return [tuple(self.low[k] + self.cell[k] * i[k] for k in range(3))
                for i in ((x, y, z) for x in range(nx) for y in range(ny) for z in range(nz))]

    def weights(self, displacement):
        """Four joints and their weights in 255ths: Kuhn's tetrahedron, the axes in falling order of fraction."""
        at = [(d - l) / c for d, l, c in zip(displacement, self.low, self.cell)]
        corner = [min(int(a), n - 2) for a, n in zip(at, LATTICE)]
        parts = [a - k for a, k in zip(at, corner)]
        joints, levels = [self._index(corner)], [1.0]
        for axis in sorted(range(3), key=lambda k: -parts[k]):
            corner[axis] += 1
            joints.append(self._index(corner))
            levels.append(parts[axis])
        marks = [int(255 * level + 0.5) for level in levels] + [0]
        weights = [marks[i] - marks[i + 1] for i in range(4)]
        return tuple(j if w else 0 for j, w in zip(joints, weights)), tuple(weights)

    def _index(self, corner):
        return (corner[0] * LATTICE[1] + corner[1]) * LATTICE[2] + corner[2]


def joint_path(goal, draw, times, spread):
    """Translations of one joint. `spread(t)`: (share of the way to the second form, strength of the storm)."""
    late = draw.uniform(-0.35, 0.35)
    rates = [draw.uniform(0.25, 0.6) for _ in range(3)]
    phases = [draw.uniform(0, 2 * math.pi) for _ in range(3)]
    path = []
    for t in times:
        share, storm = spread(t, late)
        turned = v.rotate(v.axis_angle((0.2, 1, 0.1), 1.1 * storm), goal)
        noise = tuple(1.15 * math.sin(2 * math.pi * r * t + p) for r, p in zip(rates, phases))
        path.append(v.add(v.scale(turned, share + 0.35 * storm * (1 - share)), v.scale(noise, storm)))
    return path


def add_shards(document, material, parent, times, spread, seed):
    """The sculpture under node `parent`; returns the number of shards."""
    draw = random.Random(seed)
    places = list(sphere_shards())
    draw.shuffle(places)
    pairs = [(p, q) for a, b in zip(knot_shards(), places) for p, q in zip(shrunk(a), shrunk(b))]
    moves = [v.sub(q, p) for p, q in pairs]
    lattice = Lattice(moves)
    rows = [lattice.weights(m) for m in moves]
    mesh = document.skinned_mesh("shards", [p for p, _ in pairs], [r[0] for r in rows], [r[1] for r in rows], material)
    joints = []
    for i, goal in enumerate(lattice.points()):
        joints.append(document.node("joint%d" % i, parent))
        document.animate(joints[-1], "translation", times, joint_path(goal, draw, times, spread))
    skin = document.skin("shards", joints, parent)
    document.node("shards", mesh=mesh, skin=skin)
    return len(pairs) // 3
