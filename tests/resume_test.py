#!/usr/bin/env python3
"""Kills a render at random moments and resumes it: every output must have the bytes of one whole run.

usage: resume_test.py PROGRAM SCENE [KILLS]      (10 kills unless told otherwise; exit code 1 if anything differs)

The moments come from a fixed seed, as parts of the time that one whole run takes. After each kill it is checked
that pictures and masks are whole, that all rows of the log but a torn last one are whole, and that resuming draws no
more than one frame whose picture was there. When a render is complete the next kill begins another.
"""
import pathlib
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time

FRAMES = 24
SEED = 20261123


def command(program, scene, folder, *more):
    return [program, "render", scene, "--frames", f"0:{FRAMES - 1}", "--size", "96x72", "-o", f"{folder}/p%04d.png",
            "--mask", f"{folder}/m%04d.png", "--log", f"{folder}/frames.csv", "--quiet", *more]


def rows_of(log):
    """The rows of a log; fails unless they have as many fields as the header. A kill may cut the last line short."""
    if not log.exists():
        return []
    text = log.read_text()
    lines = [line for line in text[:text.rfind("\n") + 1].splitlines() if not line.startswith("#")]
    if not lines:
        return []
    for line in lines:
        assert line.count(",") == lines[0].count(","), f"{log} has the row {line}"
    return lines[1:]


def pictures_of(folder):
    """The whole outputs by name; a file under its own name must be one of them."""
    return {file.name: file.stat().st_ino for file in folder.glob("*.png")}


def check_whole(folder, reference):
    for file in folder.glob("*.png"):
        assert file.read_bytes() == reference[file.name], f"{file.name} is not what one run makes"


def check_complete(folder, reference):
    check_whole(folder, reference)
    assert {file.name for file in folder.glob("*.png")} == set(reference), "an output is missing"
    assert (folder / "frames.csv").read_text().endswith("\n"), "the log ends within a line"
    frames = sorted(int(row.split(",")[0]) for row in rows_of(folder / "frames.csv"))
    assert frames == list(range(FRAMES)), f"the log has the frames {frames}"
    left = [file.name for file in folder.glob(".tenebra-*")]
    assert not left, f"temporary files are left: {left}"


class Render:
    """One render, from its folder's first picture to its last, in as many processes as it takes."""

    def __init__(self, program, scene, folder, reference):
        self.arguments = command(program, scene, folder, "--resume")
        self.folder, self.reference = folder, reference
        self.before, self.rows = {}, 0

    def run(self, seconds):
        """True if it was killed."""
        process = subprocess.Popen(self.arguments)
        try:
            process.wait(seconds)
        except subprocess.TimeoutExpired:
            process.send_signal(signal.SIGKILL)
            process.wait()
        assert process.returncode in (0, -signal.SIGKILL), f"exit code {process.returncode}"
        check_whole(self.folder, self.reference)
        now, rows = pictures_of(self.folder), len(rows_of(self.folder / "frames.csv"))
        again = {name[1:5] for name, inode in self.before.items() if now.get(name) != inode}
        assert len(again) <= 1, f"frames {sorted(again)} were drawn again"
        assert rows >= self.rows, "rows of the log were lost"
        self.before, self.rows = now, rows
        self.again = len(again)
        return process.returncode != 0


def main():
    program, scene = sys.argv[1:3]
    kills = int(sys.argv[3]) if len(sys.argv) > 3 else 10
    moments = random.Random(SEED)
    with tempfile.TemporaryDirectory() as root:
        whole = pathlib.Path(root) / "whole"
        whole.mkdir()
        begin = time.monotonic()
        subprocess.run(command(program, scene, whole), check=True)
        seconds = time.monotonic() - begin
        reference = {file.name: file.read_bytes() for file in whole.glob("*.png")}
        done, again, renders = 0, 0, 0
        while done < kills:
            folder = pathlib.Path(root) / "killed"
            folder.mkdir()
            render = Render(program, scene, folder, reference)
            while done < kills and render.run(moments.uniform(0, seconds)):
                done, again = done + 1, again + render.again
            render.run(None)
            again, renders = again + render.again, renders + 1
            check_complete(folder, reference)
            shutil.rmtree(folder)
    print(f"{done} kills in {renders} renders of {FRAMES} frames: the same bytes, {again} frames drawn again")


if __name__ == "__main__":
    main()
