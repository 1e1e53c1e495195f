#!/usr/bin/env python3
"""Measures the README's key figures again, by the commands that its table names.

usage: check_figures.py [--data FOLDER] [--spread S] [--list] [WORD...]

WORD: only rows with that word in them. A figure passes if the new one is within a factor of 1 + S [0.25] either way. Of figures with a range the
end is held that the program prints. The rows of `tenebra verify` took hours: here it checks a few small frames, where
nothing may be wrong. --list: measures nothing, and fails where a row of the table has no measurement here,
or a measurement no row. BENCH and TENEBRA name the programs (build/bin/tenebra-bench, build/bin/tenebra). All of it takes
half an hour on two cores. Exit code 1: a figure is not what the README says, or the two do not fit.
"""
import argparse
import os
import pathlib
import re
import shlex
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
BENCH = os.environ.get("BENCH", str(ROOT / "build/bin/tenebra-bench"))
TENEBRA = os.environ.get("TENEBRA", str(ROOT / "build/bin/tenebra"))

# How a row begins: the last lines of its command that print the figures in it, in their order; None: not printed.
PRINTED = {
    "hard shadows, one light": ("hard.dynamic_geomean", "hard.dynamic_worst"),
    "hard shadows, all lights, from triangle ids": ("hard.whole_moved_geomean", "hard.whole_moved_worst"),
    "whole frames without a GPU": ("frame.ratio_geomean", "frame.ratio_worst"),
    "exact soft shadows": ("soft.eq_worst", None),
    "soft shadows with an allowed error": (
        "soft.ratio_8_geomean", "soft.ratio_4_geomean", "soft.ratio_1_geomean",
        "soft.ratio_8_worst", "soft.ratio_4_worst", "soft.ratio_1_worst",
    ),
    "ambient occlusion at the default error": ("ao.scene_speedup_worst", None),
}
# Rows of `tenebra verify`, which counts: on a few frames of a bundled scene, where nothing may be wrong.
VERIFIED = {
    "hard masks that are wrong": ("scenes/city.glb", "--frames", "0:30:10", "--size", "320x240"),
    "visible fractions in soft shadows": ("scenes/court.glb", "--frames", "0:2", "--size", "160x120", "--shadows", "soft"),
}


def rows_of(readme):
    """(what, figures, command) of each row of the table of key figures."""
    section = readme.split("## Key figures", 1)[1].split("\n## ", 1)[0]
    for line in section.splitlines():
        cells = [cell.strip() for cell in line.strip("|").split("|")]
        if len(cells) == 3 and cells[2].startswith("`"):
            yield cells[0], [float(number) for number in re.findall(r"\d+(?:\.\d+)?", cells[1])], cells[2].strip("`")


def named(what, names):
    found = [name for name in names if what.startswith(name)]
    return found[0] if found else None


def check_list(rows):
    for what, figures, command in rows:
        if named(what, VERIFIED) and command.startswith("tenebra verify"):
            continue
        name = named(what, PRINTED)
        if not name or not command.startswith("tenebra-bench "):
            yield f"the row '{what}' has no measurement here"
        elif len(figures) != len(PRINTED[name]):
            yield f"the row '{what}' has {len(figures)} figures, expected {len(PRINTED[name])}"
    for name in [*PRINTED, *VERIFIED]:
        if not any(what.startswith(name) for what, _, _ in rows):
            yield f"no row begins with '{name}'"


def run(*command):
    print("  " + shlex.join(command), flush=True)
    done = subprocess.run(command, capture_output=True, text=True, cwd=ROOT)
    if done.returncode not in (0, 1):
        sys.exit(f"exit code {done.returncode}: {done.stderr.strip()[-400:]}")
    return done


def measured(command, data):
    """name -> value of the lines "name: value" that a benchmark ends with."""
    words = shlex.split(command)[1:] + (["--data", str(data)] if data else [])
    lines = run(BENCH, *words).stdout.splitlines()
    return {m[1]: float(m[2]) for m in (re.fullmatch(r"([a-z]+\.\w+): ([\d.]+)", line) for line in lines) if m}


def check(what, figures, command, arguments):
    name = named(what, VERIFIED)
    if name:
        done = run(TENEBRA, "verify", *VERIFIED[name])
        print("    " + (done.stdout.strip().splitlines() or ["nothing printed"])[-1])
        return done.returncode == 0
    values, fine = measured(command, arguments.data), True
    for figure, printed in zip(figures, PRINTED[named(what, PRINTED)]):
        if printed is None:
            continue
        now = values.get(printed)
        within = now is not None and figure / (1 + arguments.spread) <= now <= figure * (1 + arguments.spread)
        print(f"    {printed}: {now}, the README says {figure}{'' if within else ': NOT within the spread'}")
        fine = fine and within
    return fine


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--data", type=pathlib.Path)
    parser.add_argument("--spread", type=float, default=0.25)
    parser.add_argument("--list", action="store_true")
    parser.add_argument("words", nargs="*")
    arguments = parser.parse_args()
    rows = list(rows_of((ROOT / "README.md").read_text(encoding="utf-8")))
    wrong = list(check_list(rows))
    for sentence in wrong:
        print("README.md: " + sentence, file=sys.stderr)
    if wrong or arguments.list:
        return 1 if wrong else 0
    measured_rows = 0
    for what, figures, command in rows:
        if arguments.words and not any(word in what for word in arguments.words):
            continue
        print(what)
        measured_rows += 1
        if not check(what, figures, command, arguments):
            wrong.append(what)
    if measured_rows == 0:
        print(f"no row has one of the words {', '.join(arguments.words)}", file=sys.stderr)
        return 1
    print(f"{len(wrong)} figures are not what the README says" if wrong else "the README's figures hold")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
