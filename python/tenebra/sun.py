"""Where the sun stands, and how long it reaches points, faces and the ground. Angles are degrees.

A horizon is flat and open: nothing but the triangles hides the sun. Each sun is asked about exactly, with no bias.
Directions point towards the sun. With up_axis="z" x is east and y north; with up_axis="y" x is east and -z north.
`north` turns true north from there, clockwise seen from above; on maps it is minus the meridian convergence.

Times are datetime64 of numpy, datetimes, a DatetimeIndex of pandas or texts like "2026-06-21T12:00+02:00", from 1900
to 2100. Times without a zone are UTC. `refraction` adds what standard air lifts the sun by.

    suns = tenebra.sun.suns_of(48.14, 11.58, "2026-06-21", up_axis="z")
    hours = tenebra.sun.sun_hours((vertices, faces), points, normals, suns)["sum"]
"""
from __future__ import annotations

import datetime
from typing import Any, Callable, Dict, List, NamedTuple, Optional, Tuple, Union

import numpy as np

import tenebra

from . import _core
from ._arrays import _numbers, _of_each, _rows

__all__ = ["Positions", "Suns", "directions", "masks", "positions", "scene_sun_hours", "sun_hours", "suns_of"]

Progress = Optional[Callable[[float], Any]]
_FIRST, _END = np.datetime64("1900-01-01"), np.datetime64("2101-01-01")


class Positions(NamedTuple):
    """Where the sun stands: two arrays of the times' shape, float64, degrees."""

    azimuth: np.ndarray
    """Clockwise from true north, 0 to 360."""
    altitude: np.ndarray
    """Of the disc's centre above the horizon; negative at night."""


class Suns(NamedTuple):
    """Suns above the horizon, as suns_of finds them: what scene.sun_hours and sun_hours take."""

    time: np.ndarray
    """(s,) datetime64[ms], UTC."""
    direction: np.ndarray
    """(s, 3) float64, unit, towards the sun."""
    hours: np.ndarray
    """(s,) float64, how long each stands for: its weight."""


def positions(latitude: float, longitude: float, times: Any, *, refraction: bool = False) -> Positions:
    """Where the sun stands at times of any shape, (...): azimuth and altitude, (...), within 0.003 degrees of NREL's
    SPA from 1950 to 2100. Latitudes are north positive, longitudes east positive."""
    _within("latitude", latitude, -90, 90, "degrees; latitude comes first")
    _within("longitude", longitude, -180, 180, "degrees, east positive")
    seconds = _utc_seconds(times)
    azimuth, altitude = _core.sun_positions(latitude, longitude, np.ravel(seconds), bool(refraction))
    return Positions(azimuth.reshape(seconds.shape), altitude.reshape(seconds.shape))


def directions(latitude: float, longitude: float, times: Any, *, up_axis: str, north: float = 0.0,
               refraction: bool = False) -> np.ndarray:
    """Unit vectors towards the sun at times of any shape, (...): (..., 3) float64. At night they point below the
    horizon: leave those out where the triangles have no ground."""
    at = positions(latitude, longitude, times, refraction=refraction)
    _within("north", north, -360, 360, "degrees")
    out = _core.sun_directions(np.ravel(at.azimuth), np.ravel(at.altitude), north, _is_z(up_axis))
    return out.reshape(at.azimuth.shape + (3,))


def suns_of(latitude: float, longitude: float, days: Union[str, datetime.date, np.datetime64], *, up_axis: str,
            step: float = 10.0, zone: str = "UTC", north: float = 0.0, refraction: bool = False) -> Suns:
    """The suns of a day ("2026-06-21", a date, or a datetime, whose date its own zone says), or of days
    ("2026-03-01:2026-09-30:7": of each seven the middle one stands for all), one every `step` minutes, in the middle
    of its step, without those below the horizon. Days begin at midnight of `zone` ("+02:00": hours and minutes ahead
    of UTC)."""
    _within("latitude", latitude, -90, 90, "degrees; latitude comes first")
    _within("longitude", longitude, -180, 180, "degrees, east positive")
    _within("step", step, 0.1, 240, "minutes")
    seconds, hours = _core.suns_of(latitude, longitude, _days_text(days), step, zone, bool(refraction))
    times = np.rint(1000 * seconds).astype("datetime64[ms]")
    to_suns = directions(latitude, longitude, times, up_axis=up_axis, north=north, refraction=refraction)
    return Suns(times, to_suns, hours)


def sun_hours(triangles: tenebra.Triangles, points: Any, normals: Any, suns: Union[Suns, Any], weights: Any = None,
              on: Any = None, *, sides: Any = None, disc: float = 0.0, threads: int = 0,
              progress: Progress = None) -> Dict[str, np.ndarray]:
    """What points see of many suns. Triangles, points (..., 3), normals (..., 3) or None, on, sides, threads and
    progress are those of tenebra.Tracer; say with `on` which triangle each point lies on.

    suns: (s, 3) directions in the triangles' axes, any length but zero, or Suns. Those below the horizon count too.
    weights: (s,), 0 or more, what each sun counts; None: the hours of Suns, else 1.
    disc: the sun's diameter, 0 to 90 degrees; 0: a point. Of a disc (0.53 from Earth) the visible share counts.

    Returns a dict of arrays (...), which pandas.DataFrame takes where points are (n, 3):
    sum: float64, of the weights of the suns that the point sees.
    first, last: int32, the first and last sun of the list that it sees, -1 for none.
    """
    to_suns, weight = _sun_arrays(suns, weights)
    arrays, shape = tenebra._point_arrays(points, on, normals, sides)
    _within("disc", disc, 0, 90, "degrees")
    out = _core.sun_hours(tenebra._geometry(triangles)._core, arrays, to_suns, weight, disc, tenebra._count(threads),
                          progress)
    return {name: values.reshape(shape) for name, values in out.items()}


def masks(triangles: tenebra.Triangles, points: Any, normals: Any, suns: Union[Suns, Any], on: Any = None, *,
          sides: Any = None, threads: int = 0, progress: Progress = None) -> np.ndarray:
    """Whether each point sees each sun, as sun_hours asks: (s, ...) bool. Takes two bytes for each of
    them while it runs, then one."""
    to_suns, _ = _sun_arrays(suns, None)
    arrays, shape = tenebra._point_arrays(points, on, normals, sides)
    mask = np.empty((len(to_suns),) + shape, np.uint8)
    _core.sun_masks(tenebra._geometry(triangles)._core, arrays, to_suns, mask, tenebra._count(threads), progress)
    return mask != 0


def scene_sun_hours(scene: tenebra.Scene, suns: Union[Suns, Any], weights: Any = None, *,
                    node: Union[str, List[str], None] = None, material: Union[str, List[str], None] = None,
                    upward: bool = False, both_sides: bool = False, per_face: int = 16, per_m2: float = 0.0,
                    ground: Optional[float] = None, cell: float = 1.0, disc: float = 0.0, frame: int = 0,
                    time: Optional[float] = None, threads: int = 0, progress: Progress = None) -> Dict[str, np.ndarray]:
    """What the faces of a scene see of many suns, or cells of the ground, as `tenebra sun` counts: a row each, in a
    dict of arrays (n,) that pandas.DataFrame takes. Directions and places are in the axes and units of the file
    (suns_of(..., up_axis=scene.up_axis)); suns, weights and disc are those of sun_hours.

    Of faces, all or those of a node (with all below it), of a material, or upward ones (at most 60 degrees steep):
    the mean over per_face points, 1 to 65536, or per_m2, on the front or, with both_sides, where the sun is.
    face: uint32, number of the triangle. node, material: names. x, y, z: of its middle. area_m2.
    Of the ground, with its height `ground` in the file's unit: cells with sides of `cell` metres, rows from north to
    south. row, column: uint32. x, y, z, area_m2.
    sum, first, last: as sun_hours returns, but see-through surfaces dim, in the colours of the file:
    those of set_material change nothing here.
    """
    to_suns, weight = _sun_arrays(suns, weights)
    _within("disc", disc, 0, 90, "degrees")
    _within("per_face", per_face, 1, 65536, "points")
    _within("per_m2", per_m2, 0, 1e9, "points, 0 for those of per_face")
    _within("cell", cell, 1e-3, 1e6, "metres")
    if ground is not None:
        _within("ground", ground, -1e9, 1e9, "a height")
    core = scene._core
    with scene._one_call:
        out = _core.scene_sun_hours(core, core.time_of(frame) if time is None else time, to_suns, weight, _names(node),
                                    _names(material), upward, both_sides, int(per_face), float(per_m2), ground, cell,
                                    disc, tenebra._count(threads), progress)
    if "face" in out:
        out["node"] = np.array(_core.node_names(core))[out["node"]]
        out["material"] = np.array(_core.material_names(core))[out["material"]]
    return out


def _within(name: str, value: float, low: float, high: float, what: str) -> None:
    if not low <= value <= high:
        raise ValueError(f"{name}: found {value}, expected {low:g} to {high:g} {what}")


def _is_z(up_axis: str) -> bool:
    if up_axis not in ("y", "z"):
        raise ValueError(f"up_axis: found {up_axis!r}, expected 'z' (maps, most CAD) or 'y'")
    return up_axis == "z"


def _days_text(days: Any) -> str:
    if isinstance(days, str):
        return days
    if isinstance(days, datetime.datetime):
        days = days.date()  # as its own zone has it: numpy would turn it into UTC
    if not isinstance(days, (datetime.date, np.datetime64)):
        raise TypeError(f"days: found {days!r}, expected a text like 2026-06-21, a date, a datetime or a datetime64")
    return str(np.datetime64(days, "D"))


def _names(given: Union[str, List[str], None]) -> List[str]:
    return [] if given is None else [given] if isinstance(given, str) else list(given)


def _sun_arrays(suns: Any, weights: Any) -> Tuple[np.ndarray, np.ndarray]:
    if isinstance(suns, Suns):
        weights = suns.hours if weights is None else weights
        suns = suns.direction
    to_suns = _rows("suns", suns, np.float64, "(s, 3)")
    if to_suns.ndim != 2:
        raise ValueError(f"suns: found the shape {to_suns.shape}, expected (s, 3)")
    longest = np.abs(to_suns).max(axis=1, initial=0)
    usable = (longest > 1e-100) & (longest < 1e100)  # lengths neither overflow nor vanish; false for NaN
    if not usable.all():
        raise ValueError(f"suns: found {to_suns[~usable][0].tolist()}, expected a direction")
    weight = np.ones(len(to_suns)) if weights is None else _numbers("weights", weights, np.float64)
    _of_each("weights", weight, (len(to_suns),))
    if not ((weight >= 0) & (weight <= 1e30)).all():
        raise ValueError("weights: found a negative number, one above 1e30 or NaN, expected 0 to 1e30")
    return to_suns, np.ascontiguousarray(weight)


def _utc_seconds(times: Any) -> np.ndarray:
    """Seconds since 1970, UTC, float64, exact to the microsecond."""
    array = np.asarray(times)
    if array.dtype.kind in "OU":
        array = np.array([_utc(each) for each in array.ravel()], "datetime64[us]").reshape(array.shape)
    if array.dtype.kind != "M":
        raise TypeError(f"times: found an array of {array.dtype}, expected datetimes, datetime64 or texts")
    known = (array >= _FIRST) & (array < _END)  # false for NaT
    if not known.all():
        raise ValueError(f"times: found {np.ravel(array)[~np.ravel(known)][0]}, expected 1900 to 2100")
    return (array - np.datetime64(0, "s")) / np.timedelta64(1, "s")


def _utc(time: Any) -> Any:
    """A datetime, one of pandas among them, a date or a text as UTC without a zone."""
    if isinstance(time, str):
        try:
            time = datetime.datetime.fromisoformat(time[:-1] + "+00:00" if time.endswith("Z") else time)
        except ValueError:
            raise ValueError(f"times: found {time!r}, expected one like 2026-06-21T12:00+02:00") from None
    if isinstance(time, datetime.datetime) and time.tzinfo is not None:
        return time.astimezone(datetime.timezone.utc).replace(tzinfo=None)
    return time
