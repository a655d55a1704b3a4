"""Scenes as text, with attributes by node and name."""

from __future__ import annotations

import json
import os
from typing import Any, Iterator, Mapping, Sequence, Union

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
        self.path = os.fsdecode(path)
        self.text = text if isinstance(text, str) else _text_of(text)
        self.warnings = self._check()

    @classmethod
    def read(cls, path: Union[str, os.PathLike[str]]) -> Scene:
        """The scene of a file.

        Raises:
            OSError: when it cannot be read.
            ValueError: when it is not text.
            SceneError: with all mistakes and their places.
        """
        path = os.fsdecode(path)  # a number would be taken for an open file
        try:
            with open(path, encoding="utf-8") as file:
                text = file.read()
        except UnicodeDecodeError:
            raise ValueError(f"`{path}` is not a scene: it is not UTF-8 text. `nucleus.open` opens caches") from None
        return cls(text, path)

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
    if isinstance(scene, Mapping):
        return Scene.from_dict(scene)
    if not isinstance(scene, (str, os.PathLike)):
        raise TypeError(f"a scene is a path, a nucleus.Scene or a dict, not {type(scene).__name__}")
    return Scene.read(scene)


class Node:
    """A node of a scene: attributes by Maya's long or short names.

    ``dict(node)`` holds the values of all attributes at the first frame.
    """

    def __init__(self, scene: Scene, name: str) -> None:
        self._scene = scene
        self.name = name

    @property
    def type(self) -> str:
        """The type of the node, such as ``nCloth``."""
        return self._scene._nodes[self.name]

    def keys(self) -> list[str]:
        """The names of all attributes."""
        return _nucleus.attributes(self.type)

    def __iter__(self) -> Iterator[str]:
        return iter(self.keys())

    def __contains__(self, attribute: str) -> bool:
        try:  # short names and parts such as `translateY` too
            self[attribute]
        except KeyError:
            return False
        return True

    def __getitem__(self, attribute: str) -> Any:
        """The value at the first frame: what the scene sets, else the default."""
        return self.at(attribute, self._scene.frames[0])

    def at(self, attribute: str, frame: float) -> Any:
        """The value at a frame."""
        _check_name(attribute)
        return json.loads(_nucleus.value(self._scene.text, self._scene.path, self.name, attribute, frame))

    def __setitem__(self, attribute: str, value: Any) -> None:
        _check_name(attribute)
        self._scene._set(self.name, attribute, value)

    def __repr__(self) -> str:
        return f"<{self.type} {self.name!r}>"


def _check_name(attribute: Any) -> None:
    """Refuses what is not the name of an attribute."""
    if not isinstance(attribute, str):
        raise TypeError(f"the name of an attribute is a text, not {type(attribute).__name__}")


def _part(scene: Mapping[str, Any], name: str, default: Any, kind: Any, words: str) -> Any:
    """A part of a scene that is a dict, of the type that it must have."""
    part = scene.get(name, default)
    if not isinstance(part, kind):
        raise TypeError(f"`{name}` of a scene is {words}, not {type(part).__name__}")
    return part


def _text_of(scene: Mapping[str, Any]) -> str:
    """The text of a scene that is a dict."""
    if not isinstance(scene, Mapping):
        raise TypeError(f"a scene is made from its text or a dict, not {type(scene).__name__}")
    unknown = [str(name) for name in scene if name not in ("time", "record", "nodes", "connections", "checks")]
    if unknown:
        known = "time, record, nodes, connections and checks"
        raise ValueError(f"a scene has no {', '.join(sorted(unknown))}; it has {known}")
    period = _part(scene, "time", {"start": 1, "end": 24, "fps": 24}, Mapping, "a dict of start, end and fps")
    time = ", ".join(f"{key}: {ron(value)}" for key, value in period.items())
    lines = ["Scene(", f"    time: ({time}),"]
    if "record" in scene:
        lines.append(f"    record: {scene['record']},")
    nodes = _part(scene, "nodes", {}, Mapping, "a dict of nodes by name")
    lines += ["    nodes: {", *(f"        {_node_text(name, node)}," for name, node in nodes.items()), "    },"]
    if "connections" in scene:
        pairs = _part(scene, "connections", [], (list, tuple), "a list of pairs of plugs")
        lines.append(f"    connections: [{', '.join(map(_connection_text, pairs))}],")
    if "checks" in scene:
        checks = _part(scene, "checks", [], (list, tuple), "a list of checks")
        lines.append(f"    checks: [{', '.join(map(str, checks))}],")
    return "\n".join([*lines, ")", ""])


def _node_text(name: str, node: Mapping[str, Any]) -> str:
    """A node by its name, in the syntax of scenes."""
    if not isinstance(name, str):
        raise TypeError(f"the name of a node is a text, not {type(name).__name__}")
    if not isinstance(node, Mapping) or not isinstance(node.get("type"), str):
        raise ValueError(f"the node {name!r} needs a type, such as {{'type': 'nCloth'}}")
    kind, fields = node["type"], []
    for key, value in node.items():
        _check_name(key)
        if key != "type":
            fields.append(f"{key}: {ron(value, _nucleus.takes_word(kind, key))}")
    return f"{ron(name)}: {kind}({', '.join(fields)})"


def _connection_text(pair: Sequence[str]) -> str:
    """A connection, in the syntax of scenes."""
    if not isinstance(pair, (list, tuple)) or len(pair) != 2:
        raise TypeError(f"a connection is a pair of plugs, such as ('lift.translateY', 'cloth1.friction'), not {pair!r}")
    return f"({ron(pair[0])}, {ron(pair[1])})"
