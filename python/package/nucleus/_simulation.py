"""A run that Python advances frame by frame."""

from __future__ import annotations

import json
import os
from typing import Any, Iterator, Optional

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _nucleus, _units
from ._errors import NucleusError
from ._scene import SceneLike, as_scene


def faces_of(parts: tuple[bytes, bytes]) -> tuple[NDArray[np.uint32], NDArray[np.uint32]]:
    """Corner counts and corners as arrays."""
    counts, corners = (np.frombuffer(part, dtype=np.uint32) for part in parts)
    return counts, corners


class Simulation:
    """A run of a scene, at one of its frames.

    The interpreter lock is released while a frame is solved. Ctrl-C ends the frame that is being solved.

    The scene is read once: values that are set in it later have no effect on this simulation. Values that change with time
    are keys or expressions of the scene. To go on with other values, :meth:`restore` the state in a simulation of the changed
    scene.

    >>> simulation = Simulation("scenes/cloth/tablecloth.ron")  # doctest: +SKIP
    >>> for report in simulation:  # doctest: +SKIP
    ...     print(simulation.frame, simulation.positions("tablecloth")[:, 1].min())
    """

    def __init__(
        self,
        scene: SceneLike,
        *,
        threads: Optional[int] = None,
    ) -> None:
        """A run at its start frame. ``threads`` does not change the result; the default is one per core."""
        self.scene = as_scene(scene)
        if threads is not None and threads < 1:
            raise ValueError(f"a simulation needs at least one thread, not {threads}")
        self._run = _nucleus.Simulation(self.scene.text, self.scene.path, threads or os.cpu_count() or 1)
        self._facts: dict[str, Any] = json.loads(self._run.facts())

    @property
    def frame(self) -> int:
        """The current frame."""
        return self._run.frame

    @property
    def is_done(self) -> bool:
        """Whether the last frame of the scene has been reached. It is no limit."""
        return self._run.is_done

    @property
    def units_per_metre(self) -> float:
        """Scene units per metre; positions are in scene units."""
        return self._facts["units_per_metre"]

    @property
    def units(self) -> str:
        """The unit of positions, such as ``cm``. Velocities are in this unit per second."""
        return _units.name(self.units_per_metre)

    @property
    def objects(self) -> dict[str, dict[str, Any]]:
        """All objects by name, with their kind (``cloth``, ``particles``, ``collider``) and number of points."""
        return {one["name"]: {"kind": one["kind"], "points": one["points"]} for one in self._facts["objects"]}

    @property
    def checks(self) -> list[dict[str, Any]]:
        """The checks of the scene over all frames solved so far: ``check``, ``passed``, ``figure`` and ``frame``.

        A check that names a frame has ``passed`` false until that frame is reached. :meth:`restore` does not undo it.
        """
        return json.loads(self._run.checks())

    def step(self) -> dict[str, Any]:
        """Solves the next frame and returns its report, with the figures of ``nucleus run --json``.

        Raises:
            KeyboardInterrupt: after Ctrl-C. The frame is then incomplete; :meth:`restore` a saved state to go on.
        """
        return json.loads(self._run.advance())

    def __iter__(self) -> Iterator[dict[str, Any]]:
        """Steps to the last frame and yields the report of each."""
        while not self.is_done:
            yield self.step()

    def positions(self, name: str) -> NDArray[np.float32]:
        """Positions of an object now, in scene units, as a read-only array of shape ``(n, 3)``.

        The array refers to memory of the solver's side without a copy. It stays as it is when the simulation goes on: the
        next frame is written into other memory.
        """
        return np.asarray(self._run.positions(name))

    def velocities(self, name: str) -> NDArray[np.float32]:
        """Velocities of cloth or particles in scene units per second; an array like that of :meth:`positions`."""
        return np.asarray(self._run.velocities(name))

    def faces(self, name: str) -> tuple[NDArray[np.uint32], NDArray[np.uint32]]:
        """The faces of an object: the number of corners of each face, and the points of all corners."""
        return faces_of(self._run.faces(name))

    def move_collider(self, name: str, positions: ArrayLike) -> None:
        """Moves a collider to these positions, in scene units, during the next frame.

        Without it a collider moves as the scene says. Its points move in straight lines, and contact sees the motion.

        Raises:
            TypeError: when the positions are not numbers.
            ValueError: when the shape is not ``(n, 3)`` with one row per point, or a number is not finite or beyond 1e12 m.
            RuntimeError: when the last frame was interrupted.
        """
        array = np.asarray(positions)
        if array.dtype.kind not in "fiu":
            raise TypeError(f"positions are numbers, not {array.dtype}")
        if array.ndim != 2 or array.shape[1] != 3:
            raise ValueError(f"positions of `{name}` have the shape (n, 3), not {array.shape}")
        self._run.move_collider(name, np.ascontiguousarray(array, dtype=np.float64).tobytes())

    def save(self) -> bytes:
        """The state as bytes, to continue later with the same bits.

        Raises:
            RuntimeError: when the last frame was interrupted, or :meth:`move_collider` waits for the next frame.
        """
        return self._run.save()

    def restore(self, state: bytes) -> None:
        """Continues from a state of the same scene, or of one with the same objects and other values.

        The state holds positions and velocities. Gravity, friction and all other attributes are those of this simulation.

        Raises:
            NucleusError: when the state is damaged, of another version, or of objects with other meshes or masses.
        """
        try:
            self._run.restore(state)
        except ValueError as error:
            raise NucleusError(str(error)) from None
