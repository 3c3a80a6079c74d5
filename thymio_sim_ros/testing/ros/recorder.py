"""The messages received on one topic during a test."""

from __future__ import annotations

import re
import textwrap
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any, TypeVar, overload

from thymio_sim_ros.testing.awaited import NothingYetError
from thymio_sim_ros.testing.failure_messages import pluralized

if TYPE_CHECKING:
    from thymio_sim_ros.portable_ros.messages.message_class import Message

__all__ = ["Recorder"]

_LONGEST = 200
_PACKAGE = re.compile(r"\b\w+\.msg\.")


M = TypeVar("M", bound="Message")


class Recorder(Sequence[M]):
    """A list that fills with a topic's messages, oldest first."""

    def __init__(
        self,
        kind: type[M],
        topic: str,
        until: Callable[..., Any],
        now: Callable[[], str],
        where: Callable[[M], object] | None,
    ) -> None:
        self.kind = kind
        self.topic = topic
        self._until = until
        self._now = now
        self._where = where
        self._messages: list[M] = []
        self._last = ""

    def add(self, message: M) -> None:
        """Add a received message."""
        self._last = self._now()
        if self._where is None or self._where(message):
            self._messages.append(message)

    @property
    def latest(self) -> M:
        """The last message. Raises NothingYetError, a LookupError, if there is none; `until` then waits for it."""
        return self[-1]

    def next(
        self,
        where: Callable[[M], object] = lambda _: True,
        *,
        timeout: float | None = None,
        sim_time: float | None = None,
    ) -> M:
        """Wait for the next message that satisfies a condition; `timeout` and `sim_time` are those of `Ros.until`."""
        __tracebackhide__ = True
        begin = len(self._messages)

        def matching() -> list[M]:
            return [message for message in self._messages[begin:] if where(message)]

        found: list[M] = self._until(matching, timeout, sim_time=sim_time, what=f"the next message on {self.topic}")
        return found[0]

    def wait(self, count: int = 1, *, timeout: float | None = None, sim_time: float | None = None) -> None:
        """Wait until so many messages are there."""
        __tracebackhide__ = True
        self._until(lambda: len(self) >= count, timeout, sim_time=sim_time, what=f"{count} messages on {self.topic}")

    def clear(self) -> None:
        """Forget what has arrived."""
        self._messages.clear()

    def __repr__(self) -> str:
        if not self._messages:
            return f"{self.topic}: nothing arrived"
        last = textwrap.shorten(_PACKAGE.sub("", str(self._messages[-1])), _LONGEST, placeholder=" …")
        when = f" {self._last}" if self._last else ""
        return f"{self.topic}: {pluralized(len(self), 'message')}, last{when}: {last}"

    def __len__(self) -> int:
        return len(self._messages)

    @overload
    def __getitem__(self, index: int) -> M: ...
    @overload
    def __getitem__(self, index: slice) -> list[M]: ...
    def __getitem__(self, index: int | slice) -> M | list[M]:
        if not self._messages and isinstance(index, int):
            raise NothingYetError(f"no message came on {self.topic}")
        return self._messages[index]

    def __eq__(self, other: object) -> bool:
        return self._messages == (other._messages if isinstance(other, Recorder) else other)

    __hash__ = None  # type: ignore[assignment]  # a list that changes, as `list` itself has it
