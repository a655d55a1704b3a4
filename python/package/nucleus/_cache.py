"""Reading caches."""

from __future__ import annotations

import json
import os
from typing import Any, Optional, Union

import numpy as np
from numpy.typing import NDArray

from . import _nucleus, _units
from ._simulation import faces_of


class Cache:
    """A cache of a run.

    >>> cache = open_cache("tablecloth.mcap")  # doctest: +SKIP
    >>> cache.positions("tablecloth", frame=10).shape  # doctest: +SKIP
    (7225, 3)
    """

    def __init__(self, path: Union[str, os.PathLike[str]]) -> None:
        """Opens a cache, also the unfinished one of a run that is still going (``.mcap.part``).

        Raises:
            OSError: when it cannot be read.
        """
        self.path = os.fsdecode(path)
        self._cache = _nucleus.Playback(self.path)
        self._facts: dict[str, Any] = json.loads(self._cache.facts())

    @property
    def frames(self) -> list[int]:
        """The recorded frames."""
        return self._facts["frames"]

    @property
    def fps(self) -> float:
        """Frames per second."""
        return self._facts["fps"]

    @property
    def units_per_metre(self) -> float:
        """Scene units per metre."""
        return self._facts["units_per_metre"]

    @property
    def units(self) -> str:
        """The unit of positions, such as ``cm``."""
        return _units.name(self.units_per_metre)

    @property
    def objects(self) -> dict[str, dict[str, Any]]:
        """All objects by name, with their kind and number of points."""
        return {one["name"]: {"kind": one["kind"], "points": one["points"]} for one in self._facts["objects"]}

    @property
    def scene(self) -> str:
        """The text of the scene as it was run."""
        return self._facts["scene"]

    @property
    def metadata(self) -> dict[str, str]:
        """Further facts about the run, such as ``set`` and ``seed``."""
        return self._facts["extra"]

    @property
    def is_intact(self) -> bool:
        """Whether nothing is lost; ``corruption`` says what is."""
        return self._facts["is_intact"]

    @property
    def corruption(self) -> str:
        """What is lost, in words."""
        return self._facts["corruption"]

    def positions(self, name: str, frame: Optional[int] = None) -> NDArray[np.float32]:
        """Positions of an object at the end of a frame, ``(n, 3)`` in scene units; of the last frame without one.

        Raises:
            KeyError: when there is no such object or frame.
            OSError: when the frame is damaged.
        """
        return np.asarray(self._cache.positions(name, frame))

    def velocities(self, name: str, frame: Optional[int] = None) -> NDArray[np.float32]:
        """Velocities in scene units per second, where they are recorded (``run(..., velocities=True)``)."""
        return np.asarray(self._cache.velocities(name, frame))

    def strain(self, name: str, frame: Optional[int] = None) -> NDArray[np.float32]:
        """Strain at each point, where it is recorded (``run(..., record="strain")``)."""
        return np.frombuffer(self._cache.strain(name, frame), dtype=np.float32)

    def particles(self, name: str, frame: Optional[int] = None) -> NDArray[np.void]:
        """``id``, ``age`` and ``lifespan`` in seconds and ``mass`` in kilograms of each particle, in the order of the positions;
        none where no particle is born or dies, so that their order does not change."""
        fields = [("id", np.uint64), ("age", np.float64), ("lifespan", np.float64), ("mass", np.float64)]
        return np.frombuffer(self._cache.particles(name, frame), dtype=fields)

    def faces(self, name: str) -> tuple[NDArray[np.uint32], NDArray[np.uint32]]:
        """The faces of an object: the number of corners of each face, and the points of all corners."""
        return faces_of(self._cache.faces(name))

    @property
    def reports(self) -> list[dict[str, Any]]:
        """The figures of each frame."""
        return json.loads(self._cache.reports())


def open_cache(path: Union[str, os.PathLike[str]]) -> Cache:
    """Opens a cache; see :class:`Cache`."""
    return Cache(path)
