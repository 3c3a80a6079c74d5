"""Position of code under test, and a way to leave it even if it catches every exception."""

from __future__ import annotations

import linecache
import sys
import threading
from pathlib import Path
from types import FrameType
from typing import Any

__all__ = ["insist", "place"]

_OUTSIDE = (
    "site-packages/",
    "dist-packages/",
    "thymio_sim_ros/testing/",
    "thymio_sim_ros/tf/",
    "thymio_sim_ros/portable_ros/",
    "<frozen",
)
_STANDARD_LIBRARY = Path(threading.__file__).parent


def place(frame: FrameType | None) -> str:
    """The innermost line outside libraries, as a line of a failure message; empty if there is none."""
    while frame is not None and frame.f_back is not None and _is_library(frame):
        frame = frame.f_back
    if frame is None:
        return ""
    code = frame.f_code
    text = linecache.getline(code.co_filename, frame.f_lineno).strip()
    return f"\n  it is at {code.co_filename}, line {frame.f_lineno}, in {code.co_name}" + (f": {text}" if text else "")


def insist(error: BaseException, frame: FrameType | None) -> None:
    """Raise an error again at the next line of code under test, whatever that catches; ends with `sys.settrace(None)`.

    In `while True: try: … except: pass` an error leaves the loop only if it is raised in the line after `except:`.
    Python removes a trace function that raises.
    """

    def raise_at_line(inner: FrameType, event: str, _argument: Any) -> Any:
        if event == "line" and not _is_library(inner):
            raise error
        return raise_at_line

    while frame is not None:
        if not _is_library(frame):
            frame.f_trace = raise_at_line
        frame = frame.f_back
    sys.settrace(raise_at_line)


def _is_library(frame: FrameType) -> bool:
    file = frame.f_code.co_filename
    return any(part in file for part in _OUTSIDE) or Path(file).is_relative_to(_STANDARD_LIBRARY)
