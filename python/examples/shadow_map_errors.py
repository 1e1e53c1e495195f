#!/usr/bin/env python3
"""What a shadow map gets wrong, compared with the exact mask: light where there is shadow (leaks, and shadows that the bias
moves away from what casts them) and shadow where there is light (acne, steps). The map is drawn here as a renderer
would: the scene's depths as its light sees them, compared with a bias.

usage: shadow_map_errors.py [--out FILE.png] [--size PIXELS]
"""
import argparse
import pathlib

import matplotlib.pyplot as plt
import numpy as np

import tenebra

ROOT = pathlib.Path(__file__).resolve().parents[2]
LEAK, ACNE = (230, 60, 40), (40, 110, 230)


def shadow_map(scene, light, target, resolution):
    """Depths along the axis of a square view from the light, and the view: (d0, dx, dy) as Scene.render has them."""
    drawn = scene.render(size=(resolution, resolution), eye=light, look_at=target, up=(1, 0, 0), fov=100,
                         shadows="none", points=True, antialias=1)
    axis = axis_of(drawn["view"], resolution)
    depth = (drawn["positions"] - light) @ axis
    return np.where(drawn["triangles"] == tenebra.no_triangle, np.inf, depth), drawn["view"]


def axis_of(view, resolution):
    """The direction of the view's middle, in units of which its pixels are one deep."""
    middle = np.array(view["d0"]) + resolution / 2 * (np.array(view["dx"]) + np.array(view["dy"]))
    return middle / (middle @ middle)


def look_up(depths, view, light, points, bias):
    """255 where the map says that a point sees the light; NaN where it lies outside of the map."""
    resolution = len(depths)
    d0, dx, dy = (np.array(view[name]) for name in ("d0", "dx", "dy"))
    away = points - light
    depth = away @ axis_of(view, resolution)
    on_plane = away / depth[..., None] - d0
    x, y = on_plane @ dx / (dx @ dx), on_plane @ dy / (dy @ dy)
    inside = (depth > 0) & (x >= 0) & (x < resolution) & (y >= 0) & (y < resolution)
    column, row = (np.where(inside, axis, 0).astype(int) for axis in (x, y))
    return np.where(inside, np.where(depth <= depths[row, column] + bias, 255, 0), np.nan)


def main():
    arguments = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    arguments.add_argument("--out", default="shadow_map_errors.png")
    arguments.add_argument("--size", type=int, default=400, help="pixels of a picture's height")
    options = arguments.parse_args()

    scene = tenebra.Scene.load(ROOT / "scenes" / "city.glb")
    picture = scene.render(0, (options.size * 4 // 3, options.size), points=True)
    number = next(n for n, light in enumerate(scene.lights()) if light["type"] == "point")
    light = np.array(scene.lights()[number]["position"])
    exact = picture["masks"][number].astype(float)
    seen = picture["triangles"] != tenebra.no_triangle
    target = picture["positions"][seen].mean(axis=0)

    figure, places = plt.subplots(1, 3, figsize=(12, 3.6), layout="constrained")
    places[0].imshow(picture["image"])
    places[0].set_title("exact")
    for place, resolution, bias in zip(places[1:], (512, 2048), (0.0, 0.05)):
        depths, view = shadow_map(scene, light, target, resolution)
        found = look_up(depths, view, light, picture["positions"], bias)
        # Surfaces that face away are dark in both: the exact mask knows them, a map leaves them to shading.
        facing = facing_light(scene, picture, light)
        known = seen & facing & np.isfinite(found)
        shown = (picture["image"] // 2 + 90).astype(np.uint8)
        leaks, acne = known & (found > exact), known & (found < exact)
        shown[leaks], shown[acne] = LEAK, ACNE
        place.imshow(shown)
        wrong = 100 * (leaks | acne).sum() / known.sum()
        place.set_title(f"map of {resolution}², bias {bias:g} m: {wrong:.1f} % wrong")
        print(f"map of {resolution}x{resolution}, bias {bias:g} m: {100 * leaks.sum() / known.sum():.2f} % lit in shadow, "
              f"{100 * acne.sum() / known.sum():.2f} % dark in light")
    for place in places:
        place.set_axis_off()
    figure.savefig(options.out, dpi=80)


def facing_light(scene, picture, light):
    """Pixels whose triangles have the eye and the light on one side."""
    kept = scene.geometry()
    ids = np.where(picture["triangles"] == tenebra.no_triangle, 0, picture["triangles"])
    a, b, c = (kept["positions"][kept["triangles"][ids][..., k]].astype(float) for k in range(3))
    normal = np.cross(b - a, c - a)
    side = lambda place: np.sign(np.einsum("...k,...k", normal, np.asarray(place) - a))
    return side(light) == side(picture["view"]["eye"])


if __name__ == "__main__":
    main()
