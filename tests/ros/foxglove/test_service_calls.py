"""Calls of services without a blocking wait, driven by hand."""

from __future__ import annotations

import math
import sys

import pytest
from rclpy.task import Future
from std_srvs.srv import Trigger

from thymio_sim_ros.ros.foxglove.service_calls import ServiceCalls
from thymio_sim_ros.ros.rclpy_ext.deferred_service import create_deferred_service


class Service:
    """Replaces a client of rclpy; the test decides when its service answers."""

    def __init__(self):
        self.requests = []
        self.is_ready = True
        self.checks = 0

    def service_is_ready(self):
        self.checks += 1
        return self.is_ready

    def call_async(self, request):
        if request == "impossible":
            raise TypeError("impossible")
        future = Future()
        self.requests.append((request, future))
        return future

    def remove_pending_request(self, future):
        pass

    def answer(self):
        """Answer the oldest request by itself."""
        request, future = self.requests.pop(0)
        future.set_result(request)
        return request


class Node:
    """Creates clients, and records log messages."""

    def __init__(self):
        self.services = {}
        self.errors = []

    def create_client(self, _type, name):
        return self.services.setdefault(name, Service())

    def destroy_client(self, client):
        client.is_ready = False

    def get_logger(self):
        return self

    def error(self, text):
        self.errors.append(text)


@pytest.fixture
def node():
    return Node()


@pytest.fixture
def calls(node):
    return ServiceCalls(node)


def test_requests_in_flight_are_limited(node, calls):
    answers = []
    for number in range(20):
        calls.call(str, "/s", f"{number % 4}/{number}", lambda response, _: answers.append(response), sender=number % 4)
    assert len(node.services["/s"].requests) == 5
    while node.services["/s"].requests:
        node.services["/s"].answer()
    assert len(answers) == 20
    assert not calls.poll()


def test_a_sender_with_many_calls_delays_another_by_two(node, calls):
    for number in range(64):
        calls.call(str, "/s", f"busy {number}", lambda *_: None, sender=1)
    calls.call(str, "/s", "quiet", lambda *_: None, sender=2)
    assert [request for request, _ in node.services["/s"].requests] == ["busy 0", "busy 1", "quiet"]


def test_readiness_is_polled_for_each_service_not_for_each_call(node, calls):
    """A thousand open calls once caused a million queries per second."""
    calls.call(str, "/s", "first", lambda *_: None)
    node.services["/s"].is_ready = False
    for number in range(1000):
        calls.call(str, "/s", number, lambda *_: None)
    node.services["/s"].checks = 0
    assert calls.poll()
    assert node.services["/s"].checks == 1


def test_a_callback_may_make_many_calls_without_recursion(node, calls):
    depth = []

    def again(_response, _reason):
        depth.append(len(depth))
        if len(depth) < 2 * sys.getrecursionlimit():
            calls.call(str, "/s", "impossible", again)

    calls.call(str, "/s", "impossible", again)
    assert len(depth) == 2 * sys.getrecursionlimit()
    assert node.errors == []


def test_calls_end_by_their_deadline_whether_they_were_sent_or_not(node):
    calls = ServiceCalls(node, timeout_s=0.0)
    reasons = []
    for number in range(10):
        calls.call(str, "/s", number, lambda response, reason: reasons.append((response, reason)))
    assert not calls.poll()
    assert reasons == [(None, "no answer from /s within 0 s")] * 10
    while node.services["/s"].requests:
        node.services["/s"].answer()
    assert len(reasons) == 10


def test_a_call_may_have_a_time_out_of_its_own(node):
    calls = ServiceCalls(node, timeout_s=1000.0)
    reasons = []
    calls.call(str, "/patient", 1, lambda _, reason: reasons.append(reason))
    calls.call(str, "/hasty", 2, lambda _, reason: reasons.append(reason), timeout_s=0.0)
    assert calls.poll()
    assert reasons == ["no answer from /hasty within 0 s"]


def test_calls_of_a_vanished_service_fail(node, calls):
    reasons = []
    for number in range(3):
        calls.call(str, "/s", number, lambda _, reason: reasons.append(reason))
    calls.forget("/s")
    assert reasons == ["service /s no longer exists"] * 3
    assert not calls.poll()


def test_a_callback_that_raises_is_logged_and_others_follow(node, calls):
    answers = []
    calls.call(str, "/s", 1, lambda *_: 1 / 0)
    calls.call(str, "/s", 2, lambda response, _: answers.append(response))
    node.services["/s"].answer()
    node.services["/s"].answer()
    assert answers == [2]
    assert "ZeroDivisionError" in node.errors[0]


def test_a_service_that_is_gone_is_forgotten_when_its_calls_have_ended(ros):
    calls, answers = ServiceCalls(ros.node, timeout_s=0.0), []
    calls.call(Trigger, "/never", Trigger.Request(), lambda response, reason: answers.append(reason))
    calls.forget_gone({})
    assert not answers
    ros.until(lambda: not calls.poll())
    calls.forget_gone({"/never": []})
    assert any(client.srv_name == "/never" for client in ros.node.clients)
    calls.forget_gone({})
    assert not any(client.srv_name == "/never" for client in ros.node.clients)


def test_the_calls_of_a_sender_are_canceled(ros):
    calls, answers = ServiceCalls(ros.node, timeout_s=math.inf), []
    for sender in (1, 2):
        calls.call(Trigger, "/never", Trigger.Request(), lambda _, reason: answers.append(reason), sender=sender)
    calls.cancel(1)
    assert answers == ["call of /never canceled"]
    assert calls.poll()
    calls.cancel(2)
    assert not calls.poll()


def test_the_results_of_actions_do_not_wait_for_each_other(ros):
    waiting, calls = [], ServiceCalls(ros.node)
    name = "/walk/_action/get_result"
    create_deferred_service(ros.node, Trigger, name, lambda request, respond: waiting.append(respond))
    for _ in range(8):
        calls.call(Trigger, name, Trigger.Request(), lambda response, reason: None)
    ros.until(lambda: calls.poll() and len(waiting) == 8)
