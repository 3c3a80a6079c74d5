"""Clients of the switchboard: first messages, sessions, capabilities and roles."""

from __future__ import annotations

import pytest

from tests.bridge.switchboard.boards import GRAPH, SERVICE, A, B, client_channel, refusals, switchboard
from thymio_sim_ros.access.tokens import Role
from thymio_sim_ros.bridge import Capability, ServerInfo
from thymio_sim_ros.bridge.protocol import messages as ms
from thymio_sim_ros.bridge.switchboard import events as ev
from thymio_sim_ros.bridge.switchboard.switchboard import READ_ONLY, Switchboard


def test_a_new_client_receives_info_time_channels_and_services() -> None:
    assert [type(message) for message in switchboard().join(A)] == [
        ms.ServerInfo,
        ms.Time,
        ms.Advertise,
        ms.AdvertiseServices,
    ]


def test_a_server_without_the_time_capability_sends_no_time() -> None:
    greeting = switchboard(capabilities=[Capability.SERVICES]).join(A)
    assert not [message for message in greeting if isinstance(message, ms.Time)]


def test_a_new_client_receives_the_latest_time() -> None:
    board = switchboard()
    board.apply(ev.SetTime(42))
    assert ms.Time(42) in board.join(A)


def test_an_empty_server_advertises_nothing() -> None:
    assert [type(message) for message in Switchboard(ServerInfo("x", ())).join(A)] == [ms.ServerInfo]


def test_a_request_for_an_asset_causes_an_event() -> None:
    outcome = switchboard(A).receive(A, ms.FetchAsset("package://p/m.stl", 3))
    assert outcome.events == [ev.AssetRequested(A, "package://p/m.stl", 3)]


def test_a_new_session_is_announced_with_its_id_and_the_whole_graph() -> None:
    board = switchboard(A, B)
    board.receive(A, ms.SubscribeConnectionGraph())
    board.apply(ev.SetGraph(GRAPH))
    deliveries = board.apply(ev.NewSession("second"))
    assert [delivery.clients for delivery in deliveries] == [(A, B), (A, B), (A,)]
    assert isinstance(deliveries[0].message, ms.ServerInfo)
    assert deliveries[0].message.session_id == "second"
    assert deliveries[1].message == ms.Advertise(())
    assert deliveries[2].message == ms.ConnectionGraphUpdate((ms.PublishedTopic("/t", ("/n",)),))


@pytest.mark.parametrize(
    ("message", "capability"),
    [
        (ms.ClientAdvertise(()), Capability.CLIENT_PUBLISH),
        (ms.ServiceRequest(5, 1, "cdr", b""), Capability.SERVICES),
        (ms.GetParameters(()), Capability.PARAMETERS),
        (ms.SubscribeParameterUpdates(()), Capability.PARAMETERS_SUBSCRIBE),
        (ms.SubscribeConnectionGraph(), Capability.CONNECTION_GRAPH),
        (ms.FetchAsset("package://p/m.stl", 3), Capability.ASSETS),
    ],
)
def test_a_message_without_its_capability_is_rejected(message: ms.ClientMessage, capability: Capability) -> None:
    outcome = switchboard(A, capabilities=[]).receive(A, message)
    assert refusals(outcome.deliveries) == [(A, f"this server does not offer {capability}")]
    assert outcome.events == []


def viewer_of(board: Switchboard, client: int = B) -> Switchboard:
    """The board with a read-only client."""
    board.join(client, Role.READ_ONLY)
    return board


@pytest.mark.parametrize(
    "message",
    [
        ms.ClientAdvertise((client_channel(1),)),
        ms.ClientMessageData(1, b""),
        ms.SetParameters((ms.Parameter("/n.p", 2),), "mine"),
        ms.ServiceRequest(SERVICE.id, 1, "cdr", b""),
    ],
    ids=lambda message: message.op if hasattr(message, "op") else type(message).__name__,
)
def test_changes_by_a_read_only_client_are_rejected_with_a_status(message: ms.ClientMessage) -> None:
    board = viewer_of(switchboard(A))
    outcome = board.receive(B, message)
    assert outcome.events == []
    statuses = [delivery.message for delivery in outcome.deliveries if isinstance(delivery.message, ms.Status)]
    assert all("read-only" in status.message for status in statuses)
    assert statuses
    assert {delivery.clients for delivery in outcome.deliveries} == {(B,)}


def test_a_read_only_client_that_sets_a_parameter_receives_the_current_value() -> None:
    board = viewer_of(switchboard())
    board.apply(ev.ParametersChanged((ms.Parameter("/n.p", 1),)))
    status, answer = (
        delivery.message
        for delivery in board.receive(B, ms.SetParameters((ms.Parameter("/n.p", 2),), "mine")).deliveries
    )
    assert status.id == "parameter:/n.p"
    assert answer == ms.ParameterValues((ms.Parameter("/n.p", 1),), "mine")


def test_a_read_only_client_that_calls_a_service_receives_a_failure() -> None:
    board = viewer_of(switchboard())
    outcome = board.receive(B, ms.ServiceRequest(SERVICE.id, 3, "cdr", b""))
    assert outcome.deliveries[0].message == ms.ServiceCallFailure(SERVICE.id, 3, READ_ONLY)


def test_a_read_only_client_may_call_services_that_change_nothing() -> None:
    board = Switchboard(ServerInfo("test", tuple(Capability), ("cdr",)), is_read_only_service=lambda name: name == "/s")
    board.apply(ev.AddServices((SERVICE,)))
    request = ms.ServiceRequest(SERVICE.id, 1, "cdr", b"")
    assert viewer_of(board).receive(B, request).events == [ev.ServiceCalled(B, request)]


def test_a_read_only_client_may_read_parameters_graph_and_assets() -> None:
    board = viewer_of(switchboard())
    for message in (
        ms.GetParameters((), "x"),
        ms.SubscribeParameterUpdates(("/n.p",)),
        ms.SubscribeConnectionGraph(),
        ms.FetchAsset("package://a/b.stl", 1),
    ):
        outcome = board.receive(B, message)
        assert not any(isinstance(delivery.message, ms.Status) for delivery in outcome.deliveries)


def test_a_new_session_sends_each_client_its_own_capabilities() -> None:
    board = viewer_of(switchboard(A))
    infos = {
        delivery.clients: delivery.message
        for delivery in board.apply(ev.NewSession("second"))
        if isinstance(delivery.message, ms.ServerInfo)
    }
    assert infos[A,].metadata == {}
    assert infos[B,].metadata == {"access": "read_only"}
    assert Capability.CLIENT_PUBLISH not in infos[B,].capabilities
    assert {info.session_id for info in infos.values()} == {"second"}
