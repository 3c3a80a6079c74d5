"""`thymio-sim` that counts its Python objects and its memory of `malloc` on SIGUSR1, for `soak.py`.

The first argument is the file in which the counts are written, the others are those of `thymio-sim`.
"""

from __future__ import annotations

import ctypes
import gc
import json
import os
import signal
import sys
from collections import Counter
from pathlib import Path
from types import FrameType

from thymio_sim_ros.cli import main as command

__all__ = ["main"]


class _Mallinfo2(ctypes.Structure):
    """What glibc's `mallinfo2` returns: bytes, over all arenas."""

    _fields_ = tuple(
        (name, ctypes.c_size_t)
        for name in (
            "arena", "ordblks", "smblks", "hblks", "hblkhd", "usmblks", "fsmblks", "uordblks", "fordblks", "keepcost"
        )
    )  # fmt: skip


def main() -> int:
    """Run the suite; return its exit code."""
    path = Path(sys.argv.pop(1))

    def on_signal(_number: int, _frame: FrameType | None) -> None:
        _write(path)

    signal.signal(signal.SIGUSR1, on_signal)
    return command.main()


def _write(path: Path) -> None:
    """Write how many objects of each type there are, and the memory; the file appears when it is complete."""
    gc.collect()
    counts = Counter(f"{type(one).__module__}.{type(one).__qualname__}" for one in gc.get_objects())
    incomplete = path.with_suffix(".part")
    incomplete.write_text(json.dumps({"objects": counts, "malloc_mb": _malloc_mb()}), encoding="utf-8")
    os.replace(incomplete, path)


def _malloc_mb() -> dict[str, float]:
    """Memory of glibc's `malloc`: in use, and free but kept."""
    function = ctypes.CDLL(None).mallinfo2
    function.restype = _Mallinfo2
    found = function()
    return {"in use": (found.uordblks + found.hblkhd) / 2**20, "free": found.fordblks / 2**20}
