"""Two simulators with one clock detect each other; a silent publisher, or one of another clock, is no conflict."""

from __future__ import annotations

import pytest
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from rcl_interfaces.msg import Log
from rosgraph_msgs.msg import Clock

from thymio_sim_ros.ros.interface import qos
from thymio_sim_ros.ros.simulator import clock_conflict
from thymio_sim_ros.ros.simulator.node import Simulator, SimulatorParams

PAUSED = SimulatorParams(start_paused=True)
CLOCK = "simulator: clock"


@pytest.fixture
def simulator(ros):
    """Make a paused simulator."""
    return lambda: ros.live(Simulator(ros.context, PAUSED))


def levels(messages) -> list[bytes]:
    """Return the levels of all statuses about clocks."""
    return [status.level for message in messages for status in message.status if status.name == CLOCK]


def beat(*simulators) -> None:
    """Publish the heartbeat of each simulator."""
    for one in simulators:
        one._publish_heartbeat(0)


def conflict(simulator):
    return simulator.endpoints.clock.conflict


def test_both_warn_once_and_show_an_error_until_one_is_gone(ros, simulator):
    first, second = simulator(), simulator()
    logs = ros.collect(Log, "/rosout", where=lambda log: "another simulator" in log.msg)
    diagnostics = ros.collect(DiagnosticArray, "/diagnostics")

    def both_found() -> bool:
        beat(first, second)
        return conflict(first).is_found and conflict(second).is_found

    ros.until(both_found)
    ros.until(lambda: len(logs) == 2)
    for log in logs:
        assert f"/clock: another simulator publishes it in ROS_DOMAIN_ID {ros.domain}" in log.msg
        assert "its own ROS_DOMAIN_ID" in log.msg
        assert "-r /clock:=/lab1/clock" in log.msg
    for _ in range(5):
        beat(first, second)
        ros.deliver()
    assert len(logs) == 2
    diagnostics.clear()
    beat(first, second)
    ros.until(lambda: levels(diagnostics) == [DiagnosticStatus.ERROR] * 2)

    ros.end(second)

    def is_alone() -> bool:
        beat(first)
        return not conflict(first).is_found

    ros.until(is_alone)
    diagnostics.clear()
    beat(first)
    ros.until(lambda: levels(diagnostics) == [DiagnosticStatus.OK])
    assert conflict(first)._subscription is None


def test_a_silent_publisher_is_no_conflict(ros, simulator):
    """As one that was killed: discovery keeps it for some time."""
    alone = simulator()
    ros.node.create_publisher(Clock, "/clock", qos.CLOCK)
    heard = ros.collect(Clock, "/clock")

    def is_watched() -> bool:
        beat(alone)
        return conflict(alone)._subscription is not None

    ros.until(is_watched)
    ros.settle()
    heard.clear()

    def has_subscribers() -> bool:
        beat(alone)
        return len(heard) >= 10

    ros.until(has_subscribers)
    assert not conflict(alone).is_found
    assert conflict(alone).status().level == DiagnosticStatus.OK


def test_a_simulator_with_another_clock_is_no_conflict(ros, simulator, simulator_with):
    alone = simulator()
    other = simulator_with("-r", "/clock:=/lab1/clock", start_paused=True)
    ros.until(lambda: ros.node.count_publishers("/lab1/clock"))
    beat(alone, other)
    assert conflict(alone)._subscription is None
    assert conflict(other)._subscription is None


def test_without_a_clock_there_is_nothing_to_find(ros, simulation):
    sim = simulation(publish_clock=False)
    diagnostics = ros.collect(DiagnosticArray, "/diagnostics")
    beat(sim.simulator)
    ros.until(lambda: diagnostics)
    assert levels(diagnostics) == []


def test_a_proof_is_forgotten_when_the_other_falls_silent(ros):
    now = [100.0]
    found = clock_conflict.ClockConflict(ros.node, "/clock", 0, lambda: now[0])
    for _ in range(clock_conflict.PROOF):
        found._on_clock(Clock())
    ros.node.create_publisher(Clock, "/clock", qos.CLOCK)
    ros.node.create_publisher(Clock, "/clock", qos.CLOCK)
    ros.until(lambda: ros.node.count_publishers("/clock") == 2)
    found.poll()
    assert found.is_found
    now[0] += clock_conflict.REMEMBERED_S
    found.poll()
    assert not found.is_found
