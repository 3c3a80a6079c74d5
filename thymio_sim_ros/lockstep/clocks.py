"""Replaces clocks, sleeps and waits for files of Python's standard library by simulated time."""

from __future__ import annotations

import datetime
import select
import selectors
import time
from collections.abc import Sequence
from typing import Any

from thymio_sim_ros.lockstep.turns import Turns

__all__ = ["install"]

SECOND_NS = 1_000_000_000

EPOCH_NS = 1_767_225_600 * SECOND_NS
"""Calendar time at simulated time 0: 2026-01-01 00:00 UTC."""

UPTIME_NS = 1_000 * SECOND_NS
"""Value of the clocks without calendar at simulated time 0. Programs may take 0 for "never"."""


def install(turns: Turns) -> None:
    """Replace the clocks; `from time import sleep` gets them too, in modules imported from now on."""
    module: Any = time
    for name, base_ns in (("time", EPOCH_NS), ("monotonic", UPTIME_NS), ("perf_counter", UPTIME_NS)):
        in_ns = _clock(turns, base_ns)
        setattr(module, f"{name}_ns", in_ns)
        setattr(module, name, _in_seconds(in_ns))
    calendar_ns = module.time_ns
    localtime, gmtime = time.localtime, time.gmtime
    module.localtime = lambda seconds=None: localtime(calendar_ns() / SECOND_NS if seconds is None else seconds)
    module.gmtime = lambda seconds=None: gmtime(calendar_ns() / SECOND_NS if seconds is None else seconds)
    module.sleep = lambda seconds: turns.sleep(_checked_ns(seconds))
    _install_datetime()
    _install_selectors(turns)


def _clock(turns: Turns, base_ns: int) -> Any:
    def now_ns() -> int:
        turns.poll()
        return base_ns + turns.now_ns

    return now_ns


def _in_seconds(in_ns: Any) -> Any:
    return lambda: in_ns() / SECOND_NS


def _checked_ns(seconds: float) -> int:
    if seconds < 0:
        raise ValueError("sleep length must be non-negative")
    return round(seconds * SECOND_NS)


def _install_datetime() -> None:
    original: Any = datetime.datetime

    class SimulatedDatetime(original):  # type: ignore[misc]
        """`datetime.datetime` whose `now` is simulated."""

        @classmethod
        def now(cls, tz: Any = None) -> Any:
            return cls.fromtimestamp(time.time(), tz)

        @classmethod
        def today(cls) -> Any:
            return cls.now()

        @classmethod
        def utcnow(cls) -> Any:
            return cls.fromtimestamp(time.time(), datetime.UTC).replace(tzinfo=None)

    SimulatedDatetime.__name__ = SimulatedDatetime.__qualname__ = "datetime"
    module: Any = datetime
    module.datetime = SimulatedDatetime


def _install_selectors(turns: Turns) -> None:
    kind: Any = selectors.DefaultSelector
    look = select.select

    class SimulatedSelector(kind):  # type: ignore[misc]
        """The selector of asyncio and others, with time-outs in simulated time."""

        def select(self, timeout: float | None = None) -> Any:
            if timeout is not None and timeout <= 0:
                turns.poll()
                return super().select(0)
            deadline_ns = None if timeout is None else turns.now_ns + round(timeout * SECOND_NS)
            turns.wait(
                lambda: bool(super(SimulatedSelector, self).select(0)),
                deadline_ns,
                "a file or socket",
                is_watching=True,
            )
            return super().select(0)

    def select_in_turns(
        read: Sequence[Any], write: Sequence[Any], other: Sequence[Any], timeout: float | None = None
    ) -> tuple[list[Any], list[Any], list[Any]]:
        typed = [file for file in read if hasattr(file, "has_line")]
        files = [file for file in read if file not in typed]

        def ready() -> tuple[list[Any], list[Any], list[Any]]:
            now, *rest = look(files, write, other, 0)
            return [*(file for file in typed if file.has_line()), *now], rest[0], rest[1]

        if timeout is not None and timeout <= 0:
            turns.poll()
        else:
            deadline_ns = None if timeout is None else turns.now_ns + round(timeout * SECOND_NS)
            turns.wait(lambda: any(ready()), deadline_ns, "a file or socket", is_watching=True)
        return ready()

    for module in (select, selectors):
        patched: Any = module
        if hasattr(patched, "DefaultSelector"):
            patched.DefaultSelector = SimulatedSelector
        else:
            patched.select = select_in_turns
