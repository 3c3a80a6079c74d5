"""SVG → PNG in a process of its own, so that a picture can neither stop this one nor take its memory.

resvg draws with the interpreter's lock held and cannot be interrupted. A new interpreter (`svg_worker`) starts in 30
ms, imports only resvg, and is killed when its time is up. A fork of this process would not work: it has threads.
"""

from __future__ import annotations

import math
import re
import signal
import subprocess
import sys
from pathlib import Path
from types import ModuleType
from typing import Any

from thymio_sim_ros.errors import ThymioSimError
from thymio_sim_ros.sim.formats import svg_worker

__all__ = ["MAX_MEMORY", "MAX_SECONDS", "DrawError", "draw"]

MAX_SECONDS = 2.0
"""Processor time of all SVG pictures of a playground together, the start of their processes included.

Processor time, so that a picture that is drawn alone is also drawn while the computer is busy.
"""
_PATIENCE = 1 if sys.platform == "win32" else 30
"""Wall time that a process has, in units of its processor time, which Windows does not limit."""
MAX_MEMORY = 512 * 1024 * 1024
"""Bytes of address space that drawing one may take, where the system can limit it."""

_PYTHON = re.compile(r"(?:python|pypy)[0-9a-z.]*(?:-[a-z]+)?(?:\.exe)?", re.IGNORECASE)
"""Names of interpreters: `sys.executable` of a program that embeds Python is that program."""


class DrawError(ThymioSimError):
    """An SVG that is not drawn: what was found, and what was expected."""

    def __init__(self, found: str, expected: str) -> None:
        super().__init__(f"found {found}, expected {expected}")
        self.found = found
        self.expected = expected


def draw(text: str, resvg: ModuleType, *, seconds: float) -> tuple[bytes, float]:
    """The PNG of an SVG, and the processor time it took. Raises DrawError if that is more than `seconds`."""
    too_long = DrawError(
        f"SVG images that take longer than {MAX_SECONDS:g} s to draw", "simpler SVG images, or PNG images"
    )
    if seconds <= 0.0:
        raise too_long
    limits = str(MAX_MEMORY), str(math.ceil(seconds))
    command = [_interpreter(), "-I", "-S", svg_worker.__file__, _folder(resvg), *limits]
    try:
        done = subprocess.run(
            command,
            input=text.encode("utf-8"),
            capture_output=True,
            timeout=_PATIENCE * seconds,
            check=False,
            **_apart(),
        )
    except subprocess.TimeoutExpired as error:
        raise too_long from error
    except OSError as error:
        raise DrawError(
            f"an SVG, and no process could be started to draw it ({error})", "a Python interpreter that starts"
        ) from error
    if done.returncode == 0:
        return done.stdout, float(done.stderr.split()[-1])
    if done.returncode == svg_worker.REFUSED:
        reason = done.stdout.decode("utf-8", "replace")
        raise DrawError(f"an SVG that cannot be drawn ({reason})", "a complete SVG in UTF-8")
    if done.returncode in _OUT_OF_TIME:
        raise too_long
    raise DrawError(
        f"an SVG whose drawing process exited with code {done.returncode}",
        f"an SVG that can be drawn in {MAX_MEMORY // 1024**2} MB of memory",
    )


_OUT_OF_TIME = [-number for number in (getattr(signal, "SIGXCPU", None), getattr(signal, "SIGKILL", None)) if number]


def _interpreter() -> str:
    if getattr(sys, "frozen", False) or not sys.executable or not _PYTHON.fullmatch(Path(sys.executable).name):
        raise DrawError(
            f"an SVG in a program that embeds Python ({sys.executable or 'unknown'})",
            "a PNG image, or a program that runs in a Python interpreter",
        )
    return sys.executable


def _folder(resvg: ModuleType) -> str:
    return str(Path(str(resvg.__file__)).parent.parent)


def _apart() -> dict[str, Any]:
    """The options for a process that does not get Ctrl-C of the terminal and opens no window."""
    if sys.platform == "win32":
        return {"creationflags": subprocess.CREATE_NO_WINDOW | subprocess.CREATE_NEW_PROCESS_GROUP}
    return {"start_new_session": True}
