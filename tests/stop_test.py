#!/usr/bin/env python3
"""Stops the program by SIGINT while one stage after the other keeps it busy, and measures how long it goes on.

usage: stop_test.py PROGRAM SCENES [all]     (exit code 1 if any stage takes longer than its limit)

Without `all`: a few small inputs, and 10 s as the limit, for machines that have more to do. With `all`: inputs that keep
each stage busy for seconds, 1 s as the limit, and a table. SCENES is the folder of the bundled scenes. How a run ended is
read from what it says: after its frame (orderly), or at once, as the stage at hand did not look up in time.
"""
import json
import os
import pathlib
import random
import signal
import struct
import subprocess
import sys
import tempfile
import time

SEED = 20261123


def soup(count, size, flat=False):
    """Corners of `count` triangles of about that size in a cube of 4 m, or in planes that meet in the light at 0,9,0."""
    draw = random.Random(SEED).uniform
    for _ in range(count):
        x, y, z = draw(-2, 2), draw(0.1, 3), draw(-2, 2)
        for _ in range(3):
            if flat:  # all in the plane through x = 0 and the light
                yield (0.0, y + draw(-size, size), z + draw(-size, size))
            else:
                yield (x + draw(-size, size), y + draw(-size, size), z + draw(-size, size))


def write_glb(path, corners):
    positions = [(-3, 0, -3), (-3, 0, 3), (3, 0, 3), (-3, 0, -3), (3, 0, 3), (3, 0, -3), *corners]
    low, high = [min(p[i] for p in positions) for i in range(3)], [max(p[i] for p in positions) for i in range(3)]
    table = b"".join(struct.pack("<3f", *p) for p in positions)
    low, high = (list(struct.unpack("<3f", struct.pack("<3f", *v))) for v in (low, high))
    times = struct.pack("<2f6f", 0, 100, 0, 0, 0, 0.01, 0, 0)
    scene = {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1, 2]}],
        "extensionsUsed": ["KHR_lights_punctual"],
        "extensions": {"KHR_lights_punctual": {"lights": [{"type": "point", "intensity": 400}]}},
        "nodes": [{"mesh": 0}, {"translation": [0, 9, 0], "extensions": {"KHR_lights_punctual": {"light": 0}}},
                  {"translation": [0.3, 1.5, 7], "camera": 0}],
        "cameras": [{"type": "perspective", "perspective": {"yfov": 0.8, "znear": 0.1}}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "animations": [{"samplers": [{"input": 1, "output": 2}],
                        "channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}]}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": len(positions), "type": "VEC3", "min": low,
                       "max": high},
                      {"bufferView": 1, "componentType": 5126, "count": 2, "type": "SCALAR", "min": [0], "max": [100]},
                      {"bufferView": 1, "byteOffset": 8, "componentType": 5126, "count": 2, "type": "VEC3"}],
        "bufferViews": [{"buffer": 0, "byteLength": len(table)},
                        {"buffer": 0, "byteOffset": len(table), "byteLength": len(times)}],
        "buffers": [{"byteLength": len(table) + len(times)}],
    }
    text = json.dumps(scene).encode()
    text += b" " * (-len(text) % 4)
    binary = table + times
    path.write_bytes(struct.pack("<4sII", b"glTF", 2, 28 + len(text) + len(binary)) +
                     struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(binary), b"BIN\0") + binary)
    return str(path)


def write_obj(path, corners):
    with open(path, "w") as file:
        for number, (x, y, z) in enumerate(corners, 1):
            file.write(f"v {x:.5f} {y:.5f} {z:.5f}\n")
            if number % 3 == 0:
                file.write(f"f {number - 2} {number - 1} {number}\n")
    return str(path)


def write_aff(path, corners):
    with open(path, "w") as file:
        file.write("v\nfrom 0 1 7\nat 0 1 0\nup 0 1 0\nangle 45\nhither 0.1\nresolution 64 64\nl 0 9 0\n"
                   "f 1 0.5 0.2 0.8 0 10 0 1\n")
        for number, (x, y, z) in enumerate(corners):
            file.write(("p 3\n" if number % 3 == 0 else "") + f"{x:.5f} {y:.5f} {z:.5f}\n")
    return str(path)


class Stages:
    """Commands by the name of the stage that they keep busy."""

    def __init__(self, program, scenes, folder):
        self.program, self.folder = program, folder
        self.court, self.city = f"{scenes}/court.glb", f"{scenes}/city.glb"

    def render(self, scene, *more):
        return [self.program, "render", scene, "--raster", "cpu", "--antialias", "1", "--frames", "all", "--quiet",
                "--ao-cache", "none", "-o", f"{self.folder}/p%05d.png", *more]

    def few(self):
        glb = write_glb(self.folder / "soup.glb", soup(3000, 0.3))
        return {
            "import, OBJ": self.render(write_obj(self.folder / "a.obj", soup(500_000, 0.1))),
            "soft solver": self.render(glb, "--shadows", "soft", "--light-size", "50%"),
            "fields": self.render(self.court, "--ao", "field"),
            "blocked output": self.render(glb, "--size", "32x24", "--log", "/dev/stdout"),
        }

    def all(self):
        large = write_glb(self.folder / "large.glb", soup(2_000_000, 0.02))
        glb = write_glb(self.folder / "soup.glb", soup(20_000, 0.3))
        flat = write_glb(self.folder / "flat.glb", soup(20_000, 0.3, flat=True))
        far = ["--set-light", "0 move=1e15,3e14,0"]
        soft = ["--shadows", "soft", "--light-size", "50%"]
        return {
            "import, OBJ": self.render(write_obj(self.folder / "a.obj", soup(1_000_000, 0.1))),
            "import, AFF": self.render(write_aff(self.folder / "a.aff", soup(1_000_000, 0.1))),
            "import, GLB": self.render(large, "--size", "64x48"),
            "exposure metered": self.render(self.court, "--exposure", "auto"),
            "evaluation, raster": self.render(large, "--size", "4096x4096", "--shadows", "none"),
            "tiles, 2 M triangles": self.render(large, "--size", "2048x2048"),
            "tiles, large picture": self.render(self.court, "--size", "8192x8192"),
            "tiles, far light": self.render(self.court, "--size", "4096x4096", *far),
            "cone tree": self.render(glb, "--size", "4096x4096", "--paper", "variant=Precise"),
            "cone tree, far light": self.render(self.court, "--size", "640x480", "--paper", "variant=PreciseSEATP", *far),
            "exact, light in planes": self.render(flat, "--size", "2048x2048", "--eye", "4,3,5", "--look-at", "0,1,0"),
            "shafts": self.render(large, "--size", "1024x768", "--shadows", "soft", "--light-size", "1%"),
            "soft solver": self.render(glb, *soft),
            "soft, BSP": self.render(glb, *soft, "--paper", "soft-solver=bsp"),
            "soft, clipping": self.render(glb, *soft, "--paper", "soft-solver=clip"),
            "soft, by an error": self.render(glb, *soft, "--soft-error", "1"),
            "soft, triangles' groups": self.render(large, "--size", "640x480", *soft),
            "AO, trees": self.render(large, "--size", "64x48", "--shadows", "none", "--ao", "adaptive"),
            "AO, adaptive": self.render(self.court, "--size", "4096x4096", "--shadows", "none", "--ao", "adaptive"),
            "AO, fields": self.render(self.court, "--shadows", "none", "--ao", "field"),
            "AO, reference": self.render(self.court, "--size", "2048x2048", "--shadows", "none", "--ao", "rays",
                                         "--ao-rays", "1024"),
            "anti-aliasing": self.render(self.city, "--size", "4096x4096", "--antialias", "16"),
            "pictures written": self.render(self.city, "--size", "8192x8192", "--shadows", "none"),
            "blocked output": self.render(glb, "--size", "32x24", "--log", "/dev/stdout"),
            "convert": [self.program, "convert", large, str(self.folder / "out.glb"), "--quiet"],
            "convert, AFF": [self.program, "convert", str(self.folder / "a.aff"), str(self.folder / "out.glb"), "--quiet"],
            "verify": [self.program, "verify", self.court, "--size", "2048x2048"],
            "info": [self.program, "info", large],
        }


def stop(command, moment):
    """Sends SIGINT after `moment` seconds: how long it took to end, its exit code and its last line; None: it was done."""
    read, write = os.pipe()
    os.set_blocking(write, False)
    try:
        while True:
            os.write(write, b" " * 4096)  # nobody reads it: what is written there blocks
    except BlockingIOError:
        pass
    os.set_blocking(write, True)
    blocked = "/dev/stdout" in command
    process = subprocess.Popen(command, stdout=write if blocked else subprocess.DEVNULL, stderr=subprocess.PIPE)
    os.close(write)
    try:
        process.wait(moment)
        assert process.returncode == 0, f"{command}: exit code {process.returncode}"
        return None
    except subprocess.TimeoutExpired:
        begin = time.monotonic()
        process.send_signal(signal.SIGINT)
        said = process.communicate(timeout=60)[1].decode()
        return time.monotonic() - begin, process.returncode, said.strip().splitlines()[-1:] or [""]
    finally:
        os.close(read)


def measure(name, command, moments, limit_s):
    slowest, ends = 0.0, []
    for moment in moments:
        stopped = stop(command, moment)
        if stopped is None:
            break
        seconds, code, said = stopped
        assert code in (130, -signal.SIGINT), f"{name}: exit code {code}: {said}"
        slowest = max(slowest, seconds)
        ends.append("at once" if "at once" in said[0] or code < 0 else "orderly")
    assert ends, f"{name}: done within {moments[0]} s, so nothing was stopped; it needs a larger input"
    print(f"{name:26}{slowest:8.3f} s   {len(ends)} stops: {', '.join(ends)}{'' if slowest <= limit_s else '   TOO LONG'}",
          flush=True)
    return slowest <= limit_s


def main():
    program, scenes = sys.argv[1:3]
    every = sys.argv[3:] == ["all"]
    limit_s = 1.0 if every else 10.0
    moments = (0.3, 1.0, 2.5, 5.0) if every else (0.3,)
    with tempfile.TemporaryDirectory() as folder:
        stages = Stages(program, scenes, pathlib.Path(folder))
        commands = stages.all() if every else stages.few()
        results = [measure(name, command, moments, limit_s) for name, command in commands.items()]
    sys.exit(0 if all(results) else 1)


if __name__ == "__main__":
    main()
