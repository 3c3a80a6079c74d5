"""`--like turtlebot3` on a stepped world: topics, types, frames, and both types of velocities."""

from __future__ import annotations

import math

import pytest
import rclpy
from geometry_msgs.msg import Twist, TwistStamped, Vector3
from nav_msgs.msg import Odometry
from rclpy.context import Context
from rclpy.node import Node
from sensor_msgs.msg import BatteryState, Imu, JointState, LaserScan
from std_srvs.srv import Empty, SetBool, Trigger

from tests.ros.rclpy_ext.test_connections import beaten
from thymio_sim_ros.ros.compat.tf2_messages import TFMessage
from thymio_sim_ros.ros.interface.convert_readings import yaw_of
from thymio_sim_ros.sim.commands import Tilt


@pytest.fixture
def sim(simulation):
    return simulation(like="turtlebot3", noise=False)


@pytest.fixture
def other_node(ros):
    """A node of another participant, as a program of a student has it."""
    context = Context()
    rclpy.init(context=context, domain_id=ros.context.get_domain_id())
    node = Node("student", context=context)
    yield node
    node.destroy_node()
    rclpy.shutdown(context=context)


def test_the_scan_has_360_beams_from_the_front(ros, sim):
    scans = ros.collect(LaserScan, "/scan")
    sim.until(lambda: scans)
    scan = scans[-1]
    assert (len(scan.ranges), scan.header.frame_id) == (360, "base_scan")
    assert scan.angle_increment == pytest.approx(math.radians(1))
    # The wall behind is at -2.375 m, the robot at -2.0 m; its lidar is 2 cm before its middle.
    assert scan.ranges[180] == pytest.approx(0.395)


def test_frames_are_those_of_turtlebot3(ros, sim):
    static, moving = ros.collect(TFMessage, "/tf_static"), ros.collect(TFMessage, "/tf")
    odometry = ros.collect(Odometry, "/odom")
    sim.until(lambda: moving and odometry and static)
    pairs = {(one.header.frame_id, one.child_frame_id) for message in (*static, *moving) for one in message.transforms}
    assert {
        ("odom", "base_footprint"),
        ("base_footprint", "base_link"),
        ("base_footprint", "base_scan"),
        ("base_footprint", "imu_link"),
    } <= pairs
    assert (odometry[-1].header.frame_id, odometry[-1].child_frame_id) == ("odom", "base_footprint")


def test_the_imu_has_orientation_rates_and_accelerations(ros, sim):
    messages = ros.collect(Imu, "/imu")
    publisher = ros.publisher(Twist, "/cmd_vel")
    sim.step(0.2)
    publisher.publish(Twist(linear=Vector3(x=0.1), angular=Vector3(z=0.5)))
    sim.step(1.0)
    first, last = messages[0], messages[-1]
    assert first.header.frame_id == "imu_link"
    assert yaw_of(first.orientation) == pytest.approx(0.0, abs=1e-6)
    assert yaw_of(last.orientation) == pytest.approx(0.5, abs=0.06)
    assert last.angular_velocity.z == pytest.approx(0.5, abs=0.02)
    assert last.linear_acceleration.y == pytest.approx(0.05, abs=0.01)
    assert last.linear_acceleration.z == pytest.approx(9.81)
    assert max(one.linear_acceleration.x for one in messages) > 0.5
    sim.engine.post("thymio", Tilt(0.0, math.radians(30)))
    sim.until(lambda: abs(messages[-1].linear_acceleration.x) > 4.0)
    assert math.hypot(messages[-1].linear_acceleration.x, messages[-1].linear_acceleration.z) == pytest.approx(
        9.81, 0.02
    )


def test_both_types_of_velocities_drive_the_robot(ros, sim, other_node):
    moved = Vector3(x=0.1)
    for kind, message in ((Twist, Twist(linear=moved)), (TwistStamped, TwistStamped(twist=Twist(linear=moved)))):
        publisher = other_node.create_publisher(kind, "/cmd_vel", 10)
        ros.until(lambda publisher=publisher: publisher.get_subscription_count() == 1)
        publisher.publish(message)
        sim.until(lambda: sim.world.robots["thymio"].twist.linear_m_s > 0.09)
        publisher.publish(kind())
        sim.until(lambda: sim.world.robots["thymio"].twist.linear_m_s == 0.0)
        other_node.destroy_publisher(publisher)


@pytest.mark.parametrize("kind", [Twist, TwistStamped])
def test_no_type_of_velocities_is_reported_as_wrong(ros, sim, other_node, kind):
    other_node.create_publisher(kind, "/cmd_vel", 10)
    ros.until(lambda: ros.node.count_publishers("/cmd_vel") == 1)
    assert not [one for _ in range(3) for one in beaten(sim.simulator)]


def test_the_wheels_have_the_names_of_turtlebot3_and_a_velocity_stays(ros, sim):
    joints, batteries = ros.collect(JointState, "/joint_states"), ros.collect(BatteryState, "/battery_state")
    ros.publisher(Twist, "/cmd_vel").publish(Twist(linear=Vector3(x=0.1)))
    sim.step(3.0)
    assert list(joints[-1].name) == ["wheel_left_joint", "wheel_right_joint"]
    assert joints[-1].velocity[0] == pytest.approx(0.1 / 0.022, rel=0.01)
    assert batteries[-1].voltage == pytest.approx(4.0)


def test_its_services_answer(ros, sim):
    turtlebot3_msgs = pytest.importorskip("turtlebot3_msgs.srv", reason="turtlebot3_msgs is not in this ROS 2")

    def call(kind, name, **fields):
        client = ros.node.create_client(kind, name)
        ros.until(client.service_is_ready)
        answered = client.call_async(kind.Request(**fields))
        return sim.until(lambda: answered.done() and answered).result()

    assert call(turtlebot3_msgs.Sound, "/sound", value=1).success
    refused = call(turtlebot3_msgs.Sound, "/sound", value=9)
    assert (refused.success, refused.message) == (False, "value is 9, expected 0 to 5")
    ros.publisher(Twist, "/cmd_vel").publish(Twist(linear=Vector3(x=0.1)))
    sim.step(0.5)
    assert call(SetBool, "/motor_power", data=False).success
    sim.step(0.1)
    assert sim.world.robots["thymio"].twist.linear_m_s == 0.0
    odometry = ros.collect(Odometry, "/odom")
    sim.until(lambda: odometry and odometry[-1].pose.pose.position.x > 0.02)
    assert call(Trigger, "/reset").success
    sim.until(lambda: abs(odometry[-1].pose.pose.position.x) < 0.005)
    assert sim.now > 0.5
    call(Empty, "/reset_simulation")
    assert sim.now < 0.5
