"""Buffer, listener and broadcasters on real topics, and with the simulator."""

from __future__ import annotations

import inspect
import itertools
import math
import re
import threading
from pathlib import Path

import pytest
from geometry_msgs.msg import PointStamped, Pose, PoseStamped, TransformStamped, Vector3Stamped
from rclpy.duration import Duration
from rclpy.node import Node
from rclpy.time import Time
from std_msgs.msg import String

from tests import pages
from tests.patience import PATIENCE_S, until
from thymio_sim_ros.examples import go_to_goal_tf
from thymio_sim_ros.tf import (
    Buffer,
    ExtrapolationException,
    LookupException,
    StaticTransformBroadcaster,
    TransformBroadcaster,
    TransformListener,
    do_transform_pose,
    euler_from_quaternion,
    quaternion_from_euler,
)
from thymio_sim_ros.tf.errors import TypeException

PAGE = Path(__file__).parents[2] / "docs" / "tf.md"


@pytest.fixture(autouse=True)
def _alone(ros_domain):
    """In a domain without other nodes."""


def stamped(frame, child, seconds=1.0, x=0.0, yaw=0.0):
    message = TransformStamped(child_frame_id=child)
    message.header.frame_id = frame
    message.header.stamp = Time(seconds=seconds).to_msg()
    message.transform.translation.x = x
    rotation = message.transform.rotation
    rotation.x, rotation.y, rotation.z, rotation.w = map(float, quaternion_from_euler(0.0, 0.0, yaw))
    return message


def pose_in(frame, x=0.0, y=0.0, seconds=0.0):
    pose = PoseStamped()
    pose.header.frame_id = frame
    pose.header.stamp = Time(seconds=seconds).to_msg()
    pose.pose.position.x, pose.pose.position.y = x, y
    pose.pose.orientation.w = 1.0
    return pose


def test_a_transform_has_its_frames_time_and_numbers():
    buffer = Buffer()
    buffer.set_transform(stamped("map", "base", 1.0, x=2.0, yaw=0.5), "test")
    found = buffer.lookup_transform("map", "base", Time(seconds=1.0))
    assert found == stamped("map", "base", 1.0, x=2.0, yaw=0.5)
    assert buffer.lookup_transform("map", "base", Time().to_msg()).header.stamp.sec == 1


def test_messages_in_another_frame():
    buffer = Buffer()
    buffer.set_transform_static(stamped("map", "base", 0.0, x=1.0, yaw=math.pi / 2), "test")
    point = PointStamped()
    point.header.frame_id, point.point.x = "base", 2.0
    found = buffer.transform(point, "map")
    assert (found.header.frame_id, found.point.x, found.point.y) == ("map", pytest.approx(1.0), pytest.approx(2.0))
    vector = Vector3Stamped()
    vector.header.frame_id, vector.vector.x = "base", 2.0
    found = buffer.transform(vector, "map")
    assert (found.vector.x, found.vector.y) == (pytest.approx(0.0), pytest.approx(2.0))
    found = buffer.transform(pose_in("base", 1.0), "map").pose
    q = found.orientation
    assert (found.position.x, found.position.y) == (pytest.approx(1.0), pytest.approx(1.0))
    assert euler_from_quaternion([q.x, q.y, q.z, q.w])[2] == pytest.approx(math.pi / 2)
    assert isinstance(do_transform_pose(Pose(), buffer.lookup_transform("map", "base", Time())), Pose)
    with pytest.raises(TypeException, match="found Said, expected one of PointStamped"):
        Buffer().transform(type("Said", (String,), {"header": point.header})(), "map")


def test_what_is_no_registered_message_is_an_error_of_its_type() -> None:
    for other in (Pose(), 5):
        with pytest.raises(TypeException, match=f"found {type(other).__name__}, expected one of PointStamped"):
            Buffer().transform(other, "map")


def test_transforms_that_are_not_valid_or_repeated_are_left_out_with_a_warning(
    capfd: pytest.CaptureFixture[str],
) -> None:
    buffer, transform = Buffer(), TransformStamped(child_frame_id="base")
    transform.header.frame_id, transform.header.stamp.sec = "map", 1
    transform.transform.rotation.w = 1.0
    buffer.set_transform(transform, "me")
    transform.transform.translation.x = 5.0
    buffer.set_transform(transform, "me")
    assert buffer.lookup_transform("map", "base", Time()).transform.translation.x == 0.0
    assert "ignored a transform of me: a transform of base at time 1.000000 exists already" in capfd.readouterr().err
    transform.child_frame_id = "map"
    buffer.set_transform_static(transform, "me")
    assert "the same frame as frame_id" in capfd.readouterr().err
    assert buffer.all_frames_as_string() == "Frame base exists with parent map.\n"


def test_can_transform_with_the_reason():
    buffer = Buffer()
    buffer.set_transform(stamped("map", "base"), "test")
    assert buffer.can_transform("map", "base", Time()) is True
    is_there, why = buffer.can_transform("map", "odom", Time(), return_debug_tuple=True)
    assert (is_there, "does not exist" in why) == (False, True)
    times = (Time(seconds=1.0), "base", Time(seconds=1.0), "map")
    assert buffer.can_transform_full("base", *times)
    assert buffer.lookup_transform_full("base", *times).transform.translation.x == 0.0


class CountedClock:
    """A node and its clock: time passes by `step_ns` with each reading."""

    def __init__(self, step_ns):
        self.readings = 0
        self._step_ns = step_ns

    def get_clock(self):
        return self

    def now(self):
        self.readings += 1
        return Time(nanoseconds=self.readings * self._step_ns)

    def create_service(self, *_arguments):
        return None


def test_waiting_ends_with_the_transform():
    clock = CountedClock(0)  # no time-out elapses
    buffer = Buffer(node=clock)
    found = []
    waiting = threading.Thread(
        target=lambda: found.append(buffer.lookup_transform("map", "base", Time(), Duration(seconds=1.0))), daemon=True
    )
    waiting.start()
    until(lambda: clock.readings >= 2)  # of the begin, and of the first round
    buffer.set_transform(stamped("map", "base", x=3.0), "test")
    waiting.join(PATIENCE_S)
    assert [transform.transform.translation.x for transform in found] == [3.0]


def test_waiting_ends_with_the_time_out():
    clock = CountedClock(50_000_000)
    assert not Buffer(node=clock).can_transform("map", "odom", Time(), Duration(seconds=0.2))
    assert clock.readings == 5  # the begin, and four rounds of 50 ms


def test_a_future_is_done_when_the_transform_comes():
    buffer = Buffer()
    future = buffer.wait_for_transform_async("map", "base", Time(seconds=2.0))
    buffer.set_transform(stamped("map", "base", 1.0), "test")
    assert not future.done()
    buffer.set_transform(stamped("map", "base", 3.0, x=4.0), "test")
    assert (future.done(), future.result()) == (True, True)
    looks = buffer.lookup_transform_async("map", "base", Time(seconds=2.0))
    with pytest.raises(StopIteration) as ended:
        looks.send(None)
    assert ended.value.value.transform.translation.x == pytest.approx(2.0)


def test_transforms_are_received_and_static_ones_also_by_late_subscribers(ros):
    sender, hearer = ros.make_node("sender"), ros.make_node("hearer")
    StaticTransformBroadcaster(sender).sendTransform([stamped("base", "prox", 0.0, x=0.1)])
    fixed = StaticTransformBroadcaster(sender)
    fixed.sendTransform(stamped("base", "laser", 0.0, x=0.2))
    fixed.sendTransform([stamped("base", "camera", 0.0, x=0.3), stamped("base", "laser", 0.0, x=0.4)])
    moving = TransformBroadcaster(sender)
    buffer = Buffer()
    listener = TransformListener(buffer, hearer)
    ros.until(lambda: sender.count_subscribers("/tf"))

    def is_received():
        moving.sendTransform(stamped("map", "base", 1.0, x=1.0))
        return all(buffer.can_transform("map", name, Time()) for name in ("prox", "laser", "camera"))

    ros.until(is_received)
    assert buffer.lookup_transform("map", "laser", Time()).transform.translation.x == pytest.approx(1.4)
    listener.unregister()


def test_a_listener_with_a_thread_receives_while_its_node_waits(ros):
    sender, hearer = ros.make_node("sender"), ros.make_node("hearer")
    buffer = Buffer()
    listener = TransformListener(buffer, hearer, spin_thread=True)
    moving = TransformBroadcaster(sender)
    done, seconds = threading.Event(), itertools.count(1.0)

    def send():
        while not done.wait(0.02):
            moving.sendTransform(stamped("map", "base", next(seconds), x=1.0))

    thread = threading.Thread(target=send)
    thread.start()
    try:
        found = buffer.lookup_transform("map", "base", Time(), Duration(seconds=PATIENCE_S))  # the node is not spinning
    finally:
        done.set()
        thread.join()
        listener.unregister()
    assert found.transform.translation.x == 1.0


def test_the_robot_and_its_sensors_are_on_the_map(ros, simulation):
    sim = simulation()
    buffer = Buffer()
    listener = TransformListener(buffer, ros.make_node("hearer"))
    ros.until(lambda: ros.node.count_subscribers("/tf"))
    sim.simulator.endpoints.poll()
    sim.step(0.5)
    ros.until(lambda: buffer.can_transform("map", "proximity_center_link", Time()))
    truth = sim.world.robots["thymio"].pose
    found = buffer.lookup_transform("map", "base_link", Time())
    place, q = found.transform.translation, found.transform.rotation
    assert (place.x, place.y) == (pytest.approx(truth.x_m), pytest.approx(truth.y_m))
    assert euler_from_quaternion([q.x, q.y, q.z, q.w])[2] == pytest.approx(truth.yaw_rad)
    sensor = buffer.lookup_transform("base_link", "proximity_center_link", Time()).transform.translation
    assert (sensor.x, sensor.y) == (pytest.approx(0.08, abs=0.005), pytest.approx(0.0))
    with pytest.raises(LookupException, match="known frames: base_footprint, base_link"):
        buffer.lookup_transform("map", "base_lnik", Time())
    with pytest.raises(ExtrapolationException, match="into the future"):
        buffer.lookup_transform("odom", "base_link", Time(seconds=100.0))
    listener.unregister()


class Watcher(Node):
    """Records the time of the latest transform."""

    def __init__(self):
        super().__init__("watcher")
        self.buffer, self.places = Buffer(), []
        self.listener = TransformListener(self.buffer, self)
        self.create_timer(0.05, self.note)

    def note(self):
        if self.buffer.can_transform("odom", "base_link", Time()):
            stamp = self.buffer.lookup_transform("odom", "base_link", Time()).header.stamp
            self.places.append(stamp.sec + stamp.nanosec / 1e9)


def test_a_reset_of_the_simulator_empties_the_buffer_of_a_node_on_its_time(ros, simulation):
    sim = simulation()
    node = ros.start(Watcher)
    sim.until(lambda: node.buffer.can_transform("map", "base_link", Time(seconds=0.5)))
    sim.simulator.runner.reset()
    sim.until(lambda: node.places and node.places[-1] < 0.3)
    latest = node.buffer.lookup_transform("odom", "base_link", Time()).header.stamp
    assert latest.sec == 0


def test_the_page_shows_the_lines_of_the_model_node():
    node = [line.strip() for line in Path(go_to_goal_tf.__file__).read_text(encoding="utf-8").splitlines()]
    shown = [text for text in pages.blocks(pages.read("tf.md"), "python") if "self." in text and "here =" not in text]
    assert len(shown) == 2
    for block in shown:
        lines = [line.strip() for line in block.splitlines()]
        assert lines in [node[at : at + len(lines)] for at in range(len(node))]


def test_the_page_names_all_classes():
    from thymio_sim_ros import tf

    words = set(re.findall(r"\b([A-Za-z_0-9]+)\b", PAGE.read_text()))
    words |= {"TimeoutException", "TypeException"}
    names = {name for name in tf.__all__ if not name.startswith(("is_", "random_", "rotation_", "vector_", "unit_"))}
    assert {name for name in names if name[0].isupper() or name.startswith(("do_", "quaternion_from"))} <= words


SIGNATURES = {
    "lookup_transform": ["target_frame", "source_frame", "time", "timeout"],
    "lookup_transform_full": [
        "target_frame", "target_time", "source_frame", "source_time", "fixed_frame", "timeout",
    ],
    "lookup_transform_async": ["target_frame", "source_frame", "time"],
    "can_transform": ["target_frame", "source_frame", "time", "timeout", "return_debug_tuple"],
    "wait_for_transform_async": ["target_frame", "source_frame", "time"],
    "transform": ["object_stamped", "target_frame", "timeout", "new_type"],
    "set_transform": ["transform", "authority"],
    "set_transform_static": ["transform", "authority"],
}  # fmt: skip


@pytest.mark.parametrize("name", SIGNATURES)
def test_arguments_have_the_names_of_the_original(name):
    assert list(inspect.signature(getattr(Buffer, name)).parameters)[1:] == SIGNATURES[name]
