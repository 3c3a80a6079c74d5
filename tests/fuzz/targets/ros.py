"""Messages of other ROS nodes and of clients of the bridge; only where ROS is installed."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

from geometry_msgs.msg import Twist
from rclpy._rclpy_pybind11 import RMWError
from rclpy.serialization import deserialize_message, serialize_message
from visualization_msgs.msg import MarkerArray

from tests.fuzz.target import Target, text
from thymio_sim_ros.bridge.protocol import bounded_json
from thymio_sim_ros.bridge.protocol.errors import FrameError
from thymio_sim_ros.bridge.protocol.json_codec import reader
from thymio_sim_ros.bridge.protocol.messages import Parameter
from thymio_sim_ros.ros.compat import tf2_messages
from thymio_sim_ros.ros.compat.tf2_messages import Transform, TransformDataError
from thymio_sim_ros.ros.foxglove import cdr_complexity, json_messages
from thymio_sim_ros.ros.foxglove.cdr_complexity import TooManyPartsError
from thymio_sim_ros.ros.foxglove.json_messages import JsonMessageError
from thymio_sim_ros.ros.foxglove.parameter_values import UnfitValueError, from_ros, to_ros

PARAMETER_TYPES = (None, "float64", "float64_array", "byte_array")


def _transforms(data: bytes) -> None:
    transforms = tf2_messages.decode(data)
    if all(0 <= one.stamp_ns < 2**31 * 10**9 for one in transforms):
        assert repr(tf2_messages.decode(tf2_messages.encode(transforms))) == repr(transforms)


def _json(data: bytes) -> None:
    kind, _, body = data.partition(b"\n")
    message = json_messages.from_json(body, MarkerArray if kind == b"m" else Twist)
    serialize_message(message)
    json_messages.to_json(message)


def _long_message(data: bytes) -> None:
    """The first bytes of a message that is too long to be deserialized unchecked."""
    padded = data + bytes(cdr_complexity.UNCHECKED_BYTES)
    cdr_complexity.check_parts(padded, MarkerArray)


def _parameter(data: bytes) -> None:
    kind, body = data[:1], data[1:]
    number = kind[0] if kind else 0
    try:
        value = bounded_json.loads(text(body))
    except (ValueError, RecursionError):
        return
    parameter: Any = reader(Parameter)({"name": "/a.b", "value": value}, "parameter")
    hint = PARAMETER_TYPES[number % len(PARAMETER_TYPES)]
    stored = to_ros(Parameter("/a.b", parameter.value, hint), number % 10)
    if all(map(math.isfinite, (stored.double_value, *stored.double_array_value))):  # JSON has no others
        assert to_ros(from_ros("/a.b", stored), stored.type) == stored
    serialize_message(stored)


def _tf() -> Iterator[bytes]:
    one = Transform(5, "map", "thymio/odom", (1.0, 2.0, 3.0), (0.0, 0.0, 0.0, 1.0))
    yield tf2_messages.encode([one, one._replace(child="thymio/a")])


TARGETS = (
    Target("tf", _transforms, (TransformDataError,), _tf),
    Target(
        "ros-json",
        _json,
        (JsonMessageError,),
        lambda: [
            b't\n{"linear":{"x":1.5}}',
            b'm\n{"markers":[{"id":1,"colors":[{"r":1}],"mesh_file":{"data":"AAAA"}}]}',
        ],
        ('"points":[', '"text":', "1e999", "null"),
    ),
    Target(
        "ros-twist",
        lambda data: deserialize_message(data, Twist),
        (RMWError,),
        lambda: [bytes(serialize_message(Twist()))],
    ),
    Target("ros-long", _long_message, (TooManyPartsError,), lambda: [bytes(serialize_message(MarkerArray()))]),
    Target(
        "ros-parameter",
        _parameter,
        (UnfitValueError, FrameError),
        lambda: [b"\0[1,2.5]", b'\3"AAAA"', b"\0true"],
        ("1e999",),
    ),
)
