"""Writes a scene that is drawn in a moment and has all that a renderer may trip over: files of its own, a picture on a
surface, glass, a mesh large enough that its tree is kept, and two of three bodies that move."""
import json
import math
import struct
import zlib

GRID = 33  # 2,048 triangles: KeptTrees::least_triangles


def picture():
    """A PNG of 2x2 pixels."""
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    rows = b"\0\xff\0\0\0\xff\0" + b"\0\0\0\xff\xff\xff\xff"
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", 2, 2, 8, 2, 0, 0, 0)) +
            chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))


def hills():
    """Positions and triangles of a square of GRID x GRID vertices, 4 m wide."""
    positions = [(4 * x / (GRID - 1) - 2, 0.3 * math.sin(x) * math.cos(y), 4 * y / (GRID - 1) - 2)
                 for y in range(GRID) for x in range(GRID)]
    triangles = []
    for y in range(GRID - 1):
        for x in range(GRID - 1):
            a = y * GRID + x
            triangles += [(a, a + GRID, a + 1), (a + 1, a + GRID, a + GRID + 1)]
    return positions, triangles


def square(size):
    corners = [(-size, 0, -size), (-size, 0, size), (size, 0, size), (size, 0, -size)]
    return corners, [(0, 1, 2), (0, 2, 3)]


class Tables:
    """The binary file and the accessors into it."""

    def __init__(self):
        self.bytes, self.views, self.accessors = b"", [], []

    def add(self, rows, kind, component):
        flat = [value for row in rows for value in row]
        form = {5126: "f", 5125: "I"}[component]
        self.views.append({"buffer": 0, "byteOffset": len(self.bytes), "byteLength": 4 * len(flat)})
        self.bytes += struct.pack(f"<{len(flat)}{form}", *flat)
        width = {"SCALAR": 1, "VEC2": 2, "VEC3": 3}[kind]
        accessor = {"bufferView": len(self.views) - 1, "componentType": component, "type": kind,
                    "count": len(flat) // width}
        if component == 5126:
            accessor["min"] = [min(flat[i::width]) for i in range(width)]
            accessor["max"] = [max(flat[i::width]) for i in range(width)]
        self.accessors.append(accessor)
        return len(self.accessors) - 1


def write_scene(folder):
    """Writes it into `folder`; the name of its main file."""
    tables = Tables()

    def mesh(shape, material, textured=False):
        positions, triangles = shape
        attributes = {"POSITION": tables.add(positions, "VEC3", 5126)}
        if textured:
            attributes["TEXCOORD_0"] = tables.add([(p[0], p[2]) for p in positions], "VEC2", 5126)
        indices = tables.add([(i,) for triangle in triangles for i in triangle], "SCALAR", 5125)
        return {"primitives": [{"attributes": attributes, "indices": indices, "material": material}]}

    meshes = [mesh(hills(), 0, True), mesh(square(0.5), 1), mesh(square(0.4), 2)]
    times = tables.add([(0.0,), (0.1,)], "SCALAR", 5126)
    way = tables.add([(0, 1, 0), (0.3, 1, 0)], "VEC3", 5126)
    scene = {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1, 2, 3, 4]}],
        "extensionsUsed": ["KHR_lights_punctual"],
        "extensions": {"KHR_lights_punctual": {"lights": [{"type": "point", "intensity": 60}]}},
        "nodes": [{"mesh": 0}, {"mesh": 1, "translation": [0, 1, 0]}, {"mesh": 2, "translation": [0.8, 0.8, 0.3]},
                  {"translation": [0.5, 3, 0.4], "extensions": {"KHR_lights_punctual": {"light": 0}}},
                  {"translation": [0, 3, 4], "rotation": [-0.32, 0, 0, 0.9474], "camera": 0}],
        "cameras": [{"type": "perspective", "perspective": {"yfov": 0.8, "znear": 0.1, "aspectRatio": 1.3}}],
        "materials": [{"doubleSided": True, "pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}},
                      {"doubleSided": True},
                      {"doubleSided": True, "alphaMode": "BLEND",
                       "pbrMetallicRoughness": {"baseColorFactor": [1, 0.2, 0.2, 0.5]}}],
        "textures": [{"source": 0}], "images": [{"uri": "picture.png"}], "meshes": meshes,
        "animations": [{"samplers": [{"input": times, "output": way}],
                        "channels": [{"sampler": 0, "target": {"node": node, "path": "translation"}}
                                     for node in (1, 2)]}],
        "bufferViews": tables.views, "accessors": tables.accessors,
        "buffers": [{"uri": "tables.bin", "byteLength": len(tables.bytes)}],
    }
    (folder / "tables.bin").write_bytes(tables.bytes)
    (folder / "picture.png").write_bytes(picture())
    (folder / "scene.gltf").write_text(json.dumps(scene))
    return folder / "scene.gltf"
