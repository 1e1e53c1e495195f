#!/usr/bin/env python3
"""Writes the bundled scenes beside itself: city.glb, gallery.glb, court.glb, square.glb, room.glb. `generate.py NAME...` writes some."""

import importlib
import pathlib
import sys

SCENES = ("city", "gallery", "court", "square", "room")


def scene_bytes(name):
    return importlib.import_module("generator." + name).build().to_bytes()


def main(names):
    for name in names or SCENES:
        if name not in SCENES:
            sys.exit("generate.py: found '%s', expected one of %s." % (name, ", ".join(SCENES)))
        path = pathlib.Path(__file__).resolve().parent / (name + ".glb")
        path.write_bytes(scene_bytes(name))
        print("%s: %d bytes" % (path.name, path.stat().st_size))


if __name__ == "__main__":
    main(sys.argv[1:])
