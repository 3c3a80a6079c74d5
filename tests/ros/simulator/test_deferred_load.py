"""A parameter that takes long to load keeps no other request waiting, and is set as always in the end."""

from __future__ import annotations

import threading

import pytest
from rcl_interfaces.msg import SetParametersResult
from rcl_interfaces.srv import GetParameters, SetParameters, SetParametersAtomically
from rclpy.node import Node
from rclpy.parameter import Parameter

from tests.patience import PATIENCE_S
from thymio_sim_ros.ros.simulator.deferred_load import MAX_WAITING, DeferredLoad


class Loading:
    """A node whose parameter `map` loads only while `gate` is open."""

    def __init__(self, ros) -> None:
        self.node = ros.add(Node("loading", context=ros.context, enable_rosout=False))
        self.node.declare_parameter("map", "")
        self.node.declare_parameter("other", 0)
        self.gate = threading.Event()
        self.threads: list[threading.Thread] = []
        self.results: list[str] = []
        self.loader = DeferredLoad(self.node, "map", self._load)
        self.node.add_on_set_parameters_callback(self._check)

    def _load(self, value: str) -> str:
        self.threads.append(threading.current_thread())
        assert self.gate.wait(PATIENCE_S)
        if value == "bad":
            raise ValueError("no such map")
        return value.upper()

    def _check(self, parameters: list[Parameter]) -> SetParametersResult:
        for parameter in parameters:
            if parameter.name == "map":
                try:
                    self.results.append(self.loader.load(parameter.value))
                except ValueError as error:
                    return SetParametersResult(successful=False, reason=str(error))
        return SetParametersResult(successful=True)


@pytest.fixture
def loading(ros):
    made = Loading(ros)
    yield made
    made.gate.set()
    made.loader.close()


@pytest.fixture
def send(ros):
    """Send a request that sets parameters, without waiting for its answer."""

    def sender(*values, service="set_parameters", kind=SetParameters):
        client = ros.node.create_client(kind, f"/loading/{service}")
        ros.until(client.service_is_ready)
        parameters = [Parameter(name, value=value).to_parameter_msg() for name, value in values]
        return client.call_async(kind.Request(parameters=parameters))

    return sender


def test_other_requests_are_answered_while_a_value_loads(ros, loading, send):
    pending = send(("map", "hall"))
    ros.until(lambda: loading.threads)
    values = ros.call(GetParameters, "/loading/get_parameters", GetParameters.Request(names=["map"])).values
    assert values[0].string_value == ""
    other = ros.call(
        SetParameters,
        "/loading/set_parameters",
        SetParameters.Request(parameters=[Parameter("other", value=1).to_parameter_msg()]),
    )
    assert other.results[0].successful
    assert not pending.done()
    loading.gate.set()
    ros.until(pending.done)
    assert pending.result().results[0].successful
    assert loading.node.get_parameter("map").value == "hall"
    assert loading.results == ["HALL"]
    assert loading.threads[0] is not threading.current_thread()
    assert len(loading.threads) == 1


def test_both_services_wait_and_a_refusal_has_its_reason(ros, loading, send):
    loading.gate.set()
    one = send(("map", "bad"))
    both = send(("other", 5), ("map", "bad"), service="set_parameters_atomically", kind=SetParametersAtomically)
    ros.until(lambda: one.done() and both.done())
    assert (one.result().results[0].successful, one.result().results[0].reason) == (False, "no such map")
    assert (both.result().result.successful, both.result().result.reason) == (False, "no such map")
    assert loading.node.get_parameter("other").value == 0


def test_more_than_a_few_requests_are_refused_at_once(ros, loading, send):
    waiting = [send(("map", f"hall {number}")) for number in range(MAX_WAITING + 2)]
    ros.until(lambda: sum(one.done() for one in waiting) == 2)
    refused = [one.result().results[0] for one in waiting if one.done()]
    assert [one.reason for one in refused] == [f"{MAX_WAITING} other values of map are loading"] * 2
    loading.gate.set()
    ros.until(lambda: all(one.done() for one in waiting))
    assert sum(one.result().results[0].successful for one in waiting) == MAX_WAITING


def test_one_request_sets_one_value(ros, loading, send):
    pending = send(("map", "hall"), ("map", "yard"))
    ros.until(pending.done)
    assert [one.reason for one in pending.result().results] == ["map is set 2 times, expected once"] * 2
    assert loading.threads == []


def test_the_thread_ends_with_the_node(ros, loading, send):
    loading.gate.set()
    ros.until(send(("map", "hall")).done)
    (thread,) = loading.threads
    assert thread.is_alive()
    loading.loader.close()
    thread.join(PATIENCE_S)
    assert not thread.is_alive()


def test_the_node_itself_loads_at_once(loading):
    loading.gate.set()
    assert loading.node.set_parameters([Parameter("map", value="hall")])[0].successful
    assert loading.threads == [threading.current_thread()]
