"""The classes of actions, with the attributes that rosidl's classes have."""

from __future__ import annotations

import functools
from typing import Any, ClassVar, Generic, TypeVar

from thymio_sim_ros.portable_ros.messages.interface_files import (
    ACTION_PARTS,
    ACTION_SERVICES,
    FEEDBACK_MESSAGE,
    is_action,
    module_of,
)
from thymio_sim_ros.portable_ros.messages.message_class import Message, message_type, service_type

__all__ = ["Action", "FeedbackT", "GoalT", "ResultT", "action_type", "is_action_type"]

GoalT = TypeVar("GoalT", bound=Message)
ResultT = TypeVar("ResultT", bound=Message)
FeedbackT = TypeVar("FeedbackT", bound=Message)


class Action(Generic[GoalT, ResultT, FeedbackT]):
    """Base of all classes of actions. `Impl` has the services and topics that an action is made of."""

    TYPE_NAME: ClassVar[str] = ""
    Goal: type[GoalT]
    Result: type[ResultT]
    Feedback: type[FeedbackT]
    Impl: Any

    def __init__(self) -> None:
        raise NotImplementedError("Action classes can not be instantiated")


@functools.cache
def action_type(name: str) -> Any:
    """The class of an action by its full name, such as `tf2_msgs/action/LookupTransform`. Raises KeyError."""
    if not is_action(name):
        raise KeyError(name)
    parts: dict[str, Any] = {part: message_type(f"{name}_{part}") for part in ACTION_PARTS}
    ends = {
        **{f"{one}Service": service_type(f"{name}_{one}") for one in ACTION_SERVICES},
        FEEDBACK_MESSAGE: message_type(f"{name}_{FEEDBACK_MESSAGE}"),
        "CancelGoalService": service_type("action_msgs/srv/CancelGoal"),
        "GoalStatusMessage": message_type("action_msgs/msg/GoalStatusArray"),
    }
    module = {"__module__": module_of(name)}
    parts["Impl"] = type("Impl", (), {**module, **ends})
    return type(name.rpartition("/")[2], (Action,), {**module, "TYPE_NAME": name, **parts})


def is_action_type(kind: object) -> bool:
    """Whether an object is a class of actions."""
    return isinstance(kind, type) and issubclass(kind, Action) and kind is not Action
