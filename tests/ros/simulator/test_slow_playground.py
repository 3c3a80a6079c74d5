"""A playground that takes long to load keeps messages waiting, but not the world."""

from __future__ import annotations

import threading

import pytest
from rclpy.parameter import Parameter

from tests.patience import PATIENCE_S
from thymio_sim_ros.ros.simulator import prepared_playground


class Request:
    """An executor with one message: a request that sets the playground."""

    def __init__(self, node) -> None:
        self.node, self.result = node, None

    def spin_once(self, timeout_sec: float) -> None:
        if self.result is None:
            (self.result,) = self.node.set_parameters([Parameter("playground", value="desk")])

    def create_task(self, _task) -> Request:
        return self

    def done(self) -> bool:
        return self.result is not None


@pytest.fixture
def slow(simulation, monkeypatch):
    """A running simulator, whose next playground loads until the world has gone on for a second."""
    sim = simulation()
    world, load = sim.world, prepared_playground.load_playground
    sim.threads, sim.gone_on = [], threading.Event()

    def load_late(value: str) -> object:
        sim.threads.append(threading.current_thread())
        assert sim.gone_on.wait(PATIENCE_S)
        return load(value)

    def look() -> None:
        if world.now_ns >= 1_000_000_000:
            sim.gone_on.set()

    monkeypatch.setattr(prepared_playground, "load_playground", load_late)
    sim.simulator.runner.on_tick.append(look)
    sim.simulator.runner.pause(False)
    yield sim
    sim.gone_on.set()


def test_the_world_goes_on_while_a_playground_loads(slow):
    before, request = slow.world, Request(slow.simulator.node)
    slow.simulator.runner.spin(request)
    assert request.result.successful
    assert before.now_ns >= 1_000_000_000
    assert slow.simulator.runner.prepared.name == "desk"
    assert slow.threads != [threading.current_thread()]


def test_a_paused_world_waits(slow):
    slow.simulator.runner.pause(True)
    slow.gone_on.set()
    before, request = slow.world, Request(slow.simulator.node)
    slow.simulator.runner.spin(request)
    assert (request.result.successful, before.now_ns) == (True, 0)


def test_what_cannot_be_loaded_is_refused_with_the_reason(slow, monkeypatch):
    def fail(_value: str) -> None:
        raise OSError("nothing there")

    monkeypatch.setattr(prepared_playground, "load_playground", fail)
    request = Request(slow.simulator.node)
    slow.simulator.runner.spin(request)
    assert (request.result.successful, request.result.reason) == (False, "nothing there")


def test_a_simulator_that_ends_does_not_wait(slow):
    slow.simulator.interrupt()
    request = Request(slow.simulator.node)
    slow.simulator.runner.spin(request)
    assert (request.result.successful, request.result.reason) == (False, "the simulator ends")


def test_without_a_thread_that_runs_the_node_the_world_stands_still(slow):
    slow.gone_on.set()
    world = slow.world
    assert slow.simulator.parameter_callbacks.load_playground("desk") == ""
    assert world.now_ns == 0
    assert slow.threads == [threading.current_thread()]
