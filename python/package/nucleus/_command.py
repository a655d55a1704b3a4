"""The ``nucleus`` command as a child process."""

from __future__ import annotations

import subprocess
import sys
import threading
from typing import Callable, Optional, Sequence

COMMAND = [sys.executable, "-m", "nucleus"]
"""The command of this package."""


def call(arguments: Sequence[str], on_line: Optional[Callable[[str], None]] = None) -> tuple[int, str]:
    """Runs the command. ``on_line`` receives each line of its output. Returns the exit code and its messages.

    A run that Python is asked to end with Ctrl-C closes its cache first.
    """
    child = subprocess.Popen(
        [*COMMAND, *arguments],
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        encoding="utf-8",
        # Ctrl-C in a terminal reaches Python alone, which passes it on once.
        start_new_session=True,
    )
    messages: list[str] = []
    reader = threading.Thread(target=lambda: messages.append(child.stderr.read()), daemon=True)
    reader.start()
    try:
        for line in child.stdout:
            if on_line is not None:
                on_line(line)
        code = child.wait()
    except BaseException:
        # The command takes it as a first Ctrl-C.
        child.terminate()
        child.stdout.read()
        child.wait()
        raise
    finally:
        reader.join()
    return code, "".join(messages)
