#!/usr/bin/env python3
"""Writes museum5x64.aff: BART's museum with each of the 1,024 animated triangles of animart5.aff split 64-fold.

10,284 + 8 cones + 65,536 animated triangles: as many as museum8.aff has, BART's finest, whose animart8.aff is not
among the public copies that were found. Each key's triangle is halved at its edge midpoints three times; every piece is
then turned about its centroid and moved, by normally distributed amounts that are its own and the same at all keys
(0.5 rad; half its own size along each axis), so that the pieces form a cloud of separate triangles. It is a stand-in:
results call it museum5x64, never museum8.

usage: make_museum5x64.py MUSEUM OUTPUT     (BART's folder museum; a folder, which needs 65 MB)
"""
import math
import pathlib
import shutil
import sys

TURN_RAD = 0.5
SHIFT = 0.5


def read_triangles(path):
    """One list per triangle of (time, [x y z nx ny nz] * 3)."""
    words = iter(path.read_text().split())
    for word in words:
        assert word == "tpa", word
        count = int(next(words))
        yield [(next(words), [[float(next(words)) for _ in range(6)] for _ in range(3)]) for _ in range(count)]


def midpoint(a, b):
    return [(p + q) / 2 for p, q in zip(a, b)]


def split(triangle, depth):
    if depth == 0:
        return [triangle]
    a, b, c = triangle
    ab, bc, ca = midpoint(a, b), midpoint(b, c), midpoint(c, a)
    return [s for t in ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)) for s in split(t, depth - 1)]


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def dot(a, b):
    return sum(p * q for p, q in zip(a, b))


class Random:
    """A 64-bit linear congruential generator (Knuth's MMIX constants): the same file on every machine."""

    def __init__(self):
        self.state = 1

    def uniform(self):
        self.state = (self.state * 6364136223846793005 + 1442695040888963407) % 2**64
        return ((self.state >> 11) + 0.5) / 2**53

    def normal(self):
        return math.sqrt(-2 * math.log(self.uniform())) * math.cos(2 * math.pi * self.uniform())

    def direction(self):
        v = [self.normal() for _ in range(3)]
        length = math.sqrt(dot(v, v))
        return [x / length for x in v]


def turned(v, axis, angle):
    """v rotated about the unit axis (Rodrigues)."""
    c, s = math.cos(angle), math.sin(angle)
    across, along = cross(axis, v), dot(axis, v) * (1 - c)
    return [c * v[i] + s * across[i] + along * axis[i] for i in range(3)]


def moved(triangle, axis, angle, offset):
    a, b, c = (v[:3] for v in triangle)
    centroid = [(p + q + r) / 3 for p, q, r in zip(a, b, c)]
    normal = cross([q - p for p, q in zip(a, b)], [q - p for p, q in zip(a, c)])
    size = math.sqrt(math.sqrt(dot(normal, normal)))
    for vertex in triangle:
        arm = turned([p - q for p, q in zip(vertex[:3], centroid)], axis, angle)
        yield [centroid[i] + arm[i] + SHIFT * size * offset[i] for i in range(3)] + turned(vertex[3:], axis, angle)


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    museum, out = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
    out.mkdir(parents=True, exist_ok=True)
    for name in ("block.aff", "camera.aff", "paintings.aff", "pillar.aff", "room.aff"):
        shutil.copy(museum / name, out / name)
    top = (museum / "museum5.aff").read_text().replace("Anim Tris:1024", "Anim Tris:65536")
    for name in ("museum5.aff", "animart5.aff"):
        top = top.replace(name, name.replace("5", "5x64"))
    (out / "museum5x64.aff").write_text(top)
    random = Random()
    with open(out / "animart5x64.aff", "w") as file:
        for keys in read_triangles(museum / "animart5.aff"):
            pieces = [split(triangle, 3) for _, triangle in keys]
            for piece in range(64):
                axis, angle = random.direction(), TURN_RAD * random.normal()
                offset = [random.normal() for _ in range(3)]
                file.write(f"tpa {len(keys)}\n")
                for (time, _), level in zip(keys, pieces):
                    file.write(f" {time}\n")
                    for vertex in moved(level[piece], axis, angle, offset):
                        file.write("  " + " ".join(f"{x:.6f}" for x in vertex) + "\n")


if __name__ == "__main__":
    main()
