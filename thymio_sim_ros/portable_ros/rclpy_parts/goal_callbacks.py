"""The callbacks of a server of an action: what they are, what they answer, and those that are there by default."""

from __future__ import annotations

from collections.abc import Awaitable, Callable
from enum import Enum
from typing import Any, TypeAlias

from thymio_sim_ros.portable_ros.messages.action_class import FeedbackT, GoalT, ResultT
from thymio_sim_ros.portable_ros.rclpy_parts.server_goal_handle import ServerGoalHandle

__all__ = [
    "AcceptedCallback",
    "CancelCallback",
    "CancelResponse",
    "GoalCallback",
    "GoalResponse",
    "default_cancel_callback",
    "default_goal_callback",
    "default_handle_accepted_callback",
]


class GoalResponse(Enum):
    """Whether a goal is accepted."""

    REJECT = 1
    ACCEPT = 2


class CancelResponse(Enum):
    """Whether a request to cancel a goal is accepted."""

    REJECT = 1
    ACCEPT = 2


GoalCallback: TypeAlias = Callable[[GoalT], GoalResponse | Awaitable[GoalResponse]]
AcceptedCallback: TypeAlias = Callable[[ServerGoalHandle[GoalT, ResultT, FeedbackT]], object]
CancelCallback: TypeAlias = Callable[
    [ServerGoalHandle[GoalT, ResultT, FeedbackT]], CancelResponse | Awaitable[CancelResponse]
]


def default_handle_accepted_callback(goal_handle: ServerGoalHandle[Any, Any, Any]) -> None:
    """Execute the goal."""
    goal_handle.execute()


def default_goal_callback(goal_request: object) -> GoalResponse:
    """Accept each goal."""
    return GoalResponse.ACCEPT


def default_cancel_callback(cancel_request: object) -> CancelResponse:
    """Cancel no goal."""
    return CancelResponse.REJECT
