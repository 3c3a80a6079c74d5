"""Actions of a robot: each goal becomes a motion in simulated time, one at a time."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any, cast

from rclpy.action import ActionServer, CancelResponse, GoalResponse
from rclpy.node import Node
from rclpy.task import Future

from thymio_sim_ros.ros.interface.names import full_name
from thymio_sim_ros.ros.profiles import ActionRow, Ended, Motion
from thymio_sim_ros.ros.simulator.profile.world import RunningRobot

__all__ = ["RobotGoals"]

_NEVER_NS = -(2**62)

_REACHED, _CANCELED, _FAILED = "reached", "canceled", "failed"
"""How a goal ends."""


@dataclass(slots=True)
class _Goal:
    """A goal that is pursued: its row, the motion, the handle of rclpy, and the future word of how it ended."""

    row: ActionRow
    motion: Motion
    handle: Any
    ended: Future[str]
    fed_ns: int = _NEVER_NS


class RobotGoals:
    """The action servers of one robot. `step` is called after each tick."""

    def __init__(self, node: Node, robot: RunningRobot, rows: Sequence[ActionRow], types: Mapping[str, Any]) -> None:
        """`types`: classes by the names in the rows."""
        self._node, self._robot, self._types = node, robot, types
        self._goal: _Goal | None = None
        self._begun: Motion | None = None
        """The motion of a goal that is being accepted."""
        self._servers: list[Any] = [
            ActionServer(
                node,
                types[row.type],
                robot.names.topic(row.name),
                _not_accepted,
                goal_callback=partial(self._accept, row),
                handle_accepted_callback=partial(self._begin, row),
                cancel_callback=self._cancel,
            )
            for row in rows
        ]

    @property
    def is_active(self) -> bool:
        """Whether a goal is pursued."""
        return self._goal is not None

    def step(self) -> None:
        """Continue the motion, and publish feedback when it is due."""
        goal = self._goal
        if goal is None:
            return
        try:
            is_fallen = self._robot.is_fallen
            ended = Ended("the robot has fallen off its ground") if is_fallen else goal.motion.step()
        except Exception as error:
            self._end(_FAILED, f"internal error (please report): {error!r}")
            raise
        if ended is not None:
            self._end(_FAILED if ended.reason else _REACHED, ended.reason)
            return
        now_ns = self._robot.world.now_ns
        if now_ns - goal.fed_ns >= goal.row.feedback_ns:
            goal.fed_ns = now_ns
            goal.handle.publish_feedback(goal.motion.feedback(self._types[goal.row.type].Feedback))

    def abort(self, reason: str) -> None:
        """End the goal without success."""
        if self._goal is not None:
            self._end(_FAILED, reason)

    def close(self) -> None:
        """Abort the goal, and destroy the servers."""
        self.abort("the robot has gone")
        for server in self._servers:
            server.destroy()

    def _accept(self, row: ActionRow, request: Any) -> Any:
        robot = self._robot
        robot.world.runner.catch_up()
        try:
            if robot.is_fallen:
                raise ValueError("the robot has fallen off its ground; put it back, or reset the world")
            if robot.is_lifted:
                raise ValueError("the robot is lifted, expected it on the ground")
            self._begun = row.begin(request, robot)
        except ValueError as error:
            robot.world.report(self._name(row), error)
            return GoalResponse.REJECT
        return GoalResponse.ACCEPT

    def _begin(self, row: ActionRow, handle: Any) -> None:
        motion, self._begun = self._begun, None
        assert motion is not None  # `_accept` was called for the same goal just before
        self.abort("another goal has replaced it")
        self._goal = goal = _Goal(row, motion, handle, Future(executor=self._node.executor))
        handle.execute(partial(self._execute, goal))

    async def _execute(self, goal: _Goal, handle: Any) -> Any:
        word = cast("str", await goal.ended)
        if word == _REACHED:
            handle.succeed()
        elif word == _CANCELED and handle.is_cancel_requested:
            handle.canceled()
        else:
            handle.abort()
        return goal.motion.result(self._types[goal.row.type].Result)

    def _cancel(self, handle: Any) -> Any:
        if self._goal is None or self._goal.handle is not handle:
            return CancelResponse.REJECT
        self._end(_CANCELED, "")
        return CancelResponse.ACCEPT

    def _end(self, word: str, reason: str) -> None:
        goal, self._goal = self._goal, None
        assert goal is not None
        goal.motion.stop()
        if reason:
            self._node.get_logger().warning(f"{self._name(goal.row)}: the goal was not reached: {reason}")
        goal.ended.set_result(word)

    def _name(self, row: ActionRow) -> str:
        return full_name(self._node, self._robot.names.topic(row.name))


def _not_accepted(_handle: Any) -> Any:
    raise AssertionError("a goal is executed by the callback that it gets when it is accepted")
