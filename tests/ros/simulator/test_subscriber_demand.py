"""Who listens decides which sensors are looked at, and when the next tick matters."""

from __future__ import annotations

import pytest

from thymio_sim_ros.ros.simulator.subscriber_demand import Audience, Heard
from thymio_sim_ros.sim.model.clock import NEVER_NS

MS = 1_000_000


def test_without_listeners_nothing_is_ever_due():
    audience = Audience()
    assert audience.sensors == frozenset()
    assert audience.due_ns(0) == NEVER_NS


def test_the_earliest_reading_that_is_heard_is_due():
    audience = Audience()
    audience.join(Heard("proximity"))
    assert audience.due_ns(0) == 100 * MS
    audience.join(Heard("pose"))
    assert [audience.due_ns(now * MS) for now in (0, 40, 50, 90)] == [50 * MS, 50 * MS, 100 * MS, 100 * MS]
    audience.leave(Heard("pose"))
    assert audience.due_ns(0) == 100 * MS
    assert audience.sensors == {"proximity"}


def test_a_sensor_is_looked_at_until_the_last_listener_goes():
    audience = Audience()
    audience.join(Heard("pose"))
    audience.join(Heard("pose"))
    audience.leave(Heard("pose"))
    assert audience.sensors == {"pose"}
    audience.leave(Heard("pose"))
    assert audience.sensors == frozenset()


def test_a_topic_slower_than_its_sensor_is_due_at_its_own_pace():
    audience = Audience()
    audience.join(Heard("motor", every_ns=50 * MS))
    assert [audience.due_ns(now * MS) for now in (0, 40, 50)] == [50 * MS, 50 * MS, 100 * MS]


@pytest.mark.parametrize("topic", [Heard("buttons", is_regular=False), Heard("loudspeaker")])
def test_what_happens_now_and_then_is_never_due_but_looked_at(topic):
    audience = Audience()
    audience.join(topic)
    assert audience.due_ns(0) == NEVER_NS
    assert audience.sensors == {topic.sensor}


def test_sensors_may_measure_at_another_rate():
    audience = Audience({"proximity": 30 * MS})
    audience.join(Heard("proximity"))
    assert audience.due_ns(0) == 30 * MS


def test_a_sensor_at_another_rate_has_no_phase_of_its_own():
    audience = Audience({"battery": 100 * MS, "proximity": 100 * MS})
    audience.join(Heard("battery"))
    audience.join(Heard("proximity"))
    assert [audience.due_ns(now * MS) for now in (0, 100)] == [100 * MS, 200 * MS]


def test_time_may_jump_back():
    audience = Audience()
    audience.join(Heard("pose"))
    assert [audience.due_ns(now * MS) for now in (90, 0, 60)] == [100 * MS, 50 * MS, 100 * MS]


def test_a_sensor_of_every_tick_makes_each_tick_due():
    audience = Audience()
    audience.join(Heard("proximity"))
    audience.join(Heard("motor"))
    assert [audience.due_ns(now * MS) for now in (0, 10, 90)] == [10 * MS, 20 * MS, 100 * MS]
    audience.leave(Heard("motor"))
    assert audience.due_ns(0) == 100 * MS
    audience.join(Heard("motor", every_ns=50 * MS))
    assert audience.due_ns(0) == 50 * MS
