"""A square at noon: a plane tree of cut-out leaves, a glass pavilion lit from within, and a steel robot on its round."""

import math
import random

from . import motion
from . import robot
from . import surface as s
from . import vector as v
from .gltf import Document

END_S = 9.6   # eight cycles of the gait
HALF = 11.0
LOOKS = {"paving": (0.55, 0.52, 0.47), "kerb": (0.50, 0.48, 0.44), "rose wall": (0.62, 0.34, 0.26),
         "cream wall": (0.72, 0.65, 0.52), "trim stone": (0.66, 0.61, 0.53), "wood": (0.42, 0.23, 0.11),
         "iron": (0.20, 0.21, 0.23), "bark": (0.26, 0.19, 0.13), "soil": (0.14, 0.10, 0.07),
         "steel": (0.77, 0.78, 0.80), "brass": (0.83, 0.62, 0.30), "robot joint": (0.12, 0.12, 0.14)}
PAVILION, TREE = (3.4, 0.0, -3.2), (-3.0, 0.0, -1.6)
SPRAYS, CROWN = 190, 2.3


def ground():
    model = s.Model().add("paving", s.box((-HALF, -0.3, -HALF), (HALF, 0, HALF)))
    for x in (-HALF, HALF - 0.4):
        model.add("kerb", s.box((x, 0, -HALF), (x + 0.4, 0.14, HALF)))
    return model


def houses():
    """Two fronts behind the square, with windows that stand out."""
    model = s.Model()
    for n, (x0, x1, look, top) in enumerate(((-HALF, -1.0, "rose wall", 7.5), (-1.0, HALF, "cream wall", 6.4))):
        model.add(look, s.box((x0, 0, -HALF - 1), (x1, top, -HALF)))
        model.add("trim stone", s.box((x0, top, -HALF - 1.1), (x1, top + 0.25, -HALF + 0.15)))
        count = 4 + n
        for i in range(count):
            x = x0 + (i + 0.5) * (x1 - x0) / count
            for y in (1.1, 4.0):
                model.add("trim stone", s.box((x - 0.65, y - 0.12, -HALF), (x + 0.65, y, -HALF + 0.14)))
                model.add("wood", s.box((x - 0.5, y, -HALF), (x + 0.5, y + 1.7, -HALF + 0.06)))
    return model


def pavilion_frame():
    """Iron posts and beams of a pavilion 3 x 3 m, and its floor."""
    model, h, top = s.Model().add("wood", s.box((-1.7, 0, -1.7), (1.7, 0.16, 1.7))), 1.5, 2.7
    for x in (-h, 0, h):
        for z in (-h, 0, h):
            if x or z:
                model.add("iron", s.box((x - 0.04, 0.16, z - 0.04), (x + 0.04, top, z + 0.04)))
    for at in (-h, h):
        model.add("iron", s.box((-h - 0.04, top, at - 0.05), (h + 0.04, top + 0.1, at + 0.05)))
        model.add("iron", s.box((at - 0.05, top, -h + 0.05), (at + 0.05, top + 0.1, h - 0.05)))
    return model


def pane(width, height):
    return s.Model().add("pane", s.panel((-width / 2, 0, 0), (width, 0, 0), (0, height, 0)))


def add_pavilion(document, looks):
    looks["pane"] = document.glass_material("clear glass", (0.92, 0.97, 0.95), transmission=0.9)
    green = {"pane": document.glass_material("green glass", (0.25, 0.65, 0.40), alpha=0.4)}
    amber = {"pane": document.glass_material("amber glass", (0.95, 0.55, 0.15), alpha=0.45)}
    root = document.node("pavilion", translation=PAVILION, mesh=pavilion_frame().to_mesh(document, "pavilion", looks))
    meshes = [pane(1.38, 2.4).to_mesh(document, "%s pane" % name, look)
              for name, look in (("clear", looks), ("green", green), ("amber", amber))]
    for side in range(4):
        turn = v.axis_angle((0, 1, 0), side * math.pi / 2)
        for half in (-1, 1):
            if side == 0 and half == 1:
                continue  # the way in
            at = v.rotate(turn, (half * 0.75, 0.2, 1.5))
            document.node("pane %d %d" % (side, half), root, at, turn, mesh=meshes[(side + (half > 0)) % 3])
    roof = pane(3.0, 3.0).to_mesh(document, "roof pane", looks)
    document.node("roof pane", root, (0, 2.81, 1.5), v.axis_angle((1, 0, 0), -math.pi / 2), mesh=roof)


def spray_cards(draw, count, spread):
    """Square cards with a spray of leaves each, around the origin."""
    positions, coordinates, triangles = [], [], []
    for _ in range(count):
        out = v.normalize([draw.gauss(0, 1) for _ in range(3)])
        at = v.scale((out[0], 0.75 * out[1], out[2]), spread * draw.random() ** 0.4)
        x = v.normalize(v.cross(out, (draw.gauss(0, 1), draw.gauss(0, 1), draw.gauss(0, 1))))
        y = v.normalize(v.add(v.cross(out, x), v.scale(out, draw.uniform(-0.5, 0.5))))
        half, first = draw.uniform(0.24, 0.4), len(positions)
        for u, w in ((0, 1), (1, 1), (1, 0), (0, 0)):
            corner = v.add(v.scale(x, half * (2 * u - 1)), v.scale(y, half * (1 - 2 * w)))
            positions.append(v.add(at, corner))
            coordinates.append((float(u), float(w)))
        triangles += [(first, first + 1, first + 2), (first, first + 2, first + 3)]
    return positions, coordinates, triangles


def add_tree(document, looks):
    draw = random.Random(9)
    points = [(0, 0, 0), (0.05, 0.9, 0.03), (-0.04, 1.9, 0.0), (0.0, 3.0, 0.04)]
    model = s.Model().add("bark", s.tube(points, [0.26, 0.2, 0.16, 0.09], 12))
    model.add("soil", s.box((-0.8, 0, -0.8), (0.8, 0.05, 0.8)))
    root = document.node("tree", translation=TREE, mesh=model.to_mesh(document, "trunk", looks))
    leaves = document.cutout_material("leaves", "leaves", (0.9, 0.95, 0.85))
    times = motion.key_times(END_S, 4)
    for n in range(5):
        angle = 2 * math.pi * n / 4
        foot = (0.9 * math.cos(angle), 3.2, 0.9 * math.sin(angle)) if n < 4 else (0.0, 4.1, 0.0)
        mesh = document.card_mesh("crown %d" % n, *spray_cards(draw, SPRAYS // 5, 0.6 * CROWN), leaves)
        sways = [v.axis_angle((0.6, 0, 0.8), 0.04 * math.sin(2 * math.pi * (2 + n % 2) * t / END_S + n)) for t in times]
        node = document.node("crown %d" % n, root, foot, sways[0], mesh=mesh)
        document.animate(node, "rotation", times, sways)


def add_robot(document, looks):
    dress = {"shell": looks["steel"], "trim": looks["brass"], "joint": looks["robot joint"],
             "eye": document.material("robot eye", (0.1, 0.1, 0.1), emissive=(0.25, 0.85, 1.0))}
    meshes = {name: m.to_mesh(document, "robot " + name, dress) for name, m in robot.parts().items()}
    robot.add_robot(document, "robot", meshes, robot.Gait(END_S, 0.0), (-5.2, 0.0, 2.2), 0.52 * math.pi, None)


def add_lights(document, looks):
    sun = document.punctual_light("sun", "directional", (1.0, 0.95, 0.86), 2.6)
    document.node("sun", rotation=v.look_rotation((-0.5, 1.0, 0.65), (0, 0, 0)), extensions=sun)
    lamp = document.punctual_light("pavilion lamp", "point", (1.0, 0.75, 0.45), 18.0)
    document.node("pavilion lamp", translation=v.add(PAVILION, (0, 2.3, 0)), extensions=lamp)
    silent = {"casts_shadow": False}
    looks["panel"] = document.material("lit panel", (0.0, 0.0, 0.0), emissive=(0.75, 0.85, 1.0), extras=silent)
    at, towards = (1.0, 4.6, 1.2), (4.6, 0.2, 4.4)  # the tree stands behind it: its leaves are for hard shadows
    root = document.node("sign", translation=at, rotation=v.look_rotation(at, towards))
    document.node("sign light", root, extensions=document.rect_light("sign light", (0.75, 0.85, 1.0), 45.0, 1.8, 1.0))
    face = s.Model().add("panel", s.panel((0.9, -0.5, 0), (-1.8, 0, 0), (0, 1.0, 0)))
    document.node("sign face", root, mesh=face.to_mesh(document, "sign face", looks, silent))


def build():
    document = Document("square", ambient_light=(0.22, 0.25, 0.30), background=(0.45, 0.62, 0.85))
    looks = {name: document.material(name, color) for name, color in LOOKS.items()}
    document.node("ground", mesh=ground().to_mesh(document, "ground", looks))
    document.node("houses", mesh=houses().to_mesh(document, "houses", looks))
    add_pavilion(document, looks)
    add_tree(document, looks)
    add_robot(document, looks)
    add_lights(document, looks)
    motion.add_camera(document, "round", 50,
                      [(1.5, 1.7, 8.6), (0.2, 1.6, 7.6), (-1.6, 1.8, 7.0), (-3.0, 2.2, 7.4)],
                      [(-0.6, 1.7, -1.0), (-0.2, 1.6, -1.2), (0.4, 1.6, -1.6), (0.8, 1.6, -2.0)], END_S)
    return document
