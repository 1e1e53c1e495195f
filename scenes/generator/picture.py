"""Small tileable pictures, made of nothing but numbers, as PNG files: the same bytes on every machine."""

import random
import struct
import zlib

SIZE = 256


def _chunk(kind, data):
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


def _stored(data):
    """A zlib stream that stores: compressors differ from version to version, and so would the bytes."""
    parts = [b"\x78\x01"]
    for first in range(0, len(data), 65535):
        block = data[first:first + 65535]
        last = first + 65535 >= len(data)
        parts.append(struct.pack("<BHH", last, len(block), len(block) ^ 0xffff) + block)
    return b"".join(parts) + struct.pack(">I", zlib.adler32(data))


def png(palette, alphas, rows):
    """Indexed colour; `alphas` may be empty."""
    height, width = len(rows), len(rows[0])
    data = b"".join(b"\0" + bytes(row) for row in rows)
    chunks = [_chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 3, 0, 0, 0)),
              _chunk(b"PLTE", b"".join(bytes(c) for c in palette))]
    if alphas:
        chunks.append(_chunk(b"tRNS", bytes(alphas)))
    return b"\x89PNG\r\n\x1a\n" + b"".join(chunks + [_chunk(b"IDAT", _stored(data)), _chunk(b"IEND", b"")])


def noise(across, down, seed):
    """A tileable function of (x, y) in 0 to 1, with values in 0 to 1: smooth between across x down random ones."""
    draw = random.Random(seed)
    knots = [[draw.random() for _ in range(across)] for _ in range(down)]

    def value(x, y):
        x, y = x % 1.0 * across, y % 1.0 * down
        i, k = int(x), int(y)
        u, w = x - i, y - k
        u, w = u * u * (3 - 2 * u), w * w * (3 - 2 * w)
        i, k, j, l = i % across, k % down, (i + 1) % across, (k + 1) % down
        upper = knots[k][i] + u * (knots[k][j] - knots[k][i])
        lower = knots[l][i] + u * (knots[l][j] - knots[l][i])
        return upper + w * (lower - upper)

    return value


def layered(across, down, octaves, seed):
    layers = [(0.5 ** n, noise(across * 2 ** n, down * 2 ** n, seed + n)) for n in range(octaves)]
    total = sum(weight for weight, _ in layers)
    return lambda x, y: sum(weight * layer(x, y) for weight, layer in layers) / total


def grey(shade, low=120, high=255):
    """A picture of `shade`(x, y), 0 to 1, in 64 greys between `low` and `high` (encoded values)."""
    palette = [[low + (high - low) * i // 63] * 3 for i in range(64)]
    rows = [[min(63, max(0, int(64 * shade((x + 0.5) / SIZE, (y + 0.5) / SIZE)))) for x in range(SIZE)]
            for y in range(SIZE)]
    return png(palette, [], rows)


def asphalt():
    stones, patches = noise(128, 128, 1), layered(4, 4, 3, 2)
    return grey(lambda x, y: 0.25 + 0.5 * stones(x, y) ** 2 + 0.35 * patches(x, y), 90)


def plaster():
    coarse, fine = layered(5, 5, 4, 11), noise(96, 96, 15)
    return grey(lambda x, y: 0.35 + 0.5 * coarse(x, y) + 0.2 * fine(x, y), 150)


def stone():
    veins, grain = layered(4, 6, 5, 21), noise(128, 128, 26)
    return grey(lambda x, y: 0.30 + 0.25 * grain(x, y) + 0.6 * abs(2 * veins(x, y) - 1), 140)


def bricks():
    """Eight courses of four bricks, every other course half a brick on."""
    draw, grain = random.Random(31), noise(96, 96, 32)
    tone = [[draw.uniform(0.35, 0.8) for _ in range(4)] for _ in range(8)]

    def shade(x, y):
        course = int(8 * y)
        along = 4 * x + 0.5 * (course % 2)
        u, w = along % 1.0, 8 * y - course
        if u < 0.05 or w < 0.11:
            return 0.85 + 0.14 * grain(x, y)
        return tone[course][int(along) % 4] * (0.75 + 0.35 * grain(x, y))

    return grey(shade, 105)


def wood():
    """Grain along x: rings bent by noise."""
    bend, fibre = layered(2, 3, 3, 41), noise(8, 128, 44)

    def shade(x, y):
        ring = (9 * (y + 0.35 * bend(x, y))) % 1.0
        return 0.30 + 0.40 * abs(2 * ring - 1) + 0.35 * fibre(x, y)

    return grey(shade, 115)


def leaves():
    """A spray of leaves with a soft edge in alpha, tileable nowhere: clamp it. 28 greens x 9 alphas. Few pixels: along
    the edges of leaves each costs a triangle of every card."""
    import math
    side, greens, levels = 96, 28, 9
    draw = random.Random(51)
    blades = []
    for n in range(22):
        x, y, turn = draw.uniform(0.18, 0.82), draw.uniform(0.18, 0.82), draw.uniform(0, 6.283)
        size = draw.uniform(0.1, 0.17)
        blades.append((x, y, math.cos(turn), math.sin(turn), size, draw.uniform(0.35, 1.0)))
    top = greens - 1
    palette = [[60 + 110 * i // top, 105 + 140 * i // top, 30 + 60 * i // top] for i in range(greens)] * levels
    alphas = [255 * level // (levels - 1) for level in range(levels) for _ in range(greens)]
    rows = []
    for row in range(side):
        line = []
        for column in range(side):
            x, y = (column + 0.5) / side, (row + 0.5) / side
            best, tone = -9.0, 0.5
            for bx, by, c, s, size, shade in blades:
                dx, dy = x - bx, y - by
                if abs(dx) > 1.2 * size or abs(dy) > 1.2 * size:
                    continue
                u, w = (dx * c + dy * s) / size, (dy * c - dx * s) / size
                depth = (0.36 * (1 - u * u) - abs(w)) * size * side  # pixels within the edge, about
                if depth > best:
                    best, tone = depth, shade * (0.8 if abs(w) < 0.05 else 1.0)
            level = min(levels - 1, max(0, int((levels - 1) * (0.5 + best / 3) + 0.5)))
            line.append(greens * level + int(top * tone))
        rows.append(line)
    return png(palette, alphas, rows)


PICTURES = {"asphalt": asphalt, "plaster": plaster, "stone": stone, "bricks": bricks, "wood": wood, "leaves": leaves}
_made = {}


def of(name):
    if name not in _made:
        _made[name] = PICTURES[name]()
    return _made[name]
