"""Scenes as text, with attributes by node and name."""

from __future__ import annotations

import json
import os
from typing import Any, Iterator, Mapping, Union

from . import _nucleus
from ._errors import Diagnostic, SceneError


class Raw(str):
    """A value in the syntax of scenes, such as ``Raw("keys([(1, 0), (24, 5)])")``."""


def ron(value: Any, is_word: bool = False) -> str:
    """A Python value in the syntax of scenes. Texts are put in quotes, unless they are the words of an enum."""
    if isinstance(value, Raw):
        return str(value)
    if hasattr(value, "tolist"):  # arrays and numbers of numpy
        return ron(value.tolist(), is_word)
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return value if is_word else json.dumps(value, ensure_ascii=False)
    if isinstance(value, int):
        return str(value)
    if isinstance(value, float):
        if value != value or value in (float("inf"), float("-inf")):
            raise ValueError(f"{value} is not a finite number")
        return repr(value)
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(ron(item) for item in value) + "]"
    raise TypeError(f"an attribute takes numbers, texts, lists and arrays, not {type(value).__name__}")


def read_diagnostics(found: list[dict[str, Any]]) -> list[Diagnostic]:
    """Diagnostics from JSON."""
    return [Diagnostic(**one) for one in found]


class Scene:
    """A scene as text.

    ``scene["cloth1"]["bendResistance"] = 2`` changes one value and keeps comments and layout.

    >>> scene = Scene.read("scenes/cloth/tablecloth.ron")  # doctest: +SKIP
    >>> scene["nucleus1"]["windSpeed"]  # doctest: +SKIP
    0.0
    """

    def __init__(self, text: Union[str, Mapping[str, Any]], path: Union[str, os.PathLike[str]] = "scene.ron") -> None:
        """A scene from its text, or from a dict as :meth:`from_dict` takes it.

        ``path`` names the scene in messages; the meshes and maps that it reads are beside it.

        Raises:
            SceneError: with all mistakes and their places.
        """
        self.path = os.fspath(path)
        self.text = text if isinstance(text, str) else _text_of(text)
        self.warnings = self._check()

    @classmethod
    def read(cls, path: Union[str, os.PathLike[str]]) -> Scene:
        """The scene of a file."""
        with open(path, encoding="utf-8") as file:
            return cls(file.read(), path)

    @classmethod
    def from_dict(cls, scene: Mapping[str, Any], path: Union[str, os.PathLike[str]] = "scene.ron") -> Scene:
        """A scene from a dict.

        >>> scene = Scene.from_dict({
        ...     "time": {"start": 1, "end": 24, "fps": 24},
        ...     "nodes": {
        ...         "nucleus1": {"type": "nucleus", "spaceScale": 0.01},
        ...         "sheet": {"type": "polyPlane", "width": 50, "height": 50},
        ...         "cloth1": {"type": "nCloth", "inputMesh": "sheet"},
        ...     },
        ... })
        >>> scene["cloth1"].type
        'nCloth'
        """
        return cls(scene, path)

    def _check(self) -> list[Diagnostic]:
        found = json.loads(_nucleus.check(self.text, self.path))
        diagnostics = read_diagnostics(found["diagnostics"])
        if any(one.severity == "error" for one in diagnostics):
            raise SceneError(diagnostics)
        self._nodes: dict[str, str] = found["nodes"]
        self._time: dict[str, Any] = found["time"]
        return diagnostics

    @property
    def frames(self) -> tuple[int, int]:
        """The first and the last frame."""
        return self._time["start"], self._time["end"]

    @property
    def fps(self) -> float:
        """Frames per second."""
        return self._time["fps"]

    def __getitem__(self, node: str) -> Node:
        if node not in self._nodes:
            raise KeyError(f"the scene has no node `{node}`; it has {', '.join(sorted(self._nodes))}")
        return Node(self, node)

    def __iter__(self) -> Iterator[str]:
        return iter(self._nodes)

    def __len__(self) -> int:
        return len(self._nodes)

    def __contains__(self, node: object) -> bool:
        return node in self._nodes

    def write(self, path: Union[str, os.PathLike[str]]) -> None:
        """Writes the text to a file."""
        with open(path, "w", encoding="utf-8") as file:
            file.write(self.text)

    def _set(self, node: str, attribute: str, value: Any) -> None:
        written = ron(value, _nucleus.takes_word(self._nodes[node], attribute))
        before = self.text
        try:
            self.text = _nucleus.assign(before, self.path, node, attribute, written)
            self.warnings = self._check()
        except ValueError:
            self.text = before
            raise


SceneLike = Union[Scene, Mapping[str, Any], str, "os.PathLike[str]"]
"""A :class:`Scene`, a dict as :meth:`Scene.from_dict` takes it, or the path of a file."""


def as_scene(scene: SceneLike) -> Scene:
    """The scene of a file or of a dict; a :class:`Scene` as it is."""
    if isinstance(scene, Scene):
        return scene
    return Scene.from_dict(scene) if isinstance(scene, Mapping) else Scene.read(scene)


class Node:
    """A node of a scene: attributes by Maya's long or short names."""

    def __init__(self, scene: Scene, name: str) -> None:
        self._scene = scene
        self.name = name

    @property
    def type(self) -> str:
        """The type of the node, such as ``nCloth``."""
        return self._scene._nodes[self.name]

    def __getitem__(self, attribute: str) -> Any:
        """The value at the first frame: what the scene sets, else the default."""
        return self.at(attribute, self._scene.frames[0])

    def at(self, attribute: str, frame: float) -> Any:
        """The value at a frame."""
        return json.loads(_nucleus.value(self._scene.text, self._scene.path, self.name, attribute, frame))

    def __setitem__(self, attribute: str, value: Any) -> None:
        self._scene._set(self.name, attribute, value)

    def __repr__(self) -> str:
        return f"<{self.type} {self.name!r}>"


def _text_of(scene: Mapping[str, Any]) -> str:
    """The text of a scene that is a dict."""
    unknown = set(scene) - {"time", "record", "nodes", "connections", "checks"}
    if unknown:
        known = "time, record, nodes, connections and checks"
        raise ValueError(f"a scene has no {', '.join(sorted(unknown))}; it has {known}")
    time = ", ".join(f"{key}: {ron(value)}" for key, value in scene.get("time", {"start": 1, "end": 24, "fps": 24}).items())
    lines = ["Scene(", f"    time: ({time}),"]
    if "record" in scene:
        lines.append(f"    record: {scene['record']},")
    lines.append("    nodes: {")
    for name, node in scene.get("nodes", {}).items():
        if not isinstance(node, Mapping) or "type" not in node:
            raise ValueError(f"the node {name!r} needs a type, such as {{'type': 'nCloth'}}")
        kind = node["type"]
        settings = ((key, value) for key, value in node.items() if key != "type")
        fields = ", ".join(f"{key}: {ron(value, _nucleus.takes_word(kind, key))}" for key, value in settings)
        lines.append(f"        {ron(name)}: {kind}({fields}),")
    lines.append("    },")
    if "connections" in scene:
        pairs = (f"({ron(output)}, {ron(to)})" for output, to in scene["connections"])
        lines.append(f"    connections: [{', '.join(pairs)}],")
    if "checks" in scene:
        lines.append(f"    checks: [{', '.join(map(str, scene['checks']))}],")
    return "\n".join([*lines, ")", ""])
