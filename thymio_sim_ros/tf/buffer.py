"""A buffer of transforms with the times and messages of ROS, and what fills and feeds it: the classes of `tf2_ros`."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterable
from typing import Any

from builtin_interfaces.msg import Time as TimeMessage
from geometry_msgs.msg import TransformStamped
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.clock import Clock, ClockChange, JumpThreshold, TimeJump
from rclpy.duration import Duration
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile
from rclpy.task import Future
from rclpy.time import Time

from thymio_sim_ros.ros.compat import tf2_messages
from thymio_sim_ros.ros.rclpy_ext.throttled_log import ThrottledLog
from thymio_sim_ros.tf.buffer_core import CACHE_NS, BufferCore, RigidTransform, StampedTransform
from thymio_sim_ros.tf.errors import TransformException, TypeException
from thymio_sim_ros.tf.geometry import TRANSFORMERS, transform_of

__all__ = ["Buffer", "StaticTransformBroadcaster", "TransformBroadcaster", "TransformListener"]

NOW = Duration()
DYNAMIC = QoSProfile(depth=100)
STATIC = QoSProfile(depth=100, durability=DurabilityPolicy.TRANSIENT_LOCAL)
TRANSIENT_LOCAL = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)


class Buffer:
    """Transforms of the last 10 s, or of `cache_time`; filled by a TransformListener or by hand.

    Safe to use from several threads. `time` is a time of rclpy or a stamp; `Time()` is the latest time at which all
    transforms on the way are known.
    """

    def __init__(self, cache_time: Duration | None = None, node: Node | None = None) -> None:
        """`node`: whose clock times of waiting are measured by; wall time without one."""
        self._core = BufferCore(CACHE_NS if cache_time is None else cache_time.nanoseconds)
        self._clock = Clock() if node is None else node.get_clock()
        self._changed = threading.Condition()
        self._waiting: dict[Future, Callable[[], bool]] = {}

    def set_transform(self, transform: TransformStamped, authority: str) -> None:
        """Keep a transform. TransformException for one that cannot be, or is too old."""
        self._store([_placed(transform)], authority, is_static=False)

    def set_transform_static(self, transform: TransformStamped, authority: str) -> None:
        """Keep a transform that holds always."""
        self._store([_placed(transform)], authority, is_static=True)

    def clear(self) -> None:
        """Forget all but static transforms."""
        with self._changed:
            self._core.clear()

    def lookup_transform(
        self, target_frame: str, source_frame: str, time: Time | TimeMessage, timeout: Duration = NOW
    ) -> TransformStamped:
        """Where `source_frame` is in `target_frame`; waits for it so long.

        LookupException, ConnectivityException, ExtrapolationException, InvalidArgumentException.
        """
        return self._found(lambda: self._core.lookup(target_frame, source_frame, _ns(time)), timeout)

    def lookup_transform_full(
        self,
        target_frame: str,
        target_time: Time | TimeMessage,
        source_frame: str,
        source_time: Time | TimeMessage,
        fixed_frame: str,
        timeout: Duration = NOW,
    ) -> TransformStamped:
        """Where `source_frame` was at one time in `target_frame` at another; `fixed_frame` does not move."""
        return self._found(
            lambda: self._core.lookup_full(target_frame, _ns(target_time), source_frame, _ns(source_time), fixed_frame),
            timeout,
        )

    async def lookup_transform_async(
        self, target_frame: str, source_frame: str, time: Time | TimeMessage
    ) -> TransformStamped:
        """The same as a coroutine that waits until it is there."""
        await self.wait_for_transform_async(target_frame, source_frame, time)
        return self.lookup_transform(target_frame, source_frame, time)

    async def lookup_transform_full_async(
        self,
        target_frame: str,
        target_time: Time | TimeMessage,
        source_frame: str,
        source_time: Time | TimeMessage,
        fixed_frame: str,
    ) -> TransformStamped:
        """The same between two times."""
        times = (target_frame, target_time, source_frame, source_time, fixed_frame)
        await self.wait_for_transform_full_async(*times)
        return self.lookup_transform_full(*times)

    def can_transform(
        self,
        target_frame: str,
        source_frame: str,
        time: Time | TimeMessage,
        timeout: Duration = NOW,
        return_debug_tuple: bool = False,
    ) -> bool | tuple[bool, str]:
        """Whether there is a transform, at the latest after so long; with the reason if that is wanted."""
        return self._answer(
            lambda: self._core.lookup(target_frame, source_frame, _ns(time)), timeout, return_debug_tuple
        )

    def can_transform_full(
        self,
        target_frame: str,
        target_time: Time | TimeMessage,
        source_frame: str,
        source_time: Time | TimeMessage,
        fixed_frame: str,
        timeout: Duration = NOW,
        return_debug_tuple: bool = False,
    ) -> bool | tuple[bool, str]:
        """The same between two times."""
        return self._answer(
            lambda: self._core.lookup_full(target_frame, _ns(target_time), source_frame, _ns(source_time), fixed_frame),
            timeout,
            return_debug_tuple,
        )

    def wait_for_transform_async(self, target_frame: str, source_frame: str, time: Time | TimeMessage) -> Future:
        """A future that is done, with True, once there is a transform."""
        return self._future(lambda: self._core.lookup(target_frame, source_frame, _ns(time)))

    def wait_for_transform_full_async(
        self,
        target_frame: str,
        target_time: Time | TimeMessage,
        source_frame: str,
        source_time: Time | TimeMessage,
        fixed_frame: str,
    ) -> Future:
        """The same between two times."""
        return self._future(
            lambda: self._core.lookup_full(target_frame, _ns(target_time), source_frame, _ns(source_time), fixed_frame)
        )

    def transform(
        self, object_stamped: Any, target_frame: str, timeout: Duration = NOW, new_type: type | None = None
    ) -> Any:
        """A PointStamped, PoseStamped or Vector3Stamped in another frame. TypeException for another message."""
        header = object_stamped.header
        act = _transformer(object_stamped, new_type)
        return act(object_stamped, self.lookup_transform(target_frame, header.frame_id, header.stamp, timeout))

    def transform_full(
        self,
        object_stamped: Any,
        target_frame: str,
        target_time: Time | TimeMessage,
        fixed_frame: str,
        timeout: Duration = NOW,
        new_type: type | None = None,
    ) -> Any:
        """The same at another time."""
        header = object_stamped.header
        act = _transformer(object_stamped, new_type)
        found = self.lookup_transform_full(
            target_frame, target_time, header.frame_id, header.stamp, fixed_frame, timeout
        )
        return act(object_stamped, found)

    def all_frames_as_string(self) -> str:
        """A line for each frame with a parent."""
        with self._changed:
            return self._core.as_text()

    def all_frames_as_yaml(self) -> str:
        """For each frame its parent, who sends it, how often, and how much is kept."""
        with self._changed:
            return self._core.as_yaml()

    def _store(self, transforms: Iterable[StampedTransform], authority: str, *, is_static: bool) -> None:
        """Keep all that can be kept; the first fault is raised then."""
        fault = None
        with self._changed:
            for placed in transforms:
                try:
                    self._core.set_transform(placed, authority, is_static=is_static)
                except TransformException as error:
                    fault = fault or error
            self._changed.notify_all()
            done = [future for future, is_there in self._waiting.items() if future.cancelled() or is_there()]
            for future in done:
                del self._waiting[future]
        for future in done:
            future.set_result(True)
        if fault is not None:
            raise fault

    def _found(self, look: Callable[[], StampedTransform], timeout: Duration) -> TransformStamped:
        with self._changed:
            self._wait(look, timeout)
            return _message(look())

    def _answer(
        self, look: Callable[[], StampedTransform], timeout: Duration, is_explained: bool
    ) -> bool | tuple[bool, str]:
        with self._changed:
            self._wait(look, timeout)
            try:
                look()
            except TransformException as error:
                return (False, str(error)) if is_explained else False
        return (True, "") if is_explained else True

    def _wait(self, look: Callable[[], StampedTransform], timeout: Duration) -> None:
        """Until there is a transform, or so much time has passed on the clock."""
        end_ns = self._clock.now().nanoseconds + timeout.nanoseconds
        while timeout.nanoseconds > 0 and not _is_there(look):
            left_s = (end_ns - self._clock.now().nanoseconds) / 1e9
            if left_s <= 0.0 or left_s > timeout.nanoseconds / 1e9 + 3.0:  # time went back
                return
            self._changed.wait(min(left_s, POLL_S))

    def _future(self, look: Callable[[], StampedTransform]) -> Future:
        future = Future()
        with self._changed:
            if not _is_there(look):
                self._waiting[future] = lambda: _is_there(look)
                return future
        future.set_result(True)
        return future


POLL_S = 0.05
"""Wall time between two looks at a clock that may be a simulator's."""


class TransformListener:
    """Fills a buffer with what is sent on `/tf` and `/tf_static`; empties it when the node's time goes back.

    With `spin_thread`, messages come in while the node's callbacks wait for a transform.
    """

    def __init__(
        self,
        buffer: Buffer,
        node: Node,
        *,
        spin_thread: bool = False,
        qos: QoSProfile | None = None,
        static_qos: QoSProfile | None = None,
        tf_topic: str = "/tf",
        tf_static_topic: str = "/tf_static",
    ) -> None:
        self.buffer, self.node = buffer, node
        self._warn = ThrottledLog(node)
        self._own: Node | None = None
        if spin_thread:
            self._own = Node(
                f"{node.get_name()}_tf_listener",
                context=node.context,
                namespace=node.get_namespace(),
                enable_rosout=False,
                start_parameter_services=False,
            )
        host, group = self._own or node, ReentrantCallbackGroup()
        kind = tf2_messages.TFMessage
        self.tf_sub = host.create_subscription(
            kind, tf_topic, self.callback, qos or DYNAMIC, callback_group=group, raw=True
        )
        self.tf_static_sub = host.create_subscription(
            kind, tf_static_topic, self.static_callback, static_qos or STATIC, callback_group=group, raw=True
        )
        self._jumps = node.get_clock().create_jump_callback(
            JumpThreshold(min_forward=None, min_backward=Duration(nanoseconds=-1), on_clock_change=True),
            post_callback=self._on_jump,
        )
        if self._own is not None:
            self.executor = SingleThreadedExecutor(context=node.context)
            self.executor.add_node(self._own)
            self.dedicated_listener_thread = threading.Thread(target=self._spin, name="tf_listener", daemon=True)
            self.dedicated_listener_thread.start()

    def callback(self, data: bytes) -> None:
        """What came on `/tf`."""
        self._on_transforms(data, is_static=False)

    def static_callback(self, data: bytes) -> None:
        """What came on `/tf_static`."""
        self._on_transforms(data, is_static=True)

    def unregister(self) -> None:
        """Listen no more."""
        self._jumps.unregister()
        if self._own is None:
            self.node.destroy_subscription(self.tf_sub)
            self.node.destroy_subscription(self.tf_static_sub)
            return
        self.executor.shutdown(timeout_sec=1.0)
        self.dedicated_listener_thread.join(timeout=1.0)
        self._own.destroy_node()

    def _spin(self) -> None:
        try:
            self.executor.spin()
        except ExternalShutdownException:
            return

    def _on_transforms(self, data: bytes, *, is_static: bool) -> None:
        try:
            found = [
                StampedTransform(one.stamp_ns, one.frame, one.child, RigidTransform(one.translation, one.rotation))
                for one in tf2_messages.decode(data)
            ]
            self.buffer._store(found, "default_authority", is_static=is_static)
        except (tf2_messages.TransformDataError, TransformException) as error:
            self._warn("tf:", f"{error}; does the node use the simulator's time (use_sim_time:=true)?")

    def _on_jump(self, jump: TimeJump) -> None:
        if jump.delta.nanoseconds < 0 or jump.clock_change not in (
            ClockChange.ROS_TIME_NO_CHANGE,
            ClockChange.SYSTEM_TIME_NO_CHANGE,
        ):
            self.buffer.clear()


class TransformBroadcaster:
    """Sends transforms on `/tf`."""

    def __init__(self, node: Node, qos: QoSProfile | int | None = None) -> None:
        self.pub_tf = node.create_publisher(tf2_messages.TFMessage, "/tf", qos or DYNAMIC)

    def sendTransform(self, transform: TransformStamped | Iterable[TransformStamped]) -> None:  # noqa: N802  # as tf2's
        """One transform, or several at once."""
        self.pub_tf.publish(_encoded(_several(transform)))


class StaticTransformBroadcaster:
    """Sends transforms that hold always on `/tf_static`; who comes later hears all of them."""

    def __init__(self, node: Node, qos: QoSProfile | int | None = None) -> None:
        self.pub_tf = node.create_publisher(tf2_messages.TFMessage, "/tf_static", qos or TRANSIENT_LOCAL)
        self._sent: dict[str, TransformStamped] = {}

    def sendTransform(self, transform: TransformStamped | Iterable[TransformStamped]) -> None:  # noqa: N802  # as tf2's
        """One transform, or several; those of the same child replace those before."""
        self._sent |= {one.child_frame_id: one for one in _several(transform)}
        self.pub_tf.publish(_encoded(self._sent.values()))


def _several(transform: TransformStamped | Iterable[TransformStamped]) -> list[TransformStamped]:
    return [transform] if hasattr(transform, "child_frame_id") else list(transform)


def _encoded(transforms: Iterable[TransformStamped]) -> bytes:
    placed = map(_placed, transforms)
    return tf2_messages.encode([
        tf2_messages.Transform(one.stamp_ns, one.frame, one.child, one.motion.translation, one.motion.rotation)
        for one in placed
    ])  # fmt: skip


def _placed(transform: TransformStamped) -> StampedTransform:
    stamp_ns = _ns(transform.header.stamp)
    return StampedTransform(stamp_ns, transform.header.frame_id, transform.child_frame_id, transform_of(transform))


def _message(placed: StampedTransform) -> TransformStamped:
    message = TransformStamped(child_frame_id=placed.child)
    message.header.frame_id = placed.frame
    message.header.stamp = Time(nanoseconds=placed.stamp_ns).to_msg()
    translation, rotation = message.transform.translation, message.transform.rotation
    translation.x, translation.y, translation.z = placed.motion.translation
    rotation.x, rotation.y, rotation.z, rotation.w = placed.motion.rotation
    return message


def _ns(time: Time | TimeMessage) -> int:
    return int(time.nanoseconds if isinstance(time, Time) else Time.from_msg(time).nanoseconds)


def _is_there(look: Callable[[], StampedTransform]) -> bool:
    try:
        look()
    except TransformException:
        return False
    return True


def _transformer(message: Any, new_type: type | None) -> Callable[[Any, TransformStamped], Any]:
    kind = type(message)
    if kind not in TRANSFORMERS or new_type not in (None, kind):
        known = ", ".join(one.__name__ for one in TRANSFORMERS)
        wanted = f" as {new_type.__name__}" if new_type not in (None, kind) and new_type is not None else ""
        raise TypeException(f"{kind.__name__}{wanted} found, expected one of {known}")
    return TRANSFORMERS[kind]
