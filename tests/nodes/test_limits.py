"""What is beyond the robot is limited, and told: once in the log for each topic, counted in the diagnostics."""

from __future__ import annotations

import pytest
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import Twist, TwistStamped, Vector3
from rcl_interfaces.msg import Log
from std_msgs.msg import ColorRGBA, Float32, Float32MultiArray, Float64MultiArray, Int16, Int16MultiArray

from thymio_sim_ros.nodes.robot_inputs import robot_inputs
from thymio_sim_ros.sim.commands import LED_GROUPS
from thymio_sim_ros.sim.thymio2 import MAX_SPEED_M_S, WHEEL_RADIUS_M
from thymio_sim_ros.sim.tones import HIGHEST_HZ, LOWEST_HZ

INPUTS = {one.topic: one for one in robot_inputs()}
FULL_RAD_S = MAX_SPEED_M_S / WHEEL_RADIUS_M


def twist(linear, angular=0.0):
    return Twist(linear=Vector3(x=linear), angular=Vector3(z=angular))


BEYOND = {
    "cmd_vel": (
        twist(0.5),
        twist(MAX_SPEED_M_S),
        "a wheel would need 0.5 m/s, expected at most 0.166; both wheels are slowed down together",
    ),
    "_cmd_vel_stamped": (TwistStamped(twist=twist(0.0, 10.0)), TwistStamped(twist=twist(0.1, -1.0)), "a wheel would"),
    "_wheels/command": (
        Float64MultiArray(data=[0.0, -20.0]),
        Float64MultiArray(data=[FULL_RAD_S, -FULL_RAD_S]),
        "a wheel would need 0.44 m/s",
    ),
    "_motor/target": (
        Int16MultiArray(data=[0, -501]),
        Int16MultiArray(data=[500, -500]),
        "target -501 found, expected -500 to 500",
    ),
    **{
        f"led/body/{group}": (ColorRGBA(r=255.0), ColorRGBA(r=1.0, a=255.0), "color 255 found, expected 0 to 1")
        for group in ("top", "bottom_left", "bottom_right")
    },
    **{
        f"led/{group}": (
            Float32MultiArray(data=[0.0] * (size - 1) + [32.0]),
            Float32MultiArray(data=[1.0] * size),
            "intensity 32 found, expected 0 to 1",
        )
        for group, size in LED_GROUPS.items()
        if f"led/{group}" in INPUTS
    },
    "_led/single": (Int16MultiArray(data=[3, 33]), Int16MultiArray(data=[38, 32]), "brightness 33 found"),
    "sound/tone": (
        Float32MultiArray(data=[9000.0, 1.0]),
        Float32MultiArray(data=[0.0, -1.0]),
        "frequency 9000 found, expected 55.0",
    ),
    "_comm/tx": (Int16(data=2048), Int16(data=-1), "value 2048 found, expected -32768 to 2047"),
    "_pen/color": (ColorRGBA(g=-1.0, a=1.0), ColorRGBA(), "color -1 found"),
    "_press/clap": (Float32(data=1.5), Float32(data=1.0), "loudness 1.5 found, expected 0 to 1"),
    "_press/sound": (Float32(data=-0.5), Float32(data=0.0), "loudness -0.5 found"),
    "_press/light": (Float32(data=2.0), Float32(data=1.0), "light 2 found"),
}
"""A message beyond, one just within, and what is said of the first."""


@pytest.mark.parametrize("topic", BEYOND)
def test_what_is_beyond_the_robot_is_said(topic):
    one, (message, within, said) = INPUTS[topic], BEYOND[topic]
    assert one.beyond(message).startswith(said)
    assert one.beyond(within) == ""


@pytest.mark.parametrize("hertz", [LOWEST_HZ, -LOWEST_HZ, HIGHEST_HZ, -HIGHEST_HZ])
@pytest.mark.parametrize("seconds", [0.0, 1.0])
def test_tones_are_limited_to_what_the_wave_can_have_either_sign_and_however_long(hertz, seconds):
    def beyond(factor):
        return INPUTS["sound/tone"].beyond(Float32MultiArray(data=[factor * hertz, seconds]))

    outwards = 1.01 if abs(hertz) == HIGHEST_HZ else 0.99
    assert beyond(1.0) == beyond(1 / outwards) == ""
    assert beyond(outwards).startswith("frequency")


def test_a_command_beyond_the_robot_is_limited_told_once_and_counted(ros, simulation):
    sim = simulation()
    logs = ros.collect(Log, "/rosout", where=lambda log: "limited" in log.msg)
    diagnostics = ros.collect(DiagnosticArray, "/diagnostics")
    wheels = ros.publisher(Twist, "/cmd_vel")
    for _ in range(2):
        wheels.publish(twist(0.5))
        sim.step(0.2)
    ros.publisher(ColorRGBA, "/led/body/top").publish(ColorRGBA(r=255.0))
    ros.until(lambda: len(logs) == 2)
    assert [log.msg.partition(":")[0] for log in logs] == ["/cmd_vel limited", "/led/body/top limited"]
    assert sim.thymio.speed == pytest.approx(MAX_SPEED_M_S, rel=0.1)
    sim.simulator._beat(0)
    ros.until(lambda: diagnostics)
    assert {pair.key: pair.value for pair in diagnostics[-1].status[0].values}["messages limited"] == "3"
