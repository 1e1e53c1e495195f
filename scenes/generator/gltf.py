"""Writes one glTF 2.0 scene as a .glb file: tables of JSON and one buffer, the same bytes for the same calls."""

import json
import struct

from . import finish
from . import picture

ARRAY_BUFFER, ELEMENT_ARRAY_BUFFER = 34962, 34963
UNSIGNED_BYTE, UNSIGNED_SHORT, UNSIGNED_INT, FLOAT = 5121, 5123, 5125, 5126
FORMATS = {UNSIGNED_BYTE: "B", UNSIGNED_SHORT: "H", UNSIGNED_INT: "I", FLOAT: "f"}
TYPES = {1: "SCALAR", 2: "VEC2", 3: "VEC3", 4: "VEC4", 16: "MAT4"}
GENERATOR = "Tenebra scenes/generate.py"


def rounded(values):
    """Floats as JSON keeps them: six digits after the point, no minus zero."""
    return [round(v, 6) + 0.0 for v in values]


class Document:
    """A scene being written. Things are added by name and known by their index."""

    def __init__(self, name, ambient_light, background):
        extras = {"ambient_light": rounded(ambient_light), "background": rounded(background)}
        self.json = {"asset": {"version": "2.0", "generator": GENERATOR, "copyright": "MIT licence, as Tenebra"},
                     "scene": 0, "scenes": [{"name": name, "nodes": [], "extras": extras}]}
        self._buckets = {}    # (component type, stride, target) -> [bytes]; one bufferView each
        self._accessors = {}  # (content, layout) -> index, so that equal data is stored once
        self._samplers = {}
        self._textures = {}   # name of a picture -> index
        self._finishes = []   # of each material

    def table(self, key):
        return self.json.setdefault(key, [])

    def _append(self, key, entry):
        self.table(key).append(entry)
        return len(self.table(key)) - 1

    def use_extension(self, name):
        used = self.table("extensionsUsed")
        if name not in used:
            used.append(name)

    # Data

    def accessor(self, rows, component_type, target=None, normalized=False, bounds=False):
        """Stores `rows` (tuples of equal length) and returns the accessor's index."""
        width = len(rows[0])
        data = struct.pack("<%d%s" % (len(rows) * width, FORMATS[component_type]), *[v for row in rows for v in row])
        layout = (component_type, width, target, normalized)
        found = self._accessors.get((data, layout))
        if found is not None:
            return found
        entry = {"componentType": component_type, "count": len(rows), "type": TYPES[width]}
        if normalized:
            entry["normalized"] = True
        if bounds:
            columns = list(zip(*struct.iter_unpack("<%d%s" % (width, FORMATS[component_type]), data)))
            entry["min"], entry["max"] = [min(c) for c in columns], [max(c) for c in columns]
        entry["bufferView"], entry["byteOffset"] = self._place(data, component_type, width, target)
        index = self._append("accessors", entry)
        self._accessors[(data, layout)] = index
        return index

    def _place(self, data, component_type, width, target):
        stride = len(data) // max(1, len(data) // (width * struct.calcsize(FORMATS[component_type])))
        key = (component_type, stride if target == ARRAY_BUFFER else 0, target)
        if key not in self._buckets:
            view = {"buffer": 0, "name": "view%d" % len(self._buckets)}
            if target is not None:
                view["target"] = target
            if target == ARRAY_BUFFER:
                view["byteStride"] = stride
            self._buckets[key] = (self._append("bufferViews", view), bytearray())
        view_index, content = self._buckets[key]
        offset = len(content)
        content.extend(data + b"\0" * (-len(data) % 4))
        return view_index, offset

    # Looks

    def texture(self, name, clamped=False):
        """The picture of that name (picture.py), stored once."""
        if name not in self._textures:
            view = self._append("bufferViews", {"buffer": 0, "name": name})
            self._buckets[name] = (view, bytearray(picture.of(name)))
            image = self._append("images", {"name": name, "mimeType": "image/png", "bufferView": view})
            wrap = 33071 if clamped else 10497
            sampler = self._append("samplers", {"wrapS": wrap, "wrapT": wrap, "magFilter": 9729, "minFilter": 9987})
            self._textures[name] = self._append("textures", {"source": image, "sampler": sampler})
        return self._textures[name]

    def material(self, name, color, emissive=None, double_sided=False, extras=None):
        """A surface of the linear reflectance `color`; finish.py has the rest of its finish."""
        made_of = finish.of(name)
        surface = {"baseColorFactor": rounded(color) + [1.0], "metallicFactor": made_of.metallic,
                   "roughnessFactor": made_of.roughness}
        if made_of.picture:
            surface["baseColorTexture"] = {"index": self.texture(made_of.picture)}
        entry = {"name": name, "pbrMetallicRoughness": surface}
        if emissive:
            entry["emissiveFactor"] = rounded(emissive)
        if double_sided:
            entry["doubleSided"] = True
        if extras:
            entry["extras"] = extras
        self._finishes.append(made_of)
        return self._append("materials", entry)

    def cutout_material(self, name, texture, color, cutoff=0.5):
        """Both sides of a card, cut out where the picture's alpha is below `cutoff`."""
        self._finishes.append(finish.MATT)
        return self._append("materials", {
            "name": name, "alphaMode": "MASK", "alphaCutoff": cutoff, "doubleSided": True, "pbrMetallicRoughness": {
                "baseColorFactor": rounded(color) + [1.0], "baseColorTexture": {"index": self.texture(texture, True)},
                "metallicFactor": 0.0, "roughnessFactor": 0.8}})

    def glass_material(self, name, color, alpha=None, transmission=None):
        """Seen through by its alpha (BLEND) or by transmission."""
        self._finishes.append(finish.MATT)
        entry = {"name": name, "doubleSided": True, "pbrMetallicRoughness": {
            "baseColorFactor": rounded(color) + [1.0 if alpha is None else alpha], "metallicFactor": 0.0,
            "roughnessFactor": 0.1}}
        if alpha is not None:
            entry["alphaMode"] = "BLEND"
        if transmission is not None:
            self.use_extension("KHR_materials_transmission")
            entry["extensions"] = {"KHR_materials_transmission": {"transmissionFactor": transmission}}
        return self._append("materials", entry)

    # Shapes

    def mesh(self, name, parts, extras=None):
        """`parts`: pairs (Surface, material index), one primitive each."""
        entry = {"name": name, "primitives": [self._primitive(surface, material) for surface, material in parts]}
        if extras:
            entry["extras"] = extras
        return self._append("meshes", entry)

    def _primitive(self, surface, material):
        attributes = {"POSITION": self.accessor(surface.positions, FLOAT, ARRAY_BUFFER, bounds=True)}
        if surface.normals:
            attributes["NORMAL"] = self.accessor(surface.normals, FLOAT, ARRAY_BUFFER)
        if self._finishes[material].picture:
            coordinates = self._finishes[material].coordinates(surface.positions)
            attributes["TEXCOORD_0"] = self.accessor(coordinates, FLOAT, ARRAY_BUFFER)
        small = len(surface.positions) < 65535
        indices = [(i,) for triangle in surface.triangles for i in triangle]
        return {"attributes": attributes, "material": material, "mode": 4,
                "indices": self.accessor(indices, UNSIGNED_SHORT if small else UNSIGNED_INT, ELEMENT_ARRAY_BUFFER)}

    def card_mesh(self, name, positions, coordinates, triangles, material):
        """Flat triangles with texture coordinates of their own."""
        attributes = {"POSITION": self.accessor(positions, FLOAT, ARRAY_BUFFER, bounds=True),
                      "TEXCOORD_0": self.accessor(coordinates, FLOAT, ARRAY_BUFFER)}
        indices = self.accessor([(i,) for t in triangles for i in t], UNSIGNED_SHORT, ELEMENT_ARRAY_BUFFER)
        return self._append("meshes", {"name": name, "primitives": [
            {"attributes": attributes, "material": material, "mode": 4, "indices": indices}]})

    def lightmapped_mesh(self, name, parts):
        """`parts`: rectangles, of each material the corners of all, four after each other and counter-clockwise, their
        places in a lightmap (TEXCOORD_1), and its index. Flat, without pictures."""
        primitives = []
        for positions, places, material in parts:
            assert not self._finishes[material].picture
            coordinates = self.accessor(places, FLOAT, ARRAY_BUFFER)
            triangles = [(i, i + a, i + b) for i in range(0, len(positions), 4) for a, b in ((1, 2), (2, 3))]
            primitives.append({"material": material, "mode": 4, "attributes": {
                "POSITION": self.accessor(positions, FLOAT, ARRAY_BUFFER, bounds=True),
                "TEXCOORD_0": coordinates, "TEXCOORD_1": coordinates},  # glTF wants a first set where there is a second
                "indices": self.accessor([(i,) for t in triangles for i in t], UNSIGNED_SHORT, ELEMENT_ARRAY_BUFFER)})
        return self._append("meshes", {"name": name, "primitives": primitives})

    def skinned_mesh(self, name, positions, joints, weights, material):
        """Unindexed triangles; four joints for each vertex, with weights in 255ths."""
        attributes = {"POSITION": self.accessor(positions, FLOAT, ARRAY_BUFFER, bounds=True),
                      "JOINTS_0": self.accessor(joints, UNSIGNED_BYTE, ARRAY_BUFFER),
                      "WEIGHTS_0": self.accessor(weights, UNSIGNED_BYTE, ARRAY_BUFFER, normalized=True)}
        return self._append("meshes", {"name": name, "primitives": [
            {"attributes": attributes, "material": material, "mode": 4}]})

    def skin(self, name, joints, skeleton):
        """Joints whose rest pose is the bind pose, at the origin of the mesh: identity inverse bind matrices."""
        identity = tuple(1.0 if i % 5 == 0 else 0.0 for i in range(16))
        return self._append("skins", {"name": name, "joints": joints, "skeleton": skeleton,
                                      "inverseBindMatrices": self.accessor([identity] * len(joints), FLOAT)})

    # Nodes

    def node(self, name, parent=None, translation=None, rotation=None, **things):
        """`things`: mesh, skin, camera as indices, extensions, extras. Without a parent it is a root."""
        entry = {"name": name}
        if translation is not None:
            entry["translation"] = rounded(translation)
        if rotation is not None:
            entry["rotation"] = rounded(rotation)
        entry.update(things)
        index = self._append("nodes", entry)
        if parent is None:
            self.json["scenes"][0]["nodes"].append(index)
        else:
            self.json["nodes"][parent].setdefault("children", []).append(index)
        return index

    def camera(self, name, vertical_fov_rad, near_m=0.1, far_m=500.0, aspect=4.0 / 3.0):
        return self._append("cameras", {"name": name, "type": "perspective", "perspective": {
            "yfov": round(vertical_fov_rad, 6), "znear": near_m, "zfar": far_m, "aspectRatio": round(aspect, 6)}})

    def punctual_light(self, name, kind, color, intensity):
        """`extensions` of a node that carries the light; intensity in candela (point) or lux (directional)."""
        return self._light("KHR_lights_punctual", {
            "name": name, "type": kind, "color": rounded(color), "intensity": intensity})

    def rect_light(self, name, color, nits, width_m, height_m):
        """`extensions` of a node that carries a rectangle shining along -Z (draft EXT_lights_area)."""
        return self._light("EXT_lights_area", {
            "name": name, "type": "rect", "color": rounded(color), "intensity": nits, "size": height_m,
            "rect": {"aspect": round(width_m / height_m, 6)}})

    def _light(self, extension, entry):
        self.use_extension(extension)
        lights = self.json.setdefault("extensions", {}).setdefault(extension, {"lights": []})["lights"]
        lights.append(entry)
        return {extension: {"light": len(lights) - 1}}

    # Motion

    def animate(self, node, path, times_s, values):
        """LINEAR keys for `path` (translation, rotation, scale) of `node`, in the scene's one animation."""
        if "animations" not in self.json:
            self.json["animations"] = [{"name": self.json["scenes"][0]["name"], "channels": [], "samplers": []}]
        animation = self.json["animations"][0]
        key = (self.accessor([(t,) for t in times_s], FLOAT, bounds=True), self.accessor(values, FLOAT))
        if key not in self._samplers:
            self._samplers[key] = len(animation["samplers"])
            animation["samplers"].append({"input": key[0], "output": key[1], "interpolation": "LINEAR"})
        animation["channels"].append({"sampler": self._samplers[key], "target": {"node": node, "path": path}})

    # The file

    def to_bytes(self):
        buffer = bytearray()
        for view_index, content in self._buckets.values():
            self.json["bufferViews"][view_index].update(byteOffset=len(buffer), byteLength=len(content))
            buffer.extend(content + b"\0" * (-len(content) % 4))
        self.json["buffers"] = [{"byteLength": len(buffer)}]
        text = json.dumps(self.json, separators=(",", ":"), sort_keys=True).encode("ascii")
        text += b" " * (-len(text) % 4)
        total = 12 + 8 + len(text) + 8 + len(buffer)
        return (struct.pack("<4sII", b"glTF", 2, total) + struct.pack("<I4s", len(text), b"JSON") + text
                + struct.pack("<I4s", len(buffer), b"BIN\0") + bytes(buffer))
