"""Long messages must not consist of very many small parts."""

from __future__ import annotations

import pytest
from geometry_msgs.msg import PoseStamped
from nav_msgs.msg import Path
from rcl_interfaces.msg import Parameter, ParameterType, ParameterValue
from rcl_interfaces.srv import GetParameters, SetParameters
from rclpy.serialization import serialize_message
from sensor_msgs.msg import Image, PointCloud2, PointField
from std_msgs.msg import Int16MultiArray, MultiArrayDimension, MultiArrayLayout, String
from visualization_msgs.msg import Marker, MarkerArray

from thymio_sim_ros.ros.foxglove.cdr_complexity import MAX_PARTS, UNCHECKED_BYTES, TooManyPartsError, check_parts

LONG = "x" * (UNCHECKED_BYTES + 1)
FLAG = ParameterValue(type=ParameterType.PARAMETER_BOOL)
TEXT = ParameterValue(
    type=ParameterType.PARAMETER_STRING,
    string_value=LONG,
    bool_array_value=[True],
    double_array_value=[1.0],
    string_array_value=["a", "bcd"],
)


@pytest.mark.parametrize(
    "message",
    [
        SetParameters.Request(parameters=[Parameter(name="a", value=FLAG)] * MAX_PARTS),
        MarkerArray(markers=[Marker(ns="abc")] * MAX_PARTS),
        Path(poses=[PoseStamped()] * MAX_PARTS),
        GetParameters.Request(names=["a" * 30] * (MAX_PARTS + 1)),
        Int16MultiArray(layout=MultiArrayLayout(dim=[MultiArrayDimension(label="x" * 20)] * MAX_PARTS)),
    ],
    ids=lambda message: type(message).__name__,
)
def test_very_many_parts_are_rejected(message):
    with pytest.raises(TooManyPartsError):
        check_parts(serialize_message(message), type(message))


@pytest.mark.parametrize(
    "message",
    [
        SetParameters.Request(parameters=[Parameter(name="a" * length, value=TEXT) for length in range(9)]),
        MarkerArray(markers=[Marker(ns="a" * length, text=LONG) for length in range(9)]),
        Int16MultiArray(data=[1] * UNCHECKED_BYTES),
        Image(data=bytes(UNCHECKED_BYTES)),
        PointCloud2(fields=[PointField(name="x")] * 3, data=bytes(UNCHECKED_BYTES)),
        String(data=LONG),
    ],
    ids=lambda message: type(message).__name__,
)
def test_long_texts_and_arrays_of_numbers_are_accepted(message):
    check_parts(serialize_message(message), type(message))


def test_a_short_message_is_not_checked():
    message = SetParameters.Request(parameters=[Parameter(name="a", value=FLAG)] * 1000)
    check_parts(serialize_message(message), SetParameters.Request)


def test_bytes_that_are_too_short_are_left_to_deserialization():
    check_parts(b"\0\1\0\0" + b"\x10\0\0\0" + bytes(UNCHECKED_BYTES), SetParameters.Request)


def test_a_very_large_length_is_rejected_or_too_short():
    data = serialize_message(SetParameters.Request(parameters=[Parameter(name="a", value=TEXT)]))
    with pytest.raises(TooManyPartsError):
        check_parts(data[:4] + b"\xff" * 4 + bytes(len(data)), SetParameters.Request)
