#!/usr/bin/env python3
"""Gives `tenebra view` random input for many frames: keys, clicks, drags, wheels, sizes of the window.

usage: random_hands.py PROGRAM SCENE [FRAMES [SEED]] [-- OPTION...]     (500 frames, seed 1; options of tenebra view)

The window is on a virtual screen (Xvfb) and the hand is xdotool. A frame is one that the window has brought to the screen
with what the hand has done (event "drawn" of --report). Exit code 1 where the program crashes, says that a sanitizer
found something, hangs, or ends with another code than 0; what the hand did last is printed then. The same seed gives the
same input, though not at the same instants.
"""
import json
import os
import pathlib
import random
import subprocess
import sys
import tempfile
import time

KEYS = ("space Left Right Home End bracketleft bracketright l 1 2 3 4 v shift+v x b n m c BackSpace w a s d q e p shift+p t o g r "
        "Tab Escape F6 question ctrl+c ctrl+z ctrl+shift+z ctrl+y y Up Down Return Page_Up Page_Down plus minus period").split()
WORDS = "0 1 -1 0.5 1e9 -1e30 nan 8000 none / é".split()
SIZES = ((1000, 700), (240, 180), (640, 480), (1279, 799), (400, 790))
PATIENCE_S = 120  # sanitizers take their time
COMPLAINTS = ("Sanitizer", "runtime error:", "unexpected failure", "Assertion")


class Screen:
    def __init__(self, folder):
        number, inner = os.pipe()
        self.server = subprocess.Popen(
            ["Xvfb", "-displayfd", str(inner), "-screen", "0", "1280x800x24", "-noreset", "-nolisten", "tcp"],
            pass_fds=[inner], stderr=subprocess.DEVNULL)
        os.close(inner)
        with os.fdopen(number) as line:
            self.display = ":" + line.readline().strip()
        # A drag's files and a session's settings stay in the folder.
        self.environment = {**os.environ, "DISPLAY": self.display, "HOME": str(folder), "MESA_SHADER_CACHE_DISABLE": "1",
                            "XDG_CONFIG_HOME": str(folder), "XDG_CACHE_HOME": str(folder)}

    def hand(self, *words):
        return subprocess.run(["xdotool", *map(str, words)], env=self.environment, capture_output=True, text=True,
                              timeout=PATIENCE_S).stdout.strip()

    def end(self):
        self.server.terminate()
        self.server.wait()


class Report:
    """Events of the program, read as they come."""

    def __init__(self, path):
        self.path, self.read, self.counts, self.marks = path, 0, {}, {}

    def update(self):
        if not self.path.exists():
            return
        with open(self.path, "rb") as file:
            file.seek(self.read)
            for line in file:
                if not line.endswith(b"\n"):
                    break
                self.read += len(line)
                event = json.loads(line)
                self.counts[event["event"]] = self.counts.get(event["event"], 0) + 1
                if event["event"] == "marks":
                    self.marks = event

    def drawn(self):
        self.update()
        return self.counts.get("drawn", 0)


def somewhere(draw, marks):
    """A place in the window: mostly on a widget, where there is more to happen."""
    places = [m for m in marks.values() if isinstance(m, list) and len(m) == 4]
    if places and draw.random() < 0.7:
        left, top, right, bottom = draw.choice(places)
        return round(draw.uniform(left, right)), round(draw.uniform(top, bottom))
    return draw.randrange(1280), draw.randrange(800)


def next_act(draw, marks):
    """Words for xdotool."""
    kind = draw.choices(("key", "click", "drag", "wheel", "word", "size"), (10, 8, 6, 3, 1, 1))[0]
    if kind == "key":
        return ["key", draw.choice(KEYS)]
    if kind == "word":  # typed into whatever number is asked for
        return ["mousemove", *somewhere(draw, marks), "click", "--repeat", 2, 1, "type", draw.choice(WORDS)]
    if kind == "size":
        return ["size", *draw.choice(SIZES)]
    x, y = somewhere(draw, marks)
    if kind == "wheel":
        return ["mousemove", x, y, "click", "--repeat", draw.randrange(1, 6), draw.choice((4, 5))]
    button = draw.choices((1, 2, 3), (8, 1, 1))[0]
    if kind == "click":
        return ["mousemove", x, y, "click", button]
    held = draw.choice((None, None, "shift", "ctrl"))
    moves = [word for _ in range(draw.randrange(1, 6))
             for word in ("mousemove_relative", "--", draw.randrange(-200, 200), draw.randrange(-200, 200))]
    drag = ["mousemove", x, y, "mousedown", button, *moves, "mouseup", button]
    return ["keydown", held, *drag, "keyup", held] if held else drag


def wait(done, program, patience_s):
    end = time.monotonic() + patience_s
    while not done():
        if program.poll() is not None or time.monotonic() > end:
            return False
        time.sleep(0.01)
    return True


def play(screen, program, report, frames, draw, acts):
    """Why it is not as it should be; "": it is."""
    if not wait(lambda: report.drawn() < 0 or report.counts.get("shown", 0) > 0, program, PATIENCE_S):
        return "no first picture"
    window = screen.hand("search", "--name", "Tenebra").split("\n")[0]
    seen, last = report.drawn(), time.monotonic()
    while seen < frames:
        act = next_act(draw, report.marks)
        acts.append(act)
        screen.hand(*(["windowsize", window, *act[1:]] if act[0] == "size" else act))
        wait(lambda: report.drawn() > seen, program, 0.3)  # beside the window nothing comes of it
        if program.poll() is not None:
            return f"ended with {program.returncode} after {seen} frames"
        if report.drawn() > seen:
            seen, last = report.drawn(), time.monotonic()
        elif time.monotonic() > last + PATIENCE_S:
            return f"draws nothing for {PATIENCE_S} s after {seen} frames"
    screen.hand("mouseup", 1, "mouseup", 2, "mouseup", 3, "keyup", "shift", "keyup", "ctrl")
    program.terminate()  # -15: busy for longer than signals wait
    try:
        code = program.wait(PATIENCE_S)
    except subprocess.TimeoutExpired:
        return "does not end by SIGTERM"
    return "" if code in (0, 143, -15) else f"ended with {code}"


def main(arguments):
    options = []
    if "--" in arguments:
        at = arguments.index("--")
        arguments, options = arguments[:at], arguments[at + 1:]
    if not 3 <= len(arguments) <= 5:
        sys.exit(__doc__)
    frames = int(arguments[3]) if len(arguments) > 3 else 500
    seed = int(arguments[4]) if len(arguments) > 4 else 1
    draw, acts = random.Random(seed), []
    begun = time.monotonic()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        screen, report = Screen(folder), Report(folder / "report.jsonl")
        with open(folder / "errors", "w+", encoding="utf-8", errors="replace") as errors:
            program = subprocess.Popen(
                [os.path.abspath(arguments[1]), "view", os.path.abspath(arguments[2]), "--settings", "none", "--report",
                 str(report.path), "--gl-debug", *options],
                cwd=folder, env=screen.environment, stderr=errors, stdout=subprocess.DEVNULL)
            try:
                wrong = play(screen, program, report, frames, draw, acts)
            finally:
                program.kill()
                program.wait()
                screen.end()
            seen = report.drawn()
            errors.seek(0)
            said = errors.read()
    if not wrong and any(word in said for word in COMPLAINTS):
        wrong = "a complaint"
    print(f"{seen} frames, {len(acts)} acts, seed {seed}, "
          f"{time.monotonic() - begun:.0f} s: {wrong or 'nothing found'}")
    if wrong:
        print(said, "the last acts:", *acts[-20:], sep="\n")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv))
