"""The buffer of `tf2_ros`: transforms over time for the nodes of a process."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterable
from typing import Any

from builtin_interfaces.msg import Time as TimeMessage
from geometry_msgs.msg import TransformStamped
from rclpy.clock import Clock
from rclpy.duration import Duration
from rclpy.logging import get_logger
from rclpy.node import Node
from rclpy.task import Future
from rclpy.time import Time

from thymio_sim_ros import course_packages
from thymio_sim_ros.ros.compat import tf2_messages
from thymio_sim_ros.tf.buffer_core import CACHE_NS, BufferCore, RigidTransform, StampedTransform
from thymio_sim_ros.tf.buffer_interface import NO_WAIT, BufferInterface
from thymio_sim_ros.tf.errors import TransformException

__all__ = ["Buffer", "placed_of"]


class Buffer(BufferInterface):
    """Transforms of the last 10 s, or of `cache_time`; filled by a TransformListener or by `set_transform`.

    Thread-safe. `time` is a time of rclpy or a stamp; `Time()` means the latest time at which all transforms between
    two frames are known. `timeout` is measured on the clock of the node and is only useful if another thread fills the
    buffer.
    """

    def __init__(self, cache_time: Duration | None = None, node: Node | None = None) -> None:
        """`node` provides the clock for time-outs; wall time is used without it.

        Where tf2_msgs is installed, the node gets the service `tf2_frames`, which returns the tree of frames.
        """
        super().__init__()
        self._core = BufferCore(CACHE_NS if cache_time is None else cache_time.nanoseconds)
        self._clock = Clock() if node is None else node.get_clock()
        self._changed = threading.Condition()
        self._waiting: dict[Future[bool], Callable[[], bool]] = {}
        if node is not None and course_packages.is_installed("tf2_msgs"):
            from tf2_msgs.srv import FrameGraph

            self.srv = node.create_service(FrameGraph, "tf2_frames", self._on_frames)

    def set_transform(self, transform: TransformStamped, authority: str) -> None:
        """Store a transform; one that is invalid, too old or repeated is left out with a warning, as by tf2."""
        self._store_or_warn(transform, authority, is_static=False)

    def set_transform_static(self, transform: TransformStamped, authority: str) -> None:
        """Store a transform that is valid at any time; an invalid one is left out with a warning, as by tf2."""
        self._store_or_warn(transform, authority, is_static=True)

    def clear(self) -> None:
        """Drop all transforms except static ones."""
        with self._changed:
            self._core.clear()

    def lookup_transform(
        self, target_frame: str, source_frame: str, time: Time | TimeMessage, timeout: Duration = NO_WAIT
    ) -> TransformStamped:
        """The pose of `source_frame` in `target_frame`; waits until it is known, at most for `timeout`.

        Raises LookupException, ConnectivityException, ExtrapolationException or InvalidArgumentException.
        """
        return self._wait_and_lookup(lambda: self._core.lookup(target_frame, source_frame, _ns(time)), timeout)

    def lookup_transform_full(
        self,
        target_frame: str,
        target_time: Time | TimeMessage,
        source_frame: str,
        source_time: Time | TimeMessage,
        fixed_frame: str,
        timeout: Duration = NO_WAIT,
    ) -> TransformStamped:
        """The pose of `source_frame` at one time in `target_frame` at another time.

        `fixed_frame` is a frame that does not move in between. Raises the exceptions of `lookup_transform`.
        """
        return self._wait_and_lookup(
            lambda: self._core.lookup_full(target_frame, _ns(target_time), source_frame, _ns(source_time), fixed_frame),
            timeout,
        )

    async def lookup_transform_async(
        self, target_frame: str, source_frame: str, time: Time | TimeMessage
    ) -> TransformStamped:
        """Wait until the transform is known and return it. Raises the exceptions of `lookup_transform`."""
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
        """Wait until the transform between two times is known and return it; see `lookup_transform_full`."""
        times = (target_frame, target_time, source_frame, source_time, fixed_frame)
        await self.wait_for_transform_full_async(*times)
        return self.lookup_transform_full(*times)

    def can_transform(
        self,
        target_frame: str,
        source_frame: str,
        time: Time | TimeMessage,
        timeout: Duration = NO_WAIT,
        return_debug_tuple: bool = False,
    ) -> bool | tuple[bool, str]:
        """Whether a transform is known, after waiting at most for `timeout`.

        With `return_debug_tuple` the result is a pair with the reason, which is empty if the transform is known.
        """
        return self._wait_and_check(
            lambda: self._core.lookup(target_frame, source_frame, _ns(time)), timeout, return_debug_tuple
        )

    def can_transform_full(
        self,
        target_frame: str,
        target_time: Time | TimeMessage,
        source_frame: str,
        source_time: Time | TimeMessage,
        fixed_frame: str,
        timeout: Duration = NO_WAIT,
        return_debug_tuple: bool = False,
    ) -> bool | tuple[bool, str]:
        """Whether a transform between two times is known; see `can_transform` and `lookup_transform_full`."""
        return self._wait_and_check(
            lambda: self._core.lookup_full(target_frame, _ns(target_time), source_frame, _ns(source_time), fixed_frame),
            timeout,
            return_debug_tuple,
        )

    def lookup_transform_core(self, target_frame: str, source_frame: str, time: Time | TimeMessage) -> TransformStamped:
        """The pose of `source_frame` in `target_frame`; the same as `lookup_transform`, as tf2_py has it."""
        return self.lookup_transform(target_frame, source_frame, time)

    def can_transform_core(self, target_frame: str, source_frame: str, time: Time | TimeMessage) -> tuple[bool, str]:
        """Whether a transform is known, and the reason if not, as tf2_py has it."""
        return self._wait_and_reason(lambda: self._core.lookup(target_frame, source_frame, _ns(time)), NO_WAIT)

    def lookup_transform_full_core(
        self,
        target_frame: str,
        target_time: Time | TimeMessage,
        source_frame: str,
        source_time: Time | TimeMessage,
        fixed_frame: str,
    ) -> TransformStamped:
        """The pose of a frame at another time; the same as `lookup_transform_full`, as tf2_py has it."""
        return self.lookup_transform_full(target_frame, target_time, source_frame, source_time, fixed_frame)

    def can_transform_full_core(
        self,
        target_frame: str,
        target_time: Time | TimeMessage,
        source_frame: str,
        source_time: Time | TimeMessage,
        fixed_frame: str,
    ) -> tuple[bool, str]:
        """Whether a transform between two times is known, and the reason if not, as tf2_py has it."""
        return self._wait_and_reason(
            lambda: self._core.lookup_full(target_frame, _ns(target_time), source_frame, _ns(source_time), fixed_frame),
            NO_WAIT,
        )

    def get_latest_common_time(self, target_frame: str, source_frame: str) -> Time:
        """The latest time at which all transforms between two frames are known; 0 if all are static.

        Raises LookupException, ConnectivityException or InvalidArgumentException.
        """
        with self._changed:
            return Time(nanoseconds=self._core.latest_common_ns(target_frame, source_frame))

    def lookupVelocityCore(  # noqa: N802  # as tf2's
        self, tracking_frame: str, observation_frame: str, time: Time | TimeMessage, averaging_interval: Duration
    ) -> tuple[tuple[float, float, float], tuple[float, float, float]]:
        """The linear and angular velocity of a frame in another one, in m/s and rad/s; see `lookupVelocityFullCore`."""
        return self.lookupVelocityFullCore(
            tracking_frame, observation_frame, observation_frame, (0, 0, 0), tracking_frame, time, averaging_interval
        )

    def lookupVelocityFullCore(  # noqa: N802  # as tf2's
        self,
        tracking_frame: str,
        observation_frame: str,
        reference_frame: str,
        reference_point: tuple[float, float, float],
        reference_point_frame: str,
        time: Time | TimeMessage,
        averaging_interval: Duration,
    ) -> tuple[tuple[float, float, float], tuple[float, float, float]]:
        """The mean velocity of `tracking_frame` seen from `observation_frame`, with the axes of `reference_frame`.

        Returns the linear velocity of the reference point in m/s and the angular velocity in rad/s, averaged over an
        interval around `time`. Raises the exceptions of `lookup_transform`.
        """
        frames = (tracking_frame, observation_frame, reference_frame, reference_point, reference_point_frame)
        with self._changed:
            return self._core.velocity(*frames, _ns(time), averaging_interval.nanoseconds)

    def wait_for_transform_async(self, target_frame: str, source_frame: str, time: Time | TimeMessage) -> Future[bool]:
        """A future whose result is True as soon as the transform is known."""
        return self._future(lambda: self._core.lookup(target_frame, source_frame, _ns(time)))

    def wait_for_transform_full_async(
        self,
        target_frame: str,
        target_time: Time | TimeMessage,
        source_frame: str,
        source_time: Time | TimeMessage,
        fixed_frame: str,
    ) -> Future[bool]:
        """A future whose result is True as soon as the transform between two times is known."""
        return self._future(
            lambda: self._core.lookup_full(target_frame, _ns(target_time), source_frame, _ns(source_time), fixed_frame)
        )

    def all_frames_as_string(self) -> str:
        """One line for each frame with a parent."""
        with self._changed:
            return self._core.as_text()

    def all_frames_as_yaml(self) -> str:
        """Parent, broadcaster, rate and stored times of each frame, in the format of tf2's view_frames."""
        with self._changed:
            return self._core.as_yaml()

    def _on_frames(self, _request: object, response: Any) -> Any:
        response.frame_yaml = self.all_frames_as_yaml()
        return response

    def _store_or_warn(self, transform: TransformStamped, authority: str, *, is_static: bool) -> None:
        try:
            self._store([placed_of(transform)], authority, is_static=is_static)
        except TransformException as error:
            get_logger("tf2").warning(f"ignored a transform of {authority}: {error}")

    def _store(self, transforms: Iterable[StampedTransform], authority: str, *, is_static: bool) -> None:
        """Store all valid transforms, complete the futures that waited for them, and then raise the first error."""
        first_error = None
        with self._changed:
            for placed in transforms:
                try:
                    self._core.set_transform(placed, authority, is_static=is_static)
                except TransformException as error:
                    first_error = first_error or error
            self._changed.notify_all()
            done = [future for future, is_known in self._waiting.items() if future.cancelled() or is_known()]
            for future in done:
                del self._waiting[future]
        for future in done:
            future.set_result(True)
        if first_error is not None:
            raise first_error

    def _wait_and_lookup(self, lookup: Callable[[], StampedTransform], timeout: Duration) -> TransformStamped:
        with self._changed:
            self._wait(lookup, timeout)
            return _message(lookup())

    def _wait_and_check(
        self, lookup: Callable[[], StampedTransform], timeout: Duration, with_reason: bool
    ) -> bool | tuple[bool, str]:
        found = self._wait_and_reason(lookup, timeout)
        return found if with_reason else found[0]

    def _wait_and_reason(self, lookup: Callable[[], StampedTransform], timeout: Duration) -> tuple[bool, str]:
        with self._changed:
            self._wait(lookup, timeout)
            try:
                lookup()
            except TransformException as error:
                return False, str(error)
        return True, ""

    def _wait(self, lookup: Callable[[], StampedTransform], timeout: Duration) -> None:
        """Wait until the transform is known or the time-out has elapsed; the lock is released meanwhile."""
        end_ns = self._clock.now().nanoseconds + timeout.nanoseconds
        while timeout.nanoseconds > 0 and not _is_known(lookup):
            left_s = (end_ns - self._clock.now().nanoseconds) / 1e9
            if left_s <= 0.0 or left_s > timeout.nanoseconds / 1e9 + 3.0:  # elapsed, or the clock jumped backwards
                return
            self._changed.wait(min(left_s, POLL_S))

    def _future(self, lookup: Callable[[], StampedTransform]) -> Future[bool]:
        future: Future[bool] = Future()
        with self._changed:
            if not _is_known(lookup):
                self._waiting[future] = lambda: _is_known(lookup)
                return future
        future.set_result(True)
        return future


POLL_S = 0.05
"""Wall time between two readings of the clock, which may be simulated."""


def placed_of(transform: TransformStamped) -> StampedTransform:
    """The transform of a message."""
    message = tf2_messages.from_message(transform)
    return StampedTransform(
        message.stamp_ns, message.frame, message.child, RigidTransform(message.translation, message.rotation)
    )


def _message(placed: StampedTransform) -> TransformStamped:
    motion = placed.motion
    return tf2_messages.to_message(
        tf2_messages.Transform(placed.stamp_ns, placed.frame, placed.child, motion.translation, motion.rotation)
    )


def _ns(time: Time | TimeMessage) -> int:
    return int(time.nanoseconds if isinstance(time, Time) else Time.from_msg(time).nanoseconds)


def _is_known(lookup: Callable[[], StampedTransform]) -> bool:
    try:
        lookup()
    except TransformException:
        return False
    return True
