"""Where robots are: frames on /tf, poses that an operator or a viewer's tool gives, odometry that begins again."""

from __future__ import annotations

import math

import pytest
from geometry_msgs.msg import Point, Pose, PoseWithCovarianceStamped, Quaternion, Twist, Vector3
from nav_msgs.msg import Odometry
from rcl_interfaces.msg import Log
from std_msgs.msg import Header
from std_srvs.srv import Trigger

from thymio_sim_ros.ros.compat import tf2_messages
from thymio_sim_ros.ros.interface.convert_readings import yaw_of
from thymio_sim_ros.sim.commands import BodyTwist, MoveRobot


@pytest.mark.parametrize(("topic", "huge"), [("/initialpose", 1e200), ("/initialpose", math.nan)])
def test_a_heading_that_is_not_finite_is_rejected(ros, simulation, topic, huge):
    sim = simulation()
    message = PoseWithCovarianceStamped()
    message.pose.pose.orientation.z = huge
    before = sim.world.robots["thymio"].pose
    logs = ros.collect(Log, "/rosout")
    ros.publisher(PoseWithCovarianceStamped, topic).publish(message)
    ros.until(lambda: any("not finite" in log.msg for log in logs))
    assert sim.world.robots["thymio"].pose == before


def test_transforms_lead_from_map_to_the_wheels(ros, simulation):
    sim = simulation()
    received = []
    ros.node.create_subscription(tf2_messages.TFMessage, "/tf", received.append, 100, raw=True)
    ros.until(lambda: ros.node.count_publishers("/tf"))
    sim.world.post("thymio", BodyTwist(0.1, 0.2))
    sim.until(lambda: len(received) > 10)
    frames = {transform.child: transform for transform in tf2_messages.decode(bytes(received[-1]))}
    assert frames["odom"].frame == "map"
    assert frames["base_link"].frame == "odom"
    assert frames["left_wheel_link"].frame == "base_link"
    assert frames["base_link"].translation[0] > 0.01


def test_a_robot_that_is_tilted_leans_in_its_odometry_s_frame(ros, simulation):
    sim = simulation()
    received = []
    ros.node.create_subscription(tf2_messages.TFMessage, "/tf", received.append, 100, raw=True)
    ros.until(lambda: ros.node.count_publishers("/tf"))
    sim.thymio.tilt(pitch_rad=-0.5)
    sim.until(lambda: len(received) > 2)
    frames = {transform.child: transform for transform in tf2_messages.decode(bytes(received[-1]))}
    assert frames["base_link"].rotation == pytest.approx((0.0, math.sin(-0.25), 0.0, math.cos(-0.25)))
    assert frames["odom"].rotation == pytest.approx((0.0, 0.0, 0.0, 1.0))


def test_a_robot_can_be_moved(ros, simulation):
    sim = simulation()
    truth = ros.collect(Odometry, "/_ground_truth/odom")
    odometry = ros.collect(Odometry, "/odom")
    pose = PoseWithCovarianceStamped()
    pose.pose.pose.position.x, pose.pose.pose.position.y = 0.2, -0.1
    pose.pose.pose.orientation.z = 1.0
    pose.pose.pose.orientation.w = 0.0
    ros.publisher(PoseWithCovarianceStamped, "/initialpose").publish(pose)
    sim.until(lambda: truth and truth[-1].pose.pose.position.x == pytest.approx(0.2))
    assert abs(yaw_of(truth[-1].pose.pose.orientation)) == pytest.approx(math.pi)
    assert odometry[-1].pose.pose.position.x == 0.0


@pytest.mark.parametrize(
    ("frame", "place", "expected"),
    [
        ("", (-0.2, 0.1, 1.0), (-0.2, 0.1, 1.0)),
        ("map", (-0.2, 0.1, 1.0), (-0.2, 0.1, 1.0)),
        ("odom", (0.3, 0.0, 1.0), (0.0, 0.2, 1.0 + math.pi / 2)),
        ("base_link", (0.1, 0.05, 3.0), (-0.05, 0.1, 3.0 + math.pi / 2 - math.tau)),
    ],
)
def test_a_robot_is_moved_in_the_frame_of_the_viewer(ros, simulation, frame, place, expected):
    """Tools send the pose in the frame that they follow, which is the robot's in our layout for Foxglove."""
    sim = simulation(playground="borderless", noise=False)
    publisher = ros.publisher(PoseWithCovarianceStamped, "/initialpose")
    sim.world.post("thymio", MoveRobot(0.0, -0.1, math.pi / 2))
    sim.step(0.01)
    sim.world.post("thymio", BodyTwist(0.1, 0.0))
    sim.step(1.0)
    sim.world.post("thymio", BodyTwist(0.0, 0.0))
    sim.step(0.5)
    x, y, yaw = place
    orientation = Quaternion(z=math.sin(yaw / 2), w=math.cos(yaw / 2))
    message = PoseWithCovarianceStamped(header=Header(frame_id=frame))
    message.pose.pose = Pose(position=Point(x=x, y=y), orientation=orientation)
    publisher.publish(message)

    def found():
        pose = sim.world.robots["thymio"].pose
        return (pose.x_m, pose.y_m, pose.yaw_rad)

    sim.until(lambda: found() == pytest.approx(expected, abs=0.005), seconds=0.5)


def test_a_place_without_ground_is_refused(ros, simulation):
    sim = simulation(playground="base")
    log = ros.collect(Log, "/rosout", where=lambda line: "initialpose" in line.msg)
    message = PoseWithCovarianceStamped(header=Header(frame_id="map"))
    message.pose.pose = Pose(position=Point(x=9.0, y=9.0))
    ros.publisher(PoseWithCovarianceStamped, "/initialpose").publish(message)
    ros.until(lambda: log)
    assert "/initialpose rejected: 'thymio' cannot be placed at 9.000, 9.000 m: there is no ground; the nearest is" in (
        log[0].msg
    )
    sim.step(0.1)
    assert math.hypot(sim.thymio.pose.x_m, sim.thymio.pose.y_m) < 2.0


def test_a_frame_that_is_not_the_robot_s_is_refused(ros, simulation):
    sim = simulation()
    log = ros.collect(Log, "/rosout", where=lambda line: "initialpose" in line.msg)
    message = PoseWithCovarianceStamped(header=Header(frame_id="anna/base_link"))
    ros.publisher(PoseWithCovarianceStamped, "/initialpose").publish(message)
    ros.until(lambda: log)
    assert "found frame 'anna/base_link', expected map or odom or base_link" in log[0].msg
    assert sim.simulator._messages.rejected == 1


def test_odometry_starts_again_on_request(ros, simulation):
    sim = simulation()
    odometry = ros.collect(Odometry, "/odom")
    ros.publisher(Twist, "/cmd_vel").publish(Twist(linear=Vector3(x=0.1)))
    sim.until(lambda: odometry and odometry[-1].pose.pose.position.x > 0.05)
    assert ros.call(Trigger, "/reset_odometry").success
    sim.until(lambda: odometry[-1].pose.pose.position.x < 0.02)
