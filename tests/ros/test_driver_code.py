"""Code written for the Thymio's ROS driver runs unchanged (docs/spec/ros-interface.md section 12)."""

from __future__ import annotations

import json
import math

import pytest
from nav_msgs.msg import Odometry
from std_msgs.msg import Bool, Float32MultiArray
from std_srvs.srv import Empty

from tests.ros.driver_style import SIDE_M, Careful, Shy, Square

WALL_AHEAD = json.dumps(
    {
        "format": 1,
        "title": "Wall ahead",
        "shapes": [
            {"kind": "rectangle", "name": "ground", "size_x_m": 2.0, "size_y_m": 2.0, "color": "#ffffff"},
            {"kind": "box", "name": "wall", "x_m": 0.5, "y_m": 0, "size_x_m": 0.1, "size_y_m": 1, "height_m": 0.1,
             "color": "#ffffff"},
        ],
        "robots": [{"name": "thymio", "x_m": 0.0, "y_m": 0.0}],
    }
)  # fmt: skip
WALL_M, NOSE_M = 0.45, 0.08

BOTH_WAYS = pytest.mark.parametrize("out_of_range", ["rep117", "driver"])


@pytest.mark.parametrize("out_of_range", [pytest.param("rep117", marks=pytest.mark.slow), "driver"])
def test_a_square_is_driven_by_odometry(ros, simulation, out_of_range):
    sim = simulation(playground="borderless", out_of_range=out_of_range, cmd_vel_timeout=0.0)
    lights = ros.collect(Float32MultiArray, "/_led/state")
    truth = ros.collect(Odometry, "/_ground_truth/odom")
    square = ros.start(Square)
    sim.until(lambda: square.is_done, seconds=60.0)
    places = [(message.pose.pose.position.x, message.pose.pose.position.y) for message in truth]
    begin = places[0]
    assert math.dist(begin, places[-1]) < 0.05
    assert max(math.dist(begin, place) for place in places) == pytest.approx(SIDE_M * math.sqrt(2), abs=0.05)
    shown = {tuple(message.data[:3]) for message in lights}
    assert {(1.0, 0.0, 0.0), (0.0, 1.0, 0.0)} <= shown


def test_ranges_are_added_up_as_the_driver_has_them(ros, simulation):
    sim = simulation(playground=WALL_AHEAD, out_of_range="driver")
    shy = ros.start(Shy)
    robot = sim.world.robots["thymio"]
    sim.until(lambda: robot.pose.x_m > 0.1)
    sim.until(lambda: shy.ranges["center"] > 0.0 and robot.twist.linear_m_s == 0.0)
    assert robot.pose.x_m < WALL_M - NOSE_M
    assert shy.ranges["rear_left"] == -1.0


def test_a_button_is_one_message_for_each_change(ros, simulation):
    sim = simulation(out_of_range="driver")
    shy = ros.start(Shy)
    finger = ros.publisher(Bool, "/_press/center")
    for is_pressed in (True, False):
        finger.publish(Bool(data=is_pressed))
        sim.until(lambda wanted=is_pressed: shy.pressed and shy.pressed[-1].data == wanted)
    assert [message.data for message in shy.pressed][-2:] == [True, False]


@BOTH_WAYS
def test_a_limit_stops_the_robot_in_both_conventions(ros, simulation, out_of_range):
    sim = simulation(playground=WALL_AHEAD, out_of_range=out_of_range, robot_names=["thymio0"])
    careful = ros.start(Careful)
    ros.until(careful.ready.service_is_ready)
    answer = careful.ready.call_async(Empty.Request())
    ros.until(answer.done)
    robot = sim.world.robots["thymio0"]
    sim.until(lambda: robot.pose.x_m > WALL_M - NOSE_M - 0.1)
    sim.until(lambda: robot.twist.linear_m_s == 0.0, seconds=5.0)
    assert 0.02 < WALL_M - NOSE_M - robot.pose.x_m < 0.09


def test_relative_names_follow_a_namespace(ros, simulation):
    sim = simulation(playground="borderless", robot_names=["thymio0"], cmd_vel_timeout=0.0)
    ros.start(Square, namespace="/thymio0")
    sim.until(lambda: sim.world.robots["thymio0"].pose.x_m > 0.05)
