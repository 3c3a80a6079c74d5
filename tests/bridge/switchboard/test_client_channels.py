"""Channels on which clients publish."""

from __future__ import annotations

import pytest

from tests.bridge.switchboard.boards import A, B, client_channel, refusals, switchboard
from thymio_sim_ros.bridge.protocol import messages as ms
from thymio_sim_ros.bridge.switchboard import events as ev
from thymio_sim_ros.bridge.switchboard.client_channels import MAX_ALL_CLIENT_CHANNELS, MAX_CLIENT_CHANNELS


def test_equal_client_channel_ids_of_two_clients_are_two_channels() -> None:
    board = switchboard(A, B)
    board.receive(A, ms.ClientAdvertise((client_channel(1, "/a"),)))
    board.receive(B, ms.ClientAdvertise((client_channel(1, "/b"),)))
    assert board.receive(A, ms.ClientMessageData(1, b"x")).events == [ev.ClientMessageReceived(A, 1, b"x")]
    assert board.receive(B, ms.ClientMessageData(1, b"y")).events == [ev.ClientMessageReceived(B, 1, b"y")]


def test_the_channels_of_a_disconnected_client_are_closed() -> None:
    board = switchboard(A, B)
    board.receive(A, ms.ClientAdvertise((client_channel(1), client_channel(2))))
    board.receive(B, ms.ClientAdvertise((client_channel(1),)))
    assert board.leave(A) == [ev.ClientChannelClosed(A, 1), ev.ClientChannelClosed(A, 2)]
    assert board.receive(B, ms.ClientMessageData(1, b"y")).events == [ev.ClientMessageReceived(B, 1, b"y")]


def test_closing_a_client_channel_twice_is_rejected() -> None:
    board = switchboard(A)
    board.receive(A, ms.ClientAdvertise((client_channel(1),)))
    assert board.receive(A, ms.ClientUnadvertise((1,))).events == [ev.ClientChannelClosed(A, 1)]
    assert refusals(board.receive(A, ms.ClientUnadvertise((1,))).deliveries) == [(A, "no client channel 1")]


def test_a_message_on_a_channel_that_was_not_advertised_is_rejected() -> None:
    outcome = switchboard(A).receive(A, ms.ClientMessageData(1, b"x"))
    assert refusals(outcome.deliveries) == [(A, "message on client channel 1, which is not advertised")]
    assert outcome.events == []


@pytest.mark.parametrize(
    ("second", "text"),
    [
        (client_channel(1, "/b"), "channel 1 for /b: the ID is in use for /cmd_vel"),
        (client_channel(2, "/b", "protobuf"), "channel 2 for /b: expected encoding cdr or json, found protobuf"),
    ],
)
def test_a_channel_with_a_used_id_or_an_unknown_encoding_is_rejected(second: ms.ClientChannel, text: str) -> None:
    board = switchboard(A)
    outcome = board.receive(A, ms.ClientAdvertise((client_channel(1), second)))
    assert refusals(outcome.deliveries) == [(A, text)]
    assert outcome.events == [ev.ClientChannelOpened(A, client_channel(1))]


def test_the_channels_of_one_client_are_limited() -> None:
    board = switchboard(A)
    outcome = board.receive(A, ms.ClientAdvertise(tuple(client_channel(n) for n in range(MAX_CLIENT_CHANNELS + 1))))
    assert refusals(outcome.deliveries) == [(A, "channel 256 for /cmd_vel: more than 256 channels")]
    assert len(outcome.events) == MAX_CLIENT_CHANNELS


def test_the_channels_of_all_clients_are_limited() -> None:
    clients = tuple(range(1, 1 + MAX_ALL_CLIENT_CHANNELS // MAX_CLIENT_CHANNELS))
    board = switchboard(*clients, 99)
    for client in clients:
        board.receive(client, ms.ClientAdvertise(tuple(client_channel(n) for n in range(MAX_CLIENT_CHANNELS))))
    one = ms.ClientAdvertise((client_channel(1),))
    text = f"channel 1 for /cmd_vel: more than {MAX_ALL_CLIENT_CHANNELS} channels of all clients"
    assert refusals(board.receive(99, one).deliveries) == [(99, text)]
    board.receive(clients[0], ms.ClientUnadvertise((0,)))
    assert board.receive(99, one).events == [ev.ClientChannelOpened(99, client_channel(1))]
    board.leave(clients[1])
    assert board.receive(clients[0], ms.ClientAdvertise((client_channel(0),))).deliveries == []
