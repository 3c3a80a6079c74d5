"""Messages in several parts, in both directions (the operation `fragment`)."""

from __future__ import annotations

from collections.abc import Iterator

from thymio_sim_ros.bridge.protocol.errors import FrameError
from thymio_sim_ros.bridge.rosbridge.frames import Operation

__all__ = ["MAX_OPEN", "MAX_TOTAL", "Fragments", "split"]

MAX_OPEN = 16
"""Incomplete messages of one client; the oldest is dropped for a further one."""

MAX_TOTAL = 100_000
"""Parts of one message."""

_PART_SIZE = 100
"""Memory of a part besides its characters."""

_MIN_SIZE = 100
"""Characters of the smallest part that is sent: each has some more around it."""


class Fragments:
    """The incomplete messages of one client."""

    def __init__(self, max_size: int) -> None:
        """`max_size`: characters of all incomplete messages together, and `_PART_SIZE` for each part."""
        self._max_size = max_size
        self._size = 0
        self._parts: dict[str | int, dict[int, str]] = {}
        """Parts by message and number; the oldest message first."""

    def add(self, fragment: Operation) -> str | None:
        """Add a part; return the message once it is complete.

        The operation has passed `operations.check`. Raises FrameError for a part that is impossible, and for one with
        which the incomplete messages get too long; they are dropped then.
        """
        key, number, total = fragment["id"], fragment["num"], fragment["total"]
        if not 1 <= total <= MAX_TOTAL:
            raise FrameError("fragment.total", f"a number in 1…{MAX_TOTAL}", str(total))
        if number >= total:
            raise FrameError("fragment.num", f"a number below {total}, the total", str(number))
        parts = self._parts.setdefault(key, {})
        self._size += _size(fragment["data"]) - _size(parts.get(number))
        parts[number] = fragment["data"]
        if len(parts) == total:
            self._drop(key)
            return "".join(text for _, text in sorted(parts.items()))
        if len(self._parts) > MAX_OPEN:
            self._drop(next(iter(self._parts)))
        if self._size > self._max_size:
            size, self._size = self._size, 0
            self._parts.clear()
            raise FrameError("fragment.data", f"incomplete messages of at most {self._max_size} characters", str(size))
        return None

    def _drop(self, key: str | int) -> None:
        self._size -= sum(map(_size, self._parts.pop(key).values()))


def _size(part: str | None) -> int:
    return 0 if part is None else _PART_SIZE + len(part)


def split(text: str, size: int, key: str) -> Iterator[dict[str, object]]:
    """The parts of a message of more than `size` characters; `key` is its ID."""
    size = max(size, _MIN_SIZE)
    total = -(-len(text) // size)
    for number in range(total):
        data = text[number * size : (number + 1) * size]
        yield {"op": "fragment", "id": key, "data": data, "num": number, "total": total}
