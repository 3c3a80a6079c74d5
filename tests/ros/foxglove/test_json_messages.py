"""Conversion of JSON and messages."""

from __future__ import annotations

import base64
import json

import pytest
from geometry_msgs.msg import Twist
from rclpy.serialization import serialize_message
from sensor_msgs.msg import Image, Imu, JointState, Range
from shape_msgs.msg import SolidPrimitive
from std_msgs.msg import Bool, ByteMultiArray, Float64, Int8MultiArray, Int16MultiArray, String, UInt8MultiArray

from thymio_sim_ros.ros.foxglove.json_messages import JsonMessageError, from_json, to_json


@pytest.mark.parametrize("kind", [Twist, Imu, Range, JointState, Image, Int16MultiArray, ByteMultiArray, Bool])
def test_a_default_message_survives_json(kind):
    message = from_json(to_json(kind()), kind)
    assert message == kind()
    assert serialize_message(message)


def test_missing_fields_keep_their_defaults():
    twist = from_json(b'{"linear": {"x": 1}}', Twist)
    assert (twist.linear.x, twist.linear.y, twist.angular.z) == (1.0, 0.0, 0.0)


def test_lists_of_messages_are_messages():
    array = from_json(b'{"layout": {"dim": [{"label": "top", "size": 3}]}, "data": [1, -2, 3.0]}', Int16MultiArray)
    assert (array.layout.dim[0].label, list(array.data)) == ("top", [1, -2, 3])


@pytest.mark.parametrize(
    ("kind", "expected"),
    [(UInt8MultiArray, [1, 200]), (Int8MultiArray, [1, -56]), (ByteMultiArray, [b"\x01", b"\xc8"])],
)
def test_bytes_may_be_base64(kind, expected):
    data = base64.b64encode(bytes([1, 200])).decode()
    message = from_json(json.dumps({"data": data}).encode(), kind)
    assert list(message.data) == expected
    assert serialize_message(message)


def test_nan_and_infinity_are_null():
    assert to_json(Float64(data=float("nan"))) == b'{"data":null}'


@pytest.mark.parametrize(
    ("kind", "data", "text"),
    [
        (Bool, b"[", "not JSON: Expecting value"),
        (Bool, b"\xff", "not JSON: "),
        (Bool, b"[]", "message: expected an object, found []"),
        (Bool, b'{"data": 1}', "message.data: expected boolean, found 1"),
        (Bool, b'{"flag": true}', "message: no field flag; fields are data"),
        (String, b'{"data": 1}', "message.data: expected string, found 1"),
        (String, b'{"data": "\\ud800"}', r"message.data: expected string, found '\ud800'"),
        (Twist, b'{"linear": {"x": "1"}}', "message.linear.x: expected double, found '1'"),
        (Twist, b'{"linear": {"x": true}}', "message.linear.x: expected double, found True"),
        (Float64, b'{"data": 1' + b"0" * 400 + b"}", "message.data: expected double, found 1000"),
        (Int16MultiArray, b'{"data": [1, 40000]}', "message.data[1]: expected int16, found 40000"),
        (Int16MultiArray, b'{"data": [1.5]}', "message.data[0]: expected int16, found 1.5"),
        (Int16MultiArray, b'{"data": [NaN]}', "message.data[0]: expected int16, found nan"),
        (Int16MultiArray, b'{"data": 1}', "message.data: expected a list, found 1"),
        (UInt8MultiArray, b'{"data": "%"}', "message.data: expected a list or base64, found '%'"),
        (ByteMultiArray, b'{"data": [256]}', "message.data[0]: expected octet, found 256"),
        (
            Imu,
            b'{"orientation_covariance": [1]}',
            "message.orientation_covariance: expected double[9], found 1 elements",
        ),
        (SolidPrimitive, b'{"dimensions": [1, 2, 3, 4]}', "message.dimensions: expected sequence<double, 3>, found 4"),
    ],
)
def test_json_that_does_not_fit_is_rejected_with_its_place(kind, data, text):
    with pytest.raises(JsonMessageError) as caught:
        from_json(data, kind)
    assert str(caught.value).startswith(text)
