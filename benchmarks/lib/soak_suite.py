"""`thymio-sim` that counts its Python objects on SIGUSR1, for `soak.py`.

The first argument is the file in which the counts are written, the others are those of `thymio-sim`.
"""

from __future__ import annotations

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


def main() -> int:
    """Run the suite; return its exit code."""
    path = Path(sys.argv.pop(1))

    def on_signal(_number: int, _frame: FrameType | None) -> None:
        _write(path)

    signal.signal(signal.SIGUSR1, on_signal)
    return command.main()


def _write(path: Path) -> None:
    """Write how many objects of each type there are; the file appears when it is complete."""
    gc.collect()
    counts = Counter(f"{type(one).__module__}.{type(one).__qualname__}" for one in gc.get_objects())
    incomplete = path.with_suffix(".part")
    incomplete.write_text(json.dumps(counts), encoding="utf-8")
    os.replace(incomplete, path)
