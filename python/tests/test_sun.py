"""Sun hours: where the sun stands, closed forms on a wall, the same numbers as the program's, and what is refused."""
import csv
import datetime
import os
import subprocess
import types

import numpy as np
import pytest

import tenebra

sun = tenebra.sun
PROGRAM = os.environ.get("TENEBRA_PROGRAM")
MUNICH, DAY = (48.14, 11.58), "2026-03-20"  # at the equinox the wall's shadow ends 2.2 m north of it, all day

# A floor of 40 x 40 m with z up, and on it a wall from west to east, 2 m high.
VERTICES = np.array([[-20, -20, 0], [20, -20, 0], [20, 20, 0], [-20, 20, 0],
                     [-20, 0, 0], [20, 0, 0], [20, 0, 2], [-20, 0, 2]], np.float64)
FACES = np.array([[0, 1, 2], [0, 2, 3], [4, 5, 6], [4, 6, 7]])
POINTS = np.array([[0.0, -1, 0], [1, 1, 0], [2, 3, 0]])
ON, UP = [0, 1, 1], [[0.0, 0, 1]] * 3
SUNS = sun.suns_of(*MUNICH, DAY, up_axis="z")


def write_obj(path, shift):
    lines = ["v %r %r %r" % tuple(v) for v in (VERTICES + shift).tolist()]
    path.write_text("\n".join(lines + ["o floor", "f 1 2 3", "f 1 3 4", "o wall", "f 5 6 7", "f 5 7 8"]) + "\n")
    return path


def test_all_kinds_of_times_are_the_same_moment():
    zone = datetime.timezone(datetime.timedelta(hours=2))
    moments = ["2026-06-21T12:00", "2026-06-21 14:00+02:00", "2026-06-21T12:00:00Z",
               np.datetime64("2026-06-21T12", "h"), datetime.datetime(2026, 6, 21, 12),
               datetime.datetime(2026, 6, 21, 14, tzinfo=zone)]
    found = {tuple(map(float, sun.positions(*MUNICH, moment))) for moment in moments}
    assert len(found) == 1
    azimuth, altitude = sun.positions(*MUNICH, np.array(moments[:3]).reshape(3, 1))
    assert azimuth.shape == altitude.shape == (3, 1) and (azimuth == found.pop()[0]).all()
    assert sun.positions(*MUNICH, "2026-06-21").altitude < 0 < altitude[0, 0], "a day is its midnight"
    pandas = pytest.importorskip("pandas")
    times = pandas.DatetimeIndex(["2026-06-21 14:00"]).tz_localize("Europe/Berlin")
    assert sun.positions(*MUNICH, times).azimuth[0] == azimuth[0, 0]


def test_directions():
    noon = "2026-03-20T12:00"
    south, same = (sun.directions(48, 0, noon, up_axis=axis) for axis in "zy")
    azimuth, altitude = np.radians(sun.positions(48, 0, noon))
    expected = (np.cos(altitude) * np.sin(azimuth), np.cos(altitude) * np.cos(azimuth), np.sin(altitude))
    assert south == pytest.approx(expected, abs=1e-12) and south[1] < -0.7
    assert same.tolist() == [south[0], south[2], -south[1]]
    turned = sun.directions(48, 0, [noon], up_axis="z", north=90)
    assert turned.shape == (1, 3) and turned[0] == pytest.approx((south[1], -south[0], south[2]), abs=1e-12)


def test_suns_of_days():
    week = sun.suns_of(*MUNICH, "2026-06-21:2026-06-27:7", up_axis="z", step=60, zone="+02:00")
    assert week.time[0] == np.datetime64("2026-06-24T03:30") and set(week.hours) == {7.0}
    assert (week.direction[:, 2] > 0).all() and np.linalg.norm(week.direction, axis=1) == pytest.approx(1)
    assert len(sun.suns_of(80, 0, datetime.date(2026, 12, 21), up_axis="z").hours) == 0


@pytest.mark.parametrize("day", [
    datetime.date(2026, 3, 20), datetime.datetime(2026, 3, 20, 23), np.datetime64("2026-03-20T23:59"),
    datetime.datetime(2026, 3, 20, 1, tzinfo=datetime.timezone(datetime.timedelta(hours=2))),
    datetime.datetime(2026, 3, 20, 23, tzinfo=datetime.timezone(datetime.timedelta(hours=-8)))])
def test_a_day_is_that_of_its_own_zone(day):
    assert (sun.suns_of(*MUNICH, day, up_axis="z").time == SUNS.time).all()


def test_panes_dim_as_in_the_program(tmp_path):
    (tmp_path / "pane.mtl").write_text("newmtl solid\nKd 1 1 1\nnewmtl pane\nKd 0.25 0.25 0.25\nd 0.5\n")
    (tmp_path / "pane.obj").write_text(
        "mtllib pane.mtl\no floor\nusemtl solid\nv -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nf 1 2 3 4\n"
        "o pane\nusemtl pane\nv -99 -99 1\nv 99 -99 1\nv 99 99 1\nv -99 99 1\nf 5 6 7 8\n")
    found = tenebra.Scene.load(tmp_path / "pane.obj", up_axis="z").sun_hours(SUNS, node="floor")["sum"]
    assert (found > 0.1 * SUNS.hours.sum()).all() and (found < 0.9 * SUNS.hours.sum()).all()
    if PROGRAM is None:
        pytest.skip("TENEBRA_PROGRAM is not set")
    subprocess.run([PROGRAM, "sun", tmp_path / "pane.obj", "--up-axis", "z", "--place", "%g,%g" % MUNICH, "--day", DAY,
                    "--node", "floor", "--csv", tmp_path / "hours.csv", "--quiet"], check=True)
    with open(tmp_path / "hours.csv", newline="") as table:
        assert [float(row["hours"]) for row in csv.DictReader(table)] == pytest.approx(found, rel=1e-8)


@pytest.mark.parametrize("shift", [np.zeros(3), np.array([690000.0, 5330000, 500])])
def test_a_wall(shift):
    mesh = types.SimpleNamespace(vertices=VERTICES + shift, faces=FACES)
    hours = sun.sun_hours(mesh, POINTS + shift, UP, SUNS, on=ON)
    assert hours["sum"][0] == pytest.approx(12, abs=0.2) and hours["sum"][0] == pytest.approx(SUNS.hours.sum(), abs=0.2)
    assert hours["sum"][1] < 1 and hours["sum"][2] > 9
    seen = sun.masks(mesh, POINTS + shift, UP, SUNS, on=ON)
    assert seen.shape == (len(SUNS.hours), 3) and seen.dtype == bool
    assert hours["sum"] == pytest.approx(SUNS.hours @ seen)
    assert hours["first"].tolist() == seen.argmax(axis=0).tolist()
    assert hours["last"].tolist() == (len(seen) - 1 - seen[::-1].argmax(axis=0)).tolist()
    # From the point behind the wall, 1 m north of it: to the south, below its top and between its ends.
    east, south, up = SUNS.direction[:, 0], -SUNS.direction[:, 1], SUNS.direction[:, 2]
    wall = (south > 0) & (up < 2 * south) & (np.abs(east + south) < 20 * south)
    assert (seen[:, 1] == ~wall).all()
    if shift.any():
        assert (sun.masks((VERTICES, FACES), POINTS, UP, SUNS, on=ON) == seen).all(), "map coordinates change nothing"


def test_weights_discs_and_shapes():
    suns = [[0, 0, 2], [0, -1, 0.1]]
    ask = lambda points, **options: sun.sun_hours((VERTICES, FACES), points, None, suns, **options)
    assert ask([[0, 1, 1]])["sum"].tolist() == [1]
    grid = ask(POINTS[:, None] + [0, 0, 1], weights=[3, 4])
    assert grid["sum"].tolist() == [[7], [3], [7 if 3 * 0.1 > 1 else 3]] and grid["first"].shape == (3, 1)
    assert ask(np.zeros((0, 3)))["sum"].shape == (0,)
    half = sun.sun_hours((VERTICES, FACES), [[0, 2, 0]], [[0, 0, 1]], [[0, -1, 1]], disc=0.53)
    assert half["sum"] == pytest.approx([0.5], abs=1e-3)


def test_scenes_are_counted_as_the_program_counts(tmp_path):
    file = write_obj(tmp_path / "wall.obj", np.array([690000.0, 5330000, 500]))
    scene = tenebra.Scene.load(file, up_axis="z")
    assert scene.up_axis == "z"
    faces = scene.sun_hours(SUNS)
    assert faces["face"].tolist() == [0, 1, 2, 3] and faces["node"].tolist()[1:3] == ["floor", "wall"]
    floor = scene.sun_hours(SUNS, node="floor")
    assert (floor["sum"] == faces["sum"][:2]).all()
    ground = scene.sun_hours(SUNS, ground=501, cell=10)
    assert ground["sum"].reshape(ground["row"].max() + 1, -1).shape == (4, 4)
    assert (ground["x"][0], ground["y"][0], ground["z"][0]) == (689985, 5330015, 501)
    if PROGRAM is None:
        pytest.skip("TENEBRA_PROGRAM is not set")
    for options, found in (([], faces), (["--ground", "501", "--cell", "10"], ground)):
        subprocess.run([PROGRAM, "sun", file, "--up-axis", "z", "--place", "%g,%g" % MUNICH, "--day", DAY, "--csv",
                        tmp_path / "hours.csv", "--quiet", *options], check=True)
        with open(tmp_path / "hours.csv", newline="") as table:
            rows = list(csv.DictReader(table))
        assert [float(row["hours"]) for row in rows] == pytest.approx(found["sum"], rel=1e-8)
        first = [np.datetime64(row["first_sun"].rstrip("Z")) for row in rows]
        assert first == SUNS.time[found["first"]].tolist()
        assert [float(row["y"]) for row in rows] == pytest.approx(found["y"], abs=1e-6)


@pytest.mark.parametrize("call, kind, sentence", [
    (lambda: sun.positions(100, 0, DAY), ValueError, "latitude: found 100, expected -90 to 90 degrees"),
    (lambda: sun.positions(float("nan"), 0, DAY), ValueError, "latitude: found nan"),
    (lambda: sun.positions(0, 0, "noon"), ValueError, "times: found 'noon', expected one like 2026-06-21T12:00"),
    (lambda: sun.positions(0, 0, [1.5]), TypeError, "times: found an array of float64"),
    (lambda: sun.positions(0, 0, np.datetime64("NaT")), ValueError, "times: found NaT, expected 1900 to 2100"),
    (lambda: sun.positions(0, 0, "2222-01-01"), ValueError, "times: found 2222-01-01T.*, expected 1900"),
    (lambda: sun.directions(0, 0, DAY, up_axis="x"), ValueError, "up_axis: found 'x', expected 'z'"),
    (lambda: sun.suns_of(0, 0, "2026-02-30", up_axis="z"), ValueError, "days: found 2026-02-30, which is no day"),
    (lambda: sun.suns_of(0, 0, 20260320, up_axis="z"), TypeError, "days: found 20260320, expected a text"),
    (lambda: sun.suns_of(0, 0, DAY, up_axis="z", zone="CET"), ValueError, "zone: found CET, expected UTC"),
    (lambda: sun.suns_of(0, 0, DAY, up_axis="z", step=0), ValueError, "step: found 0, expected 0.1 to 240"),
    (lambda: sun.sun_hours((VERTICES, FACES), POINTS, UP, [[0, 0, 0]]), ValueError, "expected a direction"),
    (lambda: sun.sun_hours((VERTICES, FACES), POINTS, UP, [0, 0, 1]), ValueError, r"expected \(s, 3\)"),
    (lambda: sun.sun_hours((VERTICES, FACES), POINTS, UP, SUNS, [1]), ValueError, r"weights: found the shape \(1,\)"),
    (lambda: sun.sun_hours((VERTICES, FACES), POINTS, UP, [[0, 0, 1]], [-1]), ValueError, "weights: found a negative"),
    (lambda: sun.sun_hours((VERTICES, FACES), POINTS, UP, SUNS, on=[0, 1, 9]), ValueError, "triangle 9"),
    (lambda: sun.sun_hours((VERTICES, FACES), POINTS, UP, SUNS, disc=91), ValueError, "disc: found 91"),
])
def test_what_is_refused(call, kind, sentence):
    with pytest.raises(kind, match=sentence):
        call()


def test_a_scene_refuses_names_that_it_does_not_have(tmp_path):
    scene = tenebra.Scene.load(write_obj(tmp_path / "wall.obj", np.zeros(3)), up_axis="z")
    with pytest.raises(ValueError, match="no node called roof"):
        scene.sun_hours(SUNS, node="roof")
    with pytest.raises(ValueError, match="cell: found 0"):
        scene.sun_hours(SUNS, ground=0, cell=0)


def test_progress_may_end_a_call():
    class Enough(Exception):
        pass

    def stop(done):
        raise Enough

    points = np.random.default_rng(3).uniform(-4, 4, (1 << 19, 3))
    with pytest.raises(Enough):
        sun.sun_hours((VERTICES, FACES), points, None, SUNS, progress=stop)
