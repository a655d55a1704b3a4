"""The open Nucleus: Maya's dynamics solver without Maya.

- ``run(scene, frames=48)`` simulates a scene and records a cache, with the bits of the ``nucleus`` command.
- ``open("run.mcap")`` reads a cache: positions as numpy arrays, by object and frame.
- ``Scene`` is a scene as text, with attributes by node and name.
- ``Simulation`` is a run that your code advances frame by frame.
- ``wedge(scene, vary=...)`` does many runs with different values.

Positions have the shape ``(n, 3)``, the type ``float32`` and the units of the scene; ``units`` names these units.
"""

from typing import TYPE_CHECKING, Any

from ._nucleus import __version__

if TYPE_CHECKING:
    from ._cache import Cache
    from ._cache import open_cache as open
    from ._errors import Diagnostic, NucleusError, RunError, SceneError
    from ._run import Run, run
    from ._scene import Node, Raw, Scene
    from ._simulation import Simulation
    from ._wedge import WedgeRun, wedge

_MODULES = {
    "Cache": "_cache",
    "Diagnostic": "_errors",
    "Node": "_scene",
    "NucleusError": "_errors",
    "Raw": "_scene",
    "Run": "_run",
    "RunError": "_errors",
    "Scene": "_scene",
    "SceneError": "_errors",
    "Simulation": "_simulation",
    "WedgeRun": "_wedge",
    "open": "_cache",
    "run": "_run",
    "wedge": "_wedge",
}


def __getattr__(name: str) -> Any:
    """Imports a name when it is first used: the command, which each run of a wedge starts, needs no numpy."""
    if name not in _MODULES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    from importlib import import_module

    module = import_module(f"{__name__}.{_MODULES[name]}")
    found = getattr(module, "open_cache" if name == "open" else name)
    globals()[name] = found
    return found


def __dir__() -> list[str]:
    return sorted(__all__)


__all__ = [
    "Cache",
    "Diagnostic",
    "Node",
    "NucleusError",
    "Raw",
    "Run",
    "RunError",
    "Scene",
    "SceneError",
    "Simulation",
    "WedgeRun",
    "__version__",
    "open",
    "run",
    "wedge",
]
