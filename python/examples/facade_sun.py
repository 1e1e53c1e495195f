#!/usr/bin/env python3
"""Hours of sun on a facade over a day, the sun as a disc: how much of it each place of the wall sees, every few
minutes, summed. The house across the street and a row of balconies stand in the way.

usage: facade_sun.py [--out FILE.png] [--step MINUTES] [--day DAY_OF_YEAR] [--latitude DEGREES]
"""
import argparse

import matplotlib.pyplot as plt
import numpy as np

import tenebra

WIDTH, HEIGHT, STREET = 30.0, 15.0, 14.0  # metres: the facade faces south (+z), the other house stands beyond the street


def box(low, high):
    """The twelve triangles of a box, (12, 3, 3)."""
    corners = np.array([[x, y, z] for x in (low[0], high[0]) for y in (low[1], high[1]) for z in (low[2], high[2])])
    faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    return np.array([corners[[face[i] for i in pick]] for face in faces for pick in ((0, 1, 2), (0, 2, 3))])


def street():
    """The house with the facade at z = 0, its balconies, and the house across the street with a gap in it."""
    parts = [box((0, 0, -10), (WIDTH, HEIGHT, 0)),
             box((-20, 0, STREET), (8, 12, STREET + 10)), box((14, 0, STREET), (50, 17, STREET + 10))]
    parts += [box((x, y, 0), (x + 3, y + 0.2, 1.5)) for x in (4, 13, 22) for y in (3.5, 6.5, 9.5, 12.5)]
    return np.concatenate(parts).astype(np.float32)


def towards_sun(hour, day, latitude):
    """The direction to the sun's middle, x east, y up, z south; hours of true solar time. Spencer's declination is
    not needed for a picture: one cosine is within half a degree."""
    declination = np.radians(-23.44) * np.cos(2 * np.pi * (day + 10) / 365)
    angle, phi = np.radians(15 * (hour - 12)), np.radians(latitude)
    east = -np.cos(declination) * np.sin(angle)
    south = np.cos(declination) * np.cos(angle) * np.sin(phi) - np.sin(declination) * np.cos(phi)
    up = np.cos(declination) * np.cos(angle) * np.cos(phi) + np.sin(declination) * np.sin(phi)
    return np.array([east, up, south])


def main():
    arguments = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    arguments.add_argument("--out", default="facade_sun.png")
    arguments.add_argument("--step", type=float, default=10, help="minutes")
    arguments.add_argument("--day", type=int, default=80, help="of the year")
    arguments.add_argument("--latitude", type=float, default=52, help="degrees north")
    arguments.add_argument("--places", type=int, default=150, help="across the facade")
    options = arguments.parse_args()

    rows = int(options.places * HEIGHT / WIDTH)
    x, y = np.meshgrid((np.arange(options.places) + 0.5) * WIDTH / options.places, HEIGHT - (np.arange(rows) + 0.5) *
                       HEIGHT / rows)
    points = np.stack([x, y, np.zeros_like(x)], axis=-1)
    normals = np.broadcast_to(np.float32([0, 0, 1]), points.shape)
    geometry, tracer = tenebra.Geometry.from_corners(street()), tenebra.Tracer()

    hours, lit = np.zeros(x.shape), []
    times = np.arange(0, 24, options.step / 60)
    for hour in times:
        to_sun = towards_sun(hour, options.day, options.latitude)
        share = 0.0
        if to_sun[1] > 0:
            fraction, _ = tracer.soft_visibility(geometry, points, tenebra.AreaLight.sun(to_sun), normals=normals)
            hours += fraction * options.step / 60
            share = fraction.mean()
        lit.append(share)
    print(f"day {options.day} at {options.latitude:g} degrees: {hours.mean():.2f} hours of sun in the mean, "
          f"{hours.min():.2f} to {hours.max():.2f}")

    figure, (wall, day) = plt.subplots(1, 2, figsize=(10, 3.6), layout="constrained", width_ratios=(2, 1))
    drawn = wall.imshow(hours, extent=(0, WIDTH, 0, HEIGHT), cmap="inferno", vmin=0)
    wall.set(title="hours of sun", xlabel="m from the west end", ylabel="m above the ground")
    figure.colorbar(drawn, ax=wall)
    day.plot(times, 100 * np.array(lit))
    day.set(title="sun on the facade", xlabel="true solar time", ylabel="% of its area", xlim=(4, 20), ylim=(0, None))
    figure.savefig(options.out, dpi=80)


if __name__ == "__main__":
    main()
