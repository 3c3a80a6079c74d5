"""The states of a goal, the events that change them, and which goals a request to cancel is about."""

from __future__ import annotations

from collections.abc import Iterable
from enum import Enum, IntEnum
from typing import Protocol, TypeVar

from thymio_sim_ros.portable_ros import ros_types
from thymio_sim_ros.portable_ros.rclpy._rclpy_pybind11 import RCLError

__all__ = ["CANCELABLE", "FINAL", "GoalEvent", "GoalState", "next_state", "to_cancel"]


class GoalState(IntEnum):
    """The states, with the values of `action_msgs/msg/GoalStatus`."""

    UNKNOWN = 0
    ACCEPTED = 1
    EXECUTING = 2
    CANCELING = 3
    SUCCEEDED = 4
    CANCELED = 5
    ABORTED = 6


class GoalEvent(Enum):
    """The events."""

    EXECUTE = 0
    CANCEL_GOAL = 1
    SUCCEED = 2
    ABORT = 3
    CANCELED = 4


FINAL = frozenset({GoalState.SUCCEEDED, GoalState.CANCELED, GoalState.ABORTED})
_NEXT = {
    (GoalState.ACCEPTED, GoalEvent.EXECUTE): GoalState.EXECUTING,
    (GoalState.ACCEPTED, GoalEvent.CANCEL_GOAL): GoalState.CANCELING,
    (GoalState.EXECUTING, GoalEvent.CANCEL_GOAL): GoalState.CANCELING,
    (GoalState.EXECUTING, GoalEvent.SUCCEED): GoalState.SUCCEEDED,
    (GoalState.EXECUTING, GoalEvent.ABORT): GoalState.ABORTED,
    (GoalState.CANCELING, GoalEvent.SUCCEED): GoalState.SUCCEEDED,
    (GoalState.CANCELING, GoalEvent.ABORT): GoalState.ABORTED,
    (GoalState.CANCELING, GoalEvent.CANCELED): GoalState.CANCELED,
}
CANCELABLE = frozenset(state for state, event in _NEXT if event is GoalEvent.CANCEL_GOAL)


def next_state(state: GoalState, event: GoalEvent) -> GoalState:
    """The state after an event. Raises RCLError for an event that the state does not have."""
    if (state, event) not in _NEXT:
        raise RCLError(
            f"Failed to update goal state: goal_handle attempted invalid transition from state {state.name} with"
            f" event {event.name}"
        )
    return _NEXT[state, event]


class _Goal(Protocol):
    """A goal of a server."""

    @property
    def info(self) -> ros_types.GoalInfo:
        """Its id, and when it was accepted."""

    @property
    def status(self) -> int:
        """Its state."""


G = TypeVar("G", bound=_Goal)


def to_cancel(wanted: ros_types.GoalInfo, goals: Iterable[G]) -> tuple[int, list[G]]:
    """The return code of a request to cancel, and the goals for which the server is asked.

    An id stands for its goal, a time for all goals that were accepted until then, both for all of these, and zeros for
    all goals.
    """
    known = list(goals)
    has_id, time_ns = any(wanted.goal_id.uuid), _ns(wanted.stamp)
    is_all = not has_id and not time_ns
    named = [one for one in known if has_id and one.info.goal_id == wanted.goal_id]
    earlier = [one for one in known if is_all or (time_ns and _ns(one.info.stamp) <= time_ns)]
    chosen = [one for one in known if (one in named or one in earlier) and one.status in CANCELABLE]
    if has_id and not chosen:
        response = ros_types.CancelGoal.Response
        return (response.ERROR_GOAL_TERMINATED if named else response.ERROR_UNKNOWN_GOAL_ID), []
    return ros_types.CancelGoal.Response.ERROR_NONE, chosen


def _ns(stamp: ros_types.TimeMessage) -> int:
    return stamp.sec * 1_000_000_000 + stamp.nanosec
