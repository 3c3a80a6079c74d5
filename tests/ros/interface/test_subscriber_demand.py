"""Subscribers determine which sensors are read, and when the next reading is due."""

from __future__ import annotations

import pytest

from thymio_sim_ros.ros.interface.subscriber_demand import SubscriberDemand, TopicDemand
from thymio_sim_ros.sim.model.clock import NEVER_NS

MS = 1_000_000


def test_without_subscribers_no_reading_is_due():
    demand = SubscriberDemand()
    assert demand.sensors == frozenset()
    assert demand.due_ns(0) == NEVER_NS


def test_the_earliest_reading_with_a_subscriber_is_due():
    demand = SubscriberDemand()
    demand.add(TopicDemand("proximity"))
    assert demand.due_ns(0) == 100 * MS
    demand.add(TopicDemand("pose"))
    assert [demand.due_ns(now * MS) for now in (0, 40, 50, 90)] == [50 * MS, 50 * MS, 100 * MS, 100 * MS]
    demand.remove(TopicDemand("pose"))
    assert demand.due_ns(0) == 100 * MS
    assert demand.sensors == {"proximity"}


def test_a_sensor_is_read_until_its_last_subscriber_leaves():
    demand = SubscriberDemand()
    demand.add(TopicDemand("pose"))
    demand.add(TopicDemand("pose"))
    demand.remove(TopicDemand("pose"))
    assert demand.sensors == {"pose"}
    demand.remove(TopicDemand("pose"))
    assert demand.sensors == frozenset()


def test_a_topic_slower_than_its_sensor_is_due_at_its_own_pace():
    demand = SubscriberDemand()
    demand.add(TopicDemand("motor", every_ns=50 * MS))
    assert [demand.due_ns(now * MS) for now in (0, 40, 50)] == [50 * MS, 50 * MS, 100 * MS]


@pytest.mark.parametrize("topic", [TopicDemand("buttons", is_periodic=False), TopicDemand("loudspeaker")])
def test_an_event_driven_reading_is_never_due_but_read(topic):
    demand = SubscriberDemand()
    demand.add(topic)
    assert demand.due_ns(0) == NEVER_NS
    assert demand.sensors == {topic.sensor}


def test_sensors_may_measure_at_another_rate():
    demand = SubscriberDemand({"proximity": 30 * MS})
    demand.add(TopicDemand("proximity"))
    assert demand.due_ns(0) == 30 * MS


def test_a_sensor_at_another_rate_has_no_phase_of_its_own():
    demand = SubscriberDemand({"battery": 100 * MS, "proximity": 100 * MS})
    demand.add(TopicDemand("battery"))
    demand.add(TopicDemand("proximity"))
    assert [demand.due_ns(now * MS) for now in (0, 100)] == [100 * MS, 200 * MS]


def test_time_may_jump_back():
    demand = SubscriberDemand()
    demand.add(TopicDemand("pose"))
    assert [demand.due_ns(now * MS) for now in (90, 0, 60)] == [100 * MS, 50 * MS, 100 * MS]


def test_a_sensor_of_every_tick_makes_each_tick_due():
    demand = SubscriberDemand()
    demand.add(TopicDemand("proximity"))
    demand.add(TopicDemand("motor"))
    assert [demand.due_ns(now * MS) for now in (0, 10, 90)] == [10 * MS, 20 * MS, 100 * MS]
    demand.remove(TopicDemand("motor"))
    assert demand.due_ns(0) == 100 * MS
    demand.add(TopicDemand("motor", every_ns=50 * MS))
    assert demand.due_ns(0) == 50 * MS
