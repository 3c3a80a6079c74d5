"""Goals as a client of an action has them."""

from __future__ import annotations

from typing import Any, Generic, Protocol

from thymio_sim_ros.portable_ros import ros_types
from thymio_sim_ros.portable_ros.messages.action_class import FeedbackT, GoalT, ResultT
from thymio_sim_ros.portable_ros.rclpy.task import Future

__all__ = ["ClientGoalHandle"]


class GoalSender(Protocol):
    """A client, as its goals need it."""

    def _cancel_goal(self, goal_handle: Any) -> ros_types.CancelGoal.Response: ...
    def _cancel_goal_async(self, goal_handle: Any) -> Future[ros_types.CancelGoal.Response]: ...
    def _get_result(self, goal_handle: Any) -> Any: ...
    def _get_result_async(self, goal_handle: Any) -> Future[Any]: ...


class GoalResponse(Protocol):
    """The response to a goal of any action."""

    stamp: ros_types.TimeMessage
    accepted: bool


class ClientGoalHandle(Generic[GoalT, ResultT, FeedbackT]):
    """A goal that a server has answered."""

    def __init__(self, action_client: GoalSender, goal_id: ros_types.UUID, goal_response: GoalResponse) -> None:
        self._client, self._goal_id, self._goal_response = action_client, goal_id, goal_response
        self._status = int(ros_types.GoalStatus.STATUS_UNKNOWN)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, ClientGoalHandle) and self._goal_id == other.goal_id

    __hash__ = None  # type: ignore[assignment]  # as rclpy's

    def __repr__(self) -> str:
        return f"ClientGoalHandle <id={self.goal_id.uuid}, accepted={self.accepted}, status={self.status}>"

    @property
    def goal_id(self) -> ros_types.UUID:
        """The id of the goal."""
        return self._goal_id

    @property
    def stamp(self) -> ros_types.TimeMessage:
        """When the goal was accepted."""
        return self._goal_response.stamp

    @property
    def accepted(self) -> bool:
        """Whether the goal was accepted."""
        return self._goal_response.accepted

    @property
    def status(self) -> int:
        """The last state that is known, with the values of `action_msgs/msg/GoalStatus`."""
        return self._status

    def cancel_goal(self) -> ros_types.CancelGoal.Response:
        """Ask the server to cancel the goal and wait for its response; another thread must spin the node."""
        return self._client._cancel_goal(self)

    def cancel_goal_async(self) -> Future[ros_types.CancelGoal.Response]:
        """Ask the server to cancel the goal; the future gets its response."""
        return self._client._cancel_goal_async(self)

    def get_result(self) -> Any:
        """Wait for the response with state and result; another thread must spin the node."""
        return self._client._get_result(self)

    def get_result_async(self) -> Future[Any]:
        """Ask for the result; the future gets the response with state and result at the end of the goal."""
        return self._client._get_result_async(self)
