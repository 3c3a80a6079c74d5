"""How many ticks are executed at a time."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

pytest.importorskip("rclpy")

from thymio_sim_ros.ros.interface.subscriber_demand import SubscriberDemand, TopicDemand
from thymio_sim_ros.ros.simulator.tick_scheduler import TickScheduler
from thymio_sim_ros.sim.model.clock import TICK_NS

WALL_NS = 5_000_000_000


def scheduler(batch_ticks: int) -> TickScheduler:
    """One whose deadlines begin at `WALL_NS`, with a reading in every tick."""
    demand = SubscriberDemand()
    demand.add(TopicDemand("motor"))
    clock: Any = SimpleNamespace(due_ns=None)
    made = TickScheduler(1.0, demand, clock, batch_ticks=batch_ticks)
    made.pop_owed(WALL_NS, 0)
    return made


def test_ticks_are_executed_together_if_asked_for() -> None:
    assert scheduler(3).wait_ns(WALL_NS, 0) - scheduler(1).wait_ns(WALL_NS, 0) == 2 * TICK_NS


def test_no_tick_is_deferred_while_events_have_receivers() -> None:
    batched = scheduler(3)
    batched.is_prompt = True
    assert batched.wait_ns(WALL_NS, 0) == scheduler(1).wait_ns(WALL_NS, 0)


def test_a_command_is_not_delayed_by_the_batch() -> None:
    batched = scheduler(3)
    batched.require_next_tick(0)
    assert batched.wait_ns(WALL_NS, 0) == scheduler(1).wait_ns(WALL_NS, 0)


def test_ticks_that_would_take_too_long_are_counted_as_dropped() -> None:
    late = scheduler(1)
    owed = late.pop_owed(WALL_NS + 5 * TICK_NS, 0)
    late.drop(owed - 2)
    assert late.dropped_ticks == owed - 2 > 0
