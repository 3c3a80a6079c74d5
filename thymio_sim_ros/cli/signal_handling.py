"""Handling of the signals that ask for an end during a headless run: the results so far are kept."""

from __future__ import annotations

import signal
from collections.abc import Iterable, Iterator
from types import FrameType, TracebackType
from typing import Self, TypeVar

from thymio_sim_ros.end_signals import END_SIGNALS

__all__ = ["StopSignal"]

Step = TypeVar("Step")


class StopSignal:
    """Context in which the first of END_SIGNALS only sets `number`; a second one has its previous effect."""

    def __init__(self) -> None:
        self.number: int | None = None
        """The signal received, or None."""

    def until_signal(self, steps: Iterable[Step]) -> Iterator[Step]:
        """These steps, up to the one during which a signal arrived."""
        for step in steps:
            yield step
            if self.number is not None:
                return

    def __enter__(self) -> Self:
        self._before = {number: signal.signal(number, self._note) for number in END_SIGNALS}
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._restore()

    def _note(self, number: int, _frame: FrameType | None) -> None:
        self.number = number
        self._restore()

    def _restore(self) -> None:
        for number, handler in self._before.items():
            signal.signal(number, handler)
