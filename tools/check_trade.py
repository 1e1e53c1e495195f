#!/usr/bin/env python3
"""Whether `tenebra trade` keeps its word: settings that it gives for --budget and --error, held against renders.

usage: check_trade.py [--size WxH] VIEW...      a view: "scene.glb --frames 0:80:40 --shadows soft"
       check_trade.py --list FILE [--data DIR]   a view on each line; # begins a comment; scenes are in DIR where they
                                                 are not in the current folder (tools/trade_views.txt: twenty views)

The views are printed before the first run. Budget: the time of the standard setting; with the setting given, five
frames that were not tried (of still scenes the same one five times) take at most 10 % more in the median, and the next
setting of smaller error, on the same five frames, takes more than the budget. Error: one in the middle of the front; on frames that were not tried the picture is off the
finest by no more. TENEBRA names the program (build/bin/tenebra). Exit code 1: a word was not kept.
"""
import argparse
import json
import os
import pathlib
import re
import shlex
import statistics
import subprocess
import sys
import tempfile
import time

TENEBRA = os.environ.get("TENEBRA", "build/bin/tenebra")
CHOICES = ("--antialias", "--soft-error", "--ao-error")
FINEST = {"--antialias": "16", "--soft-error": "0", "--ao-error": "0.5"}


def tenebra(*arguments, codes=(0,)):
    run = subprocess.run([TENEBRA, *arguments], capture_output=True, text=True)
    if run.returncode not in codes:
        raise RuntimeError(run.stderr.strip().splitlines()[-1] if run.stderr.strip() else f"exit {run.returncode}")
    return run


def trade(view, *more):
    begin = time.monotonic()
    run = tenebra("trade", *view, *more, "--json", "--quiet")
    lines = run.stderr.strip().splitlines()
    return json.loads(run.stdout), lines[-1] if lines else "", time.monotonic() - begin


def chosen_options(line):
    """The choices of the command line that trade prints, and of these the words."""
    words = shlex.split(line)
    return {words[i]: words[i + 1] for i in range(len(words) - 1) if words[i] in CHOICES}


def words_of(options):
    return [word for pair in options.items() for word in pair]


def other_frames(frames):
    """Five frames between those that were tried; none of a scene that stands still."""
    first, last = min(frames), max(frames)
    if last - first < 8:
        return []
    parts = (0.12, 0.3, 0.42, 0.7, 0.88)
    return [frame for frame in (first + int(p * (last - first)) for p in parts) if frame not in frames]


def without_frames(view):
    return [w for i, w in enumerate(view) if w != "--frames" and (i == 0 or view[i - 1] != "--frames")]


def median_ms(view, options, frames):
    """Of a setting, by itself: of one renderer that has drawn a frame before."""
    given = dict(options)
    if not frames:
        found, _, _ = trade(view, *words_of(given), "--repeats", "5")
        return found["settings"][0]["frame_ms"]
    times = []
    for frame in frames:  # the same, frame by frame: its first frame is not counted
        found, _, _ = trade(without_frames(view), *words_of(given), "--frames", f"{frame}:{frame}")
        times.append(found["settings"][0]["frame_ms"])
    return statistics.median(times)


def worst_error(view, options, frames):
    worst = 0.0
    base = without_frames(view)
    with tempfile.TemporaryDirectory() as folder:
        for frame in frames:
            files = [str(pathlib.Path(folder, name)) for name in ("a.png", "b.png")]
            for file, setting in zip(files, (options, {k: FINEST[k] for k in options})):
                tenebra("render", *base, "--frames", f"{frame}:{frame}", *words_of(setting), "-o", file, "--quiet")
            text = tenebra("compare", *files, codes=(0, 1)).stdout
            worst = max(worst, float(re.search(r"RMS ([\d.e+-]+) of 255", text)[1]))
    return worst


def check(view):
    """A row of the table, and whether both words were kept."""
    usual, _, _ = trade(view, "--antialias", "4", *(["--soft-error", "0"] if "soft" in view else []),
                        *(["--ao-error", "2.5"] if "adaptive" in view else []), "--repeats", "2")
    budget = 1.02 * usual["settings"][0]["frame_ms"]
    found, line, seconds = trade(view, "--budget", f"{budget:.6g}")
    frames = other_frames(found["frames"])
    options = chosen_options(line)
    error = next(s["error_255"] for s in found["settings"] if chosen_options(s["options"]) == options)
    ms = median_ms(view, options, frames)
    finer = [s for s in found["settings"] if s["front"] and s["error_255"] < error]
    finer_ms = median_ms(view, chosen_options(max(finer, key=lambda s: s["error_255"])["options"]), frames) if finer else None
    finer_fits = finer_ms is not None and finer_ms <= budget
    promised = sorted(s["promised_error_255"] for s in found["settings"] if s["front"] and s["promised_error_255"] > 0)
    asked = 1.01 * promised[len(promised) // 2] if promised else 1.0
    _, line, more_s = trade(view, "--error", f"{asked:.6g}")
    by_error = chosen_options(line)
    seen = worst_error(view, by_error, frames)
    kept = (ms <= 1.1 * budget, not finer_fits, seen <= asked)
    print(f"{' '.join(view[0].split('/')[-1:] + view[1:])} | {seconds:.0f}, {more_s:.0f} | {budget:.1f} | "
          f"{' '.join(words_of(options))} | {ms:.1f} ({ms / budget:.2f}) | "
          f"{f'{finer_ms:.1f} ({finer_ms / budget:.2f})' if finer_ms else 'finest'} | {asked:.2f} | "
          f"{' '.join(words_of(by_error))} | {f'{seen:.2f}' if frames else 'still'} | "
          f"{'kept' if all(kept) else 'NOT KEPT'}", flush=True)
    return all(kept)


def check_error(view):
    """The row of --error alone: nothing in it is a time, so other programs may run beside it."""
    found, _, _ = trade(view, "--repeats", "1")
    promised = sorted(s["promised_error_255"] for s in found["settings"] if s["front"] and s["promised_error_255"] > 0)
    asked = 1.01 * promised[len(promised) // 2] if promised else 1.0
    _, line, _ = trade(view, "--repeats", "1", "--error", f"{asked:.6g}")
    frames, options = other_frames(found["frames"]), chosen_options(line)
    seen = worst_error(view, options, frames)
    print(f"{' '.join(view[0].split('/')[-1:] + view[1:])} | {asked:.2f} | {' '.join(words_of(options))} | "
          f"{f'{seen:.2f}' if frames else 'still'} | {'kept' if seen <= asked else 'NOT KEPT'}", flush=True)
    return seen <= asked


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--size", default="320x180")
    parser.add_argument("--list")
    parser.add_argument("--data", default=".")
    parser.add_argument("--errors", action="store_true", help="no times: --error alone")
    parser.add_argument("views", nargs="*")
    arguments = parser.parse_args()
    lines = list(arguments.views)
    if arguments.list:
        lines += [re.sub(r"#.*", "", line).strip() for line in open(arguments.list)]
    views = [[*shlex.split(line), "--size", arguments.size] for line in lines if line]
    for view in views:
        if not os.path.exists(view[0]):
            view[0] = str(pathlib.Path(arguments.data, view[0]))
    for view in views:
        print("view:", " ".join(view))
    print("view | " + ("" if arguments.errors else "seconds of trade | budget, ms | setting | took, ms (of budget) | "
                       "the next finer took | ") + "error asked | setting | worst of other frames |", flush=True)
    kept = 0
    for view in views:
        try:
            kept += check_error(view) if arguments.errors else check(view)
        except (RuntimeError, StopIteration) as failure:
            print(f"{' '.join(view)} | FAILED: {failure}", flush=True)
    print(f"{kept} of {len(views)} views keep their word")
    return 0 if kept == len(views) else 1


if __name__ == "__main__":
    sys.exit(main())
