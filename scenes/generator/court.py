"""A court under a tree: arcades on two sides, railings on a terrace, paving, a bench, and a large lit panel."""

import math

from . import motion
from . import surface as s
from . import tree
from . import vector as v
from .gltf import Document

END_S = 10.0
HALF = 7.0                # the court is a square, 14 m wide
WALL_TOP = 7.2
PANEL_AT, PANEL_AIM, PANEL_SIZE = (4.6, 9.2, 5.6), (-0.8, 0.4, -0.8), (2.0, 1.25)
LOOKS = {
    "slab light": (0.52, 0.48, 0.42), "slab": (0.45, 0.41, 0.36), "slab dark": (0.36, 0.33, 0.30),
    "joint": (0.20, 0.18, 0.16), "wall": (0.66, 0.52, 0.38), "arcade": (0.70, 0.62, 0.50),
    "column": (0.72, 0.66, 0.56), "back wall": (0.55, 0.30, 0.20), "iron": (0.05, 0.06, 0.07),
    "wood": (0.38, 0.20, 0.09), "bark": (0.17, 0.11, 0.07), "soil": (0.10, 0.07, 0.05),
    "tile": (0.48, 0.20, 0.11), "pot": (0.52, 0.24, 0.13), "shutter": (0.10, 0.22, 0.24)}
LEAVES = {"leaf light": (0.34, 0.50, 0.10), "leaf": (0.18, 0.38, 0.08), "leaf dark": (0.10, 0.26, 0.07)}


def paving():
    """Slabs with open joints over a bed."""
    model = s.Model().add("joint", s.box((-HALF, -0.3, -HALF), (HALF, -0.02, HALF)))
    looks, pitch, gap = ("slab light", "slab", "slab dark"), 0.875, 0.012
    for i in range(16):
        for k in range(16):
            x, z = -HALF + i * pitch, -HALF + k * pitch
            look = looks[(i * 7 + k * 5 + (i * k) % 3) % 3]
            model.add(look, s.box((x + gap, -0.02, z + gap), (x + pitch - gap, 0, z + pitch - gap)))
    return model


def column():
    profile = [(0, 0.18), (0.25, 0.18), (0.25, 0.18), (0.27, 0.25), (0.21, 0.33), (0.21, 0.33), (0.17, 2.55),
               (0.17, 2.55), (0.27, 2.78), (0.27, 2.78), (0, 2.78)]
    model = s.Model().add("column", s.lathe(profile, 28))
    return model.add("column", s.box_on((0, 0, 0), (0.6, 0.18, 0.6)), s.box_on((0, 2.78, 0), (0.62, 0.16, 0.62)))


def arcade():
    """Arches over columns, x in (-HALF, HALF), front on z = 0, with a walk and a wall behind; columns apart."""
    model, bays, spring, top = s.Model(), 5, 2.94, 5.2
    pitch = 2 * HALF / bays
    for bay in range(bays):
        x0 = -HALF + bay * pitch
        r = pitch / 2 - 0.24
        curve = [(x0 + pitch / 2 - r * math.cos(math.pi * i / 20), spring + r * math.sin(math.pi * i / 20))
                 for i in range(21)]
        lower = [(x0, spring)] + curve + [(x0 + pitch, spring)]
        model.add("arcade", s.extruded_strip(lower, [(x, top) for x, _ in lower], -0.5, 0))
    model.add("wall", s.box((-HALF, top, -0.5), (HALF, WALL_TOP, 0)))
    # The mouldings of the two sides meet in the corner: each begins where the other's depth ends.
    model.add("arcade", s.box((-HALF + 0.1, top - 0.08, 0), (HALF, top + 0.1, 0.1)),
              s.box((-HALF + 0.22, WALL_TOP, -0.5), (HALF, WALL_TOP + 0.16, 0.22)))
    model.add("back wall", s.box((-HALF, 0, -3.2), (HALF, WALL_TOP, -2.9)))
    model.add("arcade", s.box((-HALF, top, -2.9), (HALF, top + 0.2, -0.5)))
    model.add("slab", s.box((-HALF, -0.3, -2.9), (HALF, 0, 0)))
    for bay in range(bays):  # shuttered windows above the arches
        x = -HALF + (bay + 0.5) * pitch
        model.add("shutter", s.box((x - 0.42, 5.6, 0), (x - 0.02, 6.8, 0.05)), s.box((x + 0.02, 5.6, 0), (x + 0.42, 6.8, 0.05)))
        model.add("arcade", s.box((x - 0.52, 5.5, 0), (x + 0.52, 5.58, 0.12)))
    return model


def corner():
    """The square between the two walks, and the plain walls that close the court behind the camera."""
    model, far = s.Model(), HALF + 3.2
    model.add("slab", s.box((-far, -0.3, -far), (-HALF, 0, -HALF)))
    model.add("back wall", s.box((-far, 0, -far), (-HALF, WALL_TOP, -far + 0.3)),
              s.box((-far, 0, -far + 0.3), (-far + 0.3, WALL_TOP, -HALF)))
    model.add("wall", s.box((HALF, 0, -far), (HALF + 0.4, 4.0, HALF + 0.4)), s.box((-far, 0, HALF), (HALF, 4.0, HALF + 0.4)))
    model.add("tile", s.box((HALF - 0.1, 4.0, -far - 0.05), (HALF + 0.5, 4.12, HALF + 0.5)),
              s.box((-far - 0.05, 4.0, HALF - 0.1), (HALF - 0.1, 4.12, HALF + 0.5)))
    return model


def railing(length):
    """Thin upright bars between rails, x in (0, length), on z = 0."""
    model = s.Model()
    model.add("iron", s.box((0, 0.10, -0.018), (length, 0.14, 0.018)), s.box((0, 0.92, -0.03), (length, 0.97, 0.03)))
    count = int(length / 0.12)
    for i in range(count):
        bar = s.cylinder(0.011, 0.14, 0.92, 8, smooth=False)
        model.add("iron", bar.moved(((i + 0.5) * length / count, 0, 0)))
    for x in (0.0, length):
        model.add("iron", s.box_on((x, 0, 0.07), (0.07, 1.05, 0.07)), s.sphere(0.05, 12, 8, (x, 1.09, 0.07)))
    return model


def tree_ring():
    """A round kerb with soil in it."""
    wall = [(1.30, 0), (1.30, 0.42), (1.02, 0.42), (1.02, 0.30), (0, 0.30)]
    soil = s.lathe([(1.02, 0.30), (0, 0.34)], 40, smooth=False)
    kerb = s.lathe([(0, 0)] + wall[:3] + [(1.02, 0.2), (0, 0.2)], 40, smooth=False)
    return s.Model().add("arcade", kerb).add("soil", soil)


def bench():
    model = s.Model()
    for i in range(4):
        model.add("wood", s.chamfered_box((-1.0, 0.42, -0.24 + 0.125 * i), (1.0, 0.46, -0.135 + 0.125 * i), 0.01))
    for i in range(3):
        model.add("wood", s.chamfered_box((-1.0, 0.56 + 0.13 * i, -0.32), (1.0, 0.66 + 0.13 * i, -0.285), 0.01))
    for x in (-0.8, 0.8):
        model.add("iron", s.box((x - 0.025, 0, -0.24), (x + 0.025, 0.42, 0.24)),
                  s.box((x - 0.025, 0.42, -0.285), (x + 0.025, 0.96, -0.26)))
    return model


def pot():
    profile = [(0, 0), (0.20, 0), (0.20, 0), (0.34, 0.42), (0.30, 0.55), (0.36, 0.60), (0.36, 0.60), (0.30, 0.60),
               (0.30, 0.60), (0.27, 0.50), (0, 0.50)]
    return s.Model().add("pot", s.lathe(profile, 28))


def panel_model():
    """The lit face, on z = 0, facing -z as the light does."""
    w, h = PANEL_SIZE
    return s.Model().add("panel", s.panel((w / 2, -h / 2, 0), (-w, 0, 0), (0, h, 0)))


def housing():
    """The lamp's box behind the lit face, and its rim."""
    w, h = PANEL_SIZE[0] / 2, PANEL_SIZE[1] / 2
    return s.Model().add("iron", s.box((-w - 0.1, -h - 0.1, 0.02), (w + 0.1, h + 0.1, 0.3)))


def add_panel(document, looks):
    """The area light, the quad one sees of it, and its box. The quad casts no shadow: it would cover its own light."""
    silent = {"casts_shadow": False}
    looks["panel"] = document.material("lit panel", (0.0, 0.0, 0.0), emissive=(1.0, 0.93, 0.80), extras=silent)
    light = document.rect_light("panel light", (1.0, 0.90, 0.74), 288.0, *PANEL_SIZE)
    turn = v.look_rotation(PANEL_AT, PANEL_AIM)
    root = document.node("panel", translation=PANEL_AT, rotation=turn)
    document.node("panel light", root, extensions=light)
    document.node("lit panel", root, mesh=panel_model().to_mesh(document, "lit panel", looks, silent))
    document.node("panel housing", root, mesh=housing().to_mesh(document, "panel housing", looks))


def add_arcades(document, looks):
    walk, post = arcade().to_mesh(document, "arcade", looks), column().to_mesh(document, "column", looks)
    for name, turn, at in (("north", 0.0, (0, 0, -HALF)), ("west", math.pi / 2, (-HALF, 0, 0))):
        side = document.node(name + " side", translation=at, rotation=v.axis_angle((0, 1, 0), turn), mesh=walk)
        for i in range(1, 5):
            x = -HALF + i * 2 * HALF / 5
            document.node("%s column %d" % (name, i), side, (x, 0, -0.25), mesh=post)
        end = HALF - 0.32
        document.node(name + " end column", side, (end, 0, -0.25), mesh=post)


def add_furniture(document, looks):
    fence = railing(3.6).to_mesh(document, "railing", looks)
    for n, (at, turn) in enumerate((((-2.2, 0, 3.9), 0.0), ((1.9, 0, 3.9), 0.0), ((5.5, 0, -0.3), math.pi / 2),
                                    ((5.5, 0, -4.2), math.pi / 2))):
        document.node("railing %d" % n, translation=at, rotation=v.axis_angle((0, 1, 0), turn), mesh=fence)
    document.node("tree ring", translation=(-1.2, 0, -1.2), mesh=tree_ring().to_mesh(document, "tree ring", looks))
    seat = bench().to_mesh(document, "bench", looks)
    document.node("bench by the tree", translation=(1.6, 0, -2.6), rotation=v.axis_angle((0, 1, 0), 0.25), mesh=seat)
    document.node("bench by the walk", translation=(-4.7, 0, 1.6), rotation=v.axis_angle((0, 1, 0), 1.5), mesh=seat)
    vessel = pot().to_mesh(document, "pot", looks)
    for n, (x, z) in enumerate(((3.6, -6.2), (0.9, -6.2), (-6.1, 2.9), (-6.1, 0.1), (3.1, -2.2))):
        document.node("pot %d" % n, translation=(x, 0, z), mesh=vessel)


def build():
    document = Document("court", ambient_light=(0.13, 0.15, 0.20), background=(0.20, 0.30, 0.48))
    looks = {name: document.material(name, color) for name, color in LOOKS.items()}
    looks.update({name: document.material(name, color, double_sided=True) for name, color in LEAVES.items()})
    document.node("paving", mesh=paving().to_mesh(document, "paving", looks))
    document.node("corner", mesh=corner().to_mesh(document, "corner", looks))
    add_arcades(document, looks)
    add_furniture(document, looks)
    tree.add_tree(document, looks, (-1.2, 0.25, -1.2), END_S, seed=21)
    add_panel(document, looks)
    motion.add_camera(document, "stroll", 55,
                      [(5.9, 1.7, 6.2), (3.6, 1.6, 6.4), (0.6, 2.0, 6.2), (-2.0, 2.9, 6.0)],
                      [(-1.6, 2.3, -2.5), (-1.3, 2.3, -2.2), (-0.9, 2.2, -2.2), (-0.2, 1.9, -2.2)], END_S)
    return document
