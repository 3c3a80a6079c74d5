"""Rejected and ineffective commands: each reason is logged, and the usual causes are named."""

from __future__ import annotations

import math

import pytest
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from geometry_msgs.msg import Twist, Vector3
from rcl_interfaces.msg import Log
from std_msgs.msg import Float64MultiArray

from thymio_sim_ros.ros.rclpy_ext import message_reports

NEAR_ZERO = 5e-324
"""What rclpy sends for the int 1 in a float field."""


@pytest.fixture
def warnings_of(ros):
    """Return the warnings of the log from now on."""

    def start():
        return ros.collect(Log, "/rosout", where=lambda log: log.level == 30)

    return start


def test_each_reason_of_a_rejection_is_logged(ros, simulation, warnings_of):
    sim = simulation()
    logs = warnings_of()
    publisher = ros.publisher(Twist, "/cmd_vel")
    for command in (Twist(linear=Vector3(x=math.nan)), Twist(angular=Vector3(z=math.inf))) * 2:
        publisher.publish(command)
        sim.step(0.02)
    ros.until(lambda: len(logs) == 3)
    texts = [log.msg for log in logs]
    assert texts[0] == "/cmd_vel rejected: linear.x is nan, expected a finite number"
    assert texts[1].startswith("/cmd_vel may be computed from ranges: one without an obstacle is +inf")
    assert texts[1].endswith("start `thymio-sim --out-of-range driver`, or --ros-args -p out_of_range:=driver")
    assert texts[2] == "/cmd_vel rejected: angular.z is inf, expected a finite number"


def test_driver_ranges_are_no_cause(ros, simulation, warnings_of):
    sim = simulation(out_of_range="driver")
    logs = warnings_of()
    publisher = ros.publisher(Twist, "/cmd_vel")
    publisher.publish(Twist(linear=Vector3(x=math.nan)))
    sim.step(0.02)
    publisher.publish(Twist(angular=Vector3(z=math.nan)))
    sim.step(0.02)
    ros.until(lambda: len(logs) == 2)
    assert all("rejected" in log.msg for log in logs)


@pytest.mark.parametrize(
    ("topic", "message", "field"),
    [
        ("/cmd_vel", Twist(linear=Vector3(x=NEAR_ZERO)), "linear.x"),
        ("/_wheels/command", Float64MultiArray(data=[0.0, NEAR_ZERO]), "data"),
    ],
)
def test_an_int_in_a_float_field_is_named(ros, simulation, warnings_of, topic, message, field):
    sim = simulation()
    logs = warnings_of()
    publisher = ros.publisher(type(message), topic)
    for _ in range(2):
        publisher.publish(message)
        sim.step(0.02)
    ros.until(lambda: logs)
    assert [log.msg for log in logs] == [
        f"{topic} has a value near zero in {field}: an int in a float field, such as linear.x = 1 in place of 1.0?"
        " ROS_PYTHON_CHECK_FIELDS=1 (thymio-sim env) shows the line (reported once per topic)"
    ]


def test_diagnostics_and_viewers_get_the_present_reasons(ros, simulation, monkeypatch):
    sim = simulation()
    received = ros.collect(DiagnosticArray, "/diagnostics")
    publisher = ros.publisher(Twist, "/cmd_vel")
    for speed in (math.nan, 9.0):
        publisher.publish(Twist(linear=Vector3(x=speed)))
        sim.step(0.02)

    def status():
        received.clear()
        sim.simulator._publish_heartbeat(0)
        ros.until(lambda: received)
        (found,) = (one for one in received[-1].status if one.name == "simulator: messages")
        return found

    rejected = "/cmd_vel rejected: linear.x is nan, expected a finite number"
    present = status()
    assert (present.level, present.message) == (DiagnosticStatus.WARN, rejected)
    counts, texts = present.values[:2], [pair.value for pair in present.values[2:]]
    assert [(pair.key, pair.value) for pair in counts] == [("rejected", "1"), ("clamped", "1")]
    assert texts[0] == rejected
    assert texts[1].startswith("/cmd_vel clamped: a wheel would need 9 m/s")
    assert sim.simulator.runner.state().faults == (rejected,)
    monkeypatch.setattr(message_reports, "RECENT_S", -1.0)
    past = status()
    assert (past.level, [pair.value for pair in past.values]) == (DiagnosticStatus.OK, ["1", "1"])
    assert sim.simulator.runner.state().faults == ()
