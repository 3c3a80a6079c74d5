"""Goals as a server of an action has them."""

from __future__ import annotations

from collections.abc import Awaitable, Callable
from contextlib import AbstractContextManager
from typing import Any, Generic, Protocol, TypeAlias

from thymio_sim_ros.portable_ros import ros_types
from thymio_sim_ros.portable_ros.messages.action_class import FeedbackT, GoalT, ResultT
from thymio_sim_ros.portable_ros.rclpy_parts.goal_state import FINAL, GoalEvent, GoalState, next_state

__all__ = ["ExecuteCallback", "GoalOwner", "ServerGoalHandle"]


class GoalOwner(Protocol):
    """A server, as its goals need it."""

    @property
    def lock(self) -> AbstractContextManager[Any]:
        """Guards the states of all goals."""

    @property
    def action_type(self) -> Any:
        """The class of the action."""

    def notify_execute(self, goal_handle: Any, execute_callback: Any) -> None:
        """Let the executor execute a goal."""

    def publish_feedback(self, goal_handle: Any, feedback: Any) -> None:
        """Publish feedback of a goal."""

    def state_changed(self, goal_handle: Any) -> None:
        """Publish the states of all goals, one of which has changed; `lock` is held."""


class ServerGoalHandle(Generic[GoalT, ResultT, FeedbackT]):
    """An accepted goal. Methods that end it publish its state; the callback that executes it returns the result.

    A goal whose result has expired, or whose server is destroyed, has the state UNKNOWN and ignores all methods.
    """

    def __init__(self, action_server: GoalOwner, goal_info: ros_types.GoalInfo, goal_request: GoalT) -> None:
        self._server, self._goal_info, self._request = action_server, goal_info, goal_request
        self._state = GoalState.ACCEPTED

    def __eq__(self, other: object) -> bool:
        return isinstance(other, ServerGoalHandle) and self.goal_id == other.goal_id

    __hash__ = None  # type: ignore[assignment]  # as rclpy's

    @property
    def info(self) -> ros_types.GoalInfo:
        """The id of the goal, and when it was accepted."""
        return self._goal_info

    @property
    def request(self) -> GoalT:
        """What the client wants."""
        return self._request

    @property
    def goal_id(self) -> ros_types.UUID:
        """The id of the goal."""
        return self._goal_info.goal_id

    @property
    def is_active(self) -> bool:
        """Whether the goal is neither at its end nor unknown."""
        return self._state not in FINAL and self._state is not GoalState.UNKNOWN

    @property
    def is_cancel_requested(self) -> bool:
        """Whether the server has accepted to cancel the goal, which has not ended yet."""
        return self._state is GoalState.CANCELING

    @property
    def status(self) -> int:
        """The state, with the values of `action_msgs/msg/GoalStatus`."""
        return int(self._state)

    def execute(self, execute_callback: ExecuteCallback[GoalT, ResultT, FeedbackT] | None = None) -> None:
        """Let the executor of the node call a callback, by default that of the server, even if the goal is canceling.

        Raises RCLError for a goal that is executed already, or at its end.
        """
        if not self.is_cancel_requested:
            self._update_state(GoalEvent.EXECUTE)
        self._server.notify_execute(self, execute_callback)

    def publish_feedback(self, feedback: FeedbackT) -> None:
        """Send feedback to the client. Raises TypeError for feedback of another action."""
        if not isinstance(feedback, self._server.action_type.Feedback):
            raise TypeError
        if self._state is not GoalState.UNKNOWN:
            self._server.publish_feedback(self, feedback)

    def succeed(self) -> None:
        """End the goal with success. Raises RCLError if it is not executed."""
        self._update_state(GoalEvent.SUCCEED)

    def abort(self) -> None:
        """End the goal with a failure. Raises RCLError if it is not executed."""
        self._update_state(GoalEvent.ABORT)

    def canceled(self) -> None:
        """End the goal as canceled. Raises RCLError if no cancellation was accepted."""
        self._update_state(GoalEvent.CANCELED)

    def destroy(self) -> None:
        """Forget the state."""
        self._state = GoalState.UNKNOWN

    def _update_state(self, event: GoalEvent) -> None:
        with self._server.lock:
            if self._state is GoalState.UNKNOWN:
                return
            self._state = next_state(self._state, event)
            self._server.state_changed(self)


ExecuteCallback: TypeAlias = Callable[[ServerGoalHandle[GoalT, ResultT, FeedbackT]], ResultT | Awaitable[ResultT]]
