"""The switchboard: what clients and the owner of the data say, and what follows."""

from __future__ import annotations

from collections.abc import Sequence

import pytest

from thymio_sim_ros.bridge import Capability, ServerInfo
from thymio_sim_ros.bridge import events as ev
from thymio_sim_ros.bridge import messages as ms
from thymio_sim_ros.bridge.access import Role
from thymio_sim_ros.bridge.constants import StatusLevel
from thymio_sim_ros.bridge.graph import ConnectionGraph
from thymio_sim_ros.bridge.switchboard import (
    MAX_ALL_CLIENT_CHANNELS,
    MAX_CALLS,
    MAX_CLIENT_CHANNELS,
    MAX_OPEN_SIZE,
    MAX_PARAMETER_REQUESTS,
    MAX_REFUSALS,
    MAX_WATCHED,
    READ_ONLY,
    Delivery,
    Switchboard,
)

A, B = 1, 2
SIDE = ms.ServiceSide("cdr", "std_srvs/srv/Empty_Request", "ros2msg", "")
SERVICE = ms.Service(5, "/s", "std_srvs/srv/Empty", SIDE, SIDE)


def channel(number: int, topic: str = "/t") -> ms.Channel:
    return ms.Channel(number, topic, "cdr", "std_msgs/msg/Bool", "bool data", "ros2msg")


def client_channel(number: int, topic: str = "/cmd_vel", encoding: str = "cdr") -> ms.ClientChannel:
    return ms.ClientChannel(number, topic, encoding, "geometry_msgs/Twist")


def switchboard(*clients: int, capabilities: Sequence[Capability] = tuple(Capability)) -> Switchboard:
    """A board with channels 10 and 11, one service, and the clients connected."""
    board = Switchboard(ServerInfo("test", tuple(capabilities), ("cdr", "json"), session_id="first"))
    board.apply(ev.AddChannels((channel(10), channel(11, "/u"))))
    board.apply(ev.AddServices((SERVICE,)))
    for client in clients:
        board.join(client)
    return board


def subscribe(board: Switchboard, client: int, subscription: int, channel_id: int) -> list[ev.Event]:
    outcome = board.receive(client, ms.Subscribe((ms.Subscription(subscription, channel_id),)))
    assert not [delivery for delivery in outcome.deliveries if isinstance(delivery.message, ms.Status)]
    return outcome.events


def refusals(deliveries: Sequence[Delivery]) -> list[tuple[int, str]]:
    """(client, text) of each status; every delivery must be one."""
    found = []
    for delivery in deliveries:
        assert isinstance(delivery.message, ms.Status)
        found.append((delivery.clients[0], delivery.message.message))
    return found


# --- greeting ---


def test_a_client_is_greeted_with_info_time_channels_and_services() -> None:
    assert [type(message) for message in switchboard().join(A)] == [
        ms.ServerInfo,
        ms.Time,
        ms.Advertise,
        ms.AdvertiseServices,
    ]


def test_time_is_told_only_by_a_server_that_offers_it() -> None:
    greeting = switchboard(capabilities=[Capability.SERVICES]).join(A)
    assert not [message for message in greeting if isinstance(message, ms.Time)]


def test_a_newcomer_gets_the_newest_time() -> None:
    board = switchboard()
    board.apply(ev.SetTime(42))
    assert ms.Time(42) in board.join(A)


def test_an_empty_server_advertises_nothing() -> None:
    assert [type(message) for message in Switchboard(ServerInfo("x", ())).join(A)] == [ms.ServerInfo]


# --- subscribing ---


def test_the_owner_hears_of_the_first_and_the_last_subscriber_only() -> None:
    board = switchboard(A, B)
    assert subscribe(board, A, 1, 10) == [ev.ChannelSubscribed(10)]
    assert subscribe(board, B, 1, 10) == []
    assert board.receive(A, ms.Unsubscribe((1,))).events == []
    assert board.receive(B, ms.Unsubscribe((1,))).events == [ev.ChannelUnsubscribed(10)]


def test_equal_subscription_ids_of_two_clients_are_two_subscriptions() -> None:
    board = switchboard(A, B)
    subscribe(board, A, 7, 10)
    subscribe(board, B, 7, 11)
    assert (board.routes(10), board.routes(11)) == (((A, 7),), ((B, 7),))


def test_one_client_gets_a_channel_once() -> None:
    board = switchboard(A)
    subscribe(board, A, 1, 10)
    outcome = board.receive(A, ms.Subscribe((ms.Subscription(2, 10),)))
    assert refusals(outcome.deliveries) == [(A, "subscription 2: already subscribed to /t")]
    assert board.routes(10) == ((A, 1),)


def test_a_subscription_id_in_use_is_refused_and_changes_nothing() -> None:
    board = switchboard(A)
    subscribe(board, A, 1, 10)
    outcome = board.receive(A, ms.Subscribe((ms.Subscription(1, 11),)))
    assert refusals(outcome.deliveries) == [(A, "subscription 1 exists already")]
    assert (board.routes(11), outcome.events) == ((), [])


def test_an_unknown_channel_is_a_warning_and_the_rest_is_done() -> None:
    board = switchboard(A)
    outcome = board.receive(A, ms.Subscribe((ms.Subscription(1, 99), ms.Subscription(2, 10))))
    assert outcome.deliveries == [
        Delivery((A,), ms.Status(StatusLevel.WARNING, "subscription 1: no channel 99")),
    ]
    assert board.routes(10) == ((A, 2),)


def test_an_unknown_subscription_cannot_be_ended() -> None:
    outcome = switchboard(A).receive(A, ms.Unsubscribe((3,)))
    assert refusals(outcome.deliveries) == [(A, "no subscription 3")]


def test_a_frame_full_of_nonsense_is_refused_a_few_times_only() -> None:
    outcome = switchboard(A).receive(A, ms.Unsubscribe(tuple(range(1000))))
    assert len(refusals(outcome.deliveries)) == MAX_REFUSALS


def test_a_leaving_client_takes_its_subscriptions_along() -> None:
    board = switchboard(A, B)
    subscribe(board, A, 1, 10)
    subscribe(board, A, 2, 11)
    subscribe(board, B, 1, 11)
    assert board.leave(A) == [ev.ChannelUnsubscribed(10)]
    assert (board.routes(10), board.routes(11)) == ((), ((B, 1),))


def test_a_vanished_channel_ends_its_subscriptions() -> None:
    board = switchboard(A)
    subscribe(board, A, 1, 10)
    assert board.apply(ev.RemoveChannels((10,))) == [Delivery((A,), ms.Unadvertise((10,)))]
    assert board.routes(10) == ()


def test_ending_a_subscription_that_went_with_its_channel_is_no_fault() -> None:
    board = switchboard(A)
    subscribe(board, A, 1, 10)
    board.apply(ev.RemoveChannels((10,)))
    outcome = board.receive(A, ms.Unsubscribe((1, 2)))
    assert refusals(outcome.deliveries) == [(A, "no subscription 2")]


# --- latched channels ---


def test_a_newcomer_gets_what_is_kept_and_nobody_else_gets_it_again() -> None:
    board = switchboard(A, B)
    subscribe(board, A, 1, 10)
    board.apply(ev.RetainLast(10, 1))
    board.retain(ev.Data(10, 5, b"old"))
    board.retain(ev.Data(10, 6, b"new"))
    outcome = board.receive(B, ms.Subscribe((ms.Subscription(4, 10),)))
    assert outcome.deliveries == [Delivery((B,), ms.MessageData(4, 6, b"new"))]


@pytest.mark.parametrize(
    ("published", "retained"),
    [((b"one", b"two", b"two"), [(1, b"one"), (3, b"two")]), ((b"on", b"off", b"on"), [(2, b"off"), (3, b"on")])],
)
def test_a_repeated_message_takes_one_place_and_is_the_latest(published: Sequence[bytes], retained: object) -> None:
    board = switchboard(A, B)
    subscribe(board, A, 1, 10)
    board.apply(ev.RetainLast(10, 2))
    for time_ns, payload in enumerate(published, start=1):
        board.retain(ev.Data(10, time_ns, payload))
    deliveries = board.receive(B, ms.Subscribe((ms.Subscription(4, 10),))).deliveries
    assert [(delivery.message.time_ns, delivery.message.payload) for delivery in deliveries] == retained


def test_nothing_is_kept_of_an_ordinary_channel() -> None:
    board = switchboard(A, B)
    subscribe(board, A, 1, 10)
    board.retain(ev.Data(10, 5, b"x"))
    assert board.receive(B, ms.Subscribe((ms.Subscription(4, 10),))).deliveries == []


def test_what_is_kept_is_forgotten_with_the_last_subscriber() -> None:
    board = switchboard(A)
    subscribe(board, A, 1, 10)
    board.apply(ev.RetainLast(10, 1))
    board.retain(ev.Data(10, 5, b"x"))
    board.receive(A, ms.Unsubscribe((1,)))
    assert board.receive(A, ms.Subscribe((ms.Subscription(1, 10),))).deliveries == []


def test_depth_zero_ends_keeping() -> None:
    board = switchboard(A, B)
    subscribe(board, A, 1, 10)
    board.apply(ev.RetainLast(10, 1))
    board.retain(ev.Data(10, 5, b"x"))
    board.apply(ev.RetainLast(10, 0))
    assert board.receive(B, ms.Subscribe((ms.Subscription(4, 10),))).deliveries == []


# --- client channels ---


def test_equal_client_channel_ids_of_two_clients_are_two_channels() -> None:
    board = switchboard(A, B)
    board.receive(A, ms.ClientAdvertise((client_channel(1, "/a"),)))
    board.receive(B, ms.ClientAdvertise((client_channel(1, "/b"),)))
    assert board.receive(A, ms.ClientMessageData(1, b"x")).events == [ev.ClientMessageReceived(A, 1, b"x")]
    assert board.receive(B, ms.ClientMessageData(1, b"y")).events == [ev.ClientMessageReceived(B, 1, b"y")]


def test_a_leaving_client_closes_its_channels() -> None:
    board = switchboard(A, B)
    board.receive(A, ms.ClientAdvertise((client_channel(1), client_channel(2))))
    board.receive(B, ms.ClientAdvertise((client_channel(1),)))
    assert board.leave(A) == [ev.ClientChannelClosed(A, 1), ev.ClientChannelClosed(A, 2)]
    assert board.receive(B, ms.ClientMessageData(1, b"y")).events == [ev.ClientMessageReceived(B, 1, b"y")]


def test_a_client_channel_is_closed_once() -> None:
    board = switchboard(A)
    board.receive(A, ms.ClientAdvertise((client_channel(1),)))
    assert board.receive(A, ms.ClientUnadvertise((1,))).events == [ev.ClientChannelClosed(A, 1)]
    assert refusals(board.receive(A, ms.ClientUnadvertise((1,))).deliveries) == [(A, "no client channel 1")]


def test_a_message_on_a_channel_that_was_not_advertised_is_refused() -> None:
    outcome = switchboard(A).receive(A, ms.ClientMessageData(1, b"x"))
    assert refusals(outcome.deliveries) == [(A, "message on client channel 1, which is not advertised")]
    assert outcome.events == []


@pytest.mark.parametrize(
    ("second", "text"),
    [
        (client_channel(1, "/b"), "channel 1 for /b: the id is in use for /cmd_vel"),
        (client_channel(2, "/b", "protobuf"), "channel 2 for /b: expected encoding cdr or json, found protobuf"),
    ],
)
def test_a_client_channel_with_a_used_id_or_an_unknown_encoding_is_refused(second: ms.ClientChannel, text: str) -> None:
    board = switchboard(A)
    outcome = board.receive(A, ms.ClientAdvertise((client_channel(1), second)))
    assert refusals(outcome.deliveries) == [(A, text)]
    assert outcome.events == [ev.ClientChannelOpened(A, client_channel(1))]


def test_a_client_cannot_open_endless_channels() -> None:
    board = switchboard(A)
    outcome = board.receive(A, ms.ClientAdvertise(tuple(client_channel(n) for n in range(MAX_CLIENT_CHANNELS + 1))))
    assert refusals(outcome.deliveries) == [(A, "channel 256 for /cmd_vel: more than 256 channels")]
    assert len(outcome.events) == MAX_CLIENT_CHANNELS


def test_all_clients_together_cannot_open_endless_channels() -> None:
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


# --- services, assets ---


def test_a_call_of_a_service_reaches_the_owner() -> None:
    request = ms.ServiceRequest(5, 1, "cdr", b"")
    assert switchboard(A).receive(A, request).events == [ev.ServiceCalled(A, request)]


def test_a_call_of_an_unknown_service_fails_with_a_status_beside_it() -> None:
    outcome = switchboard(A).receive(A, ms.ServiceRequest(6, 1, "cdr", b""))
    assert outcome.deliveries == [
        Delivery((A,), ms.ServiceCallFailure(6, 1, "no service 6")),
        Delivery((A,), ms.Status(StatusLevel.ERROR, "no service 6")),
    ]


def call(number: int, payload: bytes = b"") -> ms.ServiceRequest:
    return ms.ServiceRequest(5, number, "cdr", payload)


def test_more_open_calls_than_the_limit_are_refused_at_once_and_others_are_not_concerned() -> None:
    board = switchboard(A, B)
    for number in range(MAX_CALLS):
        assert board.receive(A, call(number)).deliveries == []
    outcome = board.receive(A, call(99))
    text = f"/s: {MAX_CALLS} calls of this client wait already"
    assert outcome.events == []
    assert outcome.deliveries == [
        Delivery((A,), ms.ServiceCallFailure(5, 99, text)),
        Delivery((A,), ms.Status(StatusLevel.ERROR, text)),
    ]
    assert board.receive(B, call(99)).events == [ev.ServiceCalled(B, call(99))]


@pytest.mark.parametrize("answer", [ms.ServiceResponse(5, 0, "cdr", b""), ms.ServiceCallFailure(5, 0, "no")])
def test_an_answer_makes_room_for_another_call(answer: ms.ServiceResponse | ms.ServiceCallFailure) -> None:
    board = switchboard(A)
    for number in range(MAX_CALLS):
        board.receive(A, call(number))
    assert board.apply(ev.AnswerCall(A, answer, 0)) == [Delivery((A,), answer)]
    assert board.receive(A, call(99)).deliveries == []
    assert board.receive(A, call(100)).events == []


def test_a_large_request_is_accepted_alone_and_refused_beside_others() -> None:
    board = switchboard(A)
    large = call(1, bytes(MAX_OPEN_SIZE + 1))
    assert board.receive(A, large).events == [ev.ServiceCalled(A, large)]
    assert refusals(board.receive(A, call(2, b"small")).deliveries[1:]) == [
        (A, "/s: more than 16 MiB of this client's requests wait already")
    ]
    board.apply(ev.AnswerCall(A, ms.ServiceCallFailure(5, 1, "done"), len(large.payload)))
    assert board.receive(A, call(3, b"small")).deliveries == []


def test_a_vanished_service_cannot_be_called() -> None:
    board = switchboard(A)
    assert board.apply(ev.RemoveServices((5,))) == [Delivery((A,), ms.UnadvertiseServices((5,)))]
    assert board.receive(A, ms.ServiceRequest(5, 1, "cdr", b"")).events == []


def test_a_wish_for_an_asset_reaches_the_owner() -> None:
    outcome = switchboard(A).receive(A, ms.FetchAsset("package://p/m.stl", 3))
    assert outcome.events == [ev.AssetRequested(A, "package://p/m.stl", 3)]


# --- parameters ---

SPEED, NAME = ms.Parameter("/n.speed", 1.0, "float64"), ms.Parameter("/n.name", "x")


def with_parameters(*clients: int) -> Switchboard:
    board = switchboard(*clients)
    board.apply(ev.ParametersChanged((SPEED, NAME)))
    return board


def test_asking_for_values_is_the_owners_business() -> None:
    outcome = with_parameters(A).receive(A, ms.GetParameters(("/n.name",), "q"))
    assert outcome.events == [ev.ParametersRequested(A, ("/n.name",), "q")]
    assert outcome.deliveries == []


def test_watching_tells_the_owner_which_names() -> None:
    outcome = with_parameters(A).receive(A, ms.SubscribeParameterUpdates(("/n.name",)))
    assert outcome.events == [ev.ParametersWatched(A, ("/n.name",))]


def test_an_answer_about_all_parameters_carries_all() -> None:
    deliveries = with_parameters(A).apply(ev.SendParameters(A, None, "q"))
    assert deliveries == [Delivery((A,), ms.ParameterValues((SPEED, NAME), "q"))]


def test_setting_is_the_owners_business() -> None:
    outcome = with_parameters(A).receive(A, ms.SetParameters((SPEED,), "q"))
    assert outcome.events == [ev.ParametersSet(A, (SPEED,), "q")]
    assert outcome.deliveries == []


def test_more_open_sets_than_the_limit_are_refused_with_the_value_in_force() -> None:
    board = with_parameters(A, B)
    for _ in range(MAX_PARAMETER_REQUESTS):
        assert board.receive(A, ms.SetParameters((SPEED,), "q")).deliveries == []
    outcome = board.receive(A, ms.SetParameters((ms.Parameter("/n.speed", 9.0),), "late"))
    text = f"/n.speed: {MAX_PARAMETER_REQUESTS} requests of this client wait already"
    assert outcome.events == []
    assert outcome.deliveries == [
        Delivery((A,), ms.Status(StatusLevel.ERROR, text, "parameter:/n.speed")),
        Delivery((A,), ms.ParameterValues((SPEED,), "late")),
    ]
    assert board.receive(B, ms.SetParameters((SPEED,), "q")).events == [ev.ParametersSet(B, (SPEED,), "q")]
    board.apply(ev.SendParameters(A, ("/n.speed",), "q"))
    assert board.receive(A, ms.SetParameters((SPEED,), "q")).deliveries == []


def test_more_open_gets_than_the_limit_are_refused_with_a_status() -> None:
    board = with_parameters(A)
    for _ in range(MAX_PARAMETER_REQUESTS):
        board.receive(A, ms.GetParameters((), "q"))
    outcome = board.receive(A, ms.GetParameters((), "late"))
    assert outcome.events == []
    text = f"parameters (request 'late'): {MAX_PARAMETER_REQUESTS} requests of this client wait already"
    assert refusals(outcome.deliveries) == [(A, text)]


def test_a_client_may_not_watch_ever_more_names() -> None:
    board = with_parameters(A)
    names = tuple(f"/n.x{number}" for number in range(MAX_WATCHED))
    assert board.receive(A, ms.SubscribeParameterUpdates(names)).deliveries == []
    outcome = board.receive(A, ms.SubscribeParameterUpdates(("/n.speed",)))
    assert (len(refusals(outcome.deliveries)), outcome.events) == (1, [])


def test_an_answer_carries_the_value_in_force() -> None:
    deliveries = with_parameters(A).apply(ev.SendParameters(A, ("/n.speed", "/n.no"), "q"))
    assert deliveries == [Delivery((A,), ms.ParameterValues((SPEED,), "q"))]


def test_an_answer_to_a_client_that_left_is_forgotten() -> None:
    board = with_parameters(A)
    board.leave(A)
    assert board.apply(ev.SendParameters(A, ("/n.speed",), "q")) == []
    assert board.apply(ev.SendToClient(A, ms.RemoveStatus(()))) == []


def test_changes_go_to_those_who_asked_for_them() -> None:
    board = with_parameters(A, B)
    board.receive(A, ms.SubscribeParameterUpdates(("/n.speed", "/n.later")))
    faster = ms.Parameter("/n.speed", 2.0, "float64")
    later = ms.Parameter("/n.later", True)
    deliveries = board.apply(ev.ParametersChanged((faster, later, ms.Parameter("/n.name", "y"))))
    assert deliveries == [Delivery((A,), ms.ParameterValues((faster, later)))]


def test_an_equal_value_is_no_change() -> None:
    board = with_parameters(A)
    board.receive(A, ms.SubscribeParameterUpdates(("/n.speed",)))
    assert board.apply(ev.ParametersChanged((SPEED,))) == []


def test_an_unset_parameter_is_told_without_value() -> None:
    board = with_parameters(A)
    board.receive(A, ms.SubscribeParameterUpdates(("/n.speed",)))
    deliveries = board.apply(ev.ParametersChanged((), ("/n.speed", "/n.unknown")))
    assert deliveries == [Delivery((A,), ms.ParameterValues((ms.Parameter("/n.speed"),)))]


def test_updates_end_when_they_are_unsubscribed() -> None:
    board = with_parameters(A)
    board.receive(A, ms.SubscribeParameterUpdates(("/n.speed",)))
    board.receive(A, ms.UnsubscribeParameterUpdates(("/n.speed",)))
    assert board.apply(ev.ParametersChanged((), ("/n.speed",))) == []


# --- connection graph ---

GRAPH = ConnectionGraph({"/t": ("/n",)})


def test_the_owner_hears_of_the_first_and_the_last_who_watch_the_graph() -> None:
    board = switchboard(A, B)
    assert board.receive(A, ms.SubscribeConnectionGraph()).events == [ev.GraphSubscriptionChanged(True)]
    assert board.receive(B, ms.SubscribeConnectionGraph()).events == []
    assert board.receive(A, ms.UnsubscribeConnectionGraph()).events == []
    assert board.leave(B) == [ev.GraphSubscriptionChanged(False)]


def test_each_watcher_gets_the_whole_graph_first_and_then_differences() -> None:
    board = switchboard(A, B)
    board.receive(A, ms.SubscribeConnectionGraph())
    whole = ms.ConnectionGraphUpdate((ms.PublishedTopic("/t", ("/n",)),))
    assert board.apply(ev.SetGraph(GRAPH)) == [Delivery((A,), whole)]
    assert board.receive(B, ms.SubscribeConnectionGraph()).deliveries == [Delivery((B,), whole)]
    assert board.apply(ev.SetGraph(GRAPH)) == []
    gone = ms.ConnectionGraphUpdate(removed_topics=("/t",))
    assert board.apply(ev.SetGraph(ConnectionGraph())) == [Delivery((A,), gone), Delivery((B,), gone)]


def test_asking_twice_for_the_graph_is_asking_once() -> None:
    board = switchboard(A)
    board.receive(A, ms.SubscribeConnectionGraph())
    outcome = board.receive(A, ms.SubscribeConnectionGraph())
    assert (outcome.deliveries, outcome.events) == ([], [])


# --- sessions, capabilities ---


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


def test_latched_messages_are_told_again_at_the_time_of_now() -> None:
    board = switchboard(A, B)
    subscribe(board, A, 1, 10)
    subscribe(board, B, 2, 11)
    for channel_id in (10, 11):
        board.apply(ev.RetainLast(channel_id, 1))
        board.retain(ev.Data(channel_id, 40, b"latched"))
    board.apply(ev.RetainLast(11, 0))
    board.apply(ev.SetTime(7))
    assert board.apply(ev.ResendRetained()) == [Delivery((A,), ms.MessageData(1, 7, b"latched"))]


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
def test_what_is_not_offered_is_refused(message: ms.ClientMessage, capability: Capability) -> None:
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
def test_a_read_only_client_changes_nothing_and_is_told_so(message: ms.ClientMessage) -> None:
    board = viewer_of(switchboard(A))
    outcome = board.receive(B, message)
    assert outcome.events == []
    statuses = [delivery.message for delivery in outcome.deliveries if isinstance(delivery.message, ms.Status)]
    assert all("read-only" in status.message for status in statuses)
    assert statuses
    assert {delivery.clients for delivery in outcome.deliveries} == {(B,)}


def test_a_read_only_client_that_sets_a_parameter_gets_the_value_in_force() -> None:
    board = viewer_of(switchboard())
    board.apply(ev.ParametersChanged((ms.Parameter("/n.p", 1),)))
    status, answer = (
        delivery.message
        for delivery in board.receive(B, ms.SetParameters((ms.Parameter("/n.p", 2),), "mine")).deliveries
    )
    assert status.id == "parameter:/n.p"
    assert answer == ms.ParameterValues((ms.Parameter("/n.p", 1),), "mine")


def test_a_read_only_client_that_calls_a_service_gets_a_failure() -> None:
    board = viewer_of(switchboard())
    outcome = board.receive(B, ms.ServiceRequest(SERVICE.id, 3, "cdr", b""))
    assert outcome.deliveries[0].message == ms.ServiceCallFailure(SERVICE.id, 3, READ_ONLY)


def test_a_read_only_client_calls_services_that_change_nothing() -> None:
    board = Switchboard(ServerInfo("test", tuple(Capability), ("cdr",)), is_read_only_service=lambda name: name == "/s")
    board.apply(ev.AddServices((SERVICE,)))
    request = ms.ServiceRequest(SERVICE.id, 1, "cdr", b"")
    assert viewer_of(board).receive(B, request).events == [ev.ServiceCalled(B, request)]


def test_a_read_only_client_watches_parameters_graph_and_assets() -> None:
    board = viewer_of(switchboard())
    for message in (
        ms.GetParameters((), "x"),
        ms.SubscribeParameterUpdates(("/n.p",)),
        ms.SubscribeConnectionGraph(),
        ms.FetchAsset("package://a/b.stl", 1),
    ):
        outcome = board.receive(B, message)
        assert not any(isinstance(delivery.message, ms.Status) for delivery in outcome.deliveries)


def test_a_new_session_tells_each_client_what_it_may() -> None:
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
