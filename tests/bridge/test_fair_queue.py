"""Senders of a queue are served in turn."""

from __future__ import annotations

import pytest

from thymio_sim_ros.bridge.fair_queue import FairQueue


def filled(*values):
    queue = FairQueue()
    for sender, number in values:
        queue.put(sender, (sender, number))
    return queue


def test_senders_take_turns_and_each_keeps_its_order():
    queue = filled(("a", 1), ("a", 2), ("a", 3), ("b", 1), ("c", 1), ("c", 2))
    taken = [queue.pop() for _ in range(len(queue))]
    assert taken == [("a", 1), ("b", 1), ("c", 1), ("a", 2), ("c", 2), ("a", 3)]
    assert len(queue) == 0


def test_a_blocked_sender_is_skipped():
    queue = filled(("a", 1), ("b", 1))
    assert queue.pop(lambda sender: sender != "a") == ("b", 1)
    with pytest.raises(IndexError):
        queue.pop(lambda sender: sender != "a")
    assert queue.pop() == ("a", 1)


def test_a_value_can_be_removed_once():
    queue = filled(("a", 1), ("a", 2))
    assert queue.remove("a", ("a", 1))
    assert not queue.remove("a", ("a", 1))
    assert not queue.remove("b", ("b", 1))
    assert list(queue) == [("a", 2)]
