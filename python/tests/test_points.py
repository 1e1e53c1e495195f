"""Own points and triangles: known answers, what a caller may hand in, and what is refused with which sentence."""
import os
import signal
import threading
import time

import numpy as np
import pytest

import tenebra

# A floor at y = 0, and over x < 0 a plate at y = 2.
POSITIONS = np.array([[-9, 0, 9], [9, 0, 9], [9, 0, -9], [-9, 0, -9], [-5, 2, 5], [0, 2, 5], [0, 2, -5], [-5, 2, -5]],
                     np.float32)
INDICES = np.array([[0, 1, 2], [0, 2, 3], [4, 5, 6], [4, 6, 7]], np.uint32)
LIGHT = (0, 4, 0)
SQUARE = tenebra.AreaLight.rectangle((0, 4, 0), (1, 0, 0), (0, 0, 1))
POINTS = np.array([[-1, 1, 0], [1, 1, 0], [-1, 3, 0]], np.float64)


@pytest.mark.parametrize("triangles", [(POSITIONS, INDICES), POSITIONS[INDICES], tenebra.Geometry(POSITIONS, INDICES),
                                       (POSITIONS.tolist(), INDICES.astype(np.int64))])
def test_hard_masks(triangles):
    mask = tenebra.hard_mask(triangles, POINTS, LIGHT)
    assert mask.dtype == np.uint8 and mask.tolist() == [0, 255, 255]
    # Any layout and type of the points, any shape.
    assert tenebra.hard_mask(triangles, np.asfortranarray(POINTS.astype(np.float32)), LIGHT).tolist() == mask.tolist()
    grid = tenebra.hard_mask(triangles, np.stack([POINTS, POINTS]), tenebra.PointLight(LIGHT))
    assert grid.tolist() == [mask.tolist()] * 2
    assert tenebra.hard_mask(triangles, [-1, 1, 0], tenebra.DirectionalLight((0, 1, 0))).shape == ()
    assert tenebra.hard_mask(triangles, np.zeros((0, 3)), LIGHT).shape == (0,)


def test_sides_normals_and_spots():
    on_floor, below = [[1.0, 0, 1]], [-1]
    ask = lambda **options: tenebra.hard_mask((POSITIONS, INDICES), on_floor, LIGHT, on=[0], **options).tolist()
    assert ask() == ask(sides=[1]) == ask(normals=[[0, 2, 0]]) == [255]
    assert ask(sides=below) == ask(normals=[[0, -1, 0]]) == [0]
    spot = tenebra.PointLight(LIGHT, spot_axis=(0, -3, 0), cone_rad=0.1)
    assert tenebra.hard_mask((POSITIONS, INDICES), [[0.1, 1, 0], [3, 1, 0]], spot).tolist() == [255, 0]
    near = tenebra.PointLight(LIGHT, range_m=2)
    assert tenebra.hard_mask((POSITIONS, INDICES), [[0.1, 3, 0], [0.1, 1, 0]], near).tolist() == [255, 0]


def crowded(**options):
    """50,000 small triangles between the light and 64 points near one another."""
    random = np.random.default_rng(1)
    corners = random.uniform(-1, 1, (50000, 1, 3)) + (0, 2.5, 0) + random.normal(0, 0.01, (50000, 3, 3))
    return tenebra.soft_visibility(corners, random.uniform(-0.1, 0.1, (64, 3)), SQUARE, **options)


def test_soft_visibility():
    fraction, irradiance = tenebra.soft_visibility((POSITIONS, INDICES), [[0, 1, 0], [4, 1, 0], [-2, 1, 0]], SQUARE)
    assert fraction == pytest.approx([0.5, 1, 0], abs=1e-5)
    assert irradiance[1] > irradiance[2] == 0
    with pytest.raises(ValueError, match="not enough memory for soft shadows"):
        crowded(memory_mb=1)
    assert (crowded(memory_mb=1000)[0] == crowded()[0]).all()
    disc = tenebra.AreaLight.disc((0, 4, 0), (1, 0, 0), (0, 0, 1))
    assert disc.vertices.shape == (12, 3) and disc.area_m2 == pytest.approx(np.pi)


def test_suns():
    points, up = [[-1.0, 0, 0], [3, 0, 0]], [[0, 1, 0]] * 2
    for to_sun in ((0, 1, 0), (0.0, 2.0, 0.1)):
        fraction, _ = tenebra.soft_visibility((POSITIONS, INDICES), points, tenebra.AreaLight.sun(to_sun, 1), on=[1, 1],
                                              normals=up)
        assert fraction.tolist() == [0, 1]
    assert tenebra.AreaLight.sun((0, 1, 0)).vertices.shape == (0, 3)
    with pytest.raises(ValueError, match="sun"):
        tenebra.AreaLight.sun((0, 0, 0))


def test_map_coordinates():
    """Far from the origin doubles keep their digits; at round places the bits are those of the origin."""
    near, points = POSITIONS.astype(np.float64), np.array([[-1.0, 0, 0.5], [1, 0, 0], [-0.25, 0, 0]])
    ask = dict(on=[1, 1, 1])
    for offset in (np.array([691200.0, 0, 5334600]), np.array([691234.127, 100.5, 5334567.381])):
        far = tenebra.Geometry(near + offset, INDICES)
        assert np.abs(np.array(far.origin) - offset).max() <= 10.1 and np.mod(far.origin, 1).tolist() == [0] * 3
        for light in (LIGHT, (0.3, 8, 0.1)):
            expected = tenebra.hard_mask((near, INDICES), points, light, **ask)
            assert (tenebra.hard_mask(far, points + offset, np.add(light, offset), **ask) == expected).all()
        square = tenebra.AreaLight.rectangle(np.array([0, 4, 0]) + offset, (1, 0, 0), (0, 0, 1))
        here, there = (tenebra.soft_visibility(*what, **ask)[0] for what in (
            ((near, INDICES), points, SQUARE), (far, points + offset, square)))
        assert (here == there).all() if offset[1] == 0 else here == pytest.approx(there, abs=1e-5)
        assert np.abs(square.vertices - offset).max() <= 4 + 1e-6
        floor = np.stack(np.meshgrid(np.arange(-6, 6, 0.37), [0.0], np.arange(-4, 4, 0.41)), -1).reshape(-1, 3)
        on = np.where(floor[:, 0] + floor[:, 2] > 0, 0, 1)
        suns = [tenebra.DirectionalLight((np.cos(angle), np.sin(angle), 0.3)) for angle in np.linspace(0.2, 2.9, 12)]
        hours = [sum(tenebra.hard_mask(shape, floor + moved, sun, on=on) == 255 for sun in suns)
                 for shape, moved in ((tenebra.Geometry(near, INDICES), 0), (far, offset))]
        assert (hours[0] == hours[1]).all() and len(set(hours[0].tolist())) > 5
    assert tenebra.Geometry(near, INDICES).origin == (0, 0, 0)
    assert tenebra.Geometry(POSITIONS + np.float32(1e6), INDICES).origin == (0, 0, 0), "floats are what they are"


def test_ambient_occlusion():
    ceiling = np.array([[-9, .5, 9], [0, .5, 9], [0, .5, -9], [-9, .5, -9]], np.float32)
    triangles = (np.concatenate([POSITIONS[:4], ceiling]), INDICES)
    points = [[-4, 0, -5], [4, 0, 5]]
    for options in ({"on": [1, 0]}, {"normals": [[0, 1, 0]] * 2}):
        openness = tenebra.ambient_occlusion(triangles, points, distance=1, error=0.5, **options)
        assert openness == pytest.approx([0.75, 1], abs=0.01)


def test_moved_vertices():
    geometry, tracer = tenebra.Geometry(POSITIONS, INDICES), tenebra.Tracer()
    sun = tenebra.DirectionalLight((0, 1, 0))
    assert tracer.hard_mask(geometry, POINTS[:2], sun).tolist() == [0, 255]
    geometry.move_vertices(POSITIONS + np.float32([[0, 0, 0]] * 4 + [[5, 0, 0]] * 4))
    assert tracer.hard_mask(geometry, POINTS[:2], sun).tolist() == [255, 0]


def test_arrays_are_not_copied_twice():
    """What is contiguous and of the right type is read in place."""
    points = np.ascontiguousarray(np.random.default_rng(1).uniform(-4, 4, (64, 64, 3)))
    assert tenebra._rows("points", points, np.float64) is points
    assert tenebra._indices("on", INDICES) is INDICES


@pytest.mark.parametrize("call, kind, sentence", [
    (lambda: tenebra.hard_mask(np.zeros((2, 3)), POINTS, LIGHT), ValueError,
     r"triangles: found the shape \(2, 3\), expected \(n, 3, 3\)"),
    (lambda: tenebra.hard_mask((POSITIONS, INDICES.astype(float)), POINTS, LIGHT), TypeError,
     "triangles: found an array of float64, expected whole numbers"),
    (lambda: tenebra.hard_mask((POSITIONS, -INDICES.astype(int)), POINTS, LIGHT), ValueError, "found numbers from -7"),
    (lambda: tenebra.Geometry(POSITIONS[:5], INDICES), ValueError, "triangle 2 has the vertices 4, 5 and 6"),
    (lambda: tenebra.Geometry(POSITIONS * np.nan, INDICES), ValueError, "vertex 0 is .*nan.*finite"),
    (lambda: tenebra.hard_mask((POSITIONS, INDICES), POINTS[:, :2], LIGHT), ValueError,
     r"points: found the shape \(3, 2\), expected \(\.\.\., 3\)"),
    (lambda: tenebra.hard_mask((POSITIONS, INDICES), [["a", "b", "c"]], LIGHT), TypeError, "expected numbers"),
    (lambda: tenebra.hard_mask((POSITIONS, INDICES), [[0, np.inf, 0]], LIGHT), ValueError, "point 0 is at"),
    (lambda: tenebra.hard_mask((POSITIONS, INDICES), POINTS, LIGHT, on=[0]), ValueError,
     r"on: found the shape \(1,\), expected \(3,\)"),
    (lambda: tenebra.hard_mask((POSITIONS, INDICES), POINTS, LIGHT, on=[0, 1, 4]), ValueError, "triangle 4"),
    (lambda: tenebra.hard_mask((POSITIONS, INDICES), POINTS, LIGHT, sides=[0, 1, 2]), ValueError, "sides"),
    (lambda: tenebra.hard_mask((POSITIONS, INDICES), POINTS, (0, np.nan, 0)), ValueError, "expected finite numbers"),
    (lambda: tenebra.hard_mask((POSITIONS, INDICES), POINTS, SQUARE), TypeError, "soft_visibility"),
    (lambda: tenebra.hard_mask((POSITIONS, INDICES), POINTS, LIGHT, threads=-1), ValueError, "threads: found -1"),
    (lambda: tenebra.hard_mask((POSITIONS, INDICES), POINTS, LIGHT, threads=1 << 24), ValueError, "expected 1 to 1024"),
    (lambda: tenebra.soft_visibility((POSITIONS, INDICES), POINTS, LIGHT), TypeError, "expected an AreaLight"),
    (lambda: tenebra.soft_visibility((POSITIONS, INDICES), POINTS, SQUARE, memory_mb=0), ValueError, "found 0, expected 1"),
    (lambda: tenebra.AreaLight([[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]]), ValueError, "light"),
    (lambda: tenebra.ambient_occlusion((POSITIONS, INDICES), POINTS), ValueError, "neither a triangle nor a normal"),
])
def test_what_is_refused(call, kind, sentence):
    with pytest.raises(kind, match=sentence):
        call()


def long_call(**options):
    """Occlusion among 20,000 triangles at 300,000 points, to a tenth of a level: takes a good while."""
    random = np.random.default_rng(2)
    corners = random.uniform(-1, 1, (20000, 1, 3)) + random.normal(0, 0.02, (20000, 3, 3))
    points, normals = random.uniform(-1, 1, (300000, 3)), random.normal(0, 1, (300000, 3))
    return tenebra.ambient_occlusion(corners, points, normals=normals, distance=1, error=0.1, **options)


def test_ctrl_c_ends_a_call():
    sent = []

    def interrupt():
        sent.append(time.monotonic())
        os.kill(os.getpid(), signal.SIGINT)

    timer = threading.Timer(0.3, interrupt)  # a thread of Python's own: it runs, so the lock is released
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        long_call()
    assert time.monotonic() - sent[0] < 5


def test_progress_may_end_a_call():
    class Enough(Exception):
        pass

    def stop(done):
        raise Enough

    points = np.random.default_rng(3).uniform(-4, 4, (3 << 18, 3))
    with pytest.raises(Enough):
        tenebra.hard_mask((POSITIONS, INDICES), points, LIGHT, progress=stop)
    seen = []
    one = tenebra.hard_mask((POSITIONS, INDICES), points, LIGHT, threads=1, progress=seen.append)
    assert seen[-1] == 1
    assert (one == tenebra.hard_mask((POSITIONS, INDICES), points, LIGHT)).all()
