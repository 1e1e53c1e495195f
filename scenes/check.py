#!/usr/bin/env python3
"""Checks the bundled scenes: `check.py` reads each .glb and says in one sentence what is wrong; exit code 1 if
anything is. Generates the scenes again in memory and expects the same bytes."""

import json
import math
import pathlib
import struct
import sys

import generate

SIZE_LIMIT = 4_000_000
FORMATS = {5121: "B", 5123: "H", 5125: "I", 5126: "f"}
WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}
LEAST_AREA = 1e-9  # square metres
PATH_WIDTHS = {"translation": 3, "rotation": 4, "scale": 3}


class Fault(Exception):
    pass


def want(condition, sentence):
    if not condition:
        raise Fault(sentence)


def unpack(data):
    """The JSON and the buffer of a .glb file."""
    want(len(data) < SIZE_LIMIT, "%d bytes, expected less than %d." % (len(data), SIZE_LIMIT))
    magic, version, total = struct.unpack_from("<4sII", data)
    want((magic, version, total) == (b"glTF", 2, len(data)), "The header is not that of a glTF 2 file of this size.")
    json_size, json_kind = struct.unpack_from("<I4s", data, 12)
    size, kind = struct.unpack_from("<I4s", data, 20 + json_size)
    want((json_kind, kind) == (b"JSON", b"BIN\0"), "The chunks are not JSON and BIN.")
    want(json_size % 4 == 0 and size % 4 == 0 and 28 + json_size + size == len(data), "The chunks do not fill the file.")
    return json.loads(data[20:20 + json_size]), data[28 + json_size:]


class Reader:
    """Rows of accessors, each checked once."""

    def __init__(self, model, buffer):
        self.model, self.buffer, self.rows = model, buffer, {}
        want(model["buffers"] == [{"byteLength": len(buffer)}], "The buffer's length is not that of the chunk.")

    def __getitem__(self, index):
        if index not in self.rows:
            self.rows[index] = self._read(index, self.model["accessors"][index])
        return self.rows[index]

    def _read(self, index, accessor):
        view, name = self.model["bufferViews"][accessor["bufferView"]], "accessors[%d]" % index
        code = "<%d%s" % (WIDTHS[accessor["type"]], FORMATS[accessor["componentType"]])
        size = struct.calcsize(code)
        stride, offset = view.get("byteStride", size), accessor["byteOffset"]
        last = offset + stride * (accessor["count"] - 1) + size
        want(last <= view["byteLength"] and view["byteOffset"] + last <= len(self.buffer), name + " leaves its view.")
        want((view["byteOffset"] + offset) % struct.calcsize(code[-1]) == 0, name + " is not aligned.")
        rows = [struct.unpack_from(code, self.buffer, view["byteOffset"] + offset + stride * i)
                for i in range(accessor["count"])]
        want(all(math.isfinite(x) for row in rows for x in row), name + " holds a number that is not finite.")
        if "min" in accessor:
            columns = list(zip(*rows))
            want(accessor["min"] == [min(c) for c in columns] and accessor["max"] == [max(c) for c in columns],
                 name + ": min and max are not those of its data.")
        return rows


def check_nodes(model):
    nodes, seen = model["nodes"], set()
    names = [node["name"] for node in nodes]
    stack = list(model["scenes"][0]["nodes"])
    while stack:
        index = stack.pop()
        want(index not in seen, "Node '%s' has two parents." % names[index])
        seen.add(index)
        stack += nodes[index].get("children", [])
    want(len(seen) == len(nodes), "%d of %d nodes hang in the scene." % (len(seen), len(nodes)))
    for table in ("nodes", "meshes", "materials", "cameras"):
        names = [entry["name"] for entry in model[table]]
        want(all(names) and len(set(names)) == len(names), "Two entries of %s share a name or have none." % table)
    for node in nodes:
        turn = node.get("rotation", (0, 0, 0, 1))
        want(abs(sum(q * q for q in turn) - 1) < 1e-5, "The rotation of '%s' is not of unit length." % node["name"])


def cross_length(a, b, c):
    u, w = [y - x for x, y in zip(a, b)], [y - x for x, y in zip(a, c)]
    return math.hypot(u[1] * w[2] - u[2] * w[1], u[2] * w[0] - u[0] * w[2], u[0] * w[1] - u[1] * w[0])


def check_primitive(name, primitive, read):
    """Returns its triangles, three positions each."""
    attributes = {key: read[index] for key, index in primitive["attributes"].items()}
    positions = attributes["POSITION"]
    want(all(len(rows) == len(positions) for rows in attributes.values()), "%s: attributes differ in length." % name)
    indices = [i for (i,) in read[primitive["indices"]]] if "indices" in primitive else range(len(positions))
    want(len(indices) % 3 == 0 and max(indices) < len(positions), "%s: an index is out of range." % name)
    want(len(set(indices)) == len(positions), "%s: a vertex is not used." % name)
    triangles = [[positions[i] for i in indices[k:k + 3]] for k in range(0, len(indices), 3)]
    for triangle in triangles:
        want(cross_length(*triangle) / 2 > LEAST_AREA, "%s: a triangle at %s has no area." % (name, triangle[0]))
    for normal in attributes.get("NORMAL", ()):
        want(abs(math.hypot(*normal) - 1) < 1e-4, "%s: a normal is not of unit length." % name)
    for weights in attributes.get("WEIGHTS_0", ()):
        want(sum(weights) == 255, "%s: weights do not sum to one." % name)
    return triangles


def check_normals(name, primitive, read):
    """Smooth normals look the way their triangles face."""
    if "NORMAL" not in primitive["attributes"]:
        return
    positions, normals = read[primitive["attributes"]["POSITION"]], read[primitive["attributes"]["NORMAL"]]
    indices = [i for (i,) in read[primitive["indices"]]]
    for k in range(0, len(indices), 3):
        a, b, c = (positions[i] for i in indices[k:k + 3])
        u, w = [y - x for x, y in zip(a, b)], [y - x for x, y in zip(a, c)]
        face = (u[1] * w[2] - u[2] * w[1], u[2] * w[0] - u[0] * w[2], u[0] * w[1] - u[1] * w[0])
        mean = [sum(normals[i][n] for i in indices[k:k + 3]) for n in range(3)]
        want(sum(f * m for f, m in zip(face, mean)) > 0, "%s: a normal looks inwards." % name)


def check_meshes(model, read):
    """Returns the number of triangles drawn, instances counted."""
    counts = []
    for mesh in model["meshes"]:
        counts.append(0)
        for primitive in mesh["primitives"]:
            counts[-1] += len(check_primitive("Mesh '%s'" % mesh["name"], primitive, read))
            check_normals("Mesh '%s'" % mesh["name"], primitive, read)
    for skin in model.get("skins", ()):
        want(len(read[skin["inverseBindMatrices"]]) == len(skin["joints"]) <= 256, "A skin's tables differ in length.")
    return sum(counts[node["mesh"]] for node in model["nodes"] if "mesh" in node)


def check_animation(model, read):
    """Returns the animation's length in seconds."""
    want(len(model["animations"]) == 1, "Expected one animation.")
    animation, driven, end_s = model["animations"][0], set(), 0.0
    for channel in animation["channels"]:
        node, path = channel["target"]["node"], channel["target"]["path"]
        label = "The %s of '%s'" % (path, model["nodes"][node]["name"])
        want((node, path) not in driven, label + " is driven twice.")
        driven.add((node, path))
        sampler = animation["samplers"][channel["sampler"]]
        times, values = [t for (t,) in read[sampler["input"]]], read[sampler["output"]]
        want("min" in model["accessors"][sampler["input"]], label + " has key times without bounds.")
        want(times[0] == 0 and all(a < b for a, b in zip(times, times[1:])), label + ": key times do not rise from 0.")
        want(len(values) == len(times) and len(values[0]) == PATH_WIDTHS[path], label + ": keys and values differ.")
        if path == "rotation":
            want(all(abs(math.hypot(*q) - 1) < 1e-5 for q in values), label + " is not of unit length.")
        end_s = max(end_s, times[-1])
    return end_s


def check_scene(name, data):
    model, buffer = unpack(data)
    read = Reader(model, buffer)
    check_nodes(model)
    triangles = check_meshes(model, read)
    end_s = check_animation(model, read)
    for index in range(len(model["accessors"])):
        read[index]
    want(data == generate.scene_bytes(name), "The generator writes other bytes than those in the file.")
    lights = sum(len(e["lights"]) for e in model["extensions"].values())
    return "%d bytes, %d triangles, %d nodes, %d meshes, %d lights, %.1f s" % (
        len(data), triangles, len(model["nodes"]), len(model["meshes"]), lights, end_s)


def main():
    failed = False
    for name in generate.SCENES:
        path = pathlib.Path(__file__).resolve().parent / (name + ".glb")
        try:
            print("%s: %s" % (path.name, check_scene(name, path.read_bytes())))
        except (Fault, OSError, struct.error, ValueError, KeyError, IndexError) as fault:
            failed = True
            print("%s: %s" % (path.name, fault), file=sys.stderr)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
