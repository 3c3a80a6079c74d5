"""The integer readings of all robots in one message per tick, for a runtime with many robots.

It is a `std_msgs/Int16MultiArray` with a dimension for each reading: the label is `robot/sensor`, or `sensor` if the
robot has no name; the size is its number of words, which are consecutive in `data`. The topics `_raw/<sensor>` of each
robot carry the same readings one by one, but the cost of a message hardly depends on its size.
"""

from __future__ import annotations

import struct
from collections.abc import Iterable, Iterator, Sequence
from functools import lru_cache
from typing import Any

from rclpy.serialization import deserialize_message
from std_msgs.msg import Int16MultiArray

from thymio_sim_ros.ros.interface import sensor_topics
from thymio_sim_ros.ros.interface.names import raw_topic
from thymio_sim_ros.ros.interface.subscriber_demand import SubscriberDemand, TopicDemand
from thymio_sim_ros.ros.rclpy_ext import raw_publisher
from thymio_sim_ros.sim.model.readings import Reading
from thymio_sim_ros.sim.sensors import all_sensors

__all__ = ["RawDecoder", "RawTopic", "SensorWords", "encode"]

SensorWords = tuple[str, str, Sequence[int]]
"""ROS name of a robot, sensor, integers."""

_LITTLE_ENDIAN_CDR = b"\0\1\0\0"
_TWO = struct.Struct("<II")
_COUNT = struct.Struct("<I")
_MAX_KNOWN = 500
"""Largest number of remembered message layouts: the sensors that measure in the same tick hardly change."""


def encode(readings: Iterable[SensorWords]) -> bytes:
    """Return the serialized message of these readings."""
    heads: list[bytes] = []
    words: list[int] = []
    for robot, sensor, integers in readings:
        heads.append(_dimension(robot, sensor, len(integers)))
        words += integers
    head = (_LITTLE_ENDIAN_CDR, _COUNT.pack(len(heads)), *heads, _TWO.pack(0, len(words)))
    return b"".join((*head, struct.pack(f"<{len(words)}h", *words)))


class RawDecoder:
    """Decodes messages. Invariant: messages that begin with the same remembered bytes have the same layout."""

    def __init__(self) -> None:
        self._known: dict[int, list[tuple[bytes, list[tuple[str, str, int, int]]]]] = {}
        """By size of the message: its first bytes, and robot, sensor, first word and end of each reading."""
        self._count = 0

    def decode(self, data: bytes) -> Iterator[SensorWords]:
        """Yield the readings of a serialized message.

        Raises RuntimeError for other bytes, ValueError if the sizes do not add up to the number of words.
        """
        for head, parts in self._known.get(len(data), ()):
            if data.startswith(head):
                words = struct.unpack_from(f"<{parts[-1][3] if parts else 0}h", data, len(head))
                break
        else:
            message = deserialize_message(data, Int16MultiArray)
            words, parts = tuple(message.data), _parts(message)
            self._remember(data, words, parts)
        for robot, sensor, begin, end in parts:
            yield robot, sensor, words[begin:end]

    def _remember(self, data: bytes, words: Sequence[int], parts: list[tuple[str, str, int, int]]) -> None:
        own = encode((robot, sensor, words[begin:end]) for robot, sensor, begin, end in parts)
        if not data.startswith(own):
            return  # from another serializer, with other padding
        if self._count >= _MAX_KNOWN:
            self._known.clear()
            self._count = 0
        self._count += 1
        self._known.setdefault(len(data), []).append((own[: len(own) - 2 * len(words)], parts))


class RawTopic:
    """Publishes the readings of each tick at its end, if there are subscribers."""

    def __init__(self, publisher: Any, demand: SubscriberDemand) -> None:
        self._send, self._count = raw_publisher.sender(publisher), raw_publisher.counter(publisher)
        self._demand = demand
        self._demands = {
            sensor.name: TopicDemand(sensor.name, is_periodic=sensor_topics.is_periodic(sensor, row))
            for sensor in all_sensors()
            for row in sensor_topics.rows_of(sensor)
            if row.topic == raw_topic(sensor.name)
        }
        self._has_subscribers = False
        self._waiting: list[SensorWords] = []

    def poll(self) -> None:
        """Find out whether there are subscribers."""
        has_subscribers = self._count() > 0
        if has_subscribers == self._has_subscribers:
            return
        self._has_subscribers = has_subscribers
        for topic in self._demands.values():
            (self._demand.add if has_subscribers else self._demand.remove)(topic)

    def add(self, robot: str, sensor: str, reading: Reading) -> None:
        """Add a reading of this tick; `robot` is a ROS name."""
        if self._has_subscribers and sensor in self._demands:
            self._waiting.append((robot, sensor, reading.words))

    def flush(self) -> None:
        """Publish the readings of this tick."""
        if self._waiting:
            self._send(encode(self._waiting))
            self._waiting.clear()


@lru_cache(maxsize=8192)
def _dimension(robot: str, sensor: str, size: int) -> bytes:
    """Return a serialized MultiArrayDimension, which begins and ends at a multiple of four bytes."""
    label = f"{robot}/{sensor}".lstrip("/").encode() + b"\0"
    return _COUNT.pack(len(label)) + label + bytes(-len(label) % 4) + _TWO.pack(size, size)


def _parts(message: Int16MultiArray) -> list[tuple[str, str, int, int]]:
    parts, end = [], 0
    for dimension in message.layout.dim:
        robot, _, sensor = dimension.label.rpartition("/")
        parts.append((robot, sensor, end, end + dimension.size))
        end += dimension.size
    if end != len(message.data):
        raise ValueError(f"found {len(message.data)} words, expected {end}")
    return parts
