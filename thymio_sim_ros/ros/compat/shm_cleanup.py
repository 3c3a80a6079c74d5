"""Removal of files that libraries leave in shared memory.

rcl's tracing library, LTTng, creates two files when it is first loaded on a machine and never removes them. The process
that created them removes them, unless another process uses them by then; LTTng creates them again when needed.

Fast DDS creates one file for each port on which a participant listens. A process that is killed while doing so leaves
an incomplete file, for which every later participant on this port waits forever (seen with 2.14).

Fast DDS also creates one segment for the messages of each participant, half a megabyte, under a random name. A process
that is killed leaves it. Files of ports have few names, and Fast DDS replaces those of dead processes; names of
segments are never used again. Beside each segment is an empty file on which its process has a lock (flock) as long as
it lives: the kernel ends the lock with the process, in whatever way that ends and in whatever container it runs.
"""

from __future__ import annotations

import contextlib
import os
import re
import sys
import time
from collections.abc import Iterable
from pathlib import Path

SHARED_MEMORY = Path("/dev/shm")
PATTERN = "lttng-ust-wait-*"
PORTS = "fastrtps_port*"
LOCK = re.compile(r"(fast(?:rtps|dds)_[0-9a-f]{16})_el")
"""Name of the file with the lock of a segment, which is named by the group."""
INCOMPLETE = {b"", bytes(4), b"\x01\x00\x00\x00"}
"""First word of a Boost.Interprocess segment that is not initialized: 0, then 1; 2 when it is."""
ABANDONED_S = 10.0
"""Age above which an incomplete file, or one without a lock, is abandoned; creating it takes microseconds."""


def present(folder: Path = SHARED_MEMORY) -> frozenset[Path]:
    """The files of LTTng that exist now."""
    return frozenset(folder.glob(PATTERN))


def remove_new(before: frozenset[Path], folder: Path = SHARED_MEMORY) -> None:
    """Remove the files of LTTng that are not in `before` and that no other process has mapped."""
    new = present(folder) - before
    if not new:
        return
    used = _mapped_by_others()
    for path in new:
        if str(path) not in used:
            with contextlib.suppress(OSError):
                path.unlink()


def remove_incomplete_ports(folder: Path = SHARED_MEMORY) -> list[Path]:
    """Remove abandoned, incomplete files of ports; return their paths."""
    removed = []
    for path in folder.glob(PORTS):
        with contextlib.suppress(OSError):  # removed meanwhile, or owned by another user
            if path.name.endswith("_el") or time.time() - path.stat().st_mtime < ABANDONED_S:
                continue
            with path.open("rb") as file:
                is_incomplete = file.read(4) in INCOMPLETE
            if is_incomplete:
                path.unlink()
                removed.append(path)
    return removed


def remove_abandoned_segments(folder: Path = SHARED_MEMORY) -> list[Path]:
    """Remove the segments of this user's processes that have ended, with their locks; return their paths."""
    if sys.platform == "win32":  # where neither the folder exists nor the locks
        return []
    import fcntl

    removed = []
    for lock in folder.glob("fast*_el"):
        name = LOCK.fullmatch(lock.name)
        if name is None:
            continue
        with contextlib.suppress(OSError):  # removed meanwhile, owned by another user, or locked: its process lives
            segment = folder / name[1]
            with lock.open("rb") as file:
                state = os.fstat(file.fileno())
                if state.st_uid != os.getuid() or time.time() - state.st_mtime < ABANDONED_S:
                    continue
                fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
                segment.unlink(missing_ok=True)
                lock.unlink()
            removed.append(segment)
    return removed


def remove_abandoned() -> None:
    """Remove files of killed processes of this user; to be called before a process creates its first participant."""
    remove_incomplete_ports()
    remove_abandoned_segments()


def _mapped_by_others() -> set[str]:
    """Paths of all files that other processes have mapped, as far as this user may see them."""
    return {line.split(maxsplit=5)[5].strip() for text in _maps_of_others() for line in text if line.count("/") > 0}


def _maps_of_others() -> Iterable[list[str]]:
    mine = str(os.getpid())
    for maps in Path("/proc").glob("[0-9]*/maps"):
        if maps.parent.name != mine:
            with contextlib.suppress(OSError):  # the process has ended, or belongs to another user
                yield maps.read_text(errors="replace").splitlines()
