"""Exact hard shadows, soft shadows and ambient occlusion on the CPU.

Lengths are metres, space is right-handed. Arrays are numpy's: a contiguous array of the documented type is read in
place, any other is converted. Answers are new arrays of the points' shape.

Triangles are given as an array (n, 3, 3) of corners, as a pair (positions (v, 3), indices (n, 3)), as an object with
.vertices and .faces (trimesh), or as a Geometry, which keeps them for many calls. An offset of whole numbers is
subtracted from float64 coordinates far from the origin (maps), from points and from lights; then positions are rounded
once to float32 and taken as exact. Points are float64. Calls that ask about points, and render, release Python's lock,
end on Ctrl-C, and take the keywords

threads: the largest number of threads to use, 1 to 1024; 0: all cores. Answers do not depend on it.
progress: called on this thread now and then with the part that is done, 0 to 1.

Arguments that a call cannot use raise a TypeError (not an array of numbers, floats as indices) or a ValueError (shapes,
indices out of range, NaN, settings out of range) that says what was found and what was expected.
"""
from __future__ import annotations

import math
import os
import threading
from typing import Any, Callable, Dict, List, Optional, Sequence, Tuple, Union

import numpy as np

from . import _core
from ._arrays import _indices, _numbers, _of_each, _positions, _rows, _vector

__version__: str = _core.version
__all__ = ["AreaLight", "DirectionalLight", "Geometry", "PointLight", "Scene", "Tracer", "ambient_occlusion",
           "hard_mask", "no_triangle", "soft_visibility", "sun"]

no_triangle: int = _core.no_triangle
"""Stands for no triangle: for a point in the air, or a pixel that sees the background."""

Progress = Optional[Callable[[float], Any]]


class Geometry:
    """Triangles that are kept, with their trees, for many calls.

    positions: (v, 3) float64 or float32, metres, finite. triangles: (n, 3) uint32, three vertices each,
    counter-clockwise seen from the front. casts_shadow: (n,) bool, or None: all cast. Any number of threads may ask about one
    geometry at once, each with a Tracer of its own.
    """

    def __init__(self, positions: Any, triangles: Any, casts_shadow: Any = None) -> None:
        corners = _positions("positions", positions)
        ids = _indices("triangles", triangles)
        if corners.ndim != 2:
            raise ValueError(f"positions: found the shape {corners.shape}, expected (v, 3)")
        if ids.ndim != 2 or ids.shape[1] != 3:
            raise ValueError(f"triangles: found the shape {ids.shape}, expected (n, 3)")
        casts = None
        if casts_shadow is not None:
            casts = np.ascontiguousarray(_of_each("casts_shadow", np.asarray(casts_shadow), (len(ids),)) != 0,
                                         dtype=np.uint8)
        self._core = _core.Geometry(corners, ids, casts)
        self._vertices = len(corners)

    @classmethod
    def from_corners(cls, corners: Any) -> Geometry:
        """Makes a geometry from the corners of its triangles, (n, 3, 3) float64 or float32."""
        array = _positions("triangles", corners, "(n, 3, 3)")
        if array.ndim != 3 or array.shape[1] != 3:
            raise ValueError(f"triangles: found the shape {array.shape}, expected (n, 3, 3)")
        return cls(array.reshape(-1, 3), np.arange(3 * len(array), dtype=np.uint32).reshape(-1, 3))

    def move_vertices(self, positions: Any) -> None:
        """Gives the triangles other positions, (v, 3), as many as before. Call it while no other thread uses the
        geometry."""
        array = _positions("positions", positions)
        self._core.move_vertices(_of_each("positions", array, (self._vertices, 3)))

    @property
    def origin(self) -> Tuple[float, float, float]:
        """What was subtracted from float64 positions; zeros where float32 holds them as they are."""
        return self._core.origin


Triangles = Union[Geometry, np.ndarray, Tuple[Any, Any]]


def _geometry(triangles: Any) -> Geometry:
    if isinstance(triangles, Geometry):
        return triangles
    if isinstance(triangles, tuple) and len(triangles) == 2:
        return Geometry(*triangles)
    if hasattr(triangles, "vertices") and hasattr(triangles, "faces"):
        return Geometry(triangles.vertices, triangles.faces)
    return Geometry.from_corners(triangles)


# ---- Lights ----

class PointLight:
    """Light from `position` (3 numbers, metres). `spot_axis`, the direction in which a spot shines, limits it to within
    `cone_rad` of that axis (half the opening angle, radians); `range_m` limits its distance."""

    def __init__(self, position: Any, *, spot_axis: Any = None, cone_rad: float = math.pi / 4,
                 range_m: float = 0.0) -> None:
        axis, cos_outer = [0.0, -1.0, 0.0], -1.0
        if spot_axis is not None:
            given = np.asarray(_vector("spot_axis", spot_axis), np.float64)
            if not given.any():
                raise ValueError("spot_axis: found 0, 0, 0, expected a direction")
            if not 0 < cone_rad <= math.pi:
                raise ValueError(f"cone_rad: found {cone_rad}, expected radians, more than 0 and at most pi")
            axis, cos_outer = (given / np.linalg.norm(given)).tolist(), math.cos(cone_rad)
        self._core = _core.ShadowLight(False, _vector("position", position), axis, cos_outer, range_m)


class DirectionalLight:
    """Light from the direction `to_light` (3 numbers, towards the light, any length but zero)."""

    def __init__(self, to_light: Any) -> None:
        self._core = _core.ShadowLight(True, _vector("to_light", to_light), [0.0, -1.0, 0.0], -1.0, 0.0)


class AreaLight:
    """A planar convex polygon that shines to one side; or a sun.

    vertices: (3 to 14, 3), metres, counter-clockwise seen from the lit side.
    """

    def __init__(self, vertices: Any) -> None:
        array = _rows("vertices", vertices, np.float64)
        if array.ndim != 2:
            raise ValueError(f"vertices: found the shape {array.shape}, expected (n, 3)")
        self._core = _core.AreaLight(array)

    @classmethod
    def rectangle(cls, centre: Any, half_x: Any, half_y: Any) -> AreaLight:
        """The corners are centre +- half_x +- half_y; it shines along cross(half_x, half_y)."""
        c, x, y = (np.array(_vector(*v), np.float64) for v in
                   (("centre", centre), ("half_x", half_x), ("half_y", half_y)))
        return cls(np.array([c - x - y, c + x - y, c + x + y, c - x + y]))

    @classmethod
    def disc(cls, centre: Any, half_x: Any, half_y: Any) -> AreaLight:
        """A disc with these half axes, as the regular polygon of 12 sides and the same area."""
        light = cls.__new__(cls)
        light._core = _core.AreaLight.disc(_vector("centre", centre), _vector("half_x", half_x),
                                           _vector("half_y", half_y))
        return light

    @classmethod
    def sun(cls, to_sun: Any, diameter_deg: float = 0.533) -> AreaLight:
        """A sun in the direction `to_sun` (any length but zero), 1e-6 to 90 degrees wide: a disc infinitely far away,
        as the regular polygon of 12 sides. It has no vertices."""
        light = cls.__new__(cls)
        light._core = _core.AreaLight.sun(_vector("to_sun", to_sun), float(diameter_deg))
        return light

    @property
    def vertices(self) -> np.ndarray:
        """The corners, (n, 3) float64, metres."""
        return self._core.vertices

    @property
    def area_m2(self) -> float:
        """Of a sun: the irradiance at radiance 1 on a surface that faces it."""
        return self._core.area_m2


Light = Union[PointLight, DirectionalLight, Sequence[float], np.ndarray]


def _shadow_light(light: Any) -> Any:
    if isinstance(light, AreaLight):
        raise TypeError("light: found an AreaLight, expected a PointLight, a DirectionalLight or a position; "
                        "soft_visibility takes lights with an area")
    return light._core if isinstance(light, (PointLight, DirectionalLight)) else PointLight(light)._core


# ---- Points ----

class Tracer:
    """Answers questions about points, and keeps its buffers and trees from call to call. Use one for many calls
    with a Geometry; threads that share a tracer wait for each other. The functions of this module make one for each
    call.

    points: (..., 3) float64, metres; every answer has the shape (...). Points of a picture (rows, columns, 3)
    whose neighbours lie close together are answered more quickly.
    on: (...) uint32, the triangle that each point lies on, which never blocks it, or no_triangle.
    normals: (..., 3) float32, any length; zero: none. For a point that lies on no triangle, the normal says which
    half of space it sees.
    sides: (...) int8, 1 where the point is on the side from which its triangle is counter-clockwise, -1 behind, 0 not
    given: then the side of its normal or, without one, that of the light.
    """

    def __init__(self) -> None:
        self._core = _core.PointTracer()
        self._one_call = threading.Lock()

    def hard_mask(self, triangles: Triangles, points: Any, light: Light, *, on: Any = None, normals: Any = None,
                  sides: Any = None, threads: int = 0, progress: Progress = None) -> np.ndarray:
        """255 where a point sees the light, 0 where it does not: uint8, exact."""
        arrays, shape = _point_arrays(points, on, normals, sides)
        mask = np.empty(shape, np.uint8)
        asked, source = _geometry(triangles)._core, _shadow_light(light)
        with self._one_call:
            self._core.hard_mask(asked, arrays, source, mask, _count(threads), progress)
        return mask

    def soft_visibility(self, triangles: Triangles, points: Any, light: AreaLight, *, on: Any = None,
                        normals: Any = None, sides: Any = None, error: float = 0.0,
                        memory_mb: Optional[int] = None, threads: int = 0,
                        progress: Progress = None) -> Tuple[np.ndarray, np.ndarray]:
        """The visible part of an area light, 0 to 1, and the irradiance that it sends onto the normal (else the
        triangle's; with neither, onto a surface parallel to the light), W/m2 for a radiance of 1: two arrays of
        float32.

        error: 0: exact; else the error allowed in dense penumbrae, RMS, in 1/255 of white.
        memory_mb: bounds the candidates and lists of them (MB of 2**20 bytes), all threads together; a call that needs
        more raises a ValueError. Answers do not depend on it. None: what the system has.
        """
        if not isinstance(light, AreaLight):
            raise TypeError(f"light: found {type(light).__name__}, expected an AreaLight")
        if memory_mb is not None and memory_mb < 1:
            raise ValueError(f"memory_mb: found {memory_mb}, expected 1 or more, or None")
        arrays, shape = _point_arrays(points, on, normals, sides)
        memory_bytes = None if memory_mb is None else memory_mb << 20
        fraction, irradiance = np.empty(shape, np.float32), np.empty(shape, np.float32)
        asked = _geometry(triangles)._core
        with self._one_call:
            self._core.soft_visibility(asked, arrays, light._core, error, memory_bytes, fraction, irradiance,
                                       _count(threads), progress)
        return fraction, irradiance

    def ambient_occlusion(self, triangles: Triangles, points: Any, *, on: Any = None, normals: Any = None,
                          sides: Any = None, distance: float = 0.0, error: float = 2.5, threads: int = 0,
                          progress: Progress = None) -> np.ndarray:
        """The share of ambient light that reaches each point, 1 open to 0 closed: float32. Each point needs a
        triangle (its front, if no side is given) or a normal.

        distance: metres at which occlusion has fallen off to nothing; 0: a twentieth of the geometry's diagonal.
        error: the error allowed over all points together, RMS, in 1/255; 0.1 to 255.
        """
        arrays, shape = _point_arrays(points, on, normals, sides)
        openness = np.empty(shape, np.float32)
        asked = _geometry(triangles)._core
        with self._one_call:
            self._core.ambient_occlusion(asked, arrays, distance, error, openness, _count(threads), progress)
        return openness


def _count(threads: int) -> int:
    if not 0 <= threads <= 1024:
        raise ValueError(f"threads: found {threads}, expected 1 to 1024, or 0 for all cores")
    return threads


def _point_arrays(points: Any, on: Any, normals: Any, sides: Any) -> Tuple[Any, Tuple[int, ...]]:
    positions = _rows("points", points, np.float64, "(..., 3)")
    shape = positions.shape[:-1]
    if on is not None:
        on = _of_each("on", _indices("on", on), shape)
    if normals is not None:
        normals = _of_each("normals", _rows("normals", normals, np.float32, "(..., 3)"), positions.shape)
    if sides is not None:
        given = _numbers("sides", sides, np.int8 if np.asarray(sides).dtype == np.int8 else np.float64)
        _of_each("sides", given, shape)
        known = np.abs(given) <= 1 if given.dtype == np.int8 else np.isin(given, (-1, 0, 1))
        if not known.all():
            raise ValueError("sides: found other values than 1, -1 and 0")
        sides = np.ascontiguousarray(given, dtype=np.int8)
    width = shape[1] if len(shape) == 2 else 0
    return _core.PointArrays(positions, on, normals, sides, width), shape


def hard_mask(triangles: Triangles, points: Any, light: Light, **options: Any) -> np.ndarray:
    """255 where a point sees the light, 0 where it does not. Tracer.hard_mask describes the keywords."""
    return Tracer().hard_mask(triangles, points, light, **options)


def soft_visibility(triangles: Triangles, points: Any, light: AreaLight,
                    **options: Any) -> Tuple[np.ndarray, np.ndarray]:
    """The visible part of an area light, and its irradiance. Tracer.soft_visibility describes the keywords."""
    return Tracer().soft_visibility(triangles, points, light, **options)


def ambient_occlusion(triangles: Triangles, points: Any, **options: Any) -> np.ndarray:
    """How open points are, 1 to 0. Tracer.ambient_occlusion describes the keywords."""
    return Tracer().ambient_occlusion(triangles, points, **options)


# ---- Scenes ----

_OF_THE_SCENE = frozenset(_core.names_of_scene())
_OF_A_PICTURE = frozenset(_core.names_of_render())


def _text(name: str, value: Any) -> str:
    """One value of a setting as its text."""
    if isinstance(value, (str, os.PathLike)):
        return os.fspath(value)
    if isinstance(value, (bool, np.bool_)):
        return "true" if value else "false"
    if name in ("size", "light_size") and not np.isscalar(value):
        return "x".join(str(side) for side in value)
    if np.isscalar(value):
        return repr(value.item() if isinstance(value, np.generic) else value)
    return ",".join(repr(float(number)) for number in value)


def _keywords(options: Dict[str, Any]) -> List[Tuple[str, str]]:
    """Names and values of settings; a list of texts is a setting that is given several times."""
    keywords = []
    for name, value in options.items():
        if value is None:
            continue
        if name == "aov" and not isinstance(value, str):
            value = ",".join(value)
        several = isinstance(value, list) and value and all(isinstance(each, (str, os.PathLike)) for each in value)
        keywords += [(name, _text(name, each)) for each in (value if several else [value])]
    return keywords


def _check_names(call: str, options: Dict[str, Any], known: frozenset) -> None:
    for name in options:
        if name not in known:
            names = sorted(known)
            nearest = _core.did_you_mean(name, names)
            raise TypeError(f"{call}: found {name}{nearest}, expected one of {', '.join(names)}")


class Scene:
    """A scene file (glTF, OBJ, BART's AFF) with its animation, ready to be drawn; made by Scene.load."""

    def __init__(self, path: Union[str, os.PathLike], **options: Any) -> None:
        _check_names("Scene.load", options, _OF_THE_SCENE)
        self._core = _core.Scene(os.fspath(path), _keywords(options))
        self._one_call = threading.Lock()

    @classmethod
    def load(cls, path: Union[str, os.PathLike], **options: Any) -> Scene:
        """Reads a file, and adds a camera and light where it has none. options: those of `tenebra render` that
        concern the scene, with _ for -: no_cast, transfer, environment, clip, fps, set_light and the like. Places and
        ways that go in and come out have the axes and units of the file."""
        return cls(path, **options)

    @property
    def name(self) -> str:
        """The file's name without its folder."""
        return self._core.name

    @property
    def up_axis(self) -> str:
        """The file's axis that points up, "y" or "z"."""
        return self._core.up_axis

    @property
    def frames(self) -> int:
        """How many frames the animation has; 1 without an animation."""
        return self._core.frames

    @property
    def size(self) -> Tuple[int, int]:
        """Width and height in pixels of pictures for which no size is given."""
        return self._core.size

    @property
    def warnings(self) -> List[str]:
        """What was skipped, guessed or added when the file was read, one sentence each."""
        return self._core.warnings

    def render(self, frame: int = 0, size: Optional[Tuple[int, int]] = None, *, time: Optional[float] = None,
               points: bool = False, linear: bool = False, progress: Progress = None,
               **options: Any) -> Dict[str, Any]:
        """Draws one frame, or the instant `time` (seconds), as `tenebra render` with a --mask does.

        size: width and height in pixels. options: those of `tenebra render` that concern the camera and the
        method, with _ for -: shadows="soft", ao="adaptive", soft_error=1, eye=(x, y, z), look_at=..., threads=2,
        keys of other options by names of their own (light_facing, sun_size, soft_memory, variant),
        and aov=("depth", "normal", ...), which adds arrays to the dict.

        Returns a dict of arrays with h rows of w pixels, row 0 at the top:
        image: (h, w, 3) uint8, as the program writes it.
        linear: with linear=True, (h, w, 3) float32, the colours of the pixels' centres before exposure and tone.
        masks: by the light's number, (h, w) uint8, 255 lit to 0.
        visible_fraction: the same as (h, w) float32, with soft shadows.
        triangles: (h, w) uint32, the triangle that each pixel sees, or no_triangle.
        positions, normals: with points=True, (h, w, 3) float64, the point that each pixel sees, in the units of the
        file, and (h, w, 3) float32, the unit normal with which it is shaded; both meaningless on the background.
        view: the camera's eye and rays (eye, d0, dx, dy, orthographic: the ray through pixel (x, y) runs along
        d0 + (x + 0.5) dx + (y + 0.5) dy), in the units of the file.
        timings: milliseconds of each stage, with the names of the program's log.
        notes: sentences that a user should see once.

        The words of aov add arrays for the opaque surface at each pixel's centre:
        depth: (h, w) float32, metres along the view axis, infinite on the background.
        id: triangles as above, with part and material, (h, w) uint32 (the mesh at its node, the material's number).
        normal: (h, w, 3) float32, unit, on the eye's side, in the axes of the file.
        visibility: by the light's number, (h, w) float32, 0 to 1, with any shadows.
        irradiance: (h, w, 3) float32, from all lights, lux.
        ao: (h, w) float32, 1 open to 0 closed.
        albedo: (h, w, 3) float32.
        """
        for name in options:
            if name in _OF_THE_SCENE:
                raise TypeError(f"render: found {name}, which belongs to Scene.load")
        _check_names("render", options, _OF_A_PICTURE)
        if size is not None:
            options["size"] = size
        with self._one_call:
            return self._core.render(frame, time, _keywords(options), points, linear, progress)

    def geometry(self, frame: int = 0, *, time: Optional[float] = None) -> Dict[str, np.ndarray]:
        """The triangles of an instant: positions (v, 3) float32, or float64 where coordinates
        are far from the origin, turned or scaled; normals (v, 3) float32 (zero: the face's),
        triangles (n, 3) uint32, materials (n,) uint32, casts_shadow (n,) uint8. Every frame has the same
        triangles. Geometry takes the positions, triangles and casts_shadow among them."""
        return self._core.geometry(self._core.time_of(frame) if time is None else time)

    def lights(self, frame: int = 0, *, time: Optional[float] = None) -> List[Dict[str, Any]]:
        """The lights of an instant, by their numbers: type (point, spot, directional, rectangle or disc), name,
        position, direction (the way it shines), half_x and half_y (of rectangles and discs), in the units of the file,
        color, intensity, range_m (metres; 0: unbounded), outer_cone_rad."""
        return self._core.lights(self._core.time_of(frame) if time is None else time)

    def sun_hours(self, suns: Any, weights: Any = None, **options: Any) -> Dict[str, np.ndarray]:
        """What faces or the ground see of many suns: tenebra.sun.scene_sun_hours describes the keywords."""
        return sun.scene_sun_hours(self, suns, weights, **options)


from . import sun  # noqa: E402  it needs what stands above
