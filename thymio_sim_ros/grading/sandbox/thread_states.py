"""Whether threads work or sleep, from /proc. On systems without it no thread is known to sleep."""

from __future__ import annotations

from pathlib import Path

__all__ = ["is_sleeping", "is_working"]

_WORKING = "RD"
"""States of threads that compute, or wait for a processor or a disk."""
_OF_DDS = b"dds."
"""Beginning of the names of threads of Fast DDS, which run at times even in a program that waits."""


def is_sleeping(thread: int) -> bool:
    """Whether a thread of this process, by its native id, waits for something else than a processor or a disk."""
    try:
        with open(f"/proc/self/task/{thread}/stat", "rb") as file:
            return file.read().rpartition(b")")[2].split()[0].decode() not in _WORKING
    except OSError:  # another system
        return False


def is_working(pid: int, *, without: int | None = None) -> bool:
    """Whether a thread of a process computes, or waits for a processor or a disk.

    Threads of DDS do not count, nor the thread with the native id `without`.
    """
    try:
        threads = [
            (task / "stat").read_bytes() for task in Path(f"/proc/{pid}/task").iterdir() if task.name != str(without)
        ]
    except OSError:  # one has just ended
        return True
    return any(
        after.split()[0].decode() in _WORKING
        for name, _, after in (thread.rpartition(b")") for thread in threads)
        if not name.partition(b"(")[2].startswith(_OF_DDS)
    )
