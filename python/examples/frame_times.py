#!/usr/bin/env python3
"""How long the frames of an animation took, stage by stage: from a log of `tenebra render --log`, or for frames that
are drawn here.

usage: frame_times.py [LOG.csv] [--out FILE.png] [--scene FILE] [--frames N]
"""
import argparse
import csv
import pathlib

import matplotlib.pyplot as plt
import numpy as np

import tenebra

ROOT = pathlib.Path(__file__).resolve().parents[2]


def read_log(path):
    """The log's rows as numbers; its comments begin with #."""
    with open(path, newline="", encoding="utf-8") as log:
        rows = csv.DictReader(line for line in log if not line.startswith("#"))
        return [{name: float(value) for name, value in row.items()} for row in rows]


def draw_frames(path, count):
    """The same of `count` frames that are drawn now, spread over the animation."""
    scene = tenebra.Scene.load(path)
    frames = np.unique(np.linspace(0, scene.frames - 1, count).astype(int))
    scene.render(int(frames[0]), (320, 240))  # the first frame makes what the others keep
    return [{"frame": frame, **scene.render(int(frame), (320, 240))["timings"]} for frame in frames]


def stages_of(rows):
    """The names of the times that count, the largest first; what is left of the total is `other`."""
    names = [name for name in rows[0] if name.endswith("_ms") and name != "total_ms"]
    sums = {name: sum(row[name] for row in rows) for name in names}
    return [name for name in sorted(names, key=sums.get, reverse=True) if sums[name] > 0][:6]


def main():
    arguments = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    arguments.add_argument("log", nargs="?")
    arguments.add_argument("--out", default="frame_times.png")
    arguments.add_argument("--scene", default=ROOT / "scenes" / "city.glb")
    arguments.add_argument("--frames", type=int, default=40)
    options = arguments.parse_args()
    rows = read_log(options.log) if options.log else draw_frames(options.scene, options.frames)

    frames, total = [row["frame"] for row in rows], np.array([row["total_ms"] for row in rows])
    stages = stages_of(rows)
    times = np.array([[row[name] for row in rows] for name in stages])
    other = np.maximum(total - times.sum(axis=0), 0)
    print(f"{len(rows)} frames: median {np.median(total):.1f} ms, 95 % within {np.percentile(total, 95):.1f} ms, "
          f"longest {total.max():.1f} ms (frame {frames[int(total.argmax())]:.0f})")
    for name, row in zip(stages, times):
        print(f"  {name[:-3]:12} median {np.median(row):7.2f} ms")

    figure, (over_time, share) = plt.subplots(1, 2, figsize=(10, 3.6), layout="constrained", width_ratios=(2, 1))
    over_time.stackplot(frames, *times, other, labels=[name[:-3] for name in stages] + ["other"])
    over_time.set(title="frame times", xlabel="frame", ylabel="ms", xlim=(frames[0], frames[-1]), ylim=(0, None))
    over_time.legend(fontsize="small", ncols=2, loc="lower right")
    share.hist(total, bins=20)
    share.axvline(np.median(total), color="black", linewidth=1)
    share.set(title="how often", xlabel="ms a frame", ylabel="frames")
    figure.savefig(options.out, dpi=80)


if __name__ == "__main__":
    main()
