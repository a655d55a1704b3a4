"""Many runs with different values."""

from __future__ import annotations

import json
import os
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Iterable, Mapping, Optional, Sequence, Union

from . import _cache, _command
from ._errors import RunError
from ._run import assigned, error_of, frame_range, mapping_of, option, problems_of, scene_file
from ._scene import SceneLike, as_scene


@dataclass(frozen=True)
class WedgeRun:
    """A run of a wedge."""

    name: str
    """The name of its files."""
    values: dict[str, str]
    """Its values by node and attribute, in the syntax of scenes."""
    seed: Optional[int]
    outcome: str
    """``success``, ``problem``, ``failed``, ``interrupted``, ``killed``, or ``open`` if it has not ended."""
    report: Optional[dict[str, Any]]
    """The summary of ``nucleus run --json``."""
    problems: list[str]
    """What is wrong, in words."""
    cache: Optional[Path]

    def open(self) -> _cache.Cache:
        """Opens the cache."""
        if self.cache is None:
            raise RunError(f"run {self.name} has no cache: {'; '.join(self.problems) or self.outcome}")
        return _cache.open_cache(self.cache)


def wedge(
    scene: Optional[SceneLike] = None,
    vary: Optional[Mapping[str, Union[str, Sequence[Any]]]] = None,
    *,
    out: Union[str, os.PathLike[str]],
    samples: Optional[int] = None,
    sampling: Optional[str] = None,
    seeds: Optional[int] = None,
    seed: Optional[int] = None,
    frames: Union[int, tuple[int, int], None] = None,
    record: Optional[str] = None,
    jobs: Optional[int] = None,
    threads: Optional[int] = None,
    resume: bool = False,
    options: Sequence[str] = (),
) -> list[WedgeRun]:
    """Runs a scene with different values, several runs at once, each in a process of its own.

    Args:
        scene: A file; or a :class:`Scene` or a dict, which is kept as a file beside those that it reads; not needed with ``resume``.
        vary: Values by node and attribute: a list, or a text such as ``"0..20/5"`` or ``"0.1..10:log"``.
        out: The folder of the wedge.
        samples: Samples of intervals such as ``"0..1"``.
        sampling: ``"latin"`` (default) or ``"random"``.
        seeds: Repeats every run with this many seeds.
        seed: The first seed.
        frames: Frames of each run.
        record: Times and channels to record.
        jobs: Runs at once; default: as many as cores and memory allow.
        threads: Threads of each run.
        resume: Whether the plan of ``out`` is continued.
        options: Further options of ``nucleus wedge``, such as ``["--on=slurm", "--partition=night"]``.

    Returns:
        All runs of the plan, also those that failed; :attr:`WedgeRun.problems` says why.

    Raises:
        RunError: when the plan is refused; nothing has started then.
        KeyboardInterrupt: after Ctrl-C; ``resume=True`` continues.
    """
    arguments = ["wedge", f"--out={os.fspath(out)}"]
    for plug, values in mapping_of(vary, "vary", '{"cloth1.bendResistance": [1, 2]}').items():
        arguments.append(f"--vary={plug}={_varied(plug, values)}")
    named = {"--samples": samples, "--sampling": sampling, "--seeds": seeds, "--seed": seed}
    named |= {"--frames": frame_range(frames), "--record": record, "--jobs": jobs, "--threads": threads}
    for name, value in {**named, "--continue": resume}.items():
        arguments += option(name, value)
    arguments += options
    if scene is None:
        code, messages = _command.call(arguments)
    else:
        # Each run reads the file, also when the wedge is continued.
        with scene_file(as_scene(scene), keep=True) as path:
            code, messages = _command.call([*arguments, path])
    if code == 130:
        raise KeyboardInterrupt
    if code not in (0, 1):
        raise RunError(error_of(messages), messages)
    return read_wedge(out)


def _varied(plug: str, values: Union[str, Sequence[Any]]) -> str:
    """The values of an attribute in the syntax of the command."""
    if isinstance(values, str):
        return values
    # An array of numpy without dimensions has `__iter__`, but no elements.
    if not isinstance(values, Iterable) or getattr(values, "shape", None) == ():
        kind = type(values).__name__
        raise TypeError(f'`{plug}` takes a list of values, or a text such as "0..20/5", not {kind}')
    return ",".join(assigned(value) for value in values)


def read_wedge(out: Union[str, os.PathLike[str]]) -> list[WedgeRun]:
    """The runs of a folder, with their results so far."""
    folder = Path(out)
    plan = json.loads((folder / "plan.json").read_text(encoding="utf-8"))
    return [_run_of(folder, plan["columns"], run) for run in plan["runs"]]


def _run_of(folder: Path, columns: list[str], run: dict[str, Any]) -> WedgeRun:
    name, result = run["name"], {}
    path = folder / "results" / f"{name}.json"
    if path.exists():
        result = json.loads(path.read_text(encoding="utf-8"))
    report = (result.get("report") or {}).get("summary")
    problems = [result["error"]] if result.get("error") else problems_of(report) if report else []
    cache = folder / "runs" / f"{name}.mcap"
    return WedgeRun(
        name,
        dict(zip(columns, run["values"])),
        run.get("seed"),
        result.get("outcome", "open"),
        report,
        problems,
        cache if cache.exists() else None,
    )
