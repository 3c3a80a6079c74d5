"""Resources used by the processes of a sandbox, from /proc."""

from __future__ import annotations

import os
import resource
from collections.abc import Iterator
from dataclasses import dataclass

from thymio_sim_ros.grading.sandbox.processes import Usage
from thymio_sim_ros.grading.sandbox.thread_states import is_working

__all__ = ["descendants", "memory_used", "used"]

_TICK_S = 1 / os.sysconf("SC_CLK_TCK")
_PAGE = os.sysconf("SC_PAGE_SIZE")


@dataclass(frozen=True, slots=True)
class _Process:
    pid: int
    parent: int
    cpu_s: float
    rss: int


def used() -> Usage:
    """Return what the descendants of this process use."""
    found = descendants()
    ended = resource.getrusage(resource.RUSAGE_CHILDREN)
    cpu_s = ended.ru_utime + ended.ru_stime + sum(process.cpu_s for process in found)
    return Usage(cpu_s, any(is_working(process.pid) for process in found))


def memory_used(limit: int) -> int:
    """Memory of the descendants of this process in bytes. Shared pages count once for each process unless the sum
    exceeds `limit`: finding them takes long.
    """
    found = descendants()
    memory = sum(process.rss for process in found)
    return memory if memory <= limit else sum(_own_share(process) for process in found)


def descendants() -> list[_Process]:
    """The descendants of this process that have not been reaped."""
    children: dict[int, list[_Process]] = {}
    for process in _processes():
        children.setdefault(process.parent, []).append(process)
    found: list[_Process] = []
    pending = [os.getpid()]
    while pending:
        below = children.get(pending.pop(), [])
        found += below
        pending += [process.pid for process in below]
    return found


def _processes() -> Iterator[_Process]:
    for name in os.listdir("/proc"):
        if not name.isdigit():
            continue
        try:
            with open(f"/proc/{name}/stat", "rb") as file:
                fields = file.read().rpartition(b")")[2].split()
        except OSError:
            continue  # ended meanwhile
        ticks = sum(map(int, fields[11:15]))  # its own time, and that of its children that it waited for
        yield _Process(int(name), int(fields[1]), ticks * _TICK_S, int(fields[21]) * _PAGE)


def _own_share(process: _Process) -> int:
    """Memory of a process, shared pages divided among those that share them."""
    try:
        with open(f"/proc/{process.pid}/smaps_rollup", "rb") as file:
            lines = file.read().splitlines()
    except OSError:
        return process.rss
    return next((int(line.split()[1]) * 1024 for line in lines if line.startswith(b"Pss:")), process.rss)
