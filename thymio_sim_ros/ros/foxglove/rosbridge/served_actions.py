"""Actions that clients serve."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, cast

from action_msgs.msg import GoalStatus
from rclpy.action import ActionServer, CancelResponse, GoalResponse
from rclpy.task import Future

from thymio_sim_ros.bridge.rosbridge.frames import Operation
from thymio_sim_ros.ros.foxglove.rosbridge.client_node import ClientNode
from thymio_sim_ros.ros.foxglove.rosbridge.outbox import Outbox
from thymio_sim_ros.ros.foxglove.rosbridge.served import MAX_WAITING
from thymio_sim_ros.ros.foxglove.rosbridge.values import Compression, from_message, to_message

__all__ = ["ServedAction"]

_ABORTED = GoalStatus.STATUS_ABORTED


class ServedAction:
    """An action whose goals are sent to a client, as `send_action_goal`, and which its feedback and results answer."""

    def __init__(
        self, outbox: Outbox, place: ClientNode, action: str, kind: Any, shown: dict[str, Any], numbers: Iterator[int]
    ) -> None:
        """`shown` are the fields by which the client knows the action."""
        self._outbox, self._place, self._kind, self._shown = outbox, place, kind, shown
        self._numbers = numbers
        self._goals: dict[str, tuple[Any, Future[tuple[int, Any]]]] = {}
        """The goal and its future status and result, by the ID that the client knows."""
        self._server: Any = ActionServer(
            place.publisher, kind, action, self._execute, goal_callback=self._accept, cancel_callback=self._cancel
        )

    def _accept(self, _request: Any) -> Any:
        return GoalResponse.ACCEPT if len(self._goals) < MAX_WAITING else GoalResponse.REJECT

    async def _execute(self, goal: Any) -> Any:
        goal_id = f"action_goal:{self._shown['action']}:{next(self._numbers)}"
        ended: Future[tuple[int, Any]] = Future(executor=self._place.publisher.executor)
        self._goals[goal_id] = goal, ended
        args = from_message(goal.request, Compression.NONE)
        self._outbox.send({"op": "send_action_goal", "id": goal_id, **self._shown, "args": args, "feedback": True})
        status, result = cast("tuple[int, Any]", await ended)
        self._goals.pop(goal_id, None)
        if status == GoalStatus.STATUS_SUCCEEDED:
            goal.succeed()
        elif status == GoalStatus.STATUS_CANCELED and goal.is_cancel_requested:
            goal.canceled()
        else:
            goal.abort()
        return result

    def _cancel(self, goal: Any) -> Any:
        for goal_id, (known, _) in self._goals.items():
            if known.goal_id == goal.goal_id:
                self._outbox.send({"op": "cancel_action_goal", "id": goal_id, "action": self._shown["action"]})
        return CancelResponse.ACCEPT

    def has(self, goal_id: str) -> bool:
        """Whether a goal waits for its result."""
        return goal_id in self._goals

    def feedback(self, operation: Operation) -> None:
        """Publish feedback on a goal. Raises ValueRefusedError."""
        goal, _ = self._goals[str(operation["id"])]
        goal.publish_feedback(to_message(operation.get("values"), self._kind.Feedback, "action_feedback.values"))

    def end(self, operation: Operation) -> None:
        """End a goal with its result. Raises ValueRefusedError."""
        _, ended = self._goals[str(operation["id"])]
        is_failed = operation.get("result") is False
        values = None if is_failed and not isinstance(operation.get("values"), dict) else operation.get("values")
        result = to_message(values, self._kind.Result, "action_result.values")
        if not ended.done():
            status = operation.get("status", GoalStatus.STATUS_SUCCEEDED)
            ended.set_result((_ABORTED if is_failed else status, result))

    def close(self) -> None:
        """Abort the goals, and end the action."""
        for _, ended in self._goals.values():
            if not ended.done():
                ended.set_result((_ABORTED, self._kind.Result()))
        self._server.destroy()
