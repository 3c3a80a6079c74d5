"""Calls of services."""

from __future__ import annotations

import pytest

from tests.bridge.switchboard.boards import A, B, call, refusals, switchboard
from thymio_sim_ros.bridge.protocol import messages as ms
from thymio_sim_ros.bridge.protocol.constants import StatusLevel
from thymio_sim_ros.bridge.switchboard import events as ev
from thymio_sim_ros.bridge.switchboard.outcome import Delivery
from thymio_sim_ros.bridge.switchboard.pending_requests import (
    MAX_PENDING_CALLS,
    MAX_PENDING_SIZE,
)


def test_a_call_of_a_service_causes_an_event() -> None:
    request = ms.ServiceRequest(5, 1, "cdr", b"")
    assert switchboard(A).receive(A, request).events == [ev.ServiceCalled(A, request)]


def test_a_call_of_an_unknown_service_fails_with_a_status() -> None:
    outcome = switchboard(A).receive(A, ms.ServiceRequest(6, 1, "cdr", b""))
    assert outcome.deliveries == [
        Delivery((A,), ms.ServiceCallFailure(6, 1, "no service 6")),
        Delivery((A,), ms.Status(StatusLevel.ERROR, "no service 6")),
    ]


def test_pending_calls_are_limited_for_each_client() -> None:
    board = switchboard(A, B)
    for number in range(MAX_PENDING_CALLS):
        assert board.receive(A, call(number)).deliveries == []
    outcome = board.receive(A, call(99))
    text = f"/s: {MAX_PENDING_CALLS} calls of this client are pending: wait for their answers"
    assert outcome.events == []
    assert outcome.deliveries == [
        Delivery((A,), ms.ServiceCallFailure(5, 99, text)),
        Delivery((A,), ms.Status(StatusLevel.ERROR, text)),
    ]
    assert board.receive(B, call(99)).events == [ev.ServiceCalled(B, call(99))]


@pytest.mark.parametrize("answer", [ms.ServiceResponse(5, 0, "cdr", b""), ms.ServiceCallFailure(5, 0, "no")])
def test_an_answer_allows_another_call(answer: ms.ServiceResponse | ms.ServiceCallFailure) -> None:
    board = switchboard(A)
    for number in range(MAX_PENDING_CALLS):
        board.receive(A, call(number))
    assert board.apply(ev.AnswerCall(A, answer, 0)) == [Delivery((A,), answer)]
    assert board.receive(A, call(99)).deliveries == []
    assert board.receive(A, call(100)).events == []


def test_a_large_request_is_accepted_only_if_no_other_is_pending() -> None:
    board = switchboard(A)
    large = call(1, bytes(MAX_PENDING_SIZE + 1))
    assert board.receive(A, large).events == [ev.ServiceCalled(A, large)]
    assert refusals(board.receive(A, call(2, b"small")).deliveries[1:]) == [
        (A, "/s: 16 MiB of requests of this client are pending: wait for their answers")
    ]
    board.apply(ev.AnswerCall(A, ms.ServiceCallFailure(5, 1, "done"), len(large.payload)))
    assert board.receive(A, call(3, b"small")).deliveries == []


def test_a_call_of_a_removed_service_causes_no_event() -> None:
    board = switchboard(A)
    assert board.apply(ev.RemoveServices((5,))) == [Delivery((A,), ms.UnadvertiseServices((5,)))]
    assert board.receive(A, ms.ServiceRequest(5, 1, "cdr", b"")).events == []
