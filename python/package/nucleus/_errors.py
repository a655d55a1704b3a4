"""Exceptions of the package."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Optional, Sequence


@dataclass(frozen=True)
class Diagnostic:
    """An error or a warning about a place in a scene."""

    severity: str
    """``error`` or ``warning``."""
    message: str
    file: str
    line: int
    """The line, from 1."""
    column: int
    """The column, from 1."""
    help: Optional[str]
    """How to fix it."""

    def __str__(self) -> str:
        text = f"{self.file}:{self.line}:{self.column}: {self.severity}: {self.message}"
        return f"{text} ({self.help})" if self.help else text


class NucleusError(Exception):
    """Something that Nucleus refuses."""


class SceneError(NucleusError, ValueError):
    """A scene has errors. ``diagnostics`` holds all of them with their places, and warnings."""

    def __init__(self, diagnostics: Sequence[Diagnostic]) -> None:
        self.diagnostics = list(diagnostics)
        errors = [one for one in self.diagnostics if one.severity == "error"]
        super().__init__("\n".join(map(str, errors or self.diagnostics)))

    def __reduce__(self) -> tuple[Any, ...]:
        # An exception is rebuilt from its text by default, and this one takes diagnostics.
        return type(self), (self.diagnostics,)


class RunError(NucleusError, RuntimeError):
    """A run could not start, or lost its cache. ``messages`` is what the command said."""

    def __init__(self, message: str, messages: str = "") -> None:
        self.messages = messages
        super().__init__(message)
