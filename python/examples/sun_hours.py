#!/usr/bin/env python3
"""Hours of sun on the ground around some houses, and on the facade of one of them, on a day of your choice.

usage: sun_hours.py [--out FILE.png] [--day YYYY-MM-DD] [--place LAT LON] [--step MINUTES] [--cell METRES]
"""
import argparse

import matplotlib.pyplot as plt
import numpy as np

import tenebra

# x east, y north, z up, in metres: west, south, east, north and height of each house.
HOUSES = [(5, 5, 17, 15, 9), (23, 4, 45, 14, 6), (6, 24, 16, 40, 12), (24, 24, 46, 35, 15), (51, 8, 59, 38, 9)]
SHOWN = 3  # the house whose south facade is drawn
SIZE = 64.0


def box(west, south, east, north, height):
    """A house as twelve triangles: corners (12, 3, 3)."""
    corners = np.array([[x, y, z] for x in (west, east) for y in (south, north) for z in (0.0, height)])
    faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    return np.array([corners[[face[i] for i in pick]] for face in faces for pick in ((0, 1, 2), (0, 2, 3))])


def middles(low, high, cell):
    """The middles of cells of about this size between two numbers."""
    count = max(1, round((high - low) / cell))
    return low + (np.arange(count) + 0.5) * (high - low) / count


def main():
    arguments = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    arguments.add_argument("--out", default="sun_hours.png")
    arguments.add_argument("--day", default="2026-02-10")
    arguments.add_argument("--place", type=float, nargs=2, default=(48.14, 11.58), help="latitude and longitude")
    arguments.add_argument("--step", type=float, default=10, help="minutes")
    arguments.add_argument("--cell", type=float, default=0.5, help="metres")
    options = arguments.parse_args()

    geometry = tenebra.Geometry.from_corners(np.concatenate([box(*house) for house in HOUSES]))
    suns = tenebra.sun.suns_of(*options.place, options.day, up_axis="z", step=options.step)

    x, y = np.meshgrid(middles(0, SIZE, options.cell), middles(0, SIZE, options.cell))
    ground = np.stack([x, y, np.zeros_like(x)], axis=-1)
    up = np.broadcast_to([0.0, 0, 1], ground.shape)
    plan = tenebra.sun.sun_hours(geometry, ground, up, suns)["sum"]
    for west, south, east, north, _ in HOUSES:
        plan[(x > west) & (x < east) & (y > south) & (y < north)] = np.nan

    west, south, east, _, height = HOUSES[SHOWN]
    u, v = np.meshgrid(middles(west, east, options.cell), middles(0, height, options.cell))
    wall = np.stack([u, np.full_like(u, south), v], axis=-1)
    # Its south side is the third of a box's faces: the fifth triangle and, above the diagonal, the sixth.
    on = 12 * SHOWN + 4 + (v / height > (u - west) / (east - west))
    outward = np.broadcast_to([0.0, -1, 0], wall.shape)
    facade = tenebra.sun.sun_hours(geometry, wall, outward, suns, on=on)["sum"]
    print(f"{options.day}: {suns.hours.sum():.1f} hours of day, {np.nanmean(plan):.1f} hours of sun on the ground "
          f"and {facade.mean():.1f} on the facade in the mean")

    figure, (left, right) = plt.subplots(1, 2, figsize=(10, 4), layout="constrained", width_ratios=(1, 1.2))
    shown = dict(origin="lower", vmin=0, vmax=suns.hours.sum())
    left.imshow(plan, extent=(0, SIZE, 0, SIZE), **shown)
    left.plot([west, east], [south, south], "r", linewidth=2)
    left.set(title=f"hours of sun on the ground, {options.day}", xlabel="m east", ylabel="m north")
    drawn = right.imshow(facade, extent=(west, east, 0, height), **shown)
    right.set(title="on the facade (red in the plan)", xlabel="m east", ylabel="m above the ground")
    figure.colorbar(drawn, ax=right, label="hours", shrink=0.7)
    figure.savefig(options.out, dpi=80)


if __name__ == "__main__":
    main()
