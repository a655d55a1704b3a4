"""Recorded runs."""

from __future__ import annotations

import hashlib
import itertools
import json
import os
import threading
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Callable, Iterator, Mapping, Optional, Union

from . import _cache, _command
from ._errors import RunError
from ._scene import Scene, SceneLike, as_scene, ron


@dataclass(frozen=True)
class Run:
    """A run that has ended."""

    report: dict[str, Any]
    """The summary of ``nucleus run --json``."""
    frames: list[dict[str, Any]]
    """The figures of each frame."""
    cache: Optional[Path]
    """The cache; ``None`` if nothing was recorded."""
    problems: list[str]
    """What is wrong: failed checks, unresolved contact. Empty if nothing is."""

    @property
    def ok(self) -> bool:
        """Whether nothing is wrong."""
        return not self.problems

    @property
    def checks(self) -> list[dict[str, Any]]:
        """The checks of the scene, with ``passed``, ``figure`` and ``frame``."""
        return self.report["checks"]

    def open(self) -> _cache.Cache:
        """Opens the cache."""
        if self.cache is None:
            raise RunError("the run was not recorded")
        return _cache.open_cache(self.cache)


def problems_of(report: Mapping[str, Any]) -> list[str]:
    """What is wrong with a run, in words."""
    found = [] if report.get("ending") in ("done", "interrupted") else [f"the run ended early: {report.get('ending')}"]
    for check in report.get("checks") or []:
        if check["passed"] is False and check["frame"] is None:
            found.append(f"check {check['check']} failed, no frame was evaluated")
        elif check["passed"] is False:
            found.append(f"check {check['check']} failed with {check['figure']} at frame {check['frame']}")
    return [*found, *(report.get("unresolved_contact") or [])]


@contextmanager
def scene_file(scene: Scene, keep: bool = False) -> Iterator[str]:
    """The path of a scene. A scene in memory is written beside the files that it reads, and removed unless kept."""
    if os.path.isfile(scene.path):
        with open(scene.path, encoding="utf-8") as file:
            if file.read() == scene.text:
                yield scene.path
                return
    path = _written(scene, keep)
    try:
        yield path
    finally:
        if not keep:
            os.unlink(path)


def _written(scene: Scene, keep: bool) -> str:
    """Writes a scene beside the files that it reads, and returns the path."""
    # The name is part of the cache, and equal runs have equal bytes.
    digest = hashlib.sha256(scene.text.encode()).hexdigest()[:12]
    stem = f"{os.path.splitext(scene.path)[0]}.{digest}"
    try:
        return _kept(scene.text, stem) if keep else _own(scene.text, stem)
    except OSError as error:
        folder = os.path.dirname(scene.path) or os.curdir
        why = (
            f"cannot write the scene to the folder `{folder}`: {error.strerror}. A scene that is not a file is written there for "
            "the run, since it reads meshes and maps relative to its file. Copy what it reads to a folder that can be written, "
            "and make the scene with a `path` in it: nucleus.Scene(text, path)"
        )
        raise OSError(error.errno, why) from error


def _own(text: str, stem: str) -> str:
    """Writes a file that no other run uses: one that runs at the same time has the next number in its name."""
    for number in itertools.count(1):
        path = f"{stem}.ron" if number == 1 else f"{stem}.{number}.ron"
        try:
            with open(path, "x", encoding="utf-8") as file:
                file.write(text)
            return path
        except FileExistsError:
            continue
    raise AssertionError("numbers do not end")


def _kept(text: str, stem: str) -> str:
    """Writes the file of a wedge, which has the same name when it is continued. No reader sees half of it."""
    path, part = f"{stem}.wedge.ron", f"{stem}.{os.getpid()}.{threading.get_ident()}.part"
    with open(part, "w", encoding="utf-8") as file:
        file.write(text)
    os.replace(part, path)
    return path


def mapping_of(values: Optional[Mapping[str, Any]], name: str, example: str) -> Mapping[str, Any]:
    """Values by node and attribute; none for ``None``."""
    if values is None:
        return {}
    if not isinstance(values, Mapping):
        raise TypeError(f"`{name}` takes a dict such as {example}, not {type(values).__name__}")
    return values


def option(name: str, value: Any) -> list[str]:
    """An option of the command, left out if it is ``None`` or ``False``."""
    if value is None or value is False:
        return []
    return [name] if value is True else [f"{name}={value}"]


def frame_range(frames: Union[int, tuple[int, int], None]) -> Optional[str]:
    """``48``, or ``10..58`` for ``(10, 58)``."""
    return "..".join(map(str, frames)) if isinstance(frames, tuple) else frames and str(frames)


def run(
    scene: SceneLike,
    frames: Union[int, tuple[int, int], None] = None,
    *,
    out: Union[str, os.PathLike[str], None] = None,
    set: Optional[Mapping[str, Any]] = None,  # noqa: A002 (the name of the option)
    seed: Optional[int] = None,
    start_from: Optional[str] = None,
    record: Optional[str] = None,
    velocities: bool = False,
    checkpoint: Optional[int] = None,
    audit: bool = False,
    threads: Optional[int] = None,
    force: bool = False,
    on_frame: Optional[Callable[[dict[str, Any]], None]] = None,
) -> Run:
    """Simulates a scene and records it as a cache, in a process of its own, with the bits of ``nucleus run``.

    Args:
        scene: A file, a :class:`Scene`, or a dict.
        frames: A count that includes the start frame, or the first and last frame; default: those of the scene.
        out: The cache; default: the name of the scene with ``.mcap``, in the working folder.
        set: Attributes to set, such as ``{"cloth1.bendResistance": 2}``.
        seed: Displaces the start positions at random by up to a thousandth of an edge.
        start_from: Initial state of all cloth: ``drape.mcap@80``.
        record: Times and channels, such as ``"every:10,strain"``; ``"none"`` records nothing.
        velocities: Whether velocities are recorded.
        checkpoint: Frames from one checkpoint to the next.
        audit: Whether every time step is audited by an independent intersection test.
        threads: Threads; the result does not depend on it.
        force: Whether an existing cache is replaced.
        on_frame: Called with the figures of each frame.

    Raises:
        SceneError: with all mistakes of the scene and their places.
        RunError: when the run cannot start, or loses its cache.
        KeyboardInterrupt: after Ctrl-C; the cache is closed, and ``nucleus resume`` continues it.
    """
    figures: list[dict[str, Any]] = []
    summary: dict[str, Any] = {}

    def on_line(line: str) -> None:
        found = json.loads(line)
        if "summary" in found:
            summary.update(found["summary"])
        else:
            figures.append(found)
            if on_frame is not None:
                on_frame(found)

    assignments = mapping_of(set, "set", '{"cloth1.bendResistance": 2}')
    known = as_scene(scene)  # names all mistakes before anything starts
    with scene_file(known) as path:
        default = Path(known.path).stem + ".mcap"
        arguments = ["run", path, "--json", f"--out={os.fspath(out or default)}"]
        for plug, value in assignments.items():
            arguments.append(f"--set={plug}={assigned(value)}")
        options = {"--frames": frame_range(frames), "--seed": seed, "--from": start_from, "--record": record}
        options |= {"--velocities": velocities, "--checkpoint": checkpoint, "--audit": audit}
        for name, value in {**options, "--threads": threads, "--force": force}.items():
            arguments += option(name, value)
        code, messages = _command.call(arguments, on_line)
    if code == 130:
        raise KeyboardInterrupt
    if not summary or summary.get("error"):
        raise RunError(summary.get("error") or error_of(messages), messages)
    cache = summary.get("cache")
    return Run(summary, figures, Path(cache) if cache else None, problems_of(summary))


def assigned(value: Any) -> str:
    """A value of ``set``: texts are in the syntax of scenes already."""
    return value if isinstance(value, str) else ron(value)


def error_of(messages: str) -> str:
    """The error in the messages of the command."""
    lines = [line for line in messages.splitlines() if line.strip()]
    errors = [line for line in lines if line.startswith("error: ")]
    return (errors or lines or ["the command said nothing"])[-1].removeprefix("error: ")
