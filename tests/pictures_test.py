#!/usr/bin/env python3
"""Pictures that others read: OpenEXR by a reader that shares nothing with the program (and by OpenImageIO where it is
installed), FLIP against the paper's formulas written down once more, frames through a pipe.

usage: pictures_test.py PROGRAM SCENE        (SCENE: the bundled court, which has an area light)
"""
import math
import os
import signal
import struct
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

from flip_formulas import flip, hyab, lab
from picture_files import read_exr, read_png, write_pfm

PROGRAM, SCENE = "", ""


def run(*arguments, **more):
    return subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, timeout=120, **more)


def render(*arguments):
    done = run("render", SCENE, "--size", "40x30", "--quiet", *arguments)
    assert done.returncode == 0, done.stderr.decode()
    return done


def level(linear):
    linear = min(max(linear, 0), 1)
    encoded = 12.92 * linear if linear <= 0.0031308 else 1.055 * linear ** (1 / 2.4) - 0.055
    return int(255 * encoded + 0.5)


def transformed(matrix, point):
    p = (*point, 1)
    out = [sum(p[r] * matrix[4 * r + c] for r in range(4)) for c in range(4)]
    return [value / out[3] for value in out[:3]], out[3]


class ExrTest(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.path = Path(self.folder.name)

    def draw(self, *more):
        render("--shadows", "soft", "--ao", "adaptive", "-o", self.path / "##.exr", "--format", "float", "--aov",
               "depth,id,normal,visibility,irradiance,ao,albedo", "--antialias", 1, "--frames", "3", *more)

    def drawn(self, *more):
        self.draw(*more)
        return read_exr(self.path / "03.exr")

    def test_channels_are_what_the_other_files_have(self):
        _, kinds, values = self.drawn("--mask", self.path / "m.pfm", "--tone", "none", "--terminator", "smooth")
        self.assertEqual({kinds[name] for name in ("id", "id.part", "id.material")}, {"uint"})
        self.assertEqual(kinds["Z"], "float")
        render("--shadows", "soft", "--ao", "adaptive", "-o", self.path / "a.png", "--antialias", 1, "--frames", "3",
               "--tone", "none", "--terminator", "smooth")
        _, levels, _ = read_png((self.path / "a.png").read_bytes())
        self.assertEqual([level(values[c][i]) for i in range(1200) for c in "RGB"], levels)
        masks = [name for name in values if name.startswith("visibility.")]
        self.assertEqual(len(masks), 1)
        pfm = (self.path / "m.pfm").read_bytes()[-4800:]
        rows = [struct.unpack_from("<40f", pfm, 160 * (29 - y)) for y in range(30)]
        self.assertEqual(values[masks[0]], [value for row in rows for value in row])
        seen = [i for i in range(1200) if values["id"][i] != 0xffffffff]
        self.assertTrue(all(math.isinf(values["Z"][i]) == (i not in set(seen)) for i in range(1200)))
        for i in seen:
            self.assertAlmostEqual(math.hypot(*(values["N." + c][i] for c in "XYZ")), 1, 5)
            self.assertTrue(0 <= values["ao"][i] <= 1 and 0 <= values["albedo.G"][i] <= 1)
            self.assertTrue(values["irradiance.G"][i] > 0 or values[masks[0]][i] == 0
                            or values["irradiance.G"][i] == 0)

    def test_camera_and_depth_are_one(self):
        """The point at a pixel's depth goes back to the pixel, and camera space has the depth as z."""
        attributes, _, values = self.drawn("--eye", "1,2,9", "--look-at", "0,1,0", "--fov", 40)
        to_camera = struct.unpack("<16f", attributes["worldToCamera"])
        to_ndc = struct.unpack("<16f", attributes["worldToNDC"])
        centre, depth = transformed(to_camera, (0, 1, 0))
        for got, wanted in zip(centre, (0, 0, math.sqrt(1 + 1 + 81))):
            self.assertAlmostEqual(got, wanted, 4)
        place, _ = transformed(to_ndc, (0, 1, 0))
        self.assertAlmostEqual(place[0], 0.5, 4)
        self.assertAlmostEqual(place[1], 0.5, 4)
        # A point right of and above the middle, by camera space's axes.
        rows = [to_camera[4 * r:4 * r + 3] for r in range(3)]
        point = [c + 0.5 * rows[r][0] + 0.25 * rows[r][1] for r, c in enumerate((0, 1, 0))]
        place, depth = transformed(to_ndc, point)
        high = 2 * depth * math.tan(math.radians(20))
        self.assertAlmostEqual(depth, math.sqrt(83), 4)
        self.assertAlmostEqual(place[0], 0.5 + 0.5 / (high * 40 / 30), 4)
        self.assertAlmostEqual(place[1], 0.5 - 0.25 / high, 4)
        self.assertEqual(attributes["tenebra/frame"], b"3")
        self.assertEqual(attributes["tenebra/size"], b"40x30")
        self.assertTrue(attributes["software"].startswith(b"tenebra "))

    def test_irradiance_is_that_of_the_light(self):
        """The court's panel as a point: I cos cos' / d^2, from depths and normals alone."""
        light, towards = (4.6, 9.2, 5.6), (-0.444539, -0.724433, -0.526861)
        candela = [288 * 2 * 1.25 * c for c in (1, 0.9, 0.74)]
        render("-o", self.path / "a.exr", "--format", "float", "--antialias", 1, "--eye", "3,7,4", "--look-at",
               "-1,0,-1", "--fov", 40, "--aov", "depth,normal,visibility,irradiance")
        attributes, _, values = read_exr(self.path / "a.exr")
        to_camera = struct.unpack("<16f", attributes["worldToCamera"])
        lit = 0
        for i in range(1200):
            if values["visibility.panel light"][i] == 0:
                continue
            high = math.tan(math.radians(20)) * values["Z"][i]
            seen = ((i % 40 + 0.5 - 20) / 15 * high, (15 - i // 40 - 0.5) / 15 * high, values["Z"][i])
            point = [e + sum(s * to_camera[4 * r + c] for c, s in enumerate(seen)) for r, e in enumerate((3, 7, 4))]
            to_light = [a - b for a, b in zip(light, point)]
            distance = math.hypot(*to_light)
            cosines = (sum(values["N." + c][i] * v for c, v in zip("XYZ", to_light)) / distance,
                       -sum(t * v for t, v in zip(towards, to_light)) / distance)
            for c, intensity in zip("RGB", candela):
                wanted = intensity * max(cosines[0], 0) * max(cosines[1], 0) / distance ** 2
                self.assertAlmostEqual(values["irradiance." + c][i], wanted, delta=1e-3 * wanted + 1e-4)
            lit += 1
        self.assertGreater(lit, 200)

    def test_openimageio_reads_the_same(self):
        try:
            import OpenImageIO as oiio
        except ImportError:
            self.skipTest("OpenImageIO (package python3-openimageio) is not here: only our reader was asked")
        for compression in ("zip", "piz"):
            self.draw("--format", compression)
            buffer = oiio.ImageBuf(str(self.path / "03.exr"))
            read = dict(zip(buffer.spec().channelnames, range(buffer.nchannels)))
            if compression == "zip":
                _, _, values = read_exr(self.path / "03.exr")
            pixels = buffer.get_pixels(oiio.FLOAT)
            for name in ("R", "B", "Z", "N.Y", "albedo.G"):
                ours = values[name]
                theirs = [float(pixels[i // 40][i % 40][read[name]]) for i in range(1200)]
                self.assertEqual(ours, theirs, name)
            for name in ("id", "id.part"):
                channel = oiio.ImageBufAlgo.channels(buffer, (name,)).get_pixels(oiio.UINT)
                self.assertEqual(values[name], [int(channel[i // 40][i % 40][0]) for i in range(1200)], name)

    def test_pixels_are_means_of_linear_samples(self):
        """A PNG shows the same means, but for pixels with a sample that is brighter than white, which counts as white."""
        for exr_type, off in (("float", 0), ("half", 1)):
            arguments = ["--tone", "none", "--antialias", 16]
            render(*arguments, "-o", self.path / "a.exr", "--format", exr_type)
            _, kinds, values = read_exr(self.path / "a.exr")
            self.assertEqual(kinds, {"R": exr_type, "G": exr_type, "B": exr_type})
            self.assertLess(max(max(values[c]) for c in "RGB"), 1)
            render(*arguments, "-o", self.path / "a.png")
            _, levels, _ = read_png((self.path / "a.png").read_bytes())
            ours = [level(values[c][i]) for i in range(1200) for c in "RGB"]
            self.assertTrue(all(a >= b - off for a, b in zip(ours, levels)))
            self.assertLessEqual(sum(a > b + off for a, b in zip(ours, levels)), 20)

    def test_bright_samples_are_not_clamped(self):
        """An edge between 0 and 9 is not what one between 0 and 1 is."""
        arguments = ["--shadows", "none", "--format", "float", "--antialias", 16]
        render(*arguments, "--set-light", "0 intensity=100", "-o", self.path / "a.exr")
        render(*arguments, "--set-light", "0 intensity=100000", "-o", self.path / "b.exr")
        a, b = (read_exr(self.path / name)[2]["G"] for name in ("a.exr", "b.exr"))
        lit = [i for i in range(1200) if b[i] > 2 * a[i] > 0]
        self.assertGreater(len(lit), 600)
        self.assertGreater(max(b), 50)

    def test_resume_knows_exr(self):
        name = self.path / "%02d.exr"
        render("-o", name, "--frames", "0:2")
        times = {i: (self.path / f"{i:02}.exr").stat().st_mtime_ns for i in range(3)}
        (self.path / "01.exr").unlink()
        render("-o", name, "--frames", "0:2", "--resume")
        again = {i: (self.path / f"{i:02}.exr").stat().st_mtime_ns for i in range(3)}
        self.assertEqual([times[i] == again[i] for i in range(3)], [True, False, True])
        other = run("render", SCENE, "--size", "40x30", "-o", name, "--frames", "0:2", "--resume", "--format",
                    "float")
        self.assertEqual(other.returncode, 1)
        self.assertIn("(half, zip)", other.stderr.decode())

    def test_refusals_are_sentences(self):
        for arguments, named in ((["-o", "a.png", "--aov", "depth"], "--aov is for OpenEXR pictures"),
                                 (["-o", "a.exr", "--aov", "dept"], "found dept, expected some of depth"),
                                 (["-o", "a.exr", "--aov", "ao"], "--aov ao needs ambient occlusion"),
                                 (["-o", "a.exr", "--aov", "visibility", "--shadows", "none"], "needs shadows"),
                                 (["-o", "a.exr", "--frames", "0:1"], "no frame number"),
                                 (["-o", "a.tiff"], ".png, .jpg or .exr"),
                                 (["-o", "##_##.png"], "expected one frame number"),
                                 (["-o", "-", "--resume"], "--resume looks for what was written"),
                                 (["-o", "a.png", "--format", "png"], "expected -o -"),
                                 (["-o", "/dev/null/such/a.exr"], "cannot make the folder")):
            done = run("render", SCENE, *arguments, cwd=self.path)
            text = done.stderr.decode()
            self.assertNotEqual(done.returncode, 0)
            self.assertIn(named, text)
            self.assertEqual(text.count("\n"), 1, text)
        self.assertEqual(list(self.path.iterdir()), [])


class CompareTest(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.path = Path(self.folder.name)

    def numbers(self, a, b):
        done = run("compare", self.path / a, self.path / b)
        self.assertEqual(done.stderr, b"")
        words = done.stdout.decode().splitlines()[1].replace(",", "").split()
        return done.returncode, float(words[1]), float(words[words.index("PSNR") + 1]), float(words[-1])

    def test_flip_is_the_papers(self):
        width, height = 12, 9
        number = 1

        def random():
            nonlocal number
            number = number * 69621 % 2147483647
            return struct.unpack("<f", struct.pack("<f", number / 2147483647))[0]
        a = [[random() for _ in range(3)] for _ in range(width * height)]
        b = [[0.75 * v for v in p] if i % 5 else [0.5, random(), 0.0] for i, p in enumerate(a)]
        b = [[struct.unpack("<f", struct.pack("<f", v))[0] for v in p] for p in b]
        write_pfm(self.path / "a.pfm", a, width, height)
        write_pfm(self.path / "b.pfm", b, width, height)
        code, rms, psnr, found = self.numbers("a.pfm", "b.pfm")
        self.assertEqual(code, 1)
        self.assertAlmostEqual(found, flip(a, b, width, height), 5)
        wanted = math.sqrt(sum((u - v) ** 2 for p, q in zip(a, b) for u, v in zip(p, q)) / (3 * width * height))
        self.assertAlmostEqual(rms, wanted, 5)
        self.assertAlmostEqual(psnr, -20 * math.log10(wanted), 3)
        self.assertEqual(self.numbers("b.pfm", "a.pfm")[3], found)
        self.assertEqual(self.numbers("a.pfm", "a.pfm"), (0, 0, math.inf, 0))
        # Black and white are as far apart as pictures get without an edge: 0.95 + 0.05 (100^0.7 - s) / (m - s).
        write_pfm(self.path / "black.pfm", [(0, 0, 0)] * 4, 2, 2)
        write_pfm(self.path / "white.pfm", [(1, 1, 1)] * 4, 2, 2)
        largest = hyab(lab((0, 1, 0)), lab((0, 0, 1))) ** 0.7
        self.assertAlmostEqual(self.numbers("black.pfm", "white.pfm")[3],
                               0.95 + 0.05 * (100 ** 0.7 - 0.4 * largest) / (0.6 * largest), 5)

    def test_files_of_each_kind(self):
        render("-o", self.path / "a.exr", "--aov", "depth,normal", "--tone", "none", "--antialias", 1)
        render("-o", self.path / "b.exr", "--aov", "depth,normal", "--tone", "none", "--antialias", 1, "--light", 0,
               "--format", "piz", "--set-light", "0 intensity=40")
        render("-o", self.path / "a.png", "--tone", "none", "--antialias", 1)
        self.assertEqual(self.numbers("a.exr", "a.exr"), (0, 0, math.inf, 0))
        code, rms, _, found = self.numbers("a.exr", "b.exr")
        self.assertTrue(code == 1 and rms > 0 and 0 < found < 1)
        self.assertLess(self.numbers("a.png", "a.exr")[3], 0.05)  # but for levels, and what is beyond 1
        same = run("compare", self.path / "a.exr", self.path / "b.exr", "--layer", "N")
        self.assertEqual(same.returncode, 0, same.stdout)
        self.assertEqual(run("compare", self.path / "a.exr", self.path / "b.exr", "--layer", "Z").returncode, 0)
        missing = run("compare", self.path / "a.exr", self.path / "b.exr", "--layer", "id")
        self.assertEqual(missing.returncode, 2)
        self.assertIn(b"found the channels B, G, N.X, N.Y, N.Z, R, Z, expected id", missing.stderr)

    def test_damaged_pfm_is_refused(self):
        for head in (b"", b"PF", b"PF\n2 2\n-1\n", b"PF\n99999 99999\n-1\n", b"Pf\n-1 4\n-1\n", b"Pf\n2 1\n0\n12345678",
                     b"Pf\n4294967297 1\n-1\n1234", b"Pf\n1 1\nnan\n1234"):
            (self.path / "a.pfm").write_bytes(head)
            done = run("compare", self.path / "a.pfm", self.path / "a.pfm")
            self.assertEqual(done.returncode, 2, head)
            self.assertEqual(done.stderr.count(b"\n"), 1, done.stderr)


class PipeTest(unittest.TestCase):
    COMMAND = ("--size", "40x30", "--frames", "0:3")

    def test_frames_are_those_of_files(self):
        with tempfile.TemporaryDirectory() as folder:
            render(*self.COMMAND, "-o", f"{folder}/%d.png")
            files = [Path(folder, f"{i}.png").read_bytes() for i in range(4)]
        piped = run("render", SCENE, *self.COMMAND, "-o", "-")
        self.assertEqual(piped.stdout, b"".join(files))
        self.assertIn(b"4 of 4 frames", piped.stderr)
        raw = run("render", SCENE, *self.COMMAND, "-o", "-", "--format", "rgb24")
        self.assertEqual(list(raw.stdout), [value for data in files for value in read_png(data)[1]])

    def test_a_closed_pipe_ends_it(self):
        with subprocess.Popen([PROGRAM, "render", SCENE, "--size", "640x480", "--frames", "all", "-o", "-"],
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE) as program:
            program.stdout.read(100)
            program.stdout.close()
            errors = program.stderr.read()
        self.assertEqual(program.returncode, 75)
        self.assertIn(b"tenebra: cannot write standard output: its reader is gone.\n", errors)

    def test_a_pipe_that_nobody_reads_can_be_stopped(self):
        reader, writer = os.pipe()
        with subprocess.Popen([PROGRAM, "render", SCENE, "--size", "640x480", "--frames", "all", "-o", "-",
                               "--format", "rgb24", "--quiet"], stdout=writer, stderr=subprocess.PIPE) as program:
            os.close(writer)
            os.read(reader, 1)  # it began to write, and the pipe is full soon
            time.sleep(0.5)
            began = time.monotonic()
            program.send_signal(signal.SIGINT)
            errors = program.stderr.read()
        self.assertEqual(program.returncode, 130)
        self.assertLess(time.monotonic() - began, 4)
        self.assertTrue(errors.startswith(b"tenebra: stopped after 0 of "), errors)
        os.close(reader)


if __name__ == "__main__":
    PROGRAM, SCENE = map(os.path.abspath, sys.argv[1:3])
    unittest.main(argv=sys.argv[:1], verbosity=2)
