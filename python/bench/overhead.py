#!/usr/bin/env python3
"""What Python adds: compares frames of `Scene.render` with those of the program, and questions about points with the same
questions to the C library, on the same arrays and in turns.

usage: overhead.py BUILD_FOLDER [--scene FILE] [--frames FIRST:LAST:STEP] [--size W H] [--rounds N] [--threads N]

Each round draws the frames by the program, then by Python. A frame's time is the whole call here, and the program's
total_ms there: from evaluating the scene to the picture in memory. Ends with lines `python.NAME: ratio`, medians of the
frames' ratios; exit code 1 if one is above 1.05.
"""
import argparse
import csv
import ctypes
import pathlib
import statistics
import subprocess
import sys
import tempfile
import time

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[2]
LIMIT = 1.05


class Points(ctypes.Structure):
    """tenebra_points."""
    _fields_ = [("struct_size", ctypes.c_size_t), ("count", ctypes.c_size_t), ("positions", ctypes.c_void_p),
                ("triangles", ctypes.c_void_p), ("normals", ctypes.c_void_p), ("sides", ctypes.c_void_p),
                ("width", ctypes.c_int32)]


class Light(ctypes.Structure):
    """tenebra_light."""
    _fields_ = [("struct_size", ctypes.c_size_t), ("directional", ctypes.c_int32), ("position", ctypes.c_float * 3),
                ("to_light", ctypes.c_float * 3), ("spot_axis", ctypes.c_float * 3), ("spot_cos_outer", ctypes.c_float),
                ("range_m", ctypes.c_float)]


class Area(ctypes.Structure):
    """tenebra_area_light."""
    _fields_ = [("struct_size", ctypes.c_size_t), ("vertices", ctypes.c_void_p), ("vertex_count", ctypes.c_size_t)]


class Options(ctypes.Structure):
    """tenebra_options."""
    _fields_ = [("struct_size", ctypes.c_size_t), ("threads", ctypes.c_int32), ("soft_error", ctypes.c_double),
                ("ao_error", ctypes.c_double), ("ao_distance_m", ctypes.c_double), ("progress", ctypes.c_void_p),
                ("user", ctypes.c_void_p)]


class Library:
    """The C interface, on arrays that live as long as this."""

    def __init__(self, path, kept, points, on, sides, threads):
        self.c = ctypes.CDLL(str(path))
        self.c.tenebra_geometry_create.restype = self.c.tenebra_tracer_create.restype = ctypes.c_void_p
        self.c.tenebra_tracer_error.restype = ctypes.c_char_p
        self.geometry = ctypes.c_void_p(self.c.tenebra_geometry_create())
        self.tracer = ctypes.c_void_p(self.c.tenebra_tracer_create())
        self.kept = positions, triangles, casts = (np.ascontiguousarray(kept[name]) for name in
                                                   ("positions", "triangles", "casts_shadow"))
        self.arrays = points, on, sides
        failed = self.c.tenebra_geometry_set(
            self.geometry, positions.ctypes.data_as(ctypes.c_void_p), ctypes.c_size_t(len(positions)),
            triangles.ctypes.data_as(ctypes.c_void_p), ctypes.c_size_t(len(triangles)),
            casts.ctypes.data_as(ctypes.c_void_p))
        assert not failed
        self.points = Points(ctypes.sizeof(Points), points.size // 3, points.ctypes.data, on.ctypes.data, None,
                             sides.ctypes.data, points.shape[1])
        self.options = Options(ctypes.sizeof(Options), threads, 0.0, 2.5, 0.0, None, None)

    def call(self, name, *arguments):
        failed = getattr(self.c, "tenebra_" + name)(self.tracer, self.geometry, ctypes.byref(self.points), *arguments)
        assert not failed, self.c.tenebra_tracer_error(self.tracer)


def timed_ms(body):
    start = time.perf_counter()
    body()
    return 1000 * (time.perf_counter() - start)


def program_times(program, arguments, options):
    """total_ms by frame."""
    with tempfile.TemporaryDirectory() as folder:
        log = pathlib.Path(folder, "log.csv")
        subprocess.run([program, "render", arguments.scene, "--frames", arguments.frames, "--size",
                        "%dx%d" % tuple(arguments.size), "--raster", "cpu", "--antialias", "1", "--terminator", "flat",
                        "--threads", str(arguments.threads), "-o", "none", "--log", log, "--quiet", *options], check=True)
        with open(log, newline="", encoding="utf-8") as file:
            rows = csv.DictReader(line for line in file if not line.startswith("#"))
            return {int(row["frame"]): float(row["total_ms"]) for row in rows}


def frame_ratio(program, arguments, **options):
    """Of whole frames, without the first, which makes what the others keep."""
    import tenebra
    words = [word for name, value in options.items() for word in ("--" + name.replace("_", "-"), str(value))]
    scene = tenebra.Scene.load(arguments.scene)
    first, last, step = (int(number) for number in arguments.frames.split(":"))
    ours, theirs = {}, {}
    for _ in range(arguments.rounds):
        for frame, ms in program_times(program, arguments, words).items():
            theirs.setdefault(frame, []).append(ms)
        for frame in range(first, last + 1, step):
            ours.setdefault(frame, []).append(timed_ms(lambda: scene.render(
                frame, arguments.size, threads=arguments.threads, antialias=1, terminator="flat", **options)))
    assert ours.keys() == theirs.keys() and len(ours) > 2
    later = sorted(ours)[1:]
    print(f"frames {options}: Python {statistics.median(min(ours[f]) for f in later):.1f} ms, "
          f"program {statistics.median(min(theirs[f]) for f in later):.1f} ms")
    return statistics.median(min(ours[frame]) / min(theirs[frame]) for frame in later)


def question_ratios(library, arguments):
    """Of hard_mask, soft_visibility and ambient_occlusion."""
    import tenebra
    scene = tenebra.Scene.load(arguments.scene)
    frame = int(arguments.frames.split(":")[0])
    picture = scene.render(frame, arguments.size, points=True, shadows="none", antialias=1)
    kept, eye = scene.geometry(frame), np.array(picture["view"]["eye"])
    seen = picture["triangles"] != tenebra.no_triangle
    first = np.unravel_index(np.argmax(seen), seen.shape)  # what is seen there is asked in place of the background
    on = np.where(seen, picture["triangles"], picture["triangles"][first])
    points = np.ascontiguousarray(np.where(seen[..., None], picture["positions"], picture["positions"][first]))
    corners = kept["positions"][kept["triangles"][on]].astype(np.float64)
    faces = np.cross(corners[..., 1, :] - corners[..., 0, :], corners[..., 2, :] - corners[..., 0, :])
    sides = np.sign(np.einsum("...k,...k", faces, eye - corners[..., 0, :])).astype(np.int8)
    lamp = kept["positions"].max(axis=0) + 1
    half_x, half_y = np.array([1, 0, 0], np.float32), np.array([0, 0, 1], np.float32)
    area = tenebra.AreaLight.rectangle(lamp, half_x, half_y)
    c = Library(library, kept, points, on, sides, arguments.threads)
    light = Light(ctypes.sizeof(Light), 0, tuple(lamp), (0, 1, 0), (0, -1, 0), -1, 0)
    vertices = np.ascontiguousarray(area.vertices)
    area_of_c = Area(ctypes.sizeof(Area), vertices.ctypes.data, len(vertices))
    mask, fraction, irradiance = np.empty(on.shape, np.uint8), np.empty(on.shape, np.float32), np.empty(on.shape, np.float32)
    geometry, tracer = tenebra.Geometry(kept["positions"], kept["triangles"], kept["casts_shadow"]), tenebra.Tracer()
    common = {"on": on, "sides": sides, "threads": arguments.threads}
    options, answers = ctypes.byref(c.options), [array.ctypes.data_as(ctypes.c_void_p) for array in (mask, fraction, irradiance)]
    pairs = {
        "hard_mask": (lambda: c.call("hard_mask", ctypes.byref(light), options, answers[0]), lambda: mask,
                      lambda: tracer.hard_mask(geometry, points, tenebra.PointLight(lamp), **common)),
        "soft_visibility": (lambda: c.call("soft_visibility", ctypes.byref(area_of_c), options, answers[1], answers[2]),
                            lambda: fraction, lambda: tracer.soft_visibility(geometry, points, area, **common)[0]),
        "ambient_occlusion": (lambda: c.call("ambient_occlusion", options, answers[1]), lambda: fraction,
                              lambda: tracer.ambient_occlusion(geometry, points, **common))}
    ratios = {}
    for name, (by_c, of_c, by_python) in pairs.items():
        by_c()
        assert np.array_equal(by_python(), of_c()), name  # the same answers; trees are there from here on
        rounds = [(timed_ms(by_python), timed_ms(by_c)) for _ in range(arguments.rounds)]
        ours, theirs = (min(times) for times in zip(*rounds))
        print(f"{name}: Python {ours:.1f} ms, C {theirs:.1f} ms")
        ratios[name] = ours / theirs
    return ratios


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--scene", default=ROOT / "scenes" / "city.glb")
    parser.add_argument("--frames", default="150:156:1")
    parser.add_argument("--size", type=int, nargs=2, default=(1024, 1024))
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--threads", type=int, default=0)
    arguments = parser.parse_args()
    sys.path.insert(0, str(arguments.build / "python"))
    program = arguments.build / "bin" / "tenebra"
    ratios = {"frames_hard": frame_ratio(program, arguments, shadows="hard"),
              "frames_unshadowed": frame_ratio(program, arguments, shadows="none"),
              **question_ratios(arguments.build / "libtenebra.so", arguments)}
    for name, ratio in ratios.items():
        print(f"python.{name}: {ratio:.3f}")
    return 1 if max(ratios.values()) > LIMIT else 0


if __name__ == "__main__":
    sys.exit(main())
