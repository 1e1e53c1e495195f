"""A museum hall: pillars, paintings, and over a block a sculpture of 24,300 shards that tears apart and gathers."""

import math
import random

from . import motion
from . import shards
from . import surface as s
from . import vector as v
from .gltf import Document

END_S = 12.0
HALF_X, HALF_Z, HEIGHT = 9.0, 7.0, 7.6
PILLARS = [(x, z) for x in (-5.6, 5.6) for z in (-4.4, 0.0, 4.4)]
SCULPTURE = (0.0, 3.05, 0.0)
LOOKS = {
    "plaster": (0.62, 0.58, 0.52), "ceiling": (0.70, 0.69, 0.66), "pale tile": (0.55, 0.52, 0.47),
    "dark tile": (0.16, 0.17, 0.19), "stone": (0.56, 0.53, 0.48), "block": (0.10, 0.11, 0.13),
    "frame": (0.42, 0.27, 0.09), "wood": (0.24, 0.12, 0.06), "skirting": (0.20, 0.16, 0.13),
    "red": (0.55, 0.09, 0.06), "blue": (0.07, 0.17, 0.40), "ochre": (0.68, 0.42, 0.10),
    "green": (0.10, 0.28, 0.18), "cream": (0.74, 0.68, 0.54), "ink": (0.04, 0.05, 0.08)}


def hall():
    model = s.Model()
    x, z, h, wall = HALF_X, HALF_Z, HEIGHT, 0.4
    for side in (-1, 1):
        across = sorted((side * x, side * (x + wall)))
        along = sorted((side * z, side * (z + wall)))
        model.add("plaster", s.box((across[0], 0, -z - wall), (across[1], h, z + wall)))
        model.add("plaster", s.box((-x, 0, along[0]), (x, h, along[1])))
        model.add("skirting", s.box((-x, 0, min(side * z, side * (z - 0.06))), (x, 0.28, max(side * z, side * (z - 0.06)))))
    model.add("ceiling", s.box((-x - wall, h, -z - wall), (x + wall, h + 0.3, z + wall)))
    for beam in (-4.4, 0.0, 4.4):
        model.add("ceiling", s.box((-x, h - 0.35, beam - 0.22), (x, h, beam + 0.22)))
    add_floor(model)
    return model


def add_floor(model):
    """Square slabs, side by side, two colours."""
    for i in range(-9, 9):
        for k in range(-7, 7):
            look = "dark tile" if (i + k) % 2 else "pale tile"
            model.add(look, s.panel((i, 0, k), (0, 0, 1), (1, 0, 0)))


def pillar():
    model = s.Model()
    model.add("stone", s.box_on((0, 0, 0), (1.0, 0.3, 1.0)), s.box_on((0, HEIGHT - 0.65, 0), (1.0, 0.3, 1.0)))
    profile = [(0, 0.3), (0.44, 0.3), (0.44, 0.3), (0.46, 0.38), (0.36, 0.5), (0.36, 0.5), (0.31, HEIGHT - 0.95),
               (0.31, HEIGHT - 0.95), (0.44, HEIGHT - 0.65), (0.44, HEIGHT - 0.65), (0, HEIGHT - 0.65)]
    return model.add("stone", s.lathe(profile, 32))


def painting(width, height, draw):
    """A framed picture on the plane z = 0, facing +z: fields of colour on a ground."""
    model, w, h, rim = s.Model(), width / 2, height / 2, 0.12
    for low, high in (((-w - rim, h), (w + rim, h + rim)), ((-w - rim, -h - rim), (w + rim, -h)),
                      ((-w - rim, -h), (-w, h)), ((w, -h), (w + rim, h))):
        model.add("frame", s.box((*low, 0), (*high, 0.12)))
    model.add(draw.choice(("cream", "ink", "blue")), s.box((-w, -h, 0), (w, h, 0.04)))
    for depth in range(1, 5):
        look = draw.choice(("red", "ochre", "green", "blue", "cream", "ink"))
        a, b = draw.uniform(0.12, 0.34) * width, draw.uniform(0.10, 0.36) * height
        cx, cy = draw.uniform(a - w, w - a) * 0.9, draw.uniform(b - h, h - b) * 0.9
        model.add(look, s.box((cx - a, cy - b, 0.04 - 0.005 * depth), (cx + a, cy + b, 0.04 + 0.012 * depth)))
    return model


def block():
    model = s.Model()
    model.add("block", s.chamfered_box((-1.15, 0.22, -1.15), (1.15, 0.9, 1.15), 0.05))
    return model.add("stone", s.chamfered_box((-1.7, 0, -1.7), (1.7, 0.22, 1.7), 0.04))


def bench():
    model = s.Model().add("wood", s.chamfered_box((-1.1, 0.38, -0.28), (1.1, 0.47, 0.28), 0.02))
    return model.add("ink", s.box((-0.9, 0, -0.22), (-0.82, 0.38, 0.22)), s.box((0.82, 0, -0.22), (0.9, 0.38, 0.22)))


def spread(t, late):
    """Knot, storm, sphere, storm, knot: share of the way to the sphere and strength of the storm at `t`."""
    out = v.smoothstep((t - 2.6 - late) / 2.6)
    back = v.smoothstep((t - 8.2 - late) / 2.6)
    share = out - back
    storm = math.sin(math.pi * v.smoothstep((t - 1.4) / 4.6)) + math.sin(math.pi * v.smoothstep((t - 7.2) / 4.4))
    return share, max(0.0, storm) * 0.9


def add_paintings(document, looks):
    draw = random.Random(11)
    for n, x in enumerate((-7.3, -2.9, 2.9, 7.3)):
        for side in (-1, 1):
            mesh = painting(1.9, 2.3 if n % 3 else 1.6, draw).to_mesh(document, "painting %d %d" % (n, side), looks)
            turn = v.axis_angle((0, 1, 0), 0 if side < 0 else math.pi)
            document.node("painting %d %d" % (n, side), translation=(x, 2.6, side * HALF_Z), rotation=turn, mesh=mesh)
    for side in (-1, 1):
        mesh = painting(3.4, 2.4, draw).to_mesh(document, "large painting %d" % side, looks)
        turn = v.axis_angle((0, 1, 0), -side * math.pi / 2)
        document.node("large painting %d" % side, translation=(side * HALF_X, 2.8, 0), rotation=turn, mesh=mesh)


def add_lights(document):
    warm = document.punctual_light("warm lamp", "point", (1.0, 0.86, 0.66), 72.0)
    cool = document.punctual_light("cool lamp", "point", (0.70, 0.83, 1.0), 42.0)
    document.node("warm lamp", translation=(3.6, 5.0, 2.4), extensions=warm)
    document.node("cool lamp", translation=(-3.4, 4.8, -2.4), extensions=cool)


def add_sculpture(document, look):
    rig = document.node("sculpture", translation=SCULPTURE)
    times = motion.key_times(END_S, 4)
    turn = [v.axis_angle((0, 1, 0), math.pi * t / END_S) for t in times]
    document.animate(rig, "rotation", times, motion.same_side(turn))
    shards.add_shards(document, look, rig, times, spread, seed=7)


def build():
    document = Document("gallery", ambient_light=(0.10, 0.10, 0.115), background=(0.02, 0.02, 0.025))
    looks = {name: document.material(name, color) for name, color in LOOKS.items()}
    document.node("hall", mesh=hall().to_mesh(document, "hall", looks))
    column = pillar().to_mesh(document, "pillar", looks)
    for n, (x, z) in enumerate(PILLARS):
        document.node("pillar %d" % n, translation=(x, 0, z), mesh=column)
    document.node("block", mesh=block().to_mesh(document, "block", looks), translation=(0, 0, 0))
    seat = bench().to_mesh(document, "bench", looks)
    for n, z in enumerate((-4.4, 4.4)):
        document.node("bench %d" % n, translation=(0, 0, z), mesh=seat)
    add_paintings(document, looks)
    add_sculpture(document, document.material("shards", (0.80, 0.42, 0.14), double_sided=True))
    add_lights(document)
    eyes = [(4.6 * math.sin(a), 1.75 + 0.35 * math.sin(2 * a), 5.3 * math.cos(a)) for a in
            (0.25 + 2.3 * i / 8 for i in range(9))]
    motion.add_camera(document, "visitor", 60, eyes, [(0, 2.5, 0), (0.2, 2.7, 0), (0, 2.7, 0)], END_S)
    return document
