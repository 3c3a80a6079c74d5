"""Topics on record."""

from __future__ import annotations

import pytest
from std_msgs.msg import Int32


@pytest.fixture
def talk(ros):
    """Publish numbers."""
    publisher = ros.node.create_publisher(Int32, "numbers", 100)

    def say(*numbers):
        for number in numbers:
            publisher.publish(Int32(data=number))

    return say


def test_it_is_a_list_that_fills(ros, talk):
    numbers = ros.collect(Int32, "numbers")
    assert not numbers
    talk(1, 2, 3)
    numbers.wait(3)
    assert [message.data for message in numbers] == [1, 2, 3]
    assert numbers.latest == numbers[-1] == Int32(data=3)
    assert numbers[:1] == [Int32(data=1)]
    assert numbers == [Int32(data=1), Int32(data=2), Int32(data=3)]


def test_before_the_first_message_there_is_no_latest(ros, talk):
    numbers = ros.collect(Int32, "numbers")
    with pytest.raises(LookupError, match="no message came on /numbers"):
        numbers.latest  # noqa: B018  (a property)


def test_the_next_message_is_one_that_comes_now(ros, talk):
    numbers = ros.collect(Int32, "numbers")
    talk(1)
    numbers.wait()
    talk(2, 3)
    assert numbers.next().data == 2
    talk(4, 5)
    assert numbers.next(lambda message: message.data > 4).data == 5


def test_only_wanted_messages_are_kept(ros, talk):
    numbers = ros.collect(Int32, "numbers", where=lambda message: message.data % 2)
    talk(1, 2, 3)
    numbers.wait(2)
    assert [message.data for message in numbers] == [1, 3]
    numbers.clear()
    assert len(numbers) == 0


def test_it_prints_how_many_came_and_the_last(ros, talk):
    numbers = ros.collect(Int32, "numbers")
    assert repr(numbers) == "/numbers: nothing arrived"
    talk(1, 2)
    numbers.wait(2)
    assert repr(numbers) == "/numbers: 2 messages, last: Int32(data=2)"


def test_waiting_in_vain_names_the_topic(ros, talk):
    numbers = ros.collect(Int32, "numbers")
    with pytest.raises(pytest.fail.Exception, match="not within 0 s: 2 messages on /numbers"):
        numbers.wait(2, timeout=0.0)
    with pytest.raises(pytest.fail.Exception, match="not within 0 s: the next message on /numbers"):
        numbers.next(timeout=0.0)
