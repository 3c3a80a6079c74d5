"""What a node owns: publishers, subscriptions, clients, services, timers, guard conditions, events, waitables."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, TypeVar

from thymio_sim_ros.portable_ros.graph.entity import Entity
from thymio_sim_ros.portable_ros.rclpy.callback_groups import CallbackGroup, MutuallyExclusiveCallbackGroup
from thymio_sim_ros.portable_ros.rclpy.client import Client
from thymio_sim_ros.portable_ros.rclpy.event_handler import EventHandler
from thymio_sim_ros.portable_ros.rclpy.guard_condition import GuardCondition
from thymio_sim_ros.portable_ros.rclpy.publisher import Publisher
from thymio_sim_ros.portable_ros.rclpy.service import Service
from thymio_sim_ros.portable_ros.rclpy.subscription import Subscription
from thymio_sim_ros.portable_ros.rclpy.timer import Timer
from thymio_sim_ros.portable_ros.rclpy.waitable import Waitable, WaitableEntity
from thymio_sim_ros.portable_ros.rclpy_parts.node_parameters import NodeParameters

__all__ = ["NodeEntities"]

E = TypeVar("E", bound=Entity)

_KINDS = (Publisher, Subscription, Client, Service, Timer, GuardCondition, EventHandler, WaitableEntity)


class NodeEntities(NodeParameters):
    """The part of a node that owns what executors execute, and its publishers."""

    def _prepare_entities(self) -> None:
        """Start without entities."""
        self._entities: dict[type, list[Any]] = {kind: [] for kind in _KINDS}
        self._actions: list[Any] = []
        self._default_callback_group: CallbackGroup = MutuallyExclusiveCallbackGroup()

    @property
    def publishers(self) -> Iterator[Publisher[Any]]:
        """The publishers, without those of the log and of actions."""
        yield from (one for one in self.all_publishers if not one.is_part)

    @property
    def all_publishers(self) -> Iterator[Publisher[Any]]:
        """All publishers."""
        yield from list(self._entities[Publisher])

    @property
    def subscriptions(self) -> Iterator[Subscription]:
        """The subscriptions, without those of actions."""
        yield from (one for one in self.all_subscriptions if not one.is_part)

    @property
    def all_subscriptions(self) -> Iterator[Subscription]:
        """All subscriptions."""
        yield from list(self._entities[Subscription])

    @property
    def clients(self) -> Iterator[Client[Any, Any]]:
        """The clients, without those of actions."""
        yield from (one for one in self.all_clients if not one.is_part)

    @property
    def all_clients(self) -> Iterator[Client[Any, Any]]:
        """All clients."""
        yield from list(self._entities[Client])

    @property
    def services(self) -> Iterator[Service]:
        """The services, without those of actions."""
        yield from (one for one in self.all_services if not one.is_part)

    @property
    def all_services(self) -> Iterator[Service]:
        """All services."""
        yield from list(self._entities[Service])

    @property
    def timers(self) -> Iterator[Timer]:
        """The timers, without those of actions."""
        yield from (one for one in self.all_timers if not one.is_part)

    @property
    def all_timers(self) -> Iterator[Timer]:
        """All timers."""
        yield from list(self._entities[Timer])

    @property
    def guards(self) -> Iterator[GuardCondition]:
        """The guard conditions."""
        yield from list(self._entities[GuardCondition])

    @property
    def waitables(self) -> Iterator[Any]:
        """The handlers of events, the waitables that were added, servers and clients of actions."""
        added = (one.waitable for one in self._entities[WaitableEntity])
        yield from [*self._entities[EventHandler], *added, *self._actions]

    def polled(self) -> list[Timer | WaitableEntity]:
        """What becomes ready without a notification of the executor."""
        return [*self._entities[Timer], *self._entities[WaitableEntity]]

    def entities(self) -> list[Entity]:
        """All that an executor executes."""
        kinds = (kind for kind in self._entities if kind is not Publisher)
        return [entity for kind in kinds for entity in self._entities[kind]]

    @property
    def default_callback_group(self) -> CallbackGroup:
        """The group of all callbacks for which no other is given."""
        return self._default_callback_group

    def add_waitable(self, waitable: Waitable) -> None:
        """Execute a waitable from now on."""
        self._owned(WaitableEntity(waitable))
        self._wake_executor()

    def remove_waitable(self, waitable: Waitable) -> None:
        """Undo `add_waitable`. Raises ValueError for an unknown waitable."""
        found = [one for one in self._entities[WaitableEntity] if one.waitable is waitable]
        if not found:
            raise ValueError(f"found {waitable!r}, expected a waitable of the node")
        self._remove(found[0])

    def _wake_executor(self) -> None:
        if self.executor is not None:
            self.executor.wake()

    def _owned(self, entity: E) -> E:
        """Make this node the owner of a new entity."""
        entity.belong_to(self)
        if entity.callback_group is not None:
            entity.callback_group.add_entity(entity)
        self._entities[_kind(entity)].append(entity)
        return entity

    def _remove_with_events(self, end: Publisher[Any] | Subscription) -> bool:
        is_own = self._remove(end)
        for part in (*end.event_handlers, *end.events.timers):
            self._remove(part)
        return is_own

    def _remove(self, end: Any) -> bool:
        kind = _kind(end)
        ends = self._entities[kind]
        if not any(one is end for one in ends):
            return False
        self._entities[kind] = [one for one in ends if one is not end]
        end.destroy()
        return True


def _kind(end: Entity | Publisher[Any]) -> type:
    """The class of an entity without its subclasses."""
    return next(one for one in _KINDS if isinstance(end, one))
