"""Scenes: the same bytes as the program's, in every frame and by own points, and what is refused."""
import base64
import json
import os
import pathlib
import struct
import subprocess
import zlib

import numpy as np
import pytest

import tenebra

ROOT = pathlib.Path(__file__).resolve().parents[2]
BART = ROOT.parent / "shared" / "scenes" / "bart"
SIZE = (96, 64)
PROGRAM = os.environ.get("TENEBRA_PROGRAM")


def read_png(path):
    """(h, w) or (h, w, 3) uint8 of an 8-bit PNG; written here, so that nothing of the project judges itself."""
    data, at, packed = path.read_bytes(), 8, b""
    while at < len(data):
        length, kind = struct.unpack_from(">I4s", data, at)
        body = data[at + 8:at + 8 + length]
        if kind == b"IHDR":
            width, height, bits, colours = struct.unpack_from(">IIBB", body)
            assert bits == 8
        packed += body if kind == b"IDAT" else b""
        at += 12 + length
    channels = {0: 1, 2: 3}[colours]
    rows = np.frombuffer(zlib.decompress(packed), np.uint8).reshape(height, 1 + width * channels)
    out = np.zeros((height + 1, (width + 1) * channels), np.int64)  # a pixel and a row of zeros before the first
    for y in range(height):
        kind, row = rows[y, 0], rows[y, 1:].astype(np.int64)
        for x in range(channels, row.size + channels):
            left, up, both = out[y + 1, x - channels], out[y, x], out[y, x - channels]
            guess = left + up - both
            paeth = min((left, up, both), key=lambda value: abs(guess - value))
            out[y + 1, x] = (row[x - channels] + (0, left, up, (left + up) // 2, paeth)[kind]) & 255
    image = out[1:, channels:].astype(np.uint8).reshape(height, width, channels)
    return image[..., 0] if channels == 1 else image


def by_the_program(folder, scene, frames):
    """Its pictures and masks, written to `folder`."""
    subprocess.run([PROGRAM, "render", scene, "--frames", "%d:%d:%d" % frames, "--size", "%dx%d" % SIZE, "--raster",
                    "cpu", "--antialias", "1", "-o", folder / "image_%04d.png", "--mask", folder / "mask_%04d.png"],
                   check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


def masks_of(folder, frame):
    """By light."""
    files = sorted(folder.glob(f"mask_{frame:04d}*.png"))
    return {int(file.stem.split("_L")[1]) if "_L" in file.stem else 0: read_png(file) for file in files}


def sides_of(corners, eye):
    """The sides of their triangles that are seen from `eye`."""
    a, b, c = (corners[..., k, :].astype(np.float64) for k in range(3))
    return np.sign(np.einsum("...k,...k", np.cross(b - a, c - a), np.asarray(eye) - a))


def shadow_light(light):
    if light["type"] == "directional":
        return tenebra.DirectionalLight([-x for x in light["direction"]])
    spot = {"spot_axis": light["direction"], "cone_rad": light["outer_cone_rad"]} if light["type"] == "spot" else {}
    return tenebra.PointLight(light["position"], range_m=light["range_m"], **spot)


def write_plate(path, place):
    """A plate over a floor under a node, as glTF; its six corners."""
    corners = np.array([[-4, 0, 4], [4, 0, 4], [4, 0, -4], [-1, 1, 1], [1, 1, 1], [1, 1, -1]], "<f4").tobytes()
    buffer = "data:application/octet-stream;base64," + base64.b64encode(corners).decode()
    path.write_text(json.dumps({
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0, "translation": place}], "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 6, "type": "VEC3", "min": [-4, 0, -4],
                       "max": [4, 1, 4]}],
        "bufferViews": [{"buffer": 0, "byteLength": 72}], "buffers": [{"byteLength": 72, "uri": buffer}]}))
    return np.frombuffer(corners, "<f4").reshape(6, 3)


def test_map_coordinates(tmp_path):
    """What comes out is the file's."""
    place = [691234.25, 0, -5334567.5]
    corners = write_plate(tmp_path / "far.gltf", place)
    scene = tenebra.Scene.load(tmp_path / "far.gltf", floor="none")
    shape = scene.geometry()
    assert shape["positions"].dtype == np.float64
    assert (shape["positions"] == corners + np.array(place)).all()
    picture = scene.render(size=SIZE, points=True, eye=(place[0], 6, place[2] + 0.5), look_at=place)
    seen = picture["triangles"] != tenebra.no_triangle
    assert seen.any() and np.abs(picture["positions"][seen] - place).max() < 4.001
    geometry = tenebra.Geometry(shape["positions"], shape["triangles"], shape["casts_shadow"])
    mask = tenebra.hard_mask(geometry, picture["positions"][seen], shadow_light(scene.lights()[0]),
                             on=picture["triangles"][seen])
    assert (mask == picture["masks"][0][seen]).mean() > 0.99, "the sides of triangles are the light's"


def test_axes_and_units(tmp_path):
    """Centimetres with Z up: ways and normals are the file's too."""
    write_plate(tmp_path / "plate.gltf", [0, 0, 0])
    light = {"add_light": "point position=0,-500,0 intensity=1", "set_light": "0 size=0.5x0.3"}
    scene = tenebra.Scene.load(tmp_path / "plate.gltf", unit="cm", up_axis="z", floor="none", **light)
    lamp = scene.lights()[0]
    assert lamp["position"] == pytest.approx((0, -500, 0), abs=1e-3)
    assert [np.linalg.norm(lamp[half]) for half in ("half_x", "half_y")] == pytest.approx([25, 15], rel=1e-5)
    picture = scene.render(size=SIZE, points=True, aov="normal", eye=(0, 9, 0.5), look_at=(0, 0, 0), up=(0, 0, 1))
    seen = picture["triangles"] != tenebra.no_triangle
    assert seen.any() and (abs(picture["normal"][seen] - (0, 1, 0)) < 1e-6).all(), "both plates lie along X and Z"
    assert np.array_equal(picture["normal"][seen], picture["normals"][seen])
    view = {name: np.array(way) for name, way in picture["view"].items() if name != "orthographic"}
    y, x = np.argwhere(seen)[0]
    ray = view["d0"] + (x + 0.5) * view["dx"] + (y + 0.5) * view["dy"]
    assert np.linalg.norm(np.cross(ray, picture["positions"][y, x] - view["eye"])) < 1e-3 * np.linalg.norm(ray)


# First and last frame, and the step: four frames of each of BART's scenes.
SCENES = [(ROOT / "scenes" / "city.glb", (30, 30, 1)), (ROOT / "scenes" / "gallery.glb", (10, 10, 1)),
          (BART / "kitchen" / "kitchen.aff", (0, 300, 100)), (BART / "robots" / "Robot.aff", (0, 240, 80)),
          (BART / "museum" / "museum5.aff", (0, 120, 40))]


@pytest.mark.skipif(not PROGRAM, reason="TENEBRA_PROGRAM does not name the program")
@pytest.mark.parametrize("path, frames", [
    pytest.param(path, frames, id=path.stem,
                 marks=pytest.mark.skipif(not path.exists(), reason="BART's scenes are not there"))
    for path, frames in SCENES])
def test_the_bytes_of_the_program(path, frames, tmp_path):
    by_the_program(tmp_path, path, frames)
    scene, tracer = tenebra.Scene.load(path), tenebra.Tracer()
    for frame in range(frames[0], frames[1] + 1, frames[2]):
        picture = scene.render(frame, SIZE, points=True, antialias=1)
        masks = masks_of(tmp_path, frame)
        assert (picture["image"] == read_png(tmp_path / f"image_{frame:04d}.png")).all()
        assert picture["masks"].keys() == masks.keys() and len(masks) > 0
        assert all((picture["masks"][number] == mask).all() for number, mask in masks.items())
        own_points_have_the_same(scene, frame, picture, tracer)


def own_points_have_the_same(scene, frame, picture, tracer):
    """The masks of what the pixels see, asked about as points of one's own."""
    kept = scene.geometry(frame)
    geometry = tenebra.Geometry(kept["positions"], kept["triangles"], kept["casts_shadow"])
    seen = picture["triangles"] != tenebra.no_triangle
    on = picture["triangles"][seen]
    sides = sides_of(kept["positions"][kept["triangles"][on]], picture["view"]["eye"])
    assert np.linalg.norm(picture["normals"][seen], axis=-1) == pytest.approx(1, abs=1e-5)
    lights = scene.lights(frame)
    for number, mask in picture["masks"].items():
        own = tracer.hard_mask(geometry, picture["positions"][seen], shadow_light(lights[number]), on=on, sides=sides)
        assert (own == mask[seen]).all()


def test_methods_and_cameras():
    scene = tenebra.Scene.load(ROOT / "scenes" / "court.glb")
    soft = scene.render(size=(48, 32), shadows="soft", ao="adaptive", ao_error=5, threads=1, linear=True)
    fraction = soft["visible_fraction"]
    assert fraction and all(((f >= 0) & (f <= 1)).all() and f.shape == (32, 48) for f in fraction.values())
    assert soft["linear"].dtype == np.float32 and soft["timings"]["ao_ms"] > 0
    above = scene.render(size=(48, 32), eye=(0, 50, 0), look_at=(0, 0, 0), up=(0, 0, 1), fov=40, shadows="none")
    assert above["view"]["eye"] == (0, 50, 0) and above["masks"] == {}
    keys = {"sun_size": 1, "light_facing": (0, 1, 0), "soft_memory": 300, "variant": "Spheres"}
    assert scene.render(size=(8, 8), time=0.5, **keys)["image"].shape == (8, 8, 3)


@pytest.fixture(scope="module")
def city():
    return tenebra.Scene.load(ROOT / "scenes" / "city.glb")


@pytest.mark.parametrize("call, kind, sentence", [
    (lambda scene: scene.render(scene.frames), ValueError, "frame 301 does not exist.*0 to 300"),
    (lambda scene: scene.render(shadows="sft"), ValueError, "shadows: found sft, expected none, hard or soft"),
    (lambda scene: scene.render(size=(0, 8)), ValueError, "size: found 0x8"),
    (lambda scene: scene.render(no_cast="roof"), TypeError, "no_cast, which belongs to Scene.load"),
    (lambda scene: scene.render(colour="red"), TypeError, "render: found colour, expected one of .*shadows"),
    (lambda scene: scene.render(shadow="soft"), TypeError, r"found shadow \(did you mean shadows\?\), expected"),
    (lambda scene: tenebra.Scene.load("nothing.glb"), ValueError, "nothing.glb"),
    (lambda scene: tenebra.Scene.load("nothing.glb", shadows="soft"), TypeError, "Scene.load: found shadows"),
    (lambda scene: tenebra.Scene.load(ROOT / "scenes" / "city.glb", clip="none's \"`"), ValueError, "none's"),
])
def test_what_is_refused(city, call, kind, sentence):
    with pytest.raises(kind, match=sentence):
        call(city)


@pytest.mark.skipif(not PROGRAM, reason="TENEBRA_PROGRAM does not name the program")
def test_a_sun_of_an_edited_light_is_the_programs(tmp_path):
    scene = ROOT / "scenes" / "city.glb"
    number = len(tenebra.Scene.load(scene).lights(0))
    edits = {"add_light": "directional direction=-1,-2,0.3 intensity=2", "set_light": f"{number} diameter=4"}
    frame = tenebra.Scene.load(scene, **edits).render(frame=3, size=SIZE, shadows="soft", antialias=1)
    words = [word for name, value in edits.items() for word in ("--" + name.replace("_", "-"), value)]
    subprocess.run([PROGRAM, "render", scene, *words, "--frames", "3", "--size", "%dx%d" % SIZE, "--raster", "cpu",
                    "--antialias", "1", "--shadows", "soft", "--terminator", "flat", "-o", tmp_path / "image.png", "--quiet"],
                   check=True)
    assert np.array_equal(frame["image"], read_png(tmp_path / "image.png"))


def test_the_module_is_not_the_program():
    """It holds neither the program's reading of command lines nor its window."""
    module = pathlib.Path(tenebra._core.__file__).read_bytes()
    for part in (b"N3CLI", b"glfwInit", b"ImGui"):
        assert part not in module, part
