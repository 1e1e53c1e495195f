"""A street with ten walking robots: high walls with windows in them, an arcade, a gate at the far end."""

import math
import random

from . import motion
from . import robot
from . import surface as s
from . import vector as v
from .gltf import Document

END_S = 10.0
KERB_X, FRONT_X, LENGTH = 4.0, 7.2, 84.0   # the street runs from z = 12 to z = -72
START_Z, END_Z = 12.0, 12.0 - LENGTH
LOOKS = {
    "asphalt": (0.085, 0.088, 0.10), "paving": (0.36, 0.34, 0.31), "kerb": (0.50, 0.48, 0.44),
    "marking": (0.72, 0.70, 0.62), "glass": (0.06, 0.09, 0.12), "iron": (0.06, 0.065, 0.075),
    "wood": (0.34, 0.17, 0.07), "trim stone": (0.66, 0.61, 0.53), "awning": (0.58, 0.10, 0.06),
    "leaf": (0.12, 0.27, 0.07), "gate": (0.56, 0.47, 0.36), "ochre wall": (0.66, 0.45, 0.22),
    "rose wall": (0.60, 0.33, 0.26), "cream wall": (0.70, 0.62, 0.47), "sage wall": (0.36, 0.42, 0.33),
    "slate wall": (0.30, 0.35, 0.43)}
WALLS = ("ochre wall", "cream wall", "rose wall", "slate wall", "sage wall")
PALETTES = ({"shell": (0.72, 0.70, 0.66), "trim": (0.75, 0.22, 0.05)}, {"shell": (0.10, 0.30, 0.52), "trim": (0.70, 0.62, 0.45)},
            {"shell": (0.78, 0.46, 0.06), "trim": (0.12, 0.13, 0.16)}, {"shell": (0.48, 0.07, 0.06), "trim": (0.62, 0.60, 0.56)},
            {"shell": (0.14, 0.40, 0.32), "trim": (0.74, 0.66, 0.50)})
# x, z at the start, heading (0: along +z, towards the camera), shift of the gait in cycles, palette
WALKERS = ((-1.4, -14.0, 0.0, 0.0, 0), (1.2, -17.0, 0.0, 0.25, 2), (2.6, -3.0, math.pi, 0.5, 1),
           (-2.7, -9.0, math.pi, 0.75, 3), (0.1, -25.0, 0.0, 0.5, 4), (-5.5, -20.0, 0.0, 0.25, 1),
           (5.4, -26.0, 0.0, 0.75, 3), (5.9, -7.0, math.pi, 0.0, 4), (-2.2, -34.0, 0.0, 0.75, 2),
           (2.9, -38.0, 0.0, 0.0, 0))


def ground():
    model = s.Model()
    model.add("asphalt", s.panel((-KERB_X, 0, START_Z), (2 * KERB_X, 0, 0), (0, 0, -LENGTH)))
    for side in (-1, 1):
        outer, inner = side * (FRONT_X + 4.5), side * (KERB_X + 0.3)
        model.add("paving", s.box((min(outer, inner), -0.1, END_Z), (max(outer, inner), 0.15, START_Z)))
        edge = side * KERB_X
        model.add("kerb", s.box((min(edge, inner), -0.1, END_Z), (max(edge, inner), 0.15, START_Z)))
    for i in range(20):
        model.add("marking", s.box_on((0, 0, START_Z - 3 - 4 * i), (0.16, 0.006, 1.8)))
    for i in range(8):  # a crossing
        model.add("marking", s.box_on((-3.5 + i, 0, -8.0), (0.5, 0.006, 2.6)))
    return model


def facade(width, floors, look, draw):
    """A house on x in (0, width), its front on z = 0 facing +z; walls with windows set back into them."""
    model, floor_h, bays = s.Model(), 3.3, max(2, int(width / 2.6))
    pitch, depth = width / bays, 0.42
    top = 4.0 + floors * floor_h
    model.add(look, s.box((0, 0.15, -5.0), (width, top, -depth)))
    for floor in range(floors + 1):
        low, high = (0.15, 4.0) if floor == 0 else (4.0 + (floor - 1) * floor_h, 4.0 + floor * floor_h)
        add_storey(model, look, low, high, pitch, bays, depth, floor == 0)
    model.add("trim stone", s.box((-0.0, top, -5.0), (width, top + 0.35, 0.38)),
              s.box((0.0, 3.72, 0.0), (width, 3.98, 0.16)))
    if draw.random() < 0.6:
        model.add("iron", s.box((width * 0.6, top + 0.35, -3.2), (width * 0.6 + 1.2, top + 1.6, -2.0)))
    return model


def add_storey(model, look, low, high, pitch, bays, depth, shop):
    """Piers, a sill wall and a lintel in front of the glass."""
    sill, head, half = (0.45, 0.75, 0.95) if shop else (0.85, 0.62, 0.6)
    for bay in range(bays):
        left, right = bay * pitch, (bay + 1) * pitch
        a, b = (left + right) / 2 - half, (left + right) / 2 + half
        model.add(look, s.box((left, low, -depth), (a, high, 0)), s.box((b, low, -depth), (right, high, 0)),
                  s.box((a, low, -depth), (b, low + sill, 0)), s.box((a, high - head, -depth), (b, high, 0)))
        model.add("glass", s.box((a, low + sill, -depth), (b, high - head, -depth + 0.06)))
        middle = (a + b) / 2
        model.add("trim stone", s.box((middle - 0.035, low + sill, -depth + 0.06), (middle + 0.035, high - head, -depth + 0.1)))
        if not shop:
            model.add("trim stone", s.box((a - 0.08, low + sill - 0.1, 0), (b + 0.08, low + sill, 0.12)))


def awning(width):
    """A sloping cloth in front of a shop, closed."""
    lower, upper = [(0.0, 3.30), (1.5, 2.75)], [(0.0, 3.36), (1.5, 2.81)]
    return s.extruded_strip(lower, upper, -width / 2, width / 2).turned_y(-math.pi / 2)


def arcade(length, bays):
    """A long covered walk: round arches on piers before a wall, x in (0, length), the front on z = 0."""
    model, pitch, depth, height = s.Model(), length / bays, 0.7, 5.6
    for bay in range(bays):
        x0, x1, spring = bay * pitch, (bay + 1) * pitch, 2.6
        r = (pitch - 0.8) / 2
        curve = [((x0 + x1) / 2 - r * math.cos(math.pi * i / 14), spring + r * math.sin(math.pi * i / 14))
                 for i in range(15)]
        lower = [(x0, spring)] + curve + [(x1, spring)]
        model.add("cream wall", s.extruded_strip(lower, [(x, height) for x, _ in lower], -depth, 0))
        model.add("cream wall", s.box((x0, 0.15, -depth), (x0 + 0.4, spring, 0)),
                  s.box((x1 - 0.4, 0.15, -depth), (x1, spring, 0)))
        model.add("trim stone", s.box((x0 - 0.0, spring - 0.16, 0), (x0 + 0.46, spring + 0.04, 0.08)),
                  s.box((x1 - 0.46, spring - 0.16, 0), (x1, spring + 0.04, 0.08)))
    model.add("trim stone", s.box((0, height, -4.3), (length, height + 0.4, 0.3)))
    model.add("ochre wall", s.box((0, 0.15, -4.6), (length, 14.5, -4.3)))
    return model


def gate():
    """Closes the street: a high wall with one arch, towers beside it."""
    model, r, spring, height = s.Model(), 3.2, 4.2, 15.0
    curve = [(-r * math.cos(math.pi * i / 24), spring + r * math.sin(math.pi * i / 24)) for i in range(25)]
    lower = [(-7.0, spring)] + curve + [(7.0, spring)]
    model.add("gate", s.extruded_strip(lower, [(x, height) for x, _ in lower], -2.0, 0))
    for side in (-1, 1):
        a, b = sorted((side * r, side * 7.0))
        model.add("gate", s.box((a, 0, -2.0), (b, spring, 0)))
        model.add("trim stone", s.cylinder(2.3, -0.25, 20.0, 32).moved((side * 9.0, 0, -1.0)))
        model.add("slate wall", s.cylinder(2.7, 20.0, 25.0, 32, top_radius=0.05).moved((side * 9.0, 0, -1.0)))
    for i in range(9):
        model.add("gate", s.box_on((-6.0 + 1.5 * i, height, -0.4), (0.8, 0.9, 0.8)))
    return model


def lamp_post():
    model = s.Model().add("iron", s.cylinder(0.16, 0, 0.5, 12, 0.10), s.cylinder(0.055, 0.5, 4.6, 12))
    model.add("iron", s.tube([(0, 4.5, 0), (0.3, 4.85, 0), (0.9, 4.95, 0)], [0.04, 0.04, 0.03], 8))
    model.add("lamp", s.sphere(0.17, 16, 10, (0.95, 4.78, 0)))
    return model.add("iron", s.cylinder(0.24, 4.90, 5.02, 16, 0.05).moved((0.95, 0, 0)))


def bench():
    model = s.Model()
    for i in range(4):
        model.add("wood", s.chamfered_box((-0.9, 0.43, -0.26 + 0.13 * i), (0.9, 0.47, -0.15 + 0.13 * i), 0.01))
    for i in range(3):
        model.add("wood", s.chamfered_box((-0.9, 0.55 + 0.13 * i, -0.34), (0.9, 0.65 + 0.13 * i, -0.30), 0.01))
    for x in (-0.75, 0.75):
        model.add("iron", s.box((x - 0.03, 0, -0.26), (x + 0.03, 0.43, 0.24)),
                  s.box((x - 0.03, 0.43, -0.30), (x + 0.03, 0.95, -0.27)))
    return model


def planter():
    model = s.Model().add("trim stone", s.chamfered_box((-0.55, 0, -0.55), (0.55, 0.6, 0.55), 0.04))
    draw = random.Random(5)
    for _ in range(9):
        at = (draw.uniform(-0.3, 0.3), draw.uniform(0.75, 1.7), draw.uniform(-0.3, 0.3))
        bush = s.sphere(draw.uniform(0.26, 0.42), 7, 5).turned_y(draw.uniform(0, 2 * math.pi)).moved(at)
        model.add("leaf", s.Surface(bush.positions, bush.triangles))
    return model


def bin_model():
    return s.Model().add("iron", s.cylinder(0.24, 0, 0.85, 16, 0.29), s.cylinder(0.31, 0.85, 0.92, 16))


def add_houses(document, looks):
    """Two rows; the arcade stands in the right one."""
    draw = random.Random(3)
    for side, turn in ((-1, math.pi / 2), (1, -math.pi / 2)):
        z, n = START_Z, 0
        while z - END_Z > 1.0:
            width, floors = draw.choice((8.0, 9.5, 11.0)), draw.choice((2, 3, 4, 5))
            width = width if z - END_Z - width > 7.5 else z - END_Z
            model, name = facade(width, floors, WALLS[(n + side) % 5], draw), "house"
            if side > 0 and n == 2:
                width = 24.0
                model, name = arcade(width, 6), "arcade"
            mesh = model.to_mesh(document, "%s %d %d" % (name, side, n), looks)
            at = (side * FRONT_X, 0, z if side < 0 else z - width)
            document.node("%s %d %d" % (name, side, n), translation=at, rotation=v.axis_angle((0, 1, 0), turn), mesh=mesh)
            if name == "house" and n % 2 == 0:
                cloth = s.Model().add("awning", awning(min(4.0, width - 2)))
                document.node("awning %d %d" % (side, n), translation=(side * FRONT_X, 0, z - width / 2),
                              rotation=v.axis_angle((0, 1, 0), turn), mesh=cloth.to_mesh(document, "awning %d %d" % (side, n), looks))
            z, n = z - width, n + 1


def add_furniture(document, looks):
    meshes = {name: model.to_mesh(document, name, looks) for name, model in (
        ("lamp post", lamp_post()), ("bench", bench()), ("planter", planter()), ("bin", bin_model()))}
    for n in range(9):
        side = -1 if n % 2 else 1
        z = 6.0 - 8.5 * n
        turn = v.axis_angle((0, 1, 0), 0 if side < 0 else math.pi)
        document.node("lamp post %d" % n, translation=(side * 4.55, 0.15, z), rotation=turn, mesh=meshes["lamp post"])
        facing = v.axis_angle((0, 1, 0), -side * math.pi / 2)
        document.node("bench %d" % n, translation=(side * 6.5, 0.15, z - 3.0), rotation=facing, mesh=meshes["bench"])
        document.node("planter %d" % n, translation=(-side * 4.95, 0.15, z - 1.0), mesh=meshes["planter"])
        document.node("bin %d" % n, translation=(side * 4.7, 0.15, z - 1.2), mesh=meshes["bin"])


def add_robots(document):
    common = {"joint": document.material("robot joint", (0.09, 0.095, 0.11)),
              "eye": document.material("robot eye", (0.1, 0.1, 0.1), emissive=(0.25, 0.85, 1.0))}
    models, crews = robot.parts(), []
    for n, palette in enumerate(PALETTES):
        looks = {**common, **{k: document.material("robot %s %d" % (k, n), c) for k, c in palette.items()}}
        crews.append({name: m.to_mesh(document, "robot %d %s" % (n, name), looks) for name, m in models.items()})
    crowd = document.node("robots")
    for n, (x, z, heading, shift, palette) in enumerate(WALKERS):
        floor = 0.15 if abs(x) > KERB_X else 0.0
        robot.add_robot(document, "robot %d" % n, crews[palette], robot.Gait(END_S, shift), (x, floor, z), heading, crowd)


def add_lights(document):
    high = document.punctual_light("high lamp", "point", (1.0, 0.84, 0.62), 9500.0)
    document.node("high lamp", translation=(5.0, 36.0, 3.0), extensions=high)
    sky = document.punctual_light("evening sky", "directional", (0.62, 0.76, 1.0), 1.1)
    document.node("evening sky", rotation=v.look_rotation((-0.42, 1.0, 0.35), (0, 0, 0)), extensions=sky)


def build():
    document = Document("city", ambient_light=(0.17, 0.19, 0.24), background=(0.40, 0.58, 0.80))
    looks = {name: document.material(name, color) for name, color in LOOKS.items()}
    looks["lamp"] = document.material("lamp glass", (0.8, 0.78, 0.7), emissive=(0.75, 0.62, 0.4))
    document.node("ground", mesh=ground().to_mesh(document, "ground", looks))
    document.node("gate", translation=(0, 0, END_Z), mesh=gate().to_mesh(document, "gate", looks))
    add_houses(document, looks)
    add_furniture(document, looks)
    add_robots(document)
    add_lights(document)
    motion.add_camera(document, "walk", 52,
                      [(2.2, 1.5, 1.2), (1.4, 1.7, -1.8), (-0.4, 2.3, -6.0), (-3.2, 3.6, -11.0)],
                      [(-1.0, 1.6, -14.0), (-0.6, 1.7, -18.0), (0.3, 1.6, -24.0), (1.5, 0.6, -28.0)], END_S)
    return document
