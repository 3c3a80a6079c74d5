"""The messages that wait for one client: keeps their order, and limits the memory that a slow client can use.

Control messages always wait for their turn. Data messages do, while fewer bytes than the limit wait here and in the
transport; beyond it only the newest message of each subscription is kept, until all others have been sent. A client is
disconnected if even control messages fill `_CONTROL_FACTOR` times the limit.
"""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Callable

__all__ = ["ClientSendQueue", "Message", "Pong"]

Message = str | bytes

_CONTROL_FACTOR = 8
_WARNING_PERIOD_S = 30.0


class Pong(bytes):
    """The answer to a ping, with its content."""


class ClientSendQueue:
    """Messages for one client. Only for the thread of the event loop.

    After messages have been added, `flush` is called once for all of them.
    """

    def __init__(
        self,
        limit: int,
        *,
        warning: Message,
        buffered: Callable[[], int],
        flush: Callable[[], None],
        abort: Callable[[], None],
    ) -> None:
        """`limit`: bytes above which only the newest data messages are kept.

        `warning` is sent to a client that is slow; `buffered` returns the bytes that its transport has not sent yet,
        `flush` takes messages and writes them, as far as the transport accepts them now, and sees to the others;
        `abort` closes the connection at once.
        """
        self._limit, self._warning = limit, warning
        self._buffered, self.flush, self.abort = buffered, flush, abort
        self._waiting: deque[Message] = deque()
        self._size = 0
        """Bytes of `_waiting`; characters of texts count as one."""
        self._newest: dict[int, tuple[Message, ...]] = {}
        """The newest messages of subscriptions, which are sent after `_waiting`."""
        self._next_warning_s = float("-inf")

    @property
    def size(self) -> int:
        """Bytes that wait here and in the transport, without the newest messages of subscriptions."""
        return self._size + self._buffered()

    def put_control(self, *messages: Message) -> None:
        """Add messages that must not be lost, of any size; disconnect the client if too many bytes wait."""
        if self.size > _CONTROL_FACTOR * self._limit:
            self.abort()
        else:
            self._append(messages)

    def put_data(self, subscription_id: int, *messages: Message) -> None:
        """Add messages, or keep them as the newest of their subscription."""
        if not self._newest and self._size + self._buffered() <= self._limit:
            self._append(messages)
            return
        self._newest[subscription_id] = messages
        now_s = time.monotonic()
        if now_s >= self._next_warning_s:
            self._next_warning_s = now_s + _WARNING_PERIOD_S
            self.put_control(self._warning)

    def discard(self, subscription_id: int) -> None:
        """Drop the messages kept for an ended subscription."""
        self._newest.pop(subscription_id, None)

    def take(self, size: int) -> list[Message]:
        """The next messages, up to the one with which there are so many bytes; none if nothing waits."""
        taken: list[Message] = []
        if not self._waiting:
            for messages in self._newest.values():
                self._append(messages)
            self._newest.clear()
        while size > 0 and self._waiting:
            message = self._waiting.popleft()
            self._size -= len(message)
            size -= len(message)
            taken.append(message)
        return taken

    @property
    def is_empty(self) -> bool:
        """Whether nothing waits."""
        return not self._waiting and not self._newest

    def _append(self, messages: tuple[Message, ...]) -> None:
        for message in messages:
            self._waiting.append(message)
            self._size += len(message)
