"""The examples, each in a process of its own as a reader would run it."""

import importlib.util
import pathlib
import subprocess
import sys

import numpy as np

import nucleus

EXAMPLES = pathlib.Path(__file__).parents[1] / "examples"


def example(name):
    """An example as a module."""
    spec = importlib.util.spec_from_file_location(name, EXAMPLES / f"{name}.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_a_drape_is_plotted(folder):
    said = subprocess.run(
        [sys.executable, EXAMPLES / "drape.py", "drape.png"], check=True, capture_output=True, text=True
    ).stdout
    assert said.startswith("frame 36: mean height ") and (folder / "drape.png").stat().st_size > 10_000


def test_a_fit_finds_the_bend_resistance_of_a_measured_sag(folder):
    fit = example("fit")
    soft, stiff = fit.sag(1.0), fit.sag(20.0)
    assert soft > stiff > 0, "a stiffer strip hangs less"
    measured = fit.sag(6.0)
    resistance, reached = fit.fit(measured)
    assert abs(reached - measured) < 0.02 * (soft - stiff)
    assert abs(resistance / 6.0 - 1) < 0.1


def test_a_cache_is_read_without_the_package(folder):
    cache = nucleus.run("drape.ron", frames=5, velocities=True).open()
    source = (EXAMPLES / "read_mcap.py").read_text()
    assert "import nucleus" not in source
    frames = example("read_mcap").read("drape.mcap", "cloth1")
    assert sorted(frames) == [1, 2, 3, 4, 5]
    for frame, points in frames.items():
        assert np.array_equal(points, cache.positions("cloth1", frame))
