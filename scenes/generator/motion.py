"""Key times and the paths of cameras."""

import math

from . import vector as v


def key_times(end_s, keys_per_s):
    return [i / keys_per_s for i in range(int(round(end_s * keys_per_s)) + 1)]


def spline(points, t):
    """The Catmull-Rom curve through `points` at 0 <= t <= 1."""
    t = min(max(t, 0.0), 1.0) * (len(points) - 1)
    i = min(int(t), len(points) - 2)
    u = t - i
    p0, p1, p2, p3 = (points[min(max(k, 0), len(points) - 1)] for k in (i - 1, i, i + 1, i + 2))
    return tuple(0.5 * (2 * b + (c - a) * u + (2 * a - 5 * b + 4 * c - d) * u * u + (3 * b - a - 3 * c + d) * u ** 3)
                 for a, b, c, d in zip(p0, p1, p2, p3))


def add_camera(document, name, vertical_fov_deg, eyes, targets, end_s, keys_per_s=10):
    """A camera that travels the splines through `eyes` and `targets` at even time."""
    camera = document.camera(name, math.radians(vertical_fov_deg))
    times = key_times(end_s, keys_per_s)
    path = [spline(eyes, t / end_s) for t in times]
    turns = [v.look_rotation(eye, spline(targets, t / end_s)) for eye, t in zip(path, times)]
    node = document.node(name, translation=path[0], rotation=turns[0], camera=camera)
    document.animate(node, "translation", times, path)
    document.animate(node, "rotation", times, same_side(turns))
    return node


def same_side(turns):
    """Signs of quaternions chosen so that neighbours lie on one side: any reader takes the short way."""
    result = [turns[0]]
    for q in turns[1:]:
        near = sum(a * b for a, b in zip(q, result[-1])) >= 0
        result.append(q if near else tuple(-c for c in q))
    return result
