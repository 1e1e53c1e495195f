#!/usr/bin/env python3
"""Compares the poses of sample models with a second evaluator of glTF, written from its specification alone.

usage: pose_oracle_test.py PROGRAM FOLDER [NAME...]     PROGRAM: tenebra-positions; NAME: parts of file names

All vertices in world space, at the rest pose and at several times of every clip, agree to 1e-5 of the model's size.
Plain Python: the evaluator shares no code with what it judges. Exit code 77: there is no such folder.
"""
import array
import base64
import json
import math
import pathlib
import struct
import subprocess
import sys
import urllib.parse

TOLERANCE = 1e-5
PLACES_IN_CLIP = (0.0, 0.13, 0.37, 0.61, 0.93, 1.0)
COMPONENTS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}
FORMATS = {5120: ("b", 127.0), 5121: ("B", 255.0), 5122: ("h", 32767.0), 5123: ("H", 65535.0), 5125: ("I", 1.0),
           5126: ("f", 1.0)}
TRIANGLES = 4


class Model:
    """A file's JSON and buffers."""

    def __init__(self, path):
        data = path.read_bytes()
        binary = None
        if data[:4] == b"glTF":
            length = struct.unpack_from("<I", data, 12)[0]
            text, at = data[20:20 + length], 20 + length
            if at + 8 <= len(data):
                size = struct.unpack_from("<I", data, at)[0]
                binary = data[at + 8:at + 8 + size]
        else:
            text = data
        self.json = json.loads(text)
        self.buffers = [self.load(buffer, path.parent, binary) for buffer in self.json.get("buffers", [])]

    @staticmethod
    def load(buffer, folder, binary):
        uri = buffer.get("uri")
        if uri is None:
            return binary
        if uri.startswith("data:"):
            return base64.b64decode(uri.split(",", 1)[1])
        return (folder / urllib.parse.unquote(uri)).read_bytes()

    def elements(self, view, offset, count, components, kind, tight=False):
        letter, _ = FORMATS[kind]
        layout = struct.Struct("<%d%s" % (components, letter))
        source = self.json["bufferViews"][view]
        stride = layout.size if tight else source.get("byteStride", layout.size)
        start = source.get("byteOffset", 0) + offset
        data = self.buffers[source["buffer"]]
        return [layout.unpack_from(data, start + i * stride) for i in range(count)]

    def accessor(self, index):
        """Tuples of numbers, one for each element."""
        a = self.json["accessors"][index]
        count, components, kind = a["count"], COMPONENTS[a["type"]], a["componentType"]
        if "bufferView" in a:
            values = self.elements(a["bufferView"], a.get("byteOffset", 0), count, components, kind)
        else:
            values = [(0,) * components] * count
        if "sparse" in a:
            s = a["sparse"]
            places = self.elements(s["indices"]["bufferView"], s["indices"].get("byteOffset", 0), s["count"], 1,
                                   s["indices"]["componentType"], True)
            new = self.elements(s["values"]["bufferView"], s["values"].get("byteOffset", 0), s["count"], components,
                                kind, True)
            for (place,), value in zip(places, new):
                values[place] = value
        if a.get("normalized"):
            most = FORMATS[kind][1]
            values = [tuple(max(v / most, -1.0) for v in value) for value in values]
        return values


# Matrices are tuples of 16 numbers, column after column.
def multiply(a, b):
    return tuple(sum(a[4 * k + row] * b[4 * column + k] for k in range(4)) for column in range(4) for row in range(4))


def from_parts(t, q, s):
    x, y, z, w = q
    n = math.sqrt(x * x + y * y + z * z + w * w) or 1.0
    x, y, z, w = x / n, y / n, z / n, w / n
    return ((1 - 2 * (y * y + z * z)) * s[0], 2 * (x * y + z * w) * s[0], 2 * (x * z - y * w) * s[0], 0.0,
            2 * (x * y - z * w) * s[1], (1 - 2 * (x * x + z * z)) * s[1], 2 * (y * z + x * w) * s[1], 0.0,
            2 * (x * z + y * w) * s[2], 2 * (y * z - x * w) * s[2], (1 - 2 * (x * x + y * y)) * s[2], 0.0,
            t[0], t[1], t[2], 1.0)


def slerp(a, b, u):
    dot = sum(p * q for p, q in zip(a, b))
    if dot < 0:
        b, dot = tuple(-q for q in b), -dot
    angle = math.acos(min(dot, 1.0))
    if angle < 1e-9:
        return tuple(p + u * (q - p) for p, q in zip(a, b))
    return tuple((math.sin((1 - u) * angle) * p + math.sin(u * angle) * q) / math.sin(angle) for p, q in zip(a, b))


def sample(times, values, how, rotation, time):
    """`values`: one flat tuple for each key, three for CUBICSPLINE."""
    cubic = how == "CUBICSPLINE"
    middle = (lambda k: values[3 * k + 1]) if cubic else (lambda k: values[k])
    if time <= times[0]:
        return middle(0)
    if time >= times[-1]:
        return middle(len(times) - 1)
    k = max(i for i in range(len(times)) if times[i] <= time)
    step = times[k + 1] - times[k]
    u = (time - times[k]) / step
    if how == "STEP":
        return middle(k)
    if not cubic:
        if rotation:
            return slerp(middle(k), middle(k + 1), u)
        return tuple(a + u * (b - a) for a, b in zip(middle(k), middle(k + 1)))
    leaving, arriving = values[3 * k + 2], values[3 * k + 3]
    h00, h10 = 2 * u ** 3 - 3 * u ** 2 + 1, u ** 3 - 2 * u ** 2 + u
    h01, h11 = -2 * u ** 3 + 3 * u ** 2, u ** 3 - u ** 2
    return tuple(h00 * p + h10 * step * m + h01 * q + h11 * step * n
                 for p, m, q, n in zip(middle(k), leaving, middle(k + 1), arriving))


class Evaluator:
    def __init__(self, model):
        self.model = model
        self.json = model.json
        self.nodes = self.json.get("nodes", [])
        self.cache = {}
        self.parent = {c: i for i, n in enumerate(self.nodes) for c in n.get("children", [])}
        scenes = self.json.get("scenes", [])
        roots = (scenes[self.json.get("scene", 0)].get("nodes", []) if scenes
                 else [i for i in range(len(self.nodes)) if i not in self.parent])
        self.order = []
        stack = list(reversed(roots))
        while stack:
            node = stack.pop()
            self.order.append(node)
            stack.extend(reversed(self.nodes[node].get("children", [])))

    def read(self, index):
        if index not in self.cache:
            self.cache[index] = self.model.accessor(index)
        return self.cache[index]

    def clip_end(self, clip):
        return max(self.read(s["input"])[-1][0] for s in self.json["animations"][clip]["samplers"])

    def target_count(self, mesh):
        return len(self.json["meshes"][mesh]["primitives"][0].get("targets", []))

    def animated(self, clip, time):
        """{(node, path): value} of what the clip drives."""
        result = {}
        if clip < 0:
            return result
        animation = self.json["animations"][clip]
        for channel in animation["channels"]:
            target = channel["target"]
            places = [(target.get("node"), target["path"])]
            if target["path"] == "pointer":
                places = self.pointed(target["extensions"]["KHR_animation_pointer"]["pointer"])
            for node, path in places:
                if node is None or path not in ("translation", "rotation", "scale", "weights"):
                    continue
                sampler = animation["samplers"][channel["sampler"]]
                times = [t[0] for t in self.read(sampler["input"])]
                values = self.read(sampler["output"])
                if path == "weights":
                    n = self.target_count(self.nodes[node]["mesh"])
                    flat = [v[0] for v in values]
                    values = [tuple(flat[i:i + n]) for i in range(0, len(flat), n)]
                how = sampler.get("interpolation", "LINEAR")
                result[node, path] = sample(times, values, how, path == "rotation", time)
        return result

    def pointed(self, pointer):
        parts = pointer.strip("/").split("/")
        if len(parts) == 3 and parts[0] == "nodes":
            return [(int(parts[1]), parts[2])]
        if len(parts) == 3 and parts[0] == "meshes" and parts[2] == "weights":
            return [(i, "weights") for i, n in enumerate(self.nodes)
                    if n.get("mesh") == int(parts[1]) and "weights" not in n]
        return []

    def worlds(self, moved):
        world = {}
        for node in self.order:
            n = self.nodes[node]
            if "matrix" in n:
                local = tuple(n["matrix"])
            else:
                part = lambda path, rest: moved.get((node, path), n.get(path, rest))
                local = from_parts(part("translation", (0, 0, 0)), part("rotation", (0, 0, 0, 1)),
                                   part("scale", (1, 1, 1)))
            parent = self.parent.get(node)
            world[node] = local if parent is None else multiply(world[parent], local)
        return world

    def influences(self, attributes):
        """Lists of (joint, weight) for each vertex, weights of sum 1."""
        result = None
        for k in range(2):
            if "JOINTS_%d" % k not in attributes:
                break
            pairs = [list(zip(j, w)) for j, w in zip(self.read(attributes["JOINTS_%d" % k]),
                                                     self.read(attributes["WEIGHTS_%d" % k]))]
            result = pairs if result is None else [a + b for a, b in zip(result, pairs)]
        for i, pairs in enumerate(result or []):
            total = sum(w for _, w in pairs)
            result[i] = [(j, w / total) for j, w in pairs if w != 0]
        return result

    def vertices(self, clip, time):
        moved = self.animated(clip, time)
        world = self.worlds(moved)
        out = []
        for node in self.order:
            n = self.nodes[node]
            if "mesh" not in n:
                continue
            mesh = self.json["meshes"][n["mesh"]]
            weights = moved.get((node, "weights"), n.get("weights", mesh.get("weights", [])))
            joints = None
            if "skin" in n:
                skin = self.json["skins"][n["skin"]]
                binds = (self.read(skin["inverseBindMatrices"]) if "inverseBindMatrices" in skin
                         else [from_parts((0, 0, 0), (0, 0, 0, 1), (1, 1, 1))] * len(skin["joints"]))
                joints = [multiply(world[j], b) for j, b in zip(skin["joints"], binds)]
            for primitive in mesh["primitives"]:
                if primitive.get("mode", TRIANGLES) >= TRIANGLES and "POSITION" in primitive["attributes"]:
                    self.add_primitive(primitive, weights, joints, world[node], out)
        return out

    def add_primitive(self, primitive, weights, joints, world, out):
        positions = self.read(primitive["attributes"]["POSITION"])
        for weight, target in zip(weights, primitive.get("targets", [])):
            if weight != 0 and "POSITION" in target:
                positions = [tuple(p + weight * d for p, d in zip(a, b))
                             for a, b in zip(positions, self.read(target["POSITION"]))]
        carried = self.influences(primitive["attributes"]) if joints else None
        for i, (x, y, z) in enumerate(positions):
            if carried is None:
                m = world
                out.append((m[0] * x + m[4] * y + m[8] * z + m[12], m[1] * x + m[5] * y + m[9] * z + m[13],
                            m[2] * x + m[6] * y + m[10] * z + m[14]))
                continue
            p = [0.0, 0.0, 0.0]
            for joint, weight in carried[i]:
                m = joints[joint]
                for c in range(3):
                    p[c] += weight * (m[c] * x + m[4 + c] * y + m[8 + c] * z + m[12 + c])
            out.append(tuple(p))


def program_vertices(program, path, clip, times):
    answer = subprocess.run([program, str(path), str(clip)] + [repr(t) for t in times], stdout=subprocess.PIPE,
                            check=True).stdout
    at, result = 0, []
    for _ in times:
        count = struct.unpack_from("=Q", answer, at)[0]
        numbers = array.array("f")
        numbers.frombytes(answer[at + 8:at + 8 + 12 * count])
        result.append(numbers)
        at += 8 + 12 * count
    return result


def largest_error(expected, found):
    """The largest distance on an axis, in parts of the model's size."""
    if 3 * len(expected) != len(found):
        return math.inf
    if not expected:
        return 0.0
    size = math.dist([min(v[c] for v in expected) for c in range(3)], [max(v[c] for v in expected) for c in range(3)])
    return max(abs(v[c] - found[3 * i + c]) for i, v in enumerate(expected) for c in range(3)) / (size or 1.0)


def judge(program, path):
    evaluator = Evaluator(Model(path))
    worst, poses = 0.0, 0
    clips = range(-1, len(evaluator.json.get("animations", [])))
    for clip in clips:
        end = evaluator.clip_end(clip) if clip >= 0 else 0.0
        times = [part * end for part in PLACES_IN_CLIP] if clip >= 0 else [0.0]
        for time, found in zip(times, program_vertices(program, path, clip, times)):
            worst = max(worst, largest_error(evaluator.vertices(clip, time), found))
            poses += 1
    return worst, poses


def main():
    program, folder, names = sys.argv[1], pathlib.Path(sys.argv[2]), sys.argv[3:]
    if not folder.is_dir():
        print("skipped: the folder of extra scenes, %s, is not there" % folder)
        return 77
    wrong = 0
    for path in sorted(p for p in folder.rglob("*") if p.suffix in (".gltf", ".glb")):
        if names and not any(name in path.name for name in names):
            continue
        worst, poses = judge(program, path)
        wrong += not worst <= TOLERANCE
        print("%s%s: %d poses, largest error %.1e of the size" % ("" if worst <= TOLERANCE else "WRONG ", path.name,
                                                                 poses, worst))
    return wrong != 0


if __name__ == "__main__":
    sys.exit(main())
