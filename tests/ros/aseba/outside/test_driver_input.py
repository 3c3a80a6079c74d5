"""The runtime with a robot behind its ROS driver: a fake one that has the driver's topics and nothing else."""

from __future__ import annotations

import math

import pytest
from geometry_msgs.msg import Twist, TwistWithCovariance, Vector3
from nav_msgs.msg import Odometry
from sensor_msgs.msg import Imu, Range, Temperature
from std_msgs.msg import Bool, ColorRGBA, Empty, Float32, Int8, Int16

from tests.ros.aseba_tools import Proximity, Status, get_variables, seen, set_parameters
from thymio_sim_ros.ros.aseba.outside import driver_input
from thymio_sim_ros.ros.aseba.outside.driver_input import proximity_count
from thymio_sim_ros.sim.model.units import PROXIMITY_FULL, proximity_response, units_to_speed

COUNTS = (
    "var prox_n = 0\nvar tap_n = 0\nvar mic_n = 0\nvar rc_n = 0\nvar comm_n = 0\nvar left_n = 0\nmic.threshold = 10\n"
    "onevent prox\nprox_n = prox_n + 1\nonevent tap\ntap_n = tap_n + 1\nonevent mic\nmic_n = mic_n + 1\n"
    "onevent rc5\nrc_n = rc_n + 1\nonevent prox.comm\ncomm_n = comm_n + 1\nonevent button.left\nleft_n = left_n + 1\n"
)


class FakeRobot:
    """A node that publishes the topics of the ROS driver as the driver does."""

    def __init__(self, ros):
        self.ros = ros
        self.driven = ros.collect(Twist, "/cmd_vel")
        self._publishers = {}
        self.proximity = Proximity(ros)

    def say(self, topic, message):
        if topic not in self._publishers:
            self._publishers[topic] = self.ros.publisher(type(message), f"/{topic}", depth=1)
        self._publishers[topic].publish(message)


@pytest.fixture
def robot(ros, runtime):
    runtime(COUNTS)
    return FakeRobot(ros)


def test_ranges_make_one_reading_together(ros, robot):
    robot.proximity.send(-1.0, -1.0, 0.05, 0.0215, math.inf, -math.inf, -1.0)
    ros.until(lambda: get_variables(ros, "prox_n") == [[1]])
    (counts,) = get_variables(ros, "prox.horizontal")
    assert counts == [0, 0, round(proximity_response(0.05)), PROXIMITY_FULL, 0, PROXIMITY_FULL, 0]


def test_a_reading_that_lost_a_range_is_finished_by_the_next(ros, robot):
    robot.proximity.send(*[-1.0] * 7)
    ros.until(lambda: get_variables(ros, "prox_n") == [[1]])
    robot.say("proximity/center", seen(0.05))
    robot.say("proximity/center", seen(0.06))
    ros.until(lambda: get_variables(ros, "prox_n") == [[2]])


@pytest.mark.parametrize(("dark", "bright"), [(1.0, 0.0), (math.inf, -math.inf)])
def test_the_ground_is_dark_or_bright(ros, robot, dark, bright):
    for side, value in (("left", dark), ("right", bright)):
        robot.say(f"ground/{side}", Range(min_range=0.009, max_range=0.03, range=value))
    ros.until(lambda: get_variables(ros, "prox.ground.delta")[0][1] > 0)
    left, right = get_variables(ros, "prox.ground.delta")[0]
    assert left < 200 < 800 < right


def test_all_other_sensors_arrive_with_their_events(ros, robot):
    robot.say("buttons/left", Bool(data=True))
    robot.say("temperature", Temperature(temperature=23.4))
    robot.say("tap", Empty())
    robot.say("sound", Float32(data=0.2))
    robot.say("remote", Int8(data=17))
    robot.say("comm/received", Int16(data=-5))
    robot.say("imu", Imu(linear_acceleration=Vector3(x=9.81 / 23 * 3, y=-9.81 / 23 * 4, z=9.81)))
    twist = TwistWithCovariance(twist=Twist(linear=Vector3(x=units_to_speed(200))))
    robot.say("odom", Odometry(twist=twist))
    names = ("button.left", "temperature", "mic.intensity", "rc5.command", "prox.comm.rx", "acc", "motor.left.speed")
    ros.until(lambda: get_variables(ros, *names) == [[1], [234], [51], [17], [-5], [4, 3, 23], [200]])
    counted = get_variables(ros, "left_n", "tap_n", "mic_n", "rc_n", "comm_n")
    assert counted == [[1], [1], [1], [1], [1]]


def test_wheels_are_driven_by_velocity_and_lights_by_the_driver_s_topics(ros, robot):
    color = ros.collect(ColorRGBA, "/led/body/top")
    source = "motor.left.target = 100\nmotor.right.target = 200\ncall leds.top(32, 0, 16)"
    assert set_parameters(ros, {"script.source": source}).successful
    ros.until(lambda: robot.driven and robot.driven[-1].linear.x > 0)
    assert math.isclose(robot.driven[-1].linear.x, units_to_speed(150), rel_tol=1e-6)
    assert robot.driven[-1].angular.z > 0
    ros.until(lambda: color and (color[-1].r, color[-1].b) == (1.0, 0.5))
    assert set_parameters(ros, {"script.source": "var a"}).successful
    ros.until(lambda: robot.driven[-1].linear.x == 0.0)


def test_there_are_no_topics_of_the_simulator(ros, robot):
    status = Status(ros)
    ros.until(lambda: status["state"] == "running")
    topics = {name for name, _ in ros.node.get_topic_names_and_types()}
    assert not [name for name in topics if name.startswith("/raw/") or name == "/_motor/target"]


def test_a_range_of_nan_means_no_obstacle():
    assert proximity_count(seen(math.nan)) == 0
    assert proximity_count(seen(0.2)) == 0


def test_the_start_says_what_programs_do_not_get(ros, runtime, simulation):
    assert driver_input.MISSING in runtime("var a").startup_message
    simulation()
    assert runtime("var a").startup_message == "Program: program"
