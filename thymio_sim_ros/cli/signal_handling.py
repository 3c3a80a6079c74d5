"""Ctrl-C, or the end of a batch job's time, while a run goes on: what was made so far is kept."""

from __future__ import annotations

import signal
from collections.abc import Iterable, Iterator
from types import FrameType, TracebackType
from typing import Self, TypeVar

__all__ = ["StopSignal"]

Step = TypeVar("Step")

_SIGNALS = (signal.SIGINT, signal.SIGTERM)


class StopSignal:
    """Meanwhile the first SIGINT or SIGTERM is noted and does nothing else; the next one does what it did before."""

    def __init__(self) -> None:
        self.number: int | None = None
        """The signal that came."""

    def until_signal(self, steps: Iterable[Step]) -> Iterator[Step]:
        """These steps, as far as the one during which a signal came."""
        for step in steps:
            yield step
            if self.number is not None:
                return

    def __enter__(self) -> Self:
        self._before = {number: signal.signal(number, self._note) for number in _SIGNALS}
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
