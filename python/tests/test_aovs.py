"""What a frame knows beside its colours: the values of the program's OpenEXR files, bit for bit, and what they mean."""
import os
import pathlib
import struct
import subprocess
import zlib

import numpy as np
import pytest

import tenebra

SCENES = pathlib.Path(__file__).resolve().parents[2] / "scenes"
PROGRAM = os.environ.get("TENEBRA_PROGRAM")
WORDS = ("depth", "id", "normal", "visibility", "irradiance", "ao", "albedo")
SIZE = (72, 48)


def text_at(data, at):
    end = data.index(b"\0", at)
    return data[at:end].decode(), end + 1


def channels_of(value):
    """Names and types in the order that rows have them."""
    at, found = 0, []
    while value[at]:
        name, at = text_at(value, at)
        found.append((name, {0: "<u4", 2: "<f4"}[struct.unpack_from("<i", value, at)[0]]))
        at += 16
    return found


def read_exr(path):
    """By channel (h, w); of one part, compressed by ZIP. Written here, so that nothing of the project judges itself."""
    data, at, header = path.read_bytes(), 8, {}
    while data[at]:
        name, at = text_at(data, at)
        _, at = text_at(data, at)
        size = struct.unpack_from("<i", data, at)[0]
        header[name] = data[at + 4:at + 4 + size]
        at += 4 + size
    assert header["compression"] == b"\3"
    channels = channels_of(header["channels"])
    left, top, right, bottom = struct.unpack("<4i", header["dataWindow"])
    width, height = right - left + 1, bottom - top + 1
    out = {name: np.empty((height, width), kind) for name, kind in channels}
    for start in struct.unpack_from(f"<{-(-height // 16)}Q", data, at + 1):
        row, size = struct.unpack_from("<2i", data, start)
        rows, packed = range(row - top, min(row - top + 16, height)), data[start + 8:start + 8 + size]
        plain = 4 * width * len(channels) * len(rows)
        if size < plain:
            steps = np.frombuffer(zlib.decompress(packed), np.uint8).astype(np.int64)
            steps[1:] -= 128
            halves = np.cumsum(steps).astype(np.uint8)
            packed = np.stack([halves[:plain // 2], halves[plain // 2:]], axis=1).tobytes()
        lines = np.frombuffer(packed, "<u4").reshape(len(rows), len(channels), width)
        for number, (name, kind) in enumerate(channels):
            out[name][rows.start:rows.stop] = lines[:, number].view(kind)
    return out


def bits(array):
    return np.ascontiguousarray(array).view(np.uint32)


@pytest.mark.skipif(not PROGRAM, reason="TENEBRA_PROGRAM does not name the program")
@pytest.mark.parametrize("name, frame, shadows", [("court", 20, "soft"), ("gallery", 10, "hard")])
def test_the_values_of_the_programs_files(name, frame, shadows, tmp_path):
    path, file = SCENES / f"{name}.glb", tmp_path / "frame.exr"
    subprocess.run([PROGRAM, "render", path, "--frames", str(frame), "--size", "%dx%d" % SIZE, "--raster", "cpu",
                    "--shadows", shadows, "--ao", "adaptive", "--antialias", "1", "--terminator", "flat", "--quiet",
                    "--aov", ",".join(WORDS), "--format", "float", "-o", file], check=True)
    stored = read_exr(file)
    scene = tenebra.Scene.load(path)
    drawn = scene.render(frame, SIZE, shadows=shadows, ao="adaptive", antialias=1, linear=True, aov=WORDS)
    for key, channel in {"depth": "Z", "id": "id", "part": "id.part", "material": "id.material", "ao": "ao"}.items():
        assert np.array_equal(bits(drawn[key]), bits(stored.pop(channel))), key
    for key, layer in {"normal": "N.XYZ", "irradiance": "irradiance.RGB", "albedo": "albedo.RGB", "linear": "RGB"}.items():
        *prefix, letters = layer.split(".")
        for place, letter in enumerate(letters):
            channel = ".".join([*prefix, letter])
            assert np.array_equal(bits(drawn[key][..., place]), bits(stored.pop(channel))), channel
    names = [light["name"] or f"light{number}" for number, light in enumerate(scene.lights(frame))]
    for number, visibility in drawn["visibility"].items():
        assert np.array_equal(bits(visibility), bits(stored.pop("visibility." + names[number])))
    assert not stored and drawn["visibility"]


def test_what_they_mean():
    frame = tenebra.Scene.load(SCENES / "court.glb").render(20, SIZE, points=True, aov="depth,id,normal,visibility,albedo")
    seen = frame["triangles"] != tenebra.no_triangle
    assert seen.any() and not seen.all()
    assert np.array_equal(frame["id"], frame["triangles"])
    d0, dx, dy, eye = (np.array(frame["view"][name], np.float64) for name in ("d0", "dx", "dy", "eye"))
    axis = np.cross(dx, dy)
    axis *= np.sign(axis @ d0) / np.linalg.norm(axis)
    assert frame["depth"][seen] == pytest.approx((frame["positions"][seen] - eye) @ axis, rel=1e-6)
    assert np.isinf(frame["depth"][~seen]).all()
    assert np.array_equal(frame["normal"][seen], frame["normals"][seen]) and not frame["normal"][~seen].any()
    for number, visibility in frame["visibility"].items():
        assert np.array_equal(visibility[seen] * 255, frame["masks"][number][seen])
    assert frame["albedo"].shape == (SIZE[1], SIZE[0], 3) and 0 < frame["albedo"].max() <= 1
    assert "irradiance" not in frame and "ao" not in frame


@pytest.mark.parametrize("options, sentence", [
    ({"aov": "depht"}, "aov: found depht, expected some of depth, id"),
    ({"aov": ["ao"]}, "--aov ao needs ambient occlusion"),
    ({"aov": ("visibility",), "shadows": "none"}, "--aov visibility needs shadows"),
])
def test_what_is_refused(options, sentence):
    with pytest.raises(ValueError, match=sentence):
        tenebra.Scene.load(SCENES / "court.glb").render(0, (8, 8), **options)
