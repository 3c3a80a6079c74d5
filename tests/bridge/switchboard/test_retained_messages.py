"""Retained messages: their receivers, and when they are dropped."""

from __future__ import annotations

from collections.abc import Sequence

import pytest

from tests.bridge.switchboard.boards import A, B, subscribe, switchboard
from thymio_sim_ros.bridge.protocol import messages as ms
from thymio_sim_ros.bridge.switchboard import events as ev
from thymio_sim_ros.bridge.switchboard.outcome import Delivery


def test_only_a_new_subscriber_receives_the_retained_message() -> None:
    board = switchboard(A, B)
    subscribe(board, A, 1, 10)
    board.apply(ev.RetainLast(10, 1))
    board.subscriptions.retained.add(ev.Data(10, 5, b"old"))
    board.subscriptions.retained.add(ev.Data(10, 6, b"new"))
    outcome = board.receive(B, ms.Subscribe((ms.Subscription(4, 10),)))
    assert outcome.deliveries == [Delivery((B,), ms.MessageData(4, 6, b"new"))]


@pytest.mark.parametrize(
    ("published", "retained"),
    [((b"one", b"two", b"two"), [(1, b"one"), (3, b"two")]), ((b"on", b"off", b"on"), [(2, b"off"), (3, b"on")])],
)
def test_a_repeated_payload_is_retained_once_as_the_latest(published: Sequence[bytes], retained: object) -> None:
    board = switchboard(A, B)
    subscribe(board, A, 1, 10)
    board.apply(ev.RetainLast(10, 2))
    for time_ns, payload in enumerate(published, start=1):
        board.subscriptions.retained.add(ev.Data(10, time_ns, payload))
    deliveries = board.receive(B, ms.Subscribe((ms.Subscription(4, 10),))).deliveries
    assert [(delivery.message.time_ns, delivery.message.payload) for delivery in deliveries] == retained


def test_messages_of_other_channels_are_not_retained() -> None:
    board = switchboard(A, B)
    subscribe(board, A, 1, 10)
    board.subscriptions.retained.add(ev.Data(10, 5, b"x"))
    assert board.receive(B, ms.Subscribe((ms.Subscription(4, 10),))).deliveries == []


def test_retained_messages_outlive_the_last_subscriber() -> None:
    """The data source decides how long they are up to date."""
    board = switchboard(A)
    subscribe(board, A, 1, 10)
    board.apply(ev.RetainLast(10, 1))
    board.subscriptions.retained.add(ev.Data(10, 5, b"x"))
    board.receive(A, ms.Unsubscribe((1,)))
    outcome = board.receive(A, ms.Subscribe((ms.Subscription(2, 10),)))
    assert [delivery.message for delivery in outcome.deliveries] == [ms.MessageData(2, 5, b"x")]


def test_depth_zero_drops_retained_messages() -> None:
    board = switchboard(A, B)
    subscribe(board, A, 1, 10)
    board.apply(ev.RetainLast(10, 1))
    board.subscriptions.retained.add(ev.Data(10, 5, b"x"))
    board.apply(ev.RetainLast(10, 0))
    assert board.receive(B, ms.Subscribe((ms.Subscription(4, 10),))).deliveries == []


def test_retained_messages_are_sent_again_with_the_current_time() -> None:
    board = switchboard(A, B)
    subscribe(board, A, 1, 10)
    subscribe(board, B, 2, 11)
    for channel_id in (10, 11):
        board.apply(ev.RetainLast(channel_id, 1))
        board.subscriptions.retained.add(ev.Data(channel_id, 40, b"retained"))
    board.apply(ev.RetainLast(11, 0))
    board.apply(ev.SetTime(7))
    assert board.apply(ev.ResendRetained()) == [Delivery((A,), ms.MessageData(1, 7, b"retained"))]
