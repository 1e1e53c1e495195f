"""room.glb: a closed room to bake light into. Every face has a place of its own in TEXCOORD_1, as many texels per metre as
the others. Under the lamp stand a table, a bench, shelves and a railing: broad shadows, thin ones, and both at once."""

from . import motion
from . import vector as v
from .gltf import Document

SIZE = (6.0, 3.0, 5.0)
LAMP_SIZE, LAMP_AT = (1.4, 0.9), (2.7, 2.9, 2.6)
GAP = 3 / 512  # between faces in the map, on each side of one: more than a texel of a map of 512
LOOKS = {"plaster": (0.78, 0.75, 0.70), "floor": (0.52, 0.42, 0.33), "wood": (0.60, 0.42, 0.25), "iron": (0.35, 0.36, 0.38)}


class Face:
    """A rectangle that is seen from where `along` and `up` turn counter-clockwise."""

    def __init__(self, look, corner, along, up):
        self.look, self.corner, self.along, self.up = look, corner, along, up
        self.width, self.height = v.length(along), v.length(up)


def box_faces(look, low, high, without=""):
    """A box seen from outside, but for the sides named in `without`: some of -x +x -y +y -z +z."""
    (x, y, z), (a, b, c) = low, [h - l for l, h in zip(low, high)]
    sides = {"-x": ((x, y, z), (0, 0, c), (0, b, 0)), "+x": ((x + a, y, z + c), (0, 0, -c), (0, b, 0)),
             "-y": ((x, y, z), (a, 0, 0), (0, 0, c)), "+y": ((x, y + b, z + c), (a, 0, 0), (0, 0, -c)),
             "-z": ((x + a, y, z), (-a, 0, 0), (0, b, 0)), "+z": ((x, y, z + c), (a, 0, 0), (0, b, 0))}
    return [Face(look, *side) for name, side in sides.items() if name not in without.split()]


def walls():
    """The room itself, seen from inside: the faces of its box with their sides swapped."""
    looks = {1: "plaster", 2: "floor"}
    faces = []
    for number, face in enumerate(box_faces("plaster", (0, 0, 0), SIZE)):
        faces.append(Face(looks.get(number, "plaster"), face.corner, face.up, face.along))
    return faces


def furniture():
    faces = box_faces("wood", (1.9, 0.72, 1.7), (3.6, 0.76, 2.6))
    for x in (1.95, 3.47):
        for z in (1.75, 2.47):
            faces += box_faces("wood", (x, 0, z), (x + 0.08, 0.72, z + 0.08), "-y +y")
    faces += box_faces("wood", (1.9, 0.42, 3.1), (3.6, 0.46, 3.45))
    for x in (2.0, 3.42):
        faces += box_faces("wood", (x, 0, 3.12), (x + 0.08, 0.42, 3.43), "-y +y")
    for y in (0.35, 0.95, 1.55, 2.15):
        faces += box_faces("wood", (0, y, 1.2), (0.32, y + 0.03, 3.0), "-x")
    for i in range(9):
        faces += box_faces("iron", (4.6, 0, 0.9 + 0.35 * i), (4.64, 1.0, 0.94 + 0.35 * i), "-y +y")
    return faces + box_faces("iron", (4.58, 1.0, 0.8), (4.66, 1.05, 3.9))


def shelves(faces, texels_per_m):
    """Places of the faces in rows, the tallest first, or None where they do not fit into a square of side 1."""
    places, x, y, row = {}, 0.0, 0.0, 0.0
    for index in sorted(range(len(faces)), key=lambda i: (-faces[i].height, -faces[i].width, i)):
        width, height = (side * texels_per_m + 2 * GAP for side in (faces[index].width, faces[index].height))
        if x + width > 1:
            x, y, row = 0.0, y + row, 0.0
        if width > 1 or y + height > 1:
            return None
        places[index] = (x + GAP, y + GAP)
        x, row = x + width, max(row, height)
    return places


def unwrap(faces):
    """The scale at which all fit, as large as a thousand steps find it, and their places."""
    scale = next(i / 1000 for i in range(1000, 0, -1) if shelves(faces, i / 1000))
    return scale, shelves(faces, scale)


def add_faces(document, faces, looks):
    scale, places = unwrap(faces)
    parts = {}
    for index, face in enumerate(faces):
        positions, coordinates = parts.setdefault(face.look, ([], []))
        (u, w), width, height = places[index], face.width * scale, face.height * scale
        for a, b in ((0, 0), (1, 0), (1, 1), (0, 1)):
            along, up = v.scale(face.along, a), v.scale(face.up, b)
            positions.append(v.add(face.corner, v.add(along, up)))
            coordinates.append((u + width * a, w + height * (1 - b)))  # v runs down
    return document.lightmapped_mesh("room", [(*parts[look], looks[look]) for look in sorted(parts)])


def build():
    document = Document("room", ambient_light=(0.10, 0.11, 0.13), background=(0.0, 0.0, 0.0))
    looks = {name: document.material("room " + name, color) for name, color in LOOKS.items()}
    document.node("room", mesh=add_faces(document, walls() + furniture(), looks))
    lamp = document.rect_light("lamp", (1.0, 0.94, 0.84), 28.0, *LAMP_SIZE)
    document.node("lamp", translation=LAMP_AT, rotation=(-0.5 ** 0.5, 0.0, 0.0, 0.5 ** 0.5), extensions=lamp)
    motion.add_camera(document, "visitor", 60, [(5.6, 1.7, 4.5), (5.5, 1.9, 3.6)], [(1.6, 0.8, 1.9), (1.4, 0.8, 2.1)], 2.0, 2)
    return document
