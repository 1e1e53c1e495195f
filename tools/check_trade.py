#!/usr/bin/env python3
"""Whether `tenebra trade` keeps its word: settings that it gives for --budget and --error, held against renders.

usage: check_trade.py [--size WxH] VIEW...      a view: "scene.glb --frames 0:80:40 --shadows soft"
       check_trade.py --list FILE [--data DIR]   a view on each line; # begins a comment; scenes are in DIR where they
                                                 are not in the current folder (tools/trade_views.txt: twenty views)

The views are printed before the first run. Budget: the time of the standard setting; with the setting given, frames
that were not tried (up to fifteen; of still scenes the same one) take at most 10 % more in the median, and the next
setting of smaller error, on the same frames, takes more than the budget; where trade says that nothing fits, so does
the quickest. Each frame is drawn fifteen times, or fewer where that takes half a second: in a new process the first
frames take up to 1.7 times as long as later ones. A view is measured again, twice at most, if the standard setting's
time was not the same before and after by 5 %: the machine was not quiet. Error: one in the middle of the front; on five
frames that were not tried the picture is off the finest by no more. TENEBRA names the program (build/bin/tenebra). Exit
code 1: a word was not kept.
"""
import argparse
import json
import math
import os
import pathlib
import re
import shlex
import subprocess
import sys
import tempfile
import time

TENEBRA = os.environ.get("TENEBRA", "build/bin/tenebra")
CHOICES = ("--antialias", "--soft-error", "--ao-error")
FINEST = {"--antialias": "16", "--soft-error": "0", "--ao-error": "0.5"}
STEADY = 0.05  # by how much times of a quiet machine differ


def tenebra(*arguments, codes=(0,)):
    run = subprocess.run([TENEBRA, *arguments], capture_output=True, text=True)
    if run.returncode not in codes:
        raise RuntimeError(run.stderr.strip().splitlines()[-1] if run.stderr.strip() else f"exit {run.returncode}")
    return run


def trade(view, *more):
    begin = time.monotonic()
    run = tenebra("trade", *view, *more, "--json", "--quiet", codes=(0, 1))  # 1: nothing fits
    lines = run.stderr.strip().splitlines()
    if not run.stdout:
        raise RuntimeError(lines[-1])
    return json.loads(run.stdout), lines[-1] if lines else "", time.monotonic() - begin


def chosen_options(line):
    """The choices of the command line that trade prints; none in a sentence that says why there is no such line."""
    words = [] if line.startswith("tenebra: ") else shlex.split(line)
    return {words[i]: words[i + 1] for i in range(len(words) - 1) if words[i] in CHOICES}


def words_of(options):
    return [word for pair in options.items() for word in pair]


def other_frames(frames, most=15):
    """Frames between those that were tried, evenly apart; none of a scene that stands still."""
    first, last = min(frames), max(frames)
    count = min(most, (last - first) // 2)
    step = (last - first) // max(count, 1)
    for begin in sorted(range(first, first + step), key=lambda begin: abs(begin - first - step / 2)):
        others = range(begin, last, step)[:count]
        if not set(others) & set(frames):
            return others
    return range(0)


def without_frames(view):
    return [w for i, w in enumerate(view) if w != "--frames" and (i == 0 or view[i - 1] != "--frames")]


def median_ms(view, options, frames=range(0)):
    """Of a setting, by itself, on these frames, or those of the view."""
    if frames:
        view = [*without_frames(view), "--frames", f"{frames[0]}:{frames[-1]}:{frames.step}"]
    found, _, _ = trade(view, *words_of(options), "--repeats", "15")
    return found["settings"][0]["frame_ms"]


def worst_error(line, frames):
    """Of the pictures of a command line that trade printed."""
    worst, command, options = 0.0, shlex.split(line)[1:], chosen_options(line)
    with tempfile.TemporaryDirectory() as folder:
        for frame in frames:
            files = [str(pathlib.Path(folder, name)) for name in ("a.png", "b.png")]
            for file, setting in zip(files, (options, {k: FINEST[k] for k in options})):
                tenebra(*command[:-2 * len(options)], *words_of(setting), "--frames", f"{frame}:{frame}", "-o", file, "--quiet")
            text = tenebra("compare", *files, codes=(0, 1)).stdout
            worst = max(worst, float(re.search(r"RMS ([\d.e+-]+) of 255", text)[1]))
    return worst


def asked_error(found):
    """One in the middle of the front."""
    promised = sorted(s["promised_error_255"] for s in found["settings"] if s["front"] and s["promised_error_255"] > 0)
    return 1.01 * promised[len(promised) // 2] if promised else 1.0


def next_finer(found, options):
    """The setting of the front with the next smaller error, the first after none; None: there is none."""
    error = next((s["error_255"] for s in found["settings"] if chosen_options(s["options"]) == options), math.inf)
    finer = [s for s in found["settings"] if s["front"] and s["error_255"] < error]
    return chosen_options(max(finer, key=lambda s: s["error_255"])["options"]) if finer else None


def check_budget(view):
    """Cells of the table, whether the word was kept, and what trade printed."""
    usual = {"--antialias": "4", **({"--soft-error": "0"} if "soft" in view else {}),
             **({"--ao-error": "2.5"} if "adaptive" in view else {})}
    for _ in range(3):
        usual_ms = median_ms(view, usual)
        budget = 1.02 * usual_ms
        found, line, seconds = trade(view, "--budget", f"{budget:.6g}")
        frames, options = other_frames(found["frames"]), chosen_options(line)
        finer = next_finer(found, options)
        ms = median_ms(view, options, frames) if options else 0
        finer_ms = median_ms(view, finer, frames) if finer else math.inf
        drift = median_ms(view, usual) / usual_ms - 1
        if abs(drift) <= STEADY:
            break
    cells = (f"{seconds:.0f} | {budget:.1f} ({drift:+.0%}) | {' '.join(words_of(options)) or 'none fits'} | {ms:.1f} ({ms / budget:.2f}) | "
             f"{f'{finer_ms:.1f} ({finer_ms / budget:.2f})' if finer else 'finest'}")
    return cells, ms <= 1.1 * budget and finer_ms > budget, found


def check(view):
    """Prints a row of the table; whether both words were kept."""
    cells, budget_kept, found = check_budget(view)
    asked, frames = asked_error(found), other_frames(found["frames"], most=5)
    _, line, seconds = trade(view, "--error", f"{asked:.6g}")
    options = chosen_options(line)
    seen = worst_error(line, frames)
    kept = budget_kept and seen <= asked
    print(f"{' '.join(view[0].split('/')[-1:] + view[1:])} | {cells} | {seconds:.0f} | {asked:.2f} | "
          f"{' '.join(words_of(options))} | {f'{seen:.2f}' if frames else 'still'} | {'kept' if kept else 'NOT KEPT'}",
          flush=True)
    return kept


def check_error(view):
    """The row of --error alone: nothing in it is a time, so other programs may run beside it."""
    found, _, _ = trade(view, "--repeats", "1")
    asked = asked_error(found)
    _, line, _ = trade(view, "--repeats", "1", "--error", f"{asked:.6g}")
    frames, options = other_frames(found["frames"], most=5), chosen_options(line)
    seen = worst_error(line, frames)
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
    print("view | " + ("" if arguments.errors else "seconds of trade | budget, ms (drift) | setting | took, ms (of budget) | "
                       "the next finer took | seconds of trade | ") + "error asked | setting | worst of other frames |", flush=True)
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
