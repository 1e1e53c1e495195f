"""A tree whose branch groups are nodes that sway: one mesh for each group, with its twigs and fine leaves."""

import math
import random

from . import motion
from . import surface as s
from . import vector as v

TRUNK_HEIGHT, GROUPS, TWIGS, LEAVES_PER_TWIG = 2.7, 26, 9, 30
LEAF_LOOKS = ("leaf light", "leaf", "leaf dark")


def trunk():
    points = [(0, 0, 0), (0.06, 0.7, 0.02), (0.02, 1.5, 0.08), (-0.05, 2.2, 0.05), (0, TRUNK_HEIGHT + 0.7, 0)]
    return s.Model().add("bark", s.tube(points, [0.36, 0.27, 0.23, 0.20, 0.13], 14))


def leaf(at, along, draw):
    """A folded diamond: two triangles, an open surface."""
    size = draw.uniform(0.09, 0.15)
    side = v.normalize(v.cross(along, (draw.uniform(-1, 1), draw.uniform(-1, 1), draw.uniform(-1, 1))))
    up = v.cross(side, along)
    middle = v.add(at, v.add(v.scale(along, size * 0.45), v.scale(up, size * 0.12)))
    points = [at, v.add(middle, v.scale(side, size * 0.36)), v.add(at, v.scale(along, size)),
              v.add(middle, v.scale(side, -size * 0.36))]
    return s.Surface(points, [(0, 1, 2), (0, 2, 3)])


def direction(draw, around, width):
    wild = [draw.gauss(0, 1) for _ in range(3)]
    return v.normalize(v.add(around, v.scale(v.normalize(wild), width)))


def branch_group(out, reach, draw):
    """A branch from the origin along `out`, its twigs and leaves."""
    model = s.Model()
    bend = v.add(v.scale(out, reach * 0.5), (0, 0.08 * reach, 0))
    tip = v.add(v.scale(out, reach), (0, 0.05 * reach, 0))
    model.add("bark", s.tube([(0, 0, 0), bend, tip], [0.075, 0.05, 0.018], 7))
    for n in range(TWIGS):
        start = motion.spline([(0, 0, 0), bend, tip], 0.35 + 0.65 * n / (TWIGS - 1))
        way = direction(draw, v.add(out, (0, 0.15, 0)), 1.0)
        end = v.add(start, v.scale(way, draw.uniform(0.45, 0.85)))
        model.add("bark", s.tube([start, end], [0.017, 0.006], 5))
        look = draw.choice(LEAF_LOOKS)
        for k in range(LEAVES_PER_TWIG):
            at = v.add(v.mix(start, end, 0.15 + 0.85 * k / LEAVES_PER_TWIG), [draw.gauss(0, 0.05) for _ in range(3)])
            model.add(look, leaf(at, direction(draw, v.add(way, (0, -0.3, 0)), 0.9), draw))
    return model


def sway(draw, out, times, loop_s):
    """Small turns about an axis across the branch that return at the end: two whole numbers of swings."""
    axis = v.normalize(v.cross(out, (0.1, 1, 0.05)))
    slow, fast = draw.choice((2, 3)), draw.choice((5, 6, 7))
    p, q = draw.uniform(0, 6.28), draw.uniform(0, 6.28)
    return [v.axis_angle(axis, 0.045 * math.sin(2 * math.pi * slow * t / loop_s + p)
                         + 0.018 * math.sin(2 * math.pi * fast * t / loop_s + q)) for t in times]


def add_tree(document, looks, at, end_s, seed):
    draw = random.Random(seed)
    root = document.node("tree", translation=at, mesh=trunk().to_mesh(document, "trunk", looks))
    times = motion.key_times(end_s, 5)
    for n in range(GROUPS):
        height = n / (GROUPS - 1)
        turn, rise = 2.39996 * n, 0.12 + 1.1 * height ** 1.5
        out = v.normalize((math.cos(turn) * math.cos(rise), math.sin(rise), math.sin(turn) * math.cos(rise)))
        reach = 2.35 - 0.75 * height + draw.uniform(-0.2, 0.2)
        mesh = branch_group(out, reach, draw).to_mesh(document, "branch %d" % n, looks)
        turns = sway(draw, out, times, end_s)
        foot = (0.0, TRUNK_HEIGHT - 0.5 + 1.1 * height, 0.0)
        node = document.node("branch %d" % n, root, foot, turns[0], mesh=mesh)
        document.animate(node, "rotation", times, turns)
