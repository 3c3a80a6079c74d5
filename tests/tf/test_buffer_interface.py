"""Registers of message types, velocities and covariances: what packages and course files use of tf2 beside lookups."""

from __future__ import annotations

import importlib
import inspect
import math
import sys

import numpy as np
import pytest
from geometry_msgs.msg import PointStamped, Pose, PoseWithCovarianceStamped, TransformStamped
from rclpy.duration import Duration
from rclpy.time import Time
from std_msgs.msg import Header

from thymio_sim_ros import course_packages
from thymio_sim_ros.tf.buffer import Buffer
from thymio_sim_ros.tf.buffer_interface import (
    BufferInterface,
    ConvertRegistration,
    Stamped,
    TransformRegistration,
    convert,
)
from thymio_sim_ros.tf.errors import ExtrapolationException, NotImplementedException, TypeException
from thymio_sim_ros.tf.geometry import do_transform_pose, do_transform_pose_with_covariance_stamped

needs_absence = pytest.mark.skipif(course_packages.is_installed("tf2_ros"), reason="this ROS has the package tf2_ros")


def stamped(frame, child, seconds=0.0, x=0.0, yaw=0.0):
    message = TransformStamped(child_frame_id=child)
    message.header.frame_id, message.header.stamp = frame, Time(seconds=seconds).to_msg()
    message.transform.translation.x = x
    message.transform.rotation.z, message.transform.rotation.w = math.sin(yaw / 2), math.cos(yaw / 2)
    return message


class Scan:
    """A type of a package that tf2 does not know."""

    def __init__(self, header, x):
        self.header, self.x = header, x


class Seen:
    def __init__(self, x):
        self.x = x


class Other:
    pass


def test_a_registered_type_is_transformed_and_converted():
    buffer = Buffer()
    buffer.set_transform_static(stamped("map", "base", x=2.0), "test")
    scan = Scan(Header(frame_id="base"), 1.0)
    with pytest.raises(TypeException, match=r"found Scan, expected .*TransformRegistration\(\)\.add"):
        buffer.transform(scan, "map")
    move = lambda one, found: Scan(found.header, one.x + found.transform.translation.x)  # noqa: E731
    TransformRegistration().add(Scan, move)
    assert buffer.registration.get(Scan) is move
    found = buffer.transform(scan, "map")
    assert (found.header.frame_id, found.x) == ("map", 3.0)
    assert buffer.transform_full(scan, "map", Time(), "map").x == 3.0
    with pytest.raises(TypeException, match="found Seen, expected"):
        buffer.transform(scan, "map", new_type=Seen)
    ConvertRegistration().add_convert((Scan, Seen), lambda one: Seen(one.x))
    assert buffer.transform(scan, "map", new_type=Seen).x == 3.0


def test_types_are_converted_by_way_of_a_message():
    ConvertRegistration().add_to_msg(Seen, lambda one: PointStamped(header=Header(frame_id=str(one.x))))
    ConvertRegistration().add_from_msg(Seen, lambda point: Seen(float(point.header.frame_id)))
    assert convert(Seen(2.0), PointStamped).header.frame_id == "2.0"
    assert convert(PointStamped(header=Header(frame_id="3")), Seen).x == 3.0
    other = Other()
    assert convert(other, Other) is other
    with pytest.raises(TypeException, match="found Other, expected"):
        convert(other, Seen)


def test_an_interface_without_lookups_names_the_missing_method():
    class Half(BufferInterface):
        pass

    point = PointStamped()
    with pytest.raises(NotImplementedException, match="Half has no method lookup_transform:"):
        Half().transform(point, "map")
    with pytest.raises(NotImplementedException, match="can_transform_full"):
        Half().can_transform_full("a", Time(), "b", Time(), "c")
    assert isinstance(Buffer(), BufferInterface)


def test_an_object_gets_a_header():
    stamp = Time(seconds=2.0).to_msg()
    assert Stamped(Other(), stamp, "map").header == Header(stamp=stamp, frame_id="map")


def moving(speed=0.0, turn=0.0):
    buffer = Buffer()
    for seconds in range(5):
        buffer.set_transform(stamped("map", "base", seconds, x=speed * seconds, yaw=turn * seconds), "test")
    return buffer


def test_velocities_are_means_in_the_axes_of_a_frame():
    linear, angular = moving(speed=3.0).lookupVelocityCore("base", "map", Time(), Duration(seconds=2))
    assert (linear, angular) == (pytest.approx((3.0, 0.0, 0.0)), pytest.approx((0.0, 0.0, 0.0)))
    buffer = moving(turn=-0.5)
    frames = ("base", "map", "base", (2.0, 0.0, 0.0), "base")
    linear, angular = buffer.lookupVelocityFullCore(*frames, Time(seconds=2), Duration(seconds=2))
    assert angular == pytest.approx((0.0, 0.0, -0.5))
    assert linear == pytest.approx((0.0, -1.0, 0.0))
    seen = buffer.lookupVelocityCore("map", "base", Time(seconds=2), Duration(seconds=2))
    assert seen[1] == pytest.approx((0.0, 0.0, 0.5))


def test_a_velocity_needs_two_times():
    buffer = Buffer()
    buffer.set_transform_static(stamped("map", "base"), "test")
    with pytest.raises(ExtrapolationException, match="needs transforms of two times"):
        buffer.lookupVelocityCore("base", "map", Time(), Duration(seconds=1))


def test_the_latest_common_time():
    buffer = moving()
    buffer.set_transform(stamped("base", "arm", 3.0), "test")
    assert buffer.get_latest_common_time("map", "arm") == Time(seconds=3)
    assert buffer.get_latest_common_time("base", "base") == Time(seconds=4)


def test_a_covariance_turns_with_its_pose():
    pose = PoseWithCovarianceStamped()
    pose.pose.pose.orientation.w = 1.0
    covariance = np.zeros((6, 6))
    covariance[0, 0], covariance[0, 5], covariance[5, 5] = 4.0, 1.0, 0.25
    pose.pose.covariance = covariance.ravel()
    found = do_transform_pose_with_covariance_stamped(pose, stamped("map", "base", x=1.0, yaw=math.pi / 2))
    turned = found.pose.covariance.reshape(6, 6)
    assert found.header.frame_id == "map"
    assert found.pose.pose.position.x == 1.0
    assert [turned[1, 1], turned[1, 5], turned[5, 5]] == pytest.approx([4.0, 1.0, 0.25])
    assert np.count_nonzero(np.abs(turned) > 1e-9) == 3


def test_a_rotation_has_a_positive_w():
    half = stamped("map", "base", yaw=math.pi)
    pose = Pose(orientation=half.transform.rotation)
    assert do_transform_pose(pose, half).orientation.w == pytest.approx(1.0)


@pytest.fixture
def packages(monkeypatch):
    """The packages of course files, imported as in a prepared terminal and forgotten afterwards."""
    monkeypatch.setattr(sys, "path", list(sys.path))
    course_packages.add_to_path()
    yield importlib.import_module
    for name in [name for name in sys.modules if name.partition(".")[0] in {"tf2_ros", "tf2_py", "tf2_msgs"}]:
        del sys.modules[name]


@needs_absence
def test_the_packages_have_the_names_of_the_originals(packages):
    tf2_ros, tf2_py = packages("tf2_ros"), packages("tf2_py")
    assert set(tf2_py.__all__) < set(tf2_ros.__all__)
    assert issubclass(tf2_ros.Buffer, (tf2_ros.BufferCore, tf2_ros.BufferInterface))
    interface = packages("tf2_ros.buffer_interface")
    assert all(getattr(tf2_ros, name) is getattr(interface, name) for name in interface.__all__)
    assert packages("tf2_msgs.msg").TF2Error(error=2).error == packages("tf2_msgs.msg").TF2Error.CONNECTIVITY_ERROR


@needs_absence
@pytest.mark.skipif(course_packages.is_installed("tf2_msgs"), reason="this ROS has the action")
def test_what_needs_an_action_says_so_when_it_is_imported(packages):
    tf2_ros = packages("tf2_ros")
    said = "tf2_ros.BufferClient needs the action tf2_msgs.action.LookupTransform.*use tf2_ros.Buffer.*-tf2-msgs"
    with pytest.raises(ImportError, match=said):
        _ = tf2_ros.BufferClient
    with pytest.raises(ImportError, match=said):
        _ = packages("tf2_ros.buffer_client").BufferClient
    assert not hasattr(tf2_ros, "Nothing")


@needs_absence
def test_its_action_and_service_can_be_imported_and_not_used(packages):
    for kind in (packages("tf2_msgs.action").LookupTransform, packages("tf2_msgs.srv").FrameGraph):
        with pytest.raises(RuntimeError, match=r"tf2_msgs\.\w+\.\w+ is not installed.*ros-<distribution>-tf2-msgs"):
            kind.Request()


VELOCITY = {
    "lookupVelocityCore": ["tracking_frame", "observation_frame", "time", "averaging_interval"],
    "can_transform_full_core": ["target_frame", "target_time", "source_frame", "source_time", "fixed_frame"],
    "lookup_transform_full_core": ["target_frame", "target_time", "source_frame", "source_time", "fixed_frame"],
    "get_latest_common_time": ["target_frame", "source_frame"],
}


@pytest.mark.parametrize("name", VELOCITY)
def test_arguments_have_the_names_of_the_original(name):
    assert list(inspect.signature(getattr(Buffer, name)).parameters)[1:] == VELOCITY[name]
