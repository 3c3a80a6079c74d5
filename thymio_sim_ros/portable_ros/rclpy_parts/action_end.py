"""What servers and clients of actions have in common."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any, Generic

from thymio_sim_ros.portable_ros.messages.action_class import Action, FeedbackT, GoalT, ResultT
from thymio_sim_ros.portable_ros.rclpy.waitable import NumberOfEntities
from thymio_sim_ros.portable_ros.rclpy_parts.action_parts import ActionParts

if TYPE_CHECKING:
    from thymio_sim_ros.portable_ros.rclpy.callback_groups import CallbackGroup
    from thymio_sim_ros.portable_ros.rclpy.node import Node

__all__ = ["ActionEnd"]


class ActionEnd(Generic[GoalT, ResultT, FeedbackT]):
    """A server or a client of an action, which its node lists in place of its parts."""

    def __init__(
        self,
        node: Node,
        action_type: type[Action[GoalT, ResultT, FeedbackT]],
        action_name: str,
        callback_group: CallbackGroup | None,
        role: str,
    ) -> None:
        """`role`: `server` or `client`. Raises ValueError for a wrong name, and errors about the type."""
        self._node, self._action_type = node, action_type
        group = callback_group or node.default_callback_group
        self._parts = ActionParts(node, self, action_type, action_name, group, role)

    @property
    def action_type(self) -> type[Action[GoalT, ResultT, FeedbackT]]:
        """The class of the action."""
        return self._action_type

    @property
    def callback_group(self) -> CallbackGroup:
        """The group of all callbacks but those that execute goals, which have none."""
        return self._parts.group

    def get_num_entities(self) -> NumberOfEntities:
        """The numbers of entities that it is made of."""
        return self._parts.count()

    @contextmanager
    def _assembly(self) -> Iterator[tuple[ActionParts, Any]]:
        """The parts and their types, while all are made; if one cannot be made, those before it are removed."""
        try:
            yield self._parts, self._action_type.Impl
        except Exception:
            self._parts.destroy()
            raise
