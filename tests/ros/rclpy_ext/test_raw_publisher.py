"""The direct calls below rclpy give the same results as rclpy."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st
from rclpy.serialization import serialize_message
from std_msgs.msg import Int16MultiArray, MultiArrayDimension, MultiArrayLayout, String

from thymio_sim_ros.ros.rclpy_ext import raw_publisher

words = st.lists(st.integers(-0x8000, 0x7FFF), max_size=60)


@given(words)
def test_words_are_read_without_the_message(numbers):
    assert list(raw_publisher.words_of(serialize_message(Int16MultiArray(data=numbers)))) == numbers


@given(words, st.lists(st.text("abc", max_size=5), max_size=3), st.integers(0, 5))
def test_words_of_a_message_with_a_layout_are_the_same(numbers, labels, offset):
    dimensions = [MultiArrayDimension(label=label, size=1, stride=1) for label in labels]
    layout = MultiArrayLayout(dim=dimensions, data_offset=offset)
    assert list(raw_publisher.words_of(serialize_message(Int16MultiArray(layout=layout, data=numbers)))) == numbers


def test_words_in_the_order_of_another_processor_are_read():
    big = bytes([0, 0, 0, 0]) + bytes(8) + (2).to_bytes(4, "big") + (1).to_bytes(2, "big") + (0x102).to_bytes(2, "big")
    assert list(raw_publisher.words_of(big)) == [1, 0x102]


@pytest.mark.parametrize("broken", [b"", b"\0\1\0\0", b"\0\1\0\0" + bytes(8) + b"\xff\xff\xff\xff\1\0"])
def test_other_bytes_are_rejected(broken):
    with pytest.raises(RuntimeError):
        raw_publisher.words_of(broken)


def test_a_publisher_sends_and_counts_as_usual(ros):
    publisher = ros.node.create_publisher(String, "word", 5)
    send, count = raw_publisher.sender(publisher), raw_publisher.counter(publisher)
    assert count() == 0
    heard = ros.collect(String, "word")
    ros.until(count, what="a listener")
    send(serialize_message(String(data="hello")))
    ros.until(lambda: heard, what="the word")
    assert heard[-1].data == "hello"
