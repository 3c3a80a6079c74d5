"""Classes of message and service types, by name."""

from __future__ import annotations

import functools
import importlib.util
import sys
from typing import Any

from rclpy.type_support import check_for_type_support

from thymio_sim_ros.errors import ThymioSimError
from thymio_sim_ros.ros.compat import tf2_messages

__all__ = ["MissingTypeError", "full_name", "load_type"]


class MissingTypeError(ThymioSimError):
    """A type is not installed here or not usable; `reason` says why."""

    def __init__(self, name: str, reason: str) -> None:
        super().__init__(f"type {name} is not available: {reason}")
        self.name = name
        self.reason = reason


def full_name(name: str, kind: str = "msg") -> str:
    """Expand `pkg/Type`, which clients may send, to `pkg/msg/Type`; other forms are unchanged."""
    words = name.split("/")
    return f"{words[0]}/{kind}/{words[1]}" if len(words) == 2 else name


@functools.lru_cache(maxsize=4096)
def load_type(name: str) -> Any:
    """The class of `pkg/msg/Type`, `pkg/srv/Type` or `pkg/action/Type`, ready for endpoints of nodes.

    The services and the message of an action are `pkg/action/Type_SendGoal`, `…_GetResult` and `…_FeedbackMessage`.

    Without the package tf2_msgs, TFMessage is replaced by a class that only works with serialized messages.
    Raises MissingTypeError.
    """
    if name == tf2_messages.TF_TYPE_NAME:
        if not tf2_messages.available():
            raise MissingTypeError(name, "tf2_msgs is not installed and cannot be replaced")
        return tf2_messages.TFMessage
    words = name.split("/")
    if len(words) != 3 or words[1] not in ("msg", "srv", "action") or not all(word.isidentifier() for word in words):
        raise MissingTypeError(name, "expected package/msg/Type")
    if not _has_interfaces(words[0], words[1]):
        raise MissingTypeError(name, f"there is no package {words[0]} with {words[1]} types")
    try:
        cls = _attribute(importlib.import_module(".".join(words[:2])), words[2])
        if words[1] == "msg":
            check_for_type_support(cls)
    except (ImportError, AttributeError) as error:
        raise MissingTypeError(name, str(error)) from error
    return cls


_PARTS_OF_ACTIONS = {
    "SendGoal": "SendGoalService",
    "GetResult": "GetResultService",
    "FeedbackMessage": "FeedbackMessage",
}


def _attribute(module: Any, name: str) -> Any:
    """A class of a module by its name. Raises AttributeError."""
    action, _, part = name.rpartition("_")
    if part in _PARTS_OF_ACTIONS and hasattr(module, action):
        return getattr(getattr(module, action).Impl, _PARTS_OF_ACTIONS[part])
    return getattr(module, name)


def _has_interfaces(package: str, kind: str) -> bool:
    """Whether a package has types of this kind; it is not imported, because clients choose its name."""
    try:
        spec = importlib.util.find_spec(package)
    except ValueError:  # `__main__` has no spec if it is not a file
        return False
    if spec is None or spec.submodule_search_locations is None:
        return False
    found = (finder.find_spec(f"{package}.{kind}", spec.submodule_search_locations) for finder in sys.meta_path)
    try:
        return any(module is not None and module.origin is not None for module in found)  # a bare folder has none
    except KeyError:  # folders in a bare folder: Python looks for the package, which is not imported
        return False
