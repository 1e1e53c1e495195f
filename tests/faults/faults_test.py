#!/usr/bin/env python3
"""Lets one call of the system or of the allocator fail, then the next one, until none fails any more.

usage: faults_test.py calls|memory PROGRAM LIBRARY [STEP]      (STEP n: every n-th call; exit code 1 if anything is wrong)

calls: opening, reading, writing (no room, half of the bytes, an interruption), flushing, closing, renaming, mapping and
new threads. After each failure: every picture and mask is whole or absent, the log holds whole rows, no temporary file is
left, the exit code is as docs/farm.md says, and the sentence names the file and the reason. Then the render is resumed,
and has the bytes of one that nothing happened to.

memory: each method, and convert, where one allocation fails, or it and all that follow: the program ends with a sentence,
and what it has written is whole.

LIBRARY is failing_calls.cpp of this folder, built.
"""
import errno
import os
import pathlib
import signal
import subprocess
import sys
import tempfile

import small_scene

FRAMES = 4
PATIENCE_S = 60
RETRY, FAILED, COMPARISON = 75, 1, 2
NONE = 0

# What fails, with which error, and whether the program is to go on as if nothing were.
CALLS = [("open", errno.EIO, False), ("read", errno.EIO, False), ("read", errno.EINTR, True),
         ("write", errno.ENOSPC, False), ("write", "short", False), ("write", "once", True),
         ("write", errno.EINTR, True), ("fsync", errno.EIO, False), ("ftruncate", errno.EIO, False),
         ("close", errno.EIO, False), ("rename", errno.EIO, False), ("mmap", errno.ENOMEM, False),
         ("thread", errno.EAGAIN, False)]

METHODS = {
    "hard": [], "cone tree": ["--paper", "variant=PreciseSEATP"], "none": ["--shadows", "none", "--antialias", "1"],
    "soft": ["--shadows", "soft", "--light-size", "4%"],
    "bsp": ["--shadows", "soft", "--light-size", "4%", "--paper", "soft-solver=bsp"],
    "clip": ["--shadows", "soft", "--light-size", "4%", "--paper", "soft-solver=clip"],
    "soft error": ["--shadows", "soft", "--light-size", "4%", "--soft-error", "4"],
    "adaptive": ["--ao", "adaptive"], "field": ["--ao", "field", "--ao-rays", "4", "--paper", "ao-downscale=2"],
}


class Place:
    """A folder with the scene, and what a run makes beside it."""

    def __init__(self, root, program, library):
        self.root, self.program, self.library = root, program, library
        self.scene = small_scene.write_scene(root)
        self.out, self.note = root / "out", root / "note"

    def render(self, *more):
        out = self.out
        masks = [] if "none" in more else ["--mask", f"{out}/m%04d.png"]
        return [self.program, "render", str(self.scene), "--frames", "all", "--size", "24x18", "--raster", "cpu",
                "-o", f"{out}/p%04d.png", "--log", f"{out}/frames.csv", "--trace", f"{out}/trace.json",
                "--ao-cache", f"{out}/cache", "--quiet", *masks, *more]

    def run(self, command, call="none", at=0, error=NONE, on="call"):
        """Runs it with that fault; what happened, and the file whose call failed ("": none has one; None: none did)."""
        self.out.mkdir(exist_ok=True)
        self.note.unlink(missing_ok=True)
        environment = dict(os.environ, LD_PRELOAD=self.library, FAIL_CALL=call, FAIL_AT=str(at),
                           FAIL_WITH=str(error), FAIL_ON=on, FAIL_UNDER=str(self.root), FAIL_NOTE=str(self.note))
        done = subprocess.run(command, env=environment, capture_output=True, timeout=PATIENCE_S)
        return done, self.note.read_text(errors="replace") if self.note.exists() else None

    def clear(self):
        subprocess.run(["rm", "-rf", str(self.out)], check=True)

    def outputs(self):
        return {file.name: file.read_bytes() for file in self.out.glob("*.png")}


def check_log(log):
    if not log.exists():
        return 0
    text = log.read_text()
    assert text == "" or text.endswith("\n"), f"{log} ends within a line"
    lines = [line for line in text.splitlines() if not line.startswith("#")]
    assert all(line.count(",") == lines[0].count(",") for line in lines), f"{log} has rows of several lengths"
    return max(0, len(lines) - 1)


def check_whole(place, whole):
    for name, data in place.outputs().items():
        assert data == whole[name], f"{name} is not what one run makes"
    check_log(place.out / "frames.csv")


def check_no_temporaries(place):
    left = [file.name for file in place.out.rglob(".tenebra-*")]
    assert not left, f"temporary files are left: {left}"


def check_ends(done):
    """One sentence, and a code that docs/farm.md lists."""
    assert done.returncode in (0, FAILED, COMPARISON, RETRY), f"exit code {done.returncode}: {done.stderr}"
    if done.returncode != 0:
        lines = done.stderr.decode().splitlines()
        assert sum(line.startswith("tenebra: ") for line in lines) == 1, f"found {lines}, expected one sentence"
    return done.stderr.decode()


def check_sentence(sentence, file, error):
    reason = os.strerror(error if isinstance(error, int) else errno.ENOSPC)
    assert reason in sentence, f"'{sentence}' does not give the reason, {reason}"
    name = pathlib.Path(file).name
    # What a temporary file was to become is not known here: another name of the folder will do.
    known = pathlib.Path(file).parent.name if name.startswith(".tenebra-") else name
    assert known in sentence, f"'{sentence}' does not name {file}"


def check_complete(place, whole):
    outputs = place.outputs()
    assert outputs == whole, f"resumed: {sorted(set(whole) ^ set(outputs)) or 'other bytes'}"
    assert check_log(place.out / "frames.csv") >= FRAMES, "resumed: the log lacks frames"
    check_no_temporaries(place)


def is_input(place, file):
    return pathlib.Path(file).parent == place.root


def check_call(place, command, whole, fault, at):
    """False if there is no such call any more."""
    call, error, goes_on = fault
    place.clear()
    done, file = place.run(command, call, at, error)
    if file is None:
        return False
    sentence = check_ends(done)
    check_whole(place, whole)
    check_no_temporaries(place)
    if goes_on:
        assert done.returncode == 0, f"exit code {done.returncode}: {sentence}"
    elif done.returncode == 0:
        assert place.outputs() == whole, "an output is missing, and the exit code is 0"
    elif file:
        check_sentence(sentence, file, error)
        assert not is_input(place, file) or done.returncode == FAILED, f"an input failed with {done.returncode}"
    resumed, _ = place.run(command)
    assert resumed.returncode == 0, f"resumed: exit code {resumed.returncode}: {resumed.stderr}"
    check_complete(place, whole)
    return True


def first_to_fail(call, program):
    """1; but oneTBB 2022.1 (libtbb.so.12.15) waits for itself without end if the first mapping, which it makes while it
    starts, fails. 2021.8 (libtbb.so.12.8) does not; the program starts it before it bounds the memory."""
    if call != "mmap":
        return 1
    libraries = subprocess.run(["ldd", program], capture_output=True, text=True, check=True).stdout
    tbb = next(line.split()[2] for line in libraries.splitlines() if "libtbb.so" in line)
    if int(os.path.realpath(tbb).rsplit(".", 1)[1]) < 15:
        return 1
    print(f"mmap 1: not made to fail, {os.path.realpath(tbb)} cannot start without it")
    return 2


def until_none_fails(check, following, first=1):
    """Lets the first call fail, then following(first) and so on, until check(at) finds that there is none so far. How
    many were made to fail, and those of them that went wrong, with why."""
    at, made, failures = first, 0, []
    while True:
        try:
            if not check(at):
                return made, failures
        except (AssertionError, subprocess.TimeoutExpired) as failure:
            failures.append((at, failure))
        made += 1
        at = following(at)


def test_calls(place, step):
    command = place.render("--ao", "adaptive", "--resume")
    place.run(command)
    whole = place.outputs()
    assert len(whole) >= 2 * FRAMES
    wrong, counts = 0, {}
    for fault in CALLS:
        made, failures = until_none_fails(lambda at: check_call(place, command, whole, fault, at), lambda at: at + step,
                                          first_to_fail(fault[0], place.program))
        for at, failure in failures:
            print(f"{fault[0]} {at} ({fault[1]}): {failure}", flush=True)
        wrong += len(failures)
        counts[fault[0]] = counts.get(fault[0], 0) + made
    print(f"calls made to fail: {counts}; {wrong} wrong")
    return wrong + sum(fault[0] not in counts for fault in CALLS)


def commands_of(place):
    commands = {name: place.render(*more) for name, more in METHODS.items()}
    commands["convert"] = [place.program, "convert", str(place.scene), f"{place.out}/scene.glb", "--quiet"]
    return commands


def check_allocation(place, command, whole, at, on):
    place.clear()
    done, failed = place.run(command, "memory", at, errno.ENOMEM, on)
    if failed is None:
        return False
    check_ends(done)
    if on == "call":
        check_no_temporaries(place)
    for name, data in place.outputs().items():
        assert data == whole.get(name), f"{name} is not what one run makes"
    check_log(place.out / "frames.csv")
    return True


def check_limit(place):
    """--memory: a sentence and 1 where it is too little; the same bytes where it is enough."""
    place.clear()
    done, _ = place.run(place.render("--memory", "8"))
    assert done.returncode == FAILED and "not enough memory, 8 MB" in check_ends(done), f"--memory 8: {done}"
    assert not place.outputs(), "--memory 8: there are pictures"
    place.run(place.render())
    whole = place.outputs()
    place.clear()
    done, _ = place.run(place.render("--memory", "4000"))
    assert done.returncode == 0 and place.outputs() == whole, f"--memory 4000: {done}"


def test_memory(place, step):
    """Every STEP-th of the first allocations, later ones farther and farther apart."""
    check_limit(place)
    wrong, count = 0, 0
    for name, command in commands_of(place).items():
        place.clear()
        place.run(command)
        whole = place.outputs()
        for on in ("call", "all"):
            made, failures = until_none_fails(lambda at: check_allocation(place, command, whole, at, on),
                                              lambda at: at + max(step, at * step // 2000))
            for at, failure in failures:
                print(f"{name}, allocation {at} ({on}): {failure}", flush=True)
            wrong += len(failures)
            count += made
    print(f"allocations made to fail: {count}; {wrong} wrong")
    return wrong


def main():
    which, program, library = sys.argv[1:4]
    step = int(sys.argv[4]) if len(sys.argv) > 4 else 1
    with tempfile.TemporaryDirectory(dir="/dev/shm" if os.access("/dev/shm", os.W_OK) else None) as root:
        place = Place(pathlib.Path(root).resolve(), str(pathlib.Path(program).resolve()),
                      str(pathlib.Path(library).resolve(strict=True)))
        wrong = {"calls": test_calls, "memory": test_memory}[which](place, step)
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()
