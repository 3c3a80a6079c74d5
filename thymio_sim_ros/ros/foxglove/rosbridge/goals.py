"""Goals that a client sends to actions."""

from __future__ import annotations

import time
from dataclasses import dataclass
from functools import partial
from typing import Any

from action_msgs.msg import GoalStatus
from rclpy.action import ActionClient
from rclpy.task import Future

from thymio_sim_ros.bridge.rosbridge.frames import Operation
from thymio_sim_ros.ros.foxglove.rosbridge.client_node import ClientNode
from thymio_sim_ros.ros.foxglove.rosbridge.host import Host, RefusedError
from thymio_sim_ros.ros.foxglove.rosbridge.outbox import Outbox
from thymio_sim_ros.ros.foxglove.rosbridge.values import Compression, from_message, to_message
from thymio_sim_ros.ros.foxglove.types import MissingTypeError, load_type

__all__ = ["MAX_GOALS", "Goals"]

MAX_GOALS = 64
"""Goals of one client without a result."""

_SERVER_S = 5.0
"""Time that a goal waits for a server of its action, s."""


@dataclass(slots=True, eq=False)
class _Goal:
    """A goal of the client; `client` belongs to it alone."""

    operation: Operation
    client: Any
    request: Any
    deadline_s: float
    is_sent: bool = False
    handle: Any = None
    is_canceled: bool = False


class Goals:
    """The goals of one client. `poll` must be called while it returns True."""

    def __init__(self, host: Host, outbox: Outbox) -> None:
        self._host, self._outbox = host, outbox
        self._goals: dict[object, _Goal] = {}
        """Goals without a result, by their ID."""
        self._ended: list[_Goal] = []
        """Goals whose client is destroyed by `poll`: not in one of its own callbacks."""

    def send(self, operation: Operation, place: ClientNode) -> None:
        """Send a goal as soon as the action has a server. Raises RefusedError or ValueRefusedError."""
        key = operation.get("id", "")
        if key in self._goals:
            raise RefusedError(f"send_action_goal.id: expected a new one, found {key}, whose goal has no result yet")
        if len(self._goals) >= MAX_GOALS:
            raise RefusedError(f"send_action_goal: {MAX_GOALS} goals have no result yet")
        try:
            kind = load_type(_action_type(operation["action_type"]))
        except MissingTypeError as error:
            raise RefusedError(f"send_action_goal.action_type: {error}") from error
        if not hasattr(kind, "Goal"):
            raise RefusedError(f"send_action_goal.action_type: expected an action, found {operation['action_type']}")
        request = to_message(operation.get("args"), kind.Goal, "send_action_goal.args")
        action = place.resolve(operation["action"], "send_action_goal.action")
        client: Any = ActionClient(place.subscriber, kind, action)
        self._goals[key] = _Goal(operation, client, request, time.monotonic() + _SERVER_S)
        self._host.wake()

    def cancel(self, operation: Operation) -> None:
        """Cancel a goal. Raises RefusedError."""
        goal = self._goals.get(operation["id"])
        if goal is None:
            raise RefusedError(f"cancel_action_goal.id: expected the id of a goal, found {operation['id']}")
        goal.is_canceled = True
        if goal.handle is not None:
            goal.handle.cancel_goal_async()
        elif not goal.is_sent:
            self._end(goal, GoalStatus.STATUS_CANCELED, "canceled before the action had a server")

    def poll(self) -> bool:
        """Send goals whose action has a server; return whether others wait for one."""
        for goal in self._ended:
            goal.client.destroy()
        self._ended.clear()
        for goal in [goal for goal in self._goals.values() if not goal.is_sent]:
            if goal.client.server_is_ready():
                goal.is_sent = True
                wants_feedback = goal.operation.get("feedback", False)
                sent = goal.client.send_goal_async(
                    goal.request, feedback_callback=partial(self._feedback, goal) if wants_feedback else None
                )
                sent.add_done_callback(partial(self._answered, goal))
            elif time.monotonic() >= goal.deadline_s:
                name = goal.operation["action"]
                self._end(goal, GoalStatus.STATUS_UNKNOWN, f"no server of {name} within {_SERVER_S:g} s")
        return bool(self._ended) or not all(goal.is_sent for goal in self._goals.values())

    def close(self) -> None:
        """Forget all goals. Those that run go on, as when any other action client ends."""
        for goal in [*self._goals.values(), *self._ended]:
            goal.client.destroy()
        self._goals.clear()
        self._ended.clear()

    def _feedback(self, goal: _Goal, message: Any) -> None:
        values = from_message(message.feedback, Compression.NONE)
        self._outbox.answer("action_feedback", "action", goal.operation, values=values)

    def _answered(self, goal: _Goal, future: Future[Any]) -> None:
        handle = future.result()
        if handle is None or not handle.accepted:
            self._end(goal, GoalStatus.STATUS_UNKNOWN, f"{goal.operation['action']} rejected the goal")
            return
        goal.handle = handle
        if goal.is_canceled:
            handle.cancel_goal_async()
        handle.get_result_async().add_done_callback(partial(self._finished, goal))

    def _finished(self, goal: _Goal, future: Future[Any]) -> None:
        response = future.result()
        if response is None:
            self._end(goal, GoalStatus.STATUS_UNKNOWN, f"{goal.operation['action']} has no result")
            return
        values = from_message(response.result, Compression.NONE)
        self._end(goal, response.status, values, is_result=True)

    def _end(self, goal: _Goal, status: int, values: Any, *, is_result: bool = False) -> None:
        key = goal.operation.get("id", "")
        if self._goals.pop(key, None) is None:
            return
        self._ended.append(goal)
        self._outbox.answer("action_result", "action", goal.operation, values=values, status=status, result=is_result)
        self._host.wake()


def _action_type(name: str) -> str:
    words = name.split("/")
    return f"{words[0]}/action/{words[1]}" if len(words) == 2 else name
