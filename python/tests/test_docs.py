"""The documentation: its blocks of Python run as they are printed."""

import pathlib
import re
import shutil

import numpy as np
import pytest

import nucleus

ROOT = pathlib.Path(__file__).parents[2]
BLOCKS = re.findall(r"^```python\n(.*?)^```", (ROOT / "docs/python.md").read_text(encoding="utf-8"), re.DOTALL | re.MULTILINE)


@pytest.fixture
def scenes(tmp_path, monkeypatch):
    """A working folder with the scenes of the blocks, where the caches of runs are written."""
    shutil.copytree(ROOT / "scenes/cookbook", tmp_path / "scenes/cookbook")
    monkeypatch.chdir(tmp_path)


def test_the_first_block_prints_a_run_without_problems(scenes, capsys):
    names = {}
    exec(BLOCKS[0], names)
    assert capsys.readouterr().out.startswith("True ")
    assert (names["positions"].shape, names["positions"].dtype) == ((961, 3), np.float32)


@pytest.mark.parametrize("block", range(1, len(BLOCKS)))
def test_a_block_runs(scenes, block):
    exec(BLOCKS[block], {"nucleus": nucleus})


def test_a_state_continues_with_the_values_of_another_scene(scenes):
    names = {"nucleus": nucleus}
    (block,) = (block for block in BLOCKS if "restore" in block)
    exec(block, names)
    names["before"].step()
    falls, floats = (names[name].velocities("sheet")[:, 1].mean() for name in ("before", "after"))
    assert falls < 1.5 * floats < 0
