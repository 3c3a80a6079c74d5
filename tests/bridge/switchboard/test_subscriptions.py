"""Channels of the data source: subscriptions, routes and events."""

from __future__ import annotations

from tests.bridge.switchboard.boards import A, B, refusals, subscribe, switchboard
from thymio_sim_ros.bridge.protocol import messages as ms
from thymio_sim_ros.bridge.protocol.constants import StatusLevel
from thymio_sim_ros.bridge.switchboard import events as ev
from thymio_sim_ros.bridge.switchboard.outcome import MAX_REFUSALS, Delivery


def test_only_the_first_and_the_last_subscriber_cause_an_event() -> None:
    board = switchboard(A, B)
    assert subscribe(board, A, 1, 10) == [ev.ChannelSubscribed(10)]
    assert subscribe(board, B, 1, 10) == []
    assert board.receive(A, ms.Unsubscribe((1,))).events == []
    assert board.receive(B, ms.Unsubscribe((1,))).events == [ev.ChannelUnsubscribed(10)]


def test_equal_subscription_ids_of_two_clients_are_two_subscriptions() -> None:
    board = switchboard(A, B)
    subscribe(board, A, 7, 10)
    subscribe(board, B, 7, 11)
    assert (board.subscriptions.routes(10), board.subscriptions.routes(11)) == (((A, 7),), ((B, 7),))


def test_a_second_subscription_to_a_channel_is_rejected() -> None:
    board = switchboard(A)
    subscribe(board, A, 1, 10)
    outcome = board.receive(A, ms.Subscribe((ms.Subscription(2, 10),)))
    assert refusals(outcome.deliveries) == [(A, "subscription 2: already subscribed to /t")]
    assert board.subscriptions.routes(10) == ((A, 1),)


def test_a_subscription_id_in_use_is_rejected() -> None:
    board = switchboard(A)
    subscribe(board, A, 1, 10)
    outcome = board.receive(A, ms.Subscribe((ms.Subscription(1, 11),)))
    assert refusals(outcome.deliveries) == [(A, "subscription 1 exists already")]
    assert (board.subscriptions.routes(11), outcome.events) == ((), [])


def test_an_unknown_channel_causes_a_warning_and_does_not_affect_other_subscriptions() -> None:
    board = switchboard(A)
    outcome = board.receive(A, ms.Subscribe((ms.Subscription(1, 99), ms.Subscription(2, 10))))
    assert outcome.deliveries == [
        Delivery((A,), ms.Status(StatusLevel.WARNING, "subscription 1: no channel 99")),
    ]
    assert board.subscriptions.routes(10) == ((A, 2),)


def test_ending_an_unknown_subscription_is_rejected() -> None:
    outcome = switchboard(A).receive(A, ms.Unsubscribe((3,)))
    assert refusals(outcome.deliveries) == [(A, "no subscription 3")]


def test_a_frame_with_many_errors_causes_few_statuses() -> None:
    outcome = switchboard(A).receive(A, ms.Unsubscribe(tuple(range(1000))))
    assert len(refusals(outcome.deliveries)) == MAX_REFUSALS


def test_the_subscriptions_of_a_disconnected_client_are_removed() -> None:
    board = switchboard(A, B)
    subscribe(board, A, 1, 10)
    subscribe(board, A, 2, 11)
    subscribe(board, B, 1, 11)
    assert board.leave(A) == [ev.ChannelUnsubscribed(10)]
    assert (board.subscriptions.routes(10), board.subscriptions.routes(11)) == ((), ((B, 1),))


def test_removing_a_channel_ends_its_subscriptions() -> None:
    board = switchboard(A)
    subscribe(board, A, 1, 10)
    assert board.apply(ev.RemoveChannels((10,))) == [Delivery((A,), ms.Unadvertise((10,)))]
    assert board.subscriptions.routes(10) == ()


def test_ending_a_subscription_that_ended_with_its_channel_is_accepted() -> None:
    board = switchboard(A)
    subscribe(board, A, 1, 10)
    board.apply(ev.RemoveChannels((10,)))
    outcome = board.receive(A, ms.Unsubscribe((1, 2)))
    assert refusals(outcome.deliveries) == [(A, "no subscription 2")]
