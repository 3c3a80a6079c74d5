"""The messages that wait for one client."""

from __future__ import annotations

import pytest

from thymio_sim_ros.bridge.client_send_queue import ClientSendQueue, Message

LIMIT = 100
WARNING = "slow"


class Ends:
    """A queue of a client, and a transport that has not sent `buffered` bytes."""

    def __init__(self) -> None:
        self.buffered = 0
        self.aborts = 0
        self.queue = ClientSendQueue(
            LIMIT, warning=WARNING, buffered=lambda: self.buffered, flush=lambda: None, abort=self.abort
        )

    def abort(self) -> None:
        self.aborts += 1

    def all(self) -> list[Message]:
        """All messages that wait."""
        found = []
        while messages := self.queue.take(1):
            found += messages
        assert self.queue.is_empty
        return found


@pytest.fixture
def ends() -> Ends:
    return Ends()


def test_messages_keep_their_order(ends: Ends) -> None:
    ends.queue.put_data(1, b"a", "b")
    ends.queue.put_control("c")
    ends.queue.put_data(2, b"d")
    assert ends.all() == [b"a", "b", "c", b"d"]
    assert ends.queue.size == 0


def test_beyond_the_limit_only_the_newest_messages_of_each_subscription_are_kept(ends: Ends) -> None:
    ends.queue.put_data(1, bytes(LIMIT + 1))
    for number in range(3):
        ends.queue.put_data(1, b"one %d" % number)
        ends.queue.put_data(2, b"two %d" % number, b"and more")
    ends.queue.put_control("control")
    assert ends.all() == [bytes(LIMIT + 1), WARNING, "control", b"one 2", b"two 2", b"and more"]


def test_bytes_that_the_transport_has_not_sent_count(ends: Ends) -> None:
    ends.buffered = LIMIT + 1
    ends.queue.put_data(1, b"old")
    ends.queue.put_data(1, b"new")
    assert ends.queue.size == LIMIT + 1 + len(WARNING)
    assert ends.all() == [WARNING, b"new"]


def test_messages_of_an_ended_subscription_are_dropped(ends: Ends) -> None:
    ends.buffered = LIMIT + 1
    ends.queue.put_data(1, b"ended")
    ends.queue.discard(1)
    ends.queue.discard(7)
    assert ends.all() == [WARNING]


def test_a_client_with_too_many_control_messages_is_disconnected(ends: Ends) -> None:
    while not ends.aborts:
        ends.queue.put_control(bytes(LIMIT))
    assert ends.queue.size == 9 * LIMIT


def test_messages_are_taken_up_to_a_number_of_bytes(ends: Ends) -> None:
    ends.queue.put_control(b"ab", b"cd", b"ef", b"gh")
    assert ends.queue.take(3) == [b"ab", b"cd"]
    assert ends.queue.take(1) == [b"ef"]
    assert not ends.queue.is_empty
    assert ends.queue.take(100) == [b"gh"]
    assert ends.queue.take(100) == []
    assert ends.queue.is_empty
