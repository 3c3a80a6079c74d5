"""Messages of several topics that belong together by their times, as `message_filters` has them.

The names are those of the original. Times are `rclpy.time.Time`; a message without `header.stamp` gets the time of its
arrival where `allow_headerless` is set, and is dropped with an error in the log else.
"""

from __future__ import annotations

import threading
from bisect import bisect_left
from collections.abc import Callable, Sequence
from typing import Any

from rclpy.clock import ROSClock
from rclpy.duration import Duration
from rclpy.logging import get_logger
from rclpy.node import Node
from rclpy.time import Time

__all__ = ["ApproximateTimeSynchronizer", "Cache", "SimpleFilter", "Subscriber", "TimeSynchronizer"]

_DEPTH = 10


class SimpleFilter:
    """A source of messages; each of its callbacks gets all of them."""

    def __init__(self) -> None:
        self.callbacks: dict[int, tuple[Callable[..., object], tuple[Any, ...]]] = {}

    def registerCallback(self, cb: Callable[..., object], *args: Any) -> int:  # noqa: N802
        """Call a function with each message, then `args`; return the number of the connection."""
        connection = len(self.callbacks)
        self.callbacks[connection] = (cb, args)
        return connection

    def signalMessage(self, *msg: Any) -> None:  # noqa: N802
        """Call the callbacks with a message, or with several that belong together."""
        for callback, arguments in list(self.callbacks.values()):
            callback(*msg, *arguments)


class Subscriber(SimpleFilter):
    """The messages of a topic: `Subscriber(node, Range, "proximity/center", qos_profile=10)`."""

    def __init__(self, node: Node, msg_type: type[Any], topic: str, qos_profile: Any = _DEPTH, **options: Any) -> None:
        """`options` are those of `create_subscription`."""
        super().__init__()
        self.node, self.topic = node, topic
        self.sub = node.create_subscription(msg_type, topic, self.callback, qos_profile, **options)

    def callback(self, msg: Any) -> None:
        """Pass a message on."""
        self.signalMessage(msg)

    def getTopic(self) -> str:  # noqa: N802
        """The name of the topic, as it was given."""
        return self.topic

    def __getattr__(self, key: str) -> Any:
        if key == "sub":  # `__init__` has not come so far
            raise AttributeError(key)
        return getattr(self.sub, key)


class _Stamps:
    """The times of messages, in nanoseconds."""

    def __init__(self, allow_headerless: bool) -> None:
        self._allow_headerless = allow_headerless
        self._clock = ROSClock()

    def of(self, msg: Any) -> int | None:
        """The time of a message, None if it has none and must have one."""
        stamp = getattr(getattr(msg, "header", None), "stamp", None)
        if stamp is not None:
            return int(Time.from_msg(stamp).nanoseconds)
        if self._allow_headerless:
            return int(self._clock.now().nanoseconds)
        get_logger("message_filters").error(
            f"a message without header.stamp is dropped: found {type(msg).__name__}; allow_headerless=True gives such "
            "messages the time of their arrival",
            throttle_duration_sec=1.0,
        )
        return None


class Cache(SimpleFilter):
    """The last messages of a filter in the order of their times; passes each message on."""

    def __init__(self, f: SimpleFilter, cache_size: int = 1, allow_headerless: bool = False) -> None:
        super().__init__()
        self.cache_size = cache_size
        self._stamps = _Stamps(allow_headerless)
        self._clock_type = ROSClock().clock_type
        self._times: list[int] = []
        self._messages: list[Any] = []
        self._lock = threading.RLock()
        self.connectInput(f)

    def connectInput(self, f: SimpleFilter) -> None:  # noqa: N802
        """Keep the messages of a filter, too."""
        self.incoming_connection = f.registerCallback(self.add)

    def add(self, msg: Any) -> None:
        """Keep a message, and pass it on."""
        stamp = self._stamps.of(msg)
        if stamp is None:
            return
        with self._lock:
            at = bisect_left(self._times, stamp)
            self._times.insert(at, stamp)
            self._messages.insert(at, msg)
            if len(self._times) > self.cache_size:
                del self._times[0], self._messages[0]
        self.signalMessage(msg)

    def getInterval(self, from_stamp: Time, to_stamp: Time) -> list[Any]:  # noqa: N802
        """The messages of a time, with both ends."""
        with self._lock:
            begin, end = (
                bisect_left(self._times, from_stamp.nanoseconds),
                bisect_left(self._times, to_stamp.nanoseconds + 1),
            )
            return self._messages[begin:end]

    def getElemAfterTime(self, stamp: Time) -> Any:  # noqa: N802
        """The oldest message that is not before a time, None if there is none."""
        with self._lock:
            at = bisect_left(self._times, stamp.nanoseconds)
            return self._messages[at] if at < len(self._messages) else None

    def getElemBeforeTime(self, stamp: Time) -> Any:  # noqa: N802
        """The newest message that is not after a time, None if there is none."""
        with self._lock:
            at = bisect_left(self._times, stamp.nanoseconds + 1)
            return self._messages[at - 1] if at > 0 else None

    def getLastestTime(self) -> Time | None:  # noqa: N802  # its name has this letter
        """The time of the newest message, None if there is none."""
        return self._time(-1)

    def getOldestTime(self) -> Time | None:  # noqa: N802
        """The time of the oldest message, None if there is none."""
        return self._time(0)

    def getLast(self) -> Any:  # noqa: N802
        """The newest message, None if there is none."""
        with self._lock:
            return self._messages[-1] if self._messages else None

    def _time(self, at: int) -> Time | None:
        with self._lock:
            return Time(nanoseconds=self._times[at], clock_type=self._clock_type) if self._times else None


class TimeSynchronizer(SimpleFilter):
    """Calls back with one message of each filter, all of the same time."""

    def __init__(self, fs: Sequence[SimpleFilter], queue_size: int) -> None:
        """At most `queue_size` messages of each filter wait for the others."""
        super().__init__()
        self._stamps = _Stamps(allow_headerless=False)
        self.queue_size = queue_size
        self.lock = threading.Lock()
        self.connectInput(fs)

    def connectInput(self, fs: Sequence[SimpleFilter]) -> None:  # noqa: N802
        """Take the messages of these filters."""
        self.queues: list[dict[int, Any]] = [{} for _ in fs]
        self.input_connections = [f.registerCallback(self.add, at) for at, f in enumerate(fs)]

    def add(self, msg: Any, index: int) -> None:
        """Add a message of a filter; call back if it was the last of those that belong together."""
        stamp = self._stamps.of(msg)
        if stamp is None:
            return
        with self.lock:
            queue = self.queues[index]
            queue[stamp] = msg
            while len(queue) > self.queue_size:
                del queue[min(queue)]
            stamps = self._matching(index, stamp) if stamp in queue else None
            if stamps is None:
                return
            messages = [queue.pop(at) for queue, at in zip(self.queues, stamps, strict=True)]
        self.signalMessage(*messages)

    def _matching(self, index: int, stamp: int) -> list[int] | None:
        """The times of those that belong to a new message, one of each filter; None: not all are there."""
        return [stamp] * len(self.queues) if all(stamp in queue for queue in self.queues) else None


class ApproximateTimeSynchronizer(TimeSynchronizer):
    """Calls back with one message of each filter, of times that differ by `slop` seconds at most."""

    def __init__(
        self, fs: Sequence[SimpleFilter], queue_size: int, slop: float, allow_headerless: bool = False
    ) -> None:
        super().__init__(fs, queue_size)
        self._stamps = _Stamps(allow_headerless)
        self.slop = Duration(seconds=slop)

    def _matching(self, index: int, stamp: int) -> list[int] | None:
        slop = self.slop.nanoseconds
        near = [[one for one in queue if abs(one - stamp) <= slop] for queue in self.queues]
        near[index] = [stamp]
        best: list[int] | None = None
        for first in sorted({one for stamps in near for one in stamps if one <= stamp}):
            within = [[one for one in stamps if first <= one <= first + slop] for stamps in near]
            if all(within):
                found = [min(stamps, key=lambda one: abs(one - stamp)) for stamps in within]
                if best is None or _distance(found, stamp) < _distance(best, stamp):
                    best = found
        return best


def _distance(stamps: Sequence[int], stamp: int) -> int:
    return sum(abs(one - stamp) for one in stamps)
