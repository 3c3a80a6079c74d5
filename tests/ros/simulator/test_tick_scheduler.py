"""How many ticks are executed at a time."""

from __future__ import annotations

import time
from types import SimpleNamespace
from typing import Any

import pytest

pytest.importorskip("rclpy")

from thymio_sim_ros.ros.interface.subscriber_demand import SubscriberDemand, TopicDemand
from thymio_sim_ros.ros.simulator.tick_scheduler import TickScheduler
from thymio_sim_ros.sim.model.clock import TICK_NS


def scheduler(batch_ticks: int) -> TickScheduler:
    demand = SubscriberDemand()
    demand.add(TopicDemand("motor"))  # a reading in every tick
    clock: Any = SimpleNamespace(due_ns=None)
    return TickScheduler(1.0, demand, clock, batch_ticks=batch_ticks)


def test_ticks_are_executed_together_if_asked_for() -> None:
    wall_ns = time.monotonic_ns()
    single, batched = scheduler(1), scheduler(3)
    assert batched.wait_ns(wall_ns, 0) - single.wait_ns(wall_ns, 0) >= 2 * TICK_NS


def test_a_command_is_not_delayed_by_the_batch() -> None:
    wall_ns = time.monotonic_ns()
    batched = scheduler(3)
    before_ns = batched.wait_ns(wall_ns, 0)
    batched.require_next_tick(0)
    assert before_ns - batched.wait_ns(wall_ns, 0) == 2 * TICK_NS
