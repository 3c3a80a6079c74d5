"""Publishes the messages of a bag, at the intervals at which they were recorded."""

from __future__ import annotations

from collections.abc import Collection
from contextlib import suppress
from pathlib import Path
from types import TracebackType
from typing import Any, cast

from rclpy.clock import Clock
from rclpy.clock_type import ClockType
from rclpy.duration import Duration
from rclpy.exceptions import NotInitializedException
from rclpy.node import Node
from rclpy.time import Time
from rosbags.interfaces import Connection, ConnectionExtRosbag2
from rosbags.rosbag2 import Reader, ReaderError

from thymio_sim_ros.bags import qos
from thymio_sim_ros.bags.errors import BagError
from thymio_sim_ros.ros.foxglove.types import MissingTypeError, load_type

__all__ = ["Player"]


class Player:
    """The publishers of the topics of a bag; a context manager."""

    def __init__(self, node: Node, path: Path, *, topics: Collection[str] = ()) -> None:
        """Open a bag, a folder; without `topics`, all are played. Raises BagError."""
        self._node, self._path = node, path
        try:
            self._reader = Reader(path)
            self._reader.open()
        except (OSError, ReaderError) as error:
            raise BagError(f"{path}: cannot be read: {error}") from error
        wanted = {node.resolve_topic_name(topic) for topic in topics}
        known = sorted({one.topic for one in self._reader.connections})
        if missing := sorted(wanted - set(known)):
            self._reader.close()
            raise BagError(f"{path}: found no topic {missing[0]}, expected one of {', '.join(known) or 'none'}")
        self._publishers: dict[int, Any] = {}
        self._played: list[Connection] = []
        for one in self._reader.connections:
            if not wanted or one.topic in wanted:
                self._add(one)

    @property
    def topics(self) -> list[str]:
        """The topics that are played."""
        return [one.topic for one in self._played]

    def play(self, rate: float = 1.0, delay_s: float = 0.0) -> int:
        """Publish all messages and return their number, or that until the shutdown of the context.

        `rate` is a factor of the speed above 0. The first message follows after `delay_s`, in which subscriptions of
        other processes find the publishers. Raises BagError for a bag that cannot be read to its end.
        """
        clock = Clock(clock_type=ClockType.STEADY_TIME)
        start, first_ns, count = clock.now() + Duration(seconds=delay_s), None, 0
        try:
            for connection, stamp_ns, data in self._reader.messages(self._played):
                first_ns = stamp_ns if first_ns is None else first_ns
                due = start + Duration(nanoseconds=int((stamp_ns - first_ns) / rate))
                if not self._sleep_until(clock, due):
                    break
                self._publishers[connection.id].publish(bytes(data))
                count += 1
        except (OSError, ReaderError) as error:
            raise BagError(f"{self._path}: cannot be read to its end: {error}") from error
        return count

    def close(self) -> None:
        """Destroy the publishers and close the bag."""
        for one in self._publishers.values():
            self._node.destroy_publisher(one)
        self._publishers.clear()
        self._reader.close()

    def __enter__(self) -> Player:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def _sleep_until(self, clock: Clock, due: Time) -> bool:
        """Wait; return whether the context is still there."""
        with suppress(NotInitializedException):  # a shutdown before the wait
            clock.sleep_until(due, self._node.context)
        return bool(self._node.context.ok())

    def _add(self, connection: Connection) -> None:
        try:
            kind = load_type(connection.msgtype)
        except MissingTypeError as error:
            self._node.get_logger().warning(f"{connection.topic}: not played: {error}")
            return
        offered = cast(ConnectionExtRosbag2, connection.ext).offered_qos_profiles
        self._publishers[connection.id] = self._node.create_publisher(kind, connection.topic, qos.of_playback(offered))
        self._played.append(connection)
