"""Bytes of TFMessage, and its type built at run time (docs/spec/ros-packaging.md section 1.3)."""

from __future__ import annotations

import hashlib
import json
import os
import subprocess
import sys
import textwrap
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import FrameType
from typing import Any

import pytest

from tests.patience import PATIENCE_S, Deadline

rclpy = pytest.importorskip("rclpy")

from geometry_msgs.msg import TransformStamped
from hypothesis import given
from hypothesis import strategies as st
from rclpy.context import Context
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from rclpy.serialization import deserialize_message, serialize_message
from rclpy.type_support import check_for_type_support
from type_description_interfaces.srv import GetTypeDescription
from visualization_msgs.msg import Marker, MarkerArray

from thymio_sim_ros.ros.compat import tf2_messages, typesupport
from thymio_sim_ros.ros.compat.tf2_messages import TFMessage, Transform, TransformDataError, decode, encode
from thymio_sim_ros.testing.ros.domain import reserved

HASH = "RIHS01_e369d0f05a23ae52508854b66f6aa0437f3449d652e8cbf22d5abe85d020f087"
TRANSIENT_LOCAL = QoSProfile(
    depth=5, reliability=ReliabilityPolicy.RELIABLE, durability=DurabilityPolicy.TRANSIENT_LOCAL
)
BASE = Transform(1_500_000_000, "odom", "base_link", (1.0, -2.0, 0.25), (0.0, 0.0, 0.6, 0.8))
WHEEL = Transform(1_500_000_001, "base_link", "left_wheel_link", (0.0, 0.04675, 0.022), (0.0, 1.0, 0.0, 0.0))


def _message(transform: Transform) -> TransformStamped:
    message = TransformStamped()
    message.header.stamp.sec, message.header.stamp.nanosec = divmod(transform.stamp_ns, 10**9)
    message.header.frame_id, message.child_frame_id = transform.frame, transform.child
    translation, rotation = message.transform.translation, message.transform.rotation
    translation.x, translation.y, translation.z = transform.translation
    rotation.x, rotation.y, rotation.z, rotation.w = transform.rotation
    return message


names = st.text(st.characters(codec="utf-8", exclude_characters="\0"), max_size=20)
meters = st.floats(allow_nan=False, width=64)
transforms = st.builds(
    Transform,
    st.integers(0, 2**31 * 10**9 - 1),
    names,
    names,
    st.tuples(meters, meters, meters),
    st.tuples(meters, meters, meters, meters),
)


def test_no_transform_is_a_header_and_a_zero_count() -> None:
    assert encode([]) == bytes.fromhex("00010000 00000000")


@given(transforms)
def test_ros_reads_the_bytes_as_a_transform_stamped(transform: Transform) -> None:
    ours = encode([transform])[8:]
    frame_end = 12 + len(transform.frame.encode()) + 1
    child_end = frame_end + -frame_end % 4 + 4 + len(transform.child.encode()) + 1
    # Behind the count of four bytes the gap before the doubles is not that of a message of its own.
    alone = b"\x00\x01\x00\x00" + ours[:child_end] + bytes(-child_end % 8) + ours[-56:]
    assert deserialize_message(alone, TransformStamped) == _message(transform)


@given(st.lists(transforms, max_size=5))
def test_decode_inverts_encode(several: list[Transform]) -> None:
    assert decode(encode(several)) == tuple(several)


@given(st.lists(transforms, min_size=1, max_size=2), st.data())
def test_a_truncated_message_is_rejected(several: list[Transform], data: st.DataObject) -> None:
    whole = encode(several)
    cut = data.draw(st.integers(0, len(whole) - 1))
    with pytest.raises(TransformDataError):
        decode(whole[:cut])


def test_big_endian_bytes_are_rejected() -> None:
    with pytest.raises(TransformDataError, match="expected little-endian CDR"):
        decode(b"\x00\x00\x00\x00" + bytes(4))


def test_a_string_without_room_for_its_end_is_rejected() -> None:
    with pytest.raises(TransformDataError, match="offset 8"):
        decode(encode([BASE])[:16] + bytes(120))


def test_the_type_is_available_here() -> None:
    assert tf2_messages.available()


@pytest.mark.skipif(TFMessage is not tf2_messages._TFMessage, reason="tf2_msgs is installed")
def test_messages_are_objects_too(caplog: pytest.LogCaptureFixture) -> None:
    """Course files publish and receive TFMessage; it was a name without instances."""
    sent = TFMessage(transforms=[tf2_messages.to_message(BASE), tf2_messages.to_message(BASE)])
    data = serialize_message(sent)
    assert decode(data) == (BASE, BASE)
    assert deserialize_message(data, TFMessage) == sent
    with pytest.raises(RuntimeError, match="failed to deserialize"):
        deserialize_message(data[:50], TFMessage)
    with pytest.raises(TypeError, match="transforms: found int, expected"):
        sent.transforms = [1]
    sent.transforms.append(None)
    with pytest.raises(RuntimeError):
        serialize_message(sent)
    assert "a message cannot be sent: AttributeError" in caplog.text


def test_message_objects_arrive() -> None:
    received: list[object] = []
    sent = TFMessage(transforms=[tf2_messages.to_message(BASE)])
    with _peers("sender", "receiver") as (sender, receiver):
        publisher = sender.node.create_publisher(TFMessage, "/tf", 10)
        receiver.node.create_subscription(TFMessage, "/tf", received.append, 10)
        _until(lambda: publisher.get_subscription_count() == 1, sender, receiver)
        publisher.publish(sent)
        _until(lambda: bool(received), sender, receiver)
    assert received == [sent]


def test_ctrl_c_cannot_interrupt_a_function_whose_pointer_c_uses() -> None:
    """KeyboardInterrupt is raised in Python functions only; in one that C calls it is lost, and C crashed with 0."""
    called: set[str] = set()
    ours = typesupport.build.__code__.co_filename

    def record(frame: FrameType, event: str, _argument: object) -> None:
        if event == "call" and frame.f_code.co_filename == ours:
            called.add(frame.f_code.co_name)

    check_for_type_support(TFMessage)
    with _peers("sender", "receiver") as (sender, receiver):
        sys.setprofile(record)
        try:
            publisher = sender.node.create_publisher(TFMessage, "/tf", 10)
            subscription = receiver.node.create_subscription(TFMessage, "/tf", lambda _message: None, 10)
            assert called == set()
            _until(lambda: publisher.get_subscription_count() == 1, sender, receiver)
            publisher.publish(TFMessage(transforms=[tf2_messages.to_message(BASE)]))
            deadline = Deadline()
            while (taken := subscription.handle.take_message(TFMessage, False)) is None:
                assert not deadline.is_over
        finally:
            sys.setprofile(None)
    assert taken[0].transforms == [tf2_messages.to_message(BASE)]
    # The others return false or 0, at which rclpy raises an error.
    assert called - {"_held", "_hold", "destroy"} == {"convert_from_py", "serialize", "deserialize", "<lambda>"}


def test_another_middleware_is_rejected_by_name() -> None:
    with pytest.raises(typesupport.TypeSupportError, match="rmw_cyclonedds_cpp"):
        typesupport.check_layouts("rmw_cyclonedds_cpp")


def test_another_release_is_rejected_with_both_versions(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(typesupport, "release_of", lambda package: (5, 0))
    with pytest.raises(typesupport.TypeSupportError, match=r"rosidl_runtime_c: found release 5\.0, expected 4\.6"):
        typesupport.check_layouts("rmw_fastrtps_cpp")


def test_a_package_that_is_not_installed_has_no_release() -> None:
    assert typesupport.release_of("no_such_package") is None


def test_a_type_that_cannot_be_built_is_unavailable_with_one_warning(
    monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    class Metaclass(tf2_messages._Metaclass):
        _TYPE_SUPPORT = None

    class Message(metaclass=Metaclass):
        pass

    monkeypatch.setattr(typesupport, "release_of", lambda package: None)
    monkeypatch.setattr(tf2_messages, "TFMessage", Message)
    tf2_messages.available.cache_clear()
    try:
        assert not tf2_messages.available()
        assert not tf2_messages.available()
        assert [record.levelname for record in caplog.records] == ["WARNING"]
        assert "rosidl_runtime_c: found release none, expected 4.6" in caplog.text
    finally:
        tf2_messages.available.cache_clear()


class Peer:
    """A node in its own context, as in another process."""

    def __init__(self, name: str, domain: int) -> None:
        self.context = Context()
        self.context.init(args=[], domain_id=domain)
        self.node = Node(name, context=self.context)
        self.executor = SingleThreadedExecutor(context=self.context)
        self.executor.add_node(self.node)
        self.received: list[tuple[Transform, ...]] = []

    def publisher(self, topic: str, qos: QoSProfile | int = 10) -> Any:
        return self.node.create_publisher(TFMessage, topic, qos)

    def listen(self, topic: str, qos: QoSProfile | int = 10) -> None:
        self.node.create_subscription(TFMessage, topic, lambda data: self.received.append(decode(data)), qos, raw=True)

    @property
    def matched_publishers(self) -> int:
        """Publishers that this peer's subscriptions are matched with: the publisher's side may know of it earlier."""
        return sum(subscription.get_publisher_count() for subscription in self.node.subscriptions)

    def close(self) -> None:
        self.executor.shutdown()
        self.node.destroy_node()
        self.context.try_shutdown()


def _until(condition: Callable[[], bool], *peers: Peer) -> None:
    """Spin the peers until the condition is true."""
    deadline = Deadline()
    while not condition():
        for peer in peers:
            peer.executor.spin_once(timeout_sec=0.02)
        assert not deadline.is_over


@contextmanager
def _peers(*names: str) -> Iterator[tuple[Peer, ...]]:
    peers: list[Peer] = []
    with reserved() as domain:
        try:
            peers.extend(Peer(name, domain) for name in names)
            yield tuple(peers)
        finally:
            for peer in reversed(peers):
                peer.close()


def test_transforms_arrive_in_another_context_under_the_true_name_and_hash() -> None:
    with _peers("simulator", "viewer") as (simulator, viewer):
        publisher = simulator.publisher("/tf")
        viewer.listen("/tf")
        _until(lambda: publisher.get_subscription_count() == viewer.matched_publishers == 1, simulator, viewer)
        publisher.publish(encode([BASE, WHEEL]))
        _until(lambda: bool(viewer.received), simulator, viewer)
        (endpoint,) = viewer.node.get_publishers_info_by_topic("/tf")
    assert viewer.received == [(BASE, WHEEL)]
    assert endpoint.topic_type == tf2_messages.TF_TYPE_NAME == "tf2_msgs/msg/TFMessage"
    assert str(endpoint.topic_type_hash) == HASH


def test_a_transient_local_message_reaches_a_late_subscriber() -> None:
    with _peers("simulator", "viewer") as (simulator, viewer):
        simulator.publisher("/tf_static", TRANSIENT_LOCAL).publish(encode([WHEEL]))
        viewer.listen("/tf_static", TRANSIENT_LOCAL)
        _until(lambda: bool(viewer.received), simulator, viewer)
    assert viewer.received == [(WHEEL,)]


def test_several_nodes_of_one_process_may_come_and_go() -> None:
    with _peers("first", "second", "viewer") as peers:
        # A participant that comes while another one's publisher goes may never hear of its next one: one time in twenty
        # with Fast DDS 2.14, never in 200 when all know each other before.
        _until(lambda: all(len(peer.node.get_node_names()) == len(peers) for peer in peers), *peers)
        first, second, viewer = peers
        early = first.publisher("/tf")
        first.node.destroy_publisher(early)
        # Transient local: the publisher that went may still be counted as one of two when the viewer comes.
        publishers = [first.publisher("/tf", TRANSIENT_LOCAL), second.publisher("/tf", TRANSIENT_LOCAL)]
        viewer.listen("/tf", TRANSIENT_LOCAL)
        publishers[0].publish(encode([BASE]))
        publishers[1].publish(encode([WHEEL]))
        _until(lambda: len(viewer.received) == 2, first, second, viewer)
    assert sorted(viewer.received, key=str) == sorted([(BASE,), (WHEEL,)], key=str)


def test_the_events_executor_delivers_transforms() -> None:
    experimental = pytest.importorskip("rclpy.experimental")
    with _peers("simulator", "viewer") as (simulator, viewer):
        publisher = simulator.publisher("/tf")
        viewer.listen("/tf")
        viewer.executor.remove_node(viewer.node)
        viewer.executor = experimental.EventsExecutor(context=viewer.context)
        viewer.executor.add_node(viewer.node)
        _until(lambda: publisher.get_subscription_count() == viewer.matched_publishers == 1, simulator, viewer)
        publisher.publish(encode([BASE]))
        _until(lambda: bool(viewer.received), simulator, viewer)
    assert viewer.received == [(BASE,)]


def _hash_of(description: Any) -> str:
    """RIHS01: sha256 over the description as JSON with fixed spacing, without default values."""

    def type_of(kind: Any) -> dict[str, Any]:
        keys = ("type_id", "capacity", "string_capacity", "nested_type_name")
        return {key: getattr(kind, key) for key in keys}

    def one(individual: Any) -> dict[str, Any]:
        fields = [{"name": field.name, "type": type_of(field.type)} for field in individual.fields]
        return {"type_name": individual.type_name, "fields": fields}

    value = {
        "type_description": one(description.type_description),
        "referenced_type_descriptions": [one(item) for item in description.referenced_type_descriptions],
    }
    return "RIHS01_" + hashlib.sha256(json.dumps(value).encode()).hexdigest()


def test_the_description_service_describes_the_type_of_the_hash() -> None:
    with _peers("simulator", "viewer") as (simulator, viewer):
        simulator.publisher("/tf")
        client = viewer.node.create_client(GetTypeDescription, "/simulator/get_type_description")
        _until(client.service_is_ready, simulator, viewer)
        request = GetTypeDescription.Request(
            type_name=tf2_messages.TF_TYPE_NAME, type_hash=HASH, include_type_sources=True
        )
        future = client.call_async(request)
        _until(future.done, simulator, viewer)
        response = future.result()
    assert response.successful, response.failure_reason
    assert _hash_of(response.type_description) == HASH
    sources = {source.type_name: source for source in response.type_sources}
    content = sources["tf2_msgs/msg/TFMessage"].raw_file_contents
    assert content.strip() == "geometry_msgs/TransformStamped[] transforms"
    assert sources["tf2_msgs/msg/TFMessage"].encoding == "msg"
    assert "geometry_msgs/msg/Quaternion" in sources


def test_a_built_type_equals_the_compiled_one_and_communicates_with_it() -> None:
    """MarkerArray has the shape of TFMessage and is compiled: the proof that the structures are right."""
    check_for_type_support(Marker)
    check_for_type_support(MarkerArray)
    description = typesupport.SequenceType(
        "visualization_msgs", "MarkerArray", "markers", "visualization_msgs/msg/Marker",
        typesupport.type_hash_of(MarkerArray),
    )  # fmt: skip

    class Metaclass(tf2_messages._Metaclass):
        _TYPE_SUPPORT = typesupport.build(description, Marker)

    class Built(metaclass=Metaclass):
        pass

    sent = MarkerArray(markers=[Marker(ns="wall", id=7, text="here"), Marker(ns="box", id=8)])
    received: list[MarkerArray] = []
    with _peers("builder", "compiled") as (builder, compiled):
        publisher = builder.node.create_publisher(Built, "/markers", 10)
        compiled.node.create_subscription(MarkerArray, "/markers", received.append, 10)
        _until(lambda: publisher.get_subscription_count() == compiled.matched_publishers == 1, builder, compiled)
        publisher.publish(serialize_message(sent))
        _until(lambda: bool(received), builder, compiled)
        (endpoint,) = compiled.node.get_publishers_info_by_topic("/markers")
        (own,) = compiled.node.get_subscriptions_info_by_topic("/markers")
    assert received == [sent]
    assert endpoint.topic_type_hash == own.topic_type_hash


@pytest.mark.process
def test_transforms_arrive_from_another_process() -> None:
    program = """
        import sys
        import threading
        import rclpy
        from rclpy.node import Node
        from thymio_sim_ros.ros.compat.tf2_messages import TFMessage, Transform, encode

        rclpy.init(args=[])
        node = Node("other")
        publisher = node.create_publisher(TFMessage, "/tf", 10)
        transform = Transform(5, "odom", "base_link", (1.0, 2.0, 3.0), (0.0, 0.0, 0.0, 1.0))
        node.create_timer(0.05, lambda: publisher.publish(encode([transform])))
        is_enough = threading.Event()
        threading.Thread(target=lambda: (sys.stdin.read(), is_enough.set())).start()
        while not is_enough.is_set():
            rclpy.spin_once(node, timeout_sec=0.1)
        node.destroy_node()
        rclpy.try_shutdown()
    """
    with _peers("viewer") as (viewer,):
        environment = os.environ | {"ROS_DOMAIN_ID": str(viewer.context.get_domain_id())}
        viewer.listen("/tf")
        command = [sys.executable, "-c", textwrap.dedent(program)]
        process = subprocess.Popen(command, env=environment, stdin=subprocess.PIPE)
        try:
            _until(lambda: bool(viewer.received), viewer)
            (endpoint,) = viewer.node.get_publishers_info_by_topic("/tf")
            process.communicate(timeout=PATIENCE_S)  # closes its standard input
            assert process.returncode == 0
        finally:
            process.kill()
            process.wait()
    assert viewer.received[0] == (Transform(5, "odom", "base_link", (1.0, 2.0, 3.0), (0.0, 0.0, 0.0, 1.0)),)
    assert str(endpoint.topic_type_hash) == HASH
