"""What a process holds on to at a moment, and how that changes over time; for `soak.py`."""

from __future__ import annotations

import itertools
import os
import re
import statistics
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

__all__ = ["Sample", "change", "sample", "shared_files"]

_SHARED_MEMORY = re.compile(r"/dev/shm/\S+")


@dataclass(frozen=True)
class Sample:
    """A process `minute` minutes after its start; shared memory is that which it has mapped."""

    minute: float
    rss_mb: float
    pss_mb: float
    descriptors: int
    threads: int
    shared_files: int
    shared_mb: float


def sample(pid: int, minute: float) -> Sample:
    """Measure a process. PSS is its memory, of which it has a share of what it shares with others."""
    process = Path(f"/proc/{pid}")
    sizes = _sizes_mb(process / "smaps_rollup")
    return Sample(
        minute=minute,
        rss_mb=sizes["Rss"],
        pss_mb=sizes["Pss"],
        descriptors=len(os.listdir(process / "fd")),
        threads=len(os.listdir(process / "task")),
        shared_files=len(shared_files(pid)),
        shared_mb=sum(_span_mb(line) for line in _lines(process / "maps") if _SHARED_MEMORY.search(line)),
    )


def shared_files(pid: int) -> set[Path]:
    """Files of shared memory that a process has mapped; those that are deleted have " (deleted)" in their lines."""
    found = map(_SHARED_MEMORY.search, _lines(Path(f"/proc/{pid}/maps")))
    return {Path(one[0]) for one in found if one}


def change(at: Sequence[float], values: Sequence[float]) -> float:
    """Return how much values change over their time: the median of all slopes (Theil and Sen) times the duration.

    Single values, such as a sample beside a large request, have no influence on it.
    """
    pairs = itertools.combinations(zip(at, values, strict=True), 2)
    slopes = [(last - first) / (end - begin) for (begin, first), (end, last) in pairs if end > begin]
    return statistics.median(slopes) * (at[-1] - at[0]) if slopes else 0.0


def _sizes_mb(path: Path) -> dict[str, float]:
    fields = (line.split() for line in _lines(path)[1:])
    return {key.rstrip(":"): int(value) / 1024 for key, value, *_ in fields}


def _span_mb(line: str) -> float:
    begin, _, end = line.split()[0].partition("-")
    return (int(end, 16) - int(begin, 16)) / 2**20


def _lines(path: Path) -> list[str]:
    return path.read_text(encoding="utf-8", errors="replace").splitlines()
