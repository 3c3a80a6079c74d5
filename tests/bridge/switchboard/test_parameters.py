"""Requests for parameters and subscriptions to their updates."""

from __future__ import annotations

from tests.bridge.switchboard.boards import A, B, refusals, switchboard
from thymio_sim_ros.bridge.protocol import messages as ms
from thymio_sim_ros.bridge.protocol.constants import StatusLevel
from thymio_sim_ros.bridge.switchboard import events as ev
from thymio_sim_ros.bridge.switchboard.outcome import Delivery
from thymio_sim_ros.bridge.switchboard.parameters import MAX_WATCHED
from thymio_sim_ros.bridge.switchboard.pending_requests import (
    MAX_PENDING_PARAMETER_REQUESTS,
)
from thymio_sim_ros.bridge.switchboard.switchboard import Switchboard

SPEED, NAME = ms.Parameter("/n.speed", 1.0, "float64"), ms.Parameter("/n.name", "x")


def with_parameters(*clients: int) -> Switchboard:
    board = switchboard(*clients)
    board.apply(ev.ParametersChanged((SPEED, NAME)))
    return board


def test_a_request_for_values_is_passed_to_the_data_source() -> None:
    outcome = with_parameters(A).receive(A, ms.GetParameters(("/n.name",), "q"))
    assert outcome.events == [ev.ParametersRequested(A, ("/n.name",), "q")]
    assert outcome.deliveries == []


def test_a_subscription_to_updates_causes_an_event_with_the_names() -> None:
    outcome = with_parameters(A).receive(A, ms.SubscribeParameterUpdates(("/n.name",)))
    assert outcome.events == [ev.ParametersWatched(A, ("/n.name",))]


def test_an_answer_to_a_request_for_all_parameters_has_all_values() -> None:
    deliveries = with_parameters(A).apply(ev.SendParameters(A, None, "q"))
    assert deliveries == [Delivery((A,), ms.ParameterValues((SPEED, NAME), "q"))]


def test_a_request_to_set_values_is_passed_to_the_data_source() -> None:
    outcome = with_parameters(A).receive(A, ms.SetParameters((SPEED,), "q"))
    assert outcome.events == [ev.ParametersSet(A, (SPEED,), "q")]
    assert outcome.deliveries == []


def test_a_set_request_above_the_limit_is_rejected_with_the_current_value() -> None:
    board = with_parameters(A, B)
    for _ in range(MAX_PENDING_PARAMETER_REQUESTS):
        assert board.receive(A, ms.SetParameters((SPEED,), "q")).deliveries == []
    outcome = board.receive(A, ms.SetParameters((ms.Parameter("/n.speed", 9.0),), "late"))
    text = f"/n.speed: {MAX_PENDING_PARAMETER_REQUESTS} requests of this client are pending: wait for their answers"
    assert outcome.events == []
    assert outcome.deliveries == [
        Delivery((A,), ms.Status(StatusLevel.ERROR, text, "parameter:/n.speed")),
        Delivery((A,), ms.ParameterValues((SPEED,), "late")),
    ]
    assert board.receive(B, ms.SetParameters((SPEED,), "q")).events == [ev.ParametersSet(B, (SPEED,), "q")]
    board.apply(ev.SendParameters(A, ("/n.speed",), "q"))
    assert board.receive(A, ms.SetParameters((SPEED,), "q")).deliveries == []


def test_a_get_request_above_the_limit_is_rejected_with_a_status() -> None:
    board = with_parameters(A)
    for _ in range(MAX_PENDING_PARAMETER_REQUESTS):
        board.receive(A, ms.GetParameters((), "q"))
    outcome = board.receive(A, ms.GetParameters((), "late"))
    assert outcome.events == []
    text = f"{MAX_PENDING_PARAMETER_REQUESTS} requests of this client are pending: wait for their answers"
    assert refusals(outcome.deliveries) == [(A, f"parameters (request 'late'): {text}")]


def test_the_names_that_a_client_watches_are_limited() -> None:
    board = with_parameters(A)
    names = tuple(f"/n.x{number}" for number in range(MAX_WATCHED))
    assert board.receive(A, ms.SubscribeParameterUpdates(names)).deliveries == []
    outcome = board.receive(A, ms.SubscribeParameterUpdates(("/n.speed",)))
    assert (len(refusals(outcome.deliveries)), outcome.events) == (1, [])


def test_an_answer_has_the_current_value() -> None:
    deliveries = with_parameters(A).apply(ev.SendParameters(A, ("/n.speed", "/n.no"), "q"))
    assert deliveries == [Delivery((A,), ms.ParameterValues((SPEED,), "q"))]


def test_an_answer_to_a_disconnected_client_is_dropped() -> None:
    board = with_parameters(A)
    board.leave(A)
    assert board.apply(ev.SendParameters(A, ("/n.speed",), "q")) == []
    assert board.apply(ev.SendToClient(A, ms.RemoveStatus(()))) == []


def test_changes_are_sent_to_the_clients_that_watch_the_parameter() -> None:
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


def test_a_removed_parameter_is_sent_without_value() -> None:
    board = with_parameters(A)
    board.receive(A, ms.SubscribeParameterUpdates(("/n.speed",)))
    deliveries = board.apply(ev.ParametersChanged((), ("/n.speed", "/n.unknown")))
    assert deliveries == [Delivery((A,), ms.ParameterValues((ms.Parameter("/n.speed"),)))]


def test_updates_end_when_they_are_unsubscribed() -> None:
    board = with_parameters(A)
    board.receive(A, ms.SubscribeParameterUpdates(("/n.speed",)))
    board.receive(A, ms.UnsubscribeParameterUpdates(("/n.speed",)))
    assert board.apply(ev.ParametersChanged((), ("/n.speed",))) == []
