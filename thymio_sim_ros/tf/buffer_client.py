"""The client of `tf2_ros` that asks a server for transforms by an action.

The server is a node that has the action `tf2_msgs/action/LookupTransform`, such as `buffer_server` of tf2_ros.
"""

from __future__ import annotations

import threading
import time as clock
from typing import Any

from builtin_interfaces.msg import Time as TimeMessage
from geometry_msgs.msg import TransformStamped
from rclpy.action import ActionClient
from rclpy.duration import Duration
from rclpy.node import Node
from rclpy.task import Future
from rclpy.time import Time
from tf2_msgs.action import LookupTransform
from tf2_msgs.msg import TF2Error

from thymio_sim_ros.tf.buffer_interface import NO_WAIT, BufferInterface
from thymio_sim_ros.tf.errors import (
    ConnectivityException,
    ExtrapolationException,
    InvalidArgumentException,
    LookupException,
    TimeoutException,
    TransformException,
)

__all__ = ["BufferClient"]

PADDING = Duration(seconds=2.0)

_EXCEPTIONS: dict[int, type[TransformException]] = {
    TF2Error.LOOKUP_ERROR: LookupException,
    TF2Error.CONNECTIVITY_ERROR: ConnectivityException,
    TF2Error.EXTRAPOLATION_ERROR: ExtrapolationException,
    TF2Error.INVALID_ARGUMENT_ERROR: InvalidArgumentException,
    TF2Error.TIMEOUT_ERROR: TimeoutException,
}


class BufferClient(BufferInterface):
    """A buffer of transforms in another node.

    Lookups wait for the server while another thread spins the node. In a callback of a single-threaded node, each of
    them ends with a TimeoutException.
    """

    def __init__(
        self,
        node: Node,
        ns: str,
        check_frequency: float = 10.0,
        timeout_padding: Duration = PADDING,
    ) -> None:
        """`ns` is the name of the action, and `timeout_padding` is added to the time-out of each lookup.

        `check_frequency` is that of tf2; here, replies are not polled for.
        """
        super().__init__()
        self.node, self.check_frequency, self.timeout_padding = node, check_frequency, timeout_padding
        self._name = node.resolve_service_name(ns)
        self.action_client = ActionClient(node, LookupTransform, action_name=ns)

    def destroy(self) -> None:
        """Destroy the action client."""
        self.action_client.destroy()

    def lookup_transform(
        self, target_frame: str, source_frame: str, time: Time | TimeMessage, timeout: Duration = NO_WAIT
    ) -> TransformStamped:
        """The pose of `source_frame` in `target_frame`; the server waits until it is known, at most for `timeout`.

        Raises the exceptions of `Buffer.lookup_transform`, and TimeoutException without a reply.
        """
        return self._ask(
            LookupTransform.Goal(
                target_frame=target_frame,
                source_frame=source_frame,
                source_time=_message(time),
                timeout=timeout.to_msg(),
            )
        )

    def lookup_transform_full(
        self,
        target_frame: str,
        target_time: Time | TimeMessage,
        source_frame: str,
        source_time: Time | TimeMessage,
        fixed_frame: str,
        timeout: Duration = NO_WAIT,
    ) -> TransformStamped:
        """The pose of `source_frame` at one time in `target_frame` at another time; see `Buffer.lookup_transform_full`.

        Raises the exceptions of `lookup_transform`.
        """
        return self._ask(
            LookupTransform.Goal(
                target_frame=target_frame,
                target_time=_message(target_time),
                source_frame=source_frame,
                source_time=_message(source_time),
                fixed_frame=fixed_frame,
                timeout=timeout.to_msg(),
                advanced=True,
            )
        )

    def can_transform(
        self, target_frame: str, source_frame: str, time: Time | TimeMessage, timeout: Duration = NO_WAIT
    ) -> bool:
        """Whether the server knows a transform, after waiting at most for `timeout`."""
        try:
            self.lookup_transform(target_frame, source_frame, time, timeout)
        except TransformException:
            return False
        return True

    def can_transform_full(
        self,
        target_frame: str,
        target_time: Time | TimeMessage,
        source_frame: str,
        source_time: Time | TimeMessage,
        fixed_frame: str,
        timeout: Duration = NO_WAIT,
    ) -> bool:
        """Whether the server knows a transform between two times; see `can_transform`."""
        try:
            self.lookup_transform_full(target_frame, target_time, source_frame, source_time, fixed_frame, timeout)
        except TransformException:
            return False
        return True

    def _ask(self, goal: LookupTransform.Goal) -> TransformStamped:
        if not self.action_client.server_is_ready():
            raise TimeoutException(
                f"no server has the action {self._name}: start one, such as buffer_server of tf2_ros"
            )
        wait_ns = Duration.from_msg(goal.timeout).nanoseconds + self.timeout_padding.nanoseconds
        end_s = clock.monotonic() + wait_ns / 1e9
        handle = self._result(self.action_client.send_goal_async(goal), end_s)
        if not handle.accepted:
            raise TimeoutException(f"the server of {self._name} did not accept the lookup")
        try:
            result = self._result(handle.get_result_async(), end_s).result
        except TimeoutException:
            handle.cancel_goal_async()
            raise
        if result.error.error != TF2Error.NO_ERROR:
            raise _EXCEPTIONS.get(result.error.error, TransformException)(result.error.error_string)
        transform: TransformStamped = result.transform
        return transform

    def _result(self, future: Future[Any], end_s: float) -> Any:
        """The result of a future. Raises TimeoutException if it is not done at that time of the monotonic clock."""
        done = threading.Event()
        future.add_done_callback(lambda _: done.set())
        if not done.wait(max(0.0, end_s - clock.monotonic())):
            raise TimeoutException(
                f"the server of {self._name} did not reply in time; does another thread spin {self.node.get_name()}?"
            )
        return future.result()


def _message(time: Time | TimeMessage) -> TimeMessage:
    return time.to_msg() if isinstance(time, Time) else time
