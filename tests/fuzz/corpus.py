"""The corpus of a target: a text file with one input per line, as a Python literal, so that changes can be read."""

from __future__ import annotations

import ast
import sys
from collections.abc import Iterable
from pathlib import Path
from types import CodeType, FrameType

from tests.fuzz.target import Target

__all__ = ["FOLDER", "load", "smallest", "store"]

_OURS = ("/aseba_vm/", "/thymio_sim_ros/")
FOLDER = Path(__file__).parents[1] / "data" / "fuzz"


def load(name: str) -> list[bytes]:
    """Return the inputs kept for a target, in their order."""
    path = FOLDER / f"{name}.txt"
    return list(map(ast.literal_eval, path.read_text(encoding="ascii").splitlines())) if path.exists() else []


def smallest(target: Target, inputs: Iterable[bytes], most: int) -> list[bytes]:
    """Return short inputs that together execute each line that any of them executes, at most as many as `most`."""
    kept: list[bytes] = []
    known: set[tuple[CodeType, int]] = set()
    for data in sorted(set(inputs), key=lambda data: (len(data), data)):
        lines = _lines(target, data)
        if not lines <= known and len(kept) < most:
            known |= lines
            kept.append(data)
    return kept


def _lines(target: Target, data: bytes) -> set[tuple[CodeType, int]]:
    """The lines of this project that an input executes."""
    found: set[tuple[CodeType, int]] = set()

    def trace(frame: FrameType, event: str, _argument: object) -> object:
        if not any(part in frame.f_code.co_filename for part in _OURS):
            return None
        if event == "line":
            found.add((frame.f_code, frame.f_lineno))
        return trace

    sys.settrace(trace)  # type: ignore[arg-type]
    try:
        target.accepts(data)
    except Exception:
        found.add((trace.__code__, len(found)))  # a finding is kept
    finally:
        sys.settrace(None)
    return found


def store(name: str, inputs: Iterable[bytes]) -> None:
    """Keep inputs, each once, short ones first."""
    FOLDER.mkdir(parents=True, exist_ok=True)
    rows = [repr(data) for data in sorted(set(inputs), key=lambda data: (len(data), data))]
    if rows:
        (FOLDER / f"{name}.txt").write_text("".join(f"{row}\n" for row in rows), encoding="ascii", newline="\n")
