"""The endpoints that a server or a client of an action has in its node: services or clients, and two topics."""

from __future__ import annotations

import functools
from collections.abc import Awaitable, Callable
from typing import TYPE_CHECKING, Any, TypeVar

from thymio_sim_ros.portable_ros.graph.names import topic_problem
from thymio_sim_ros.portable_ros.messages.action_class import is_action_type
from thymio_sim_ros.portable_ros.messages.message_class import Message
from thymio_sim_ros.portable_ros.rclpy.client import Client
from thymio_sim_ros.portable_ros.rclpy.event_handler import PublisherEventCallbacks, SubscriptionEventCallbacks
from thymio_sim_ros.portable_ros.rclpy.publisher import Publisher
from thymio_sim_ros.portable_ros.rclpy.service import Service
from thymio_sim_ros.portable_ros.rclpy.subscription import Subscription
from thymio_sim_ros.portable_ros.rclpy.task import await_or_execute
from thymio_sim_ros.portable_ros.rclpy.timer import Timer
from thymio_sim_ros.portable_ros.rclpy.type_support import check_for_type_support
from thymio_sim_ros.portable_ros.rclpy.waitable import NumberOfEntities

if TYPE_CHECKING:
    from thymio_sim_ros.portable_ros.graph.protocols import ClientEnd
    from thymio_sim_ros.portable_ros.rclpy.callback_groups import CallbackGroup
    from thymio_sim_ros.portable_ros.rclpy.qos import QoSProfile
    from thymio_sim_ros.portable_ros.rclpy_parts.node_endpoints import NodeEndpoints

__all__ = [
    "CANCEL_GOAL",
    "FEEDBACK",
    "GET_RESULT",
    "SEND_GOAL",
    "STATUS",
    "ActionParts",
    "DeferredService",
    "Respond",
    "full_name",
]

SEND_GOAL, CANCEL_GOAL, GET_RESULT = "send_goal", "cancel_goal", "get_result"
FEEDBACK, STATUS = "feedback", "status"

Respond = Callable[[Message], None]


def full_name(action: str, part: str) -> str:
    """The name of a service or topic of an action."""
    return f"{action}/_action/{part}"


class DeferredService(Service):
    """A service whose callback gets a request and what sends the response, at once or later."""

    async def _answer(self, request: Message, header: tuple[ClientEnd, int]) -> None:
        await await_or_execute(self.callback, request, functools.partial(self.send_response, header=header))


P = TypeVar("P", bound=Client[Any, Any] | Service | Subscription | Timer | Publisher[Any])


class ActionParts:
    """The parts of an action in a node. The node lists the action in their place; `destroy` removes all."""

    def __init__(
        self, node: NodeEndpoints, action: object, action_type: Any, name: str, group: CallbackGroup, role: str
    ) -> None:
        """`action`: what the node lists; `role`: `server` or `client`.

        Raises ValueError for a name that is not valid, and for a node whose context is shut down.
        """
        check_for_type_support(action_type)
        if not is_action_type(action_type):
            raise RuntimeError(f"The action type provided is not valid ({action_type}), this might be a message")
        with node.handle:
            if not node.context.ok():
                raise ValueError(f"Failed to create action {role}: rcl node's context is invalid")
        if problem := topic_problem(name):
            raise ValueError(f"Failed to create action {role} due to invalid topic name '{name}' : {problem[0]}")
        self._node, self._action, self._name, self.group = node, action, name, group
        self._parts: list[Any] = []
        node._actions.append(action)

    def service(
        self, kind: Any, part: str, callback: Callable[[Any, Respond], Awaitable[None] | None], profile: QoSProfile
    ) -> DeferredService:
        """A service whose callback sends the response."""
        return self._part(self._node._add_service(DeferredService(self._description(kind, part, profile), callback)))

    def client(self, client_class: Callable[..., P], kind: Any, part: str, profile: QoSProfile) -> P:
        """A client of a class that is made of a description."""
        made: Any = client_class(self._description(kind, part, profile))
        added: P = self._node._add_client(made)
        return self._part(added)

    def publisher(self, kind: Any, part: str, profile: QoSProfile) -> Publisher[Any]:
        """A publisher."""
        events = PublisherEventCallbacks(use_default_callbacks=False)
        return self._part(
            self._node.create_publisher(kind, full_name(self._name, part), profile, event_callbacks=events)
        )

    def subscription(
        self, kind: Any, part: str, callback: Callable[[Any], object], profile: QoSProfile
    ) -> Subscription:
        """A subscription."""
        name, events = full_name(self._name, part), SubscriptionEventCallbacks(use_default_callbacks=False)
        return self._part(
            self._node.create_subscription(
                kind, name, callback, profile, callback_group=self.group, event_callbacks=events
            )
        )

    def timer(self, callback: Callable[[], object]) -> Timer:
        """A timer that has not been started."""
        return self._part(self._node.create_timer(0.0, callback, self.group, autostart=False))

    def count(self) -> NumberOfEntities:
        """The numbers of entities of each kind, without publishers."""
        kinds = [type(one) for one in self._parts]
        return NumberOfEntities(
            num_subs=sum(issubclass(kind, Subscription) for kind in kinds),
            num_timers=kinds.count(Timer),
            num_clients=sum(issubclass(kind, Client) for kind in kinds),
            num_services=kinds.count(DeferredService),
        )

    def destroy(self) -> None:
        """Remove all parts, and the action from the list of the node."""
        for part in self._parts:
            self._node._remove(part)
        self._parts.clear()
        self._node._actions[:] = [one for one in self._node._actions if one is not self._action]

    def _description(self, kind: Any, part: str, profile: QoSProfile) -> Any:
        return self._node._service_description(kind, full_name(self._name, part), profile, self.group)

    def _part(self, made: P) -> P:
        made.is_part = True
        self._parts.append(made)
        return made
