"""Shared-memory files of LTTng: rcl's tracing library makes two at its first load on a machine and leaves them.

Whoever made them tidies up, unless another process uses them by then; LTTng makes them again when it needs them.
"""

from __future__ import annotations

import contextlib
import os
from collections.abc import Iterable
from pathlib import Path

SHARED_MEMORY = Path("/dev/shm")
PATTERN = "lttng-ust-wait-*"


def present(folder: Path = SHARED_MEMORY) -> frozenset[Path]:
    """The files that are there now."""
    return frozenset(folder.glob(PATTERN))


def remove_new(before: frozenset[Path], folder: Path = SHARED_MEMORY) -> None:
    """Remove those that were not there before and that no other process has mapped."""
    new = present(folder) - before
    if not new:
        return
    used = _mapped_by_others()
    for path in new:
        if str(path) not in used:
            with contextlib.suppress(OSError):
                path.unlink()


def _mapped_by_others() -> set[str]:
    return {line.split(maxsplit=5)[5].strip() for text in _maps_of_others() for line in text if line.count("/") > 0}


def _maps_of_others() -> Iterable[list[str]]:
    mine = str(os.getpid())
    for maps in Path("/proc").glob("[0-9]*/maps"):
        if maps.parent.name != mine:
            with contextlib.suppress(OSError):  # it has ended, or belongs to somebody else
                yield maps.read_text(errors="replace").splitlines()
