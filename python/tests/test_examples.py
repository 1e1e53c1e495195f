"""The worked examples run, say what they found, and draw a picture."""
import pathlib
import subprocess
import sys

import pytest

pytest.importorskip("matplotlib")
EXAMPLES = pathlib.Path(__file__).resolve().parents[1] / "examples"


@pytest.mark.parametrize("name, options, said", [
    ("shadow_map_errors", ["--size", "96"], "dark in light"),
    ("sun_hours", ["--step", "60", "--cell", "2"], "3.6 hours of sun on the ground"),
    ("frame_times", ["--frames", "3"], "3 frames: median"),
])
def test_example(name, options, said, tmp_path):
    picture = tmp_path / "picture.png"
    done = subprocess.run([sys.executable, "-B", EXAMPLES / f"{name}.py", *options, "--out", picture], check=True,
                          capture_output=True, text=True)
    assert said in done.stdout
    assert picture.stat().st_size > 5000
