"""Waitables: several entities that are executed together."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable
from types import TracebackType
from typing import TYPE_CHECKING, Any

from thymio_sim_ros.portable_ros.graph.entity import Entity, Handle
from thymio_sim_ros.portable_ros.rclpy.timer import Timer

if TYPE_CHECKING:
    from thymio_sim_ros.portable_ros.rclpy.callback_groups import CallbackGroup
    from thymio_sim_ros.portable_ros.rclpy.task import Future

__all__ = ["EntitySet", "NumberOfEntities", "Waitable", "WaitableEntity"]


class NumberOfEntities:
    """Numbers of entities of each kind."""

    __slots__ = [  # noqa: RUF023  # in the order of the arguments
        "num_subscriptions",
        "num_guard_conditions",
        "num_timers",
        "num_clients",
        "num_services",
        "num_events",
    ]

    def __init__(
        self,
        num_subs: int = 0,
        num_gcs: int = 0,
        num_timers: int = 0,
        num_clients: int = 0,
        num_services: int = 0,
        num_events: int = 0,
    ) -> None:
        self.num_subscriptions, self.num_guard_conditions, self.num_timers = num_subs, num_gcs, num_timers
        self.num_clients, self.num_services, self.num_events = num_clients, num_services, num_events

    def __add__(self, other: NumberOfEntities) -> NumberOfEntities:
        return NumberOfEntities(*(getattr(self, one) + getattr(other, one) for one in self.__slots__))

    def __repr__(self) -> str:
        return f"<{type(self).__name__}({', '.join(str(getattr(self, one)) for one in self.__slots__)})>"


class EntitySet:
    """What a waitable waits for: entities of nodes by their handles. The methods `add_…` return an index."""

    def __init__(self) -> None:
        self._entities: defaultdict[str, list[Entity]] = defaultdict(list)

    def add_subscription(self, handle: Handle) -> int:
        """Wait for messages."""
        return self._add("subscription", handle)

    def add_guard_condition(self, handle: Handle) -> int:
        """Wait for a trigger."""
        return self._add("guard_condition", handle)

    def add_timer(self, handle: Handle) -> int:
        """Wait for a period."""
        return self._add("timer", handle)

    def add_client(self, handle: Handle) -> int:
        """Wait for responses."""
        return self._add("client", handle)

    def add_service(self, handle: Handle) -> int:
        """Wait for requests."""
        return self._add("service", handle)

    def add_event(self, handle: Handle) -> int:
        """Wait for events of an endpoint."""
        return self._add("event", handle)

    def is_ready(self, kind: str, index: int) -> bool:
        """Whether the entity of an index of a kind, such as `timer`, has events."""
        entity = self._entities[kind][index]
        return entity.is_ready() if isinstance(entity, Timer) else entity.pending() > 0

    def _add(self, kind: str, handle: Handle) -> int:
        entity = handle.owner()
        if entity is None:
            raise ValueError(f"found the handle of a {handle.name}, expected one of an entity")
        self._entities[kind].append(entity)
        return len(self._entities[kind]) - 1


class Waitable:
    """Base of waitables. A subclass says when it is ready, and what is executed then."""

    def __init__(self, callback_group: CallbackGroup) -> None:
        self.callback_group = callback_group
        self.callback_group.add_entity(self)
        self._futures: list[Future[Any]] = []

    def __enter__(self) -> None:
        """Called before a wait."""

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Called after a wait."""

    def add_future(self, future: Future[Any]) -> None:
        """Call the callbacks of a future in the executor of the node."""
        self._futures.append(future)

    def remove_future(self, future: Future[Any]) -> None:
        """Undo `add_future`. Raises ValueError for an unknown future."""
        self._futures.remove(future)

    def is_ready(self, wait_set: EntitySet) -> bool:
        """Whether there is something to execute after a wait."""
        raise NotImplementedError("Must be implemented by subclass")

    def take_data(self) -> Any:
        """Take what `execute` gets."""
        raise NotImplementedError("Must be implemented by subclass")

    async def execute(self, taken_data: Any) -> None:
        """Execute what was ready."""
        raise NotImplementedError("Must be implemented by subclass")

    def get_num_entities(self) -> NumberOfEntities:
        """The numbers of entities that `add_to_wait_set` adds."""
        raise NotImplementedError("Must be implemented by subclass")

    def add_to_wait_set(self, wait_set: EntitySet) -> None:
        """Wait for all entities."""
        raise NotImplementedError("Must be implemented by subclass")


class WaitableEntity(Entity):
    """A waitable in the queue of an executor."""

    def __init__(self, waitable: Waitable) -> None:
        super().__init__(waitable.callback_group)
        self.waitable = waitable
        self._is_announced = False

    def announce_if_due(self) -> bool:
        """Return whether the waitable is ready and was not announced to the executor, and mark it as announced."""
        if self._is_announced or self.is_destroyed:
            return False
        entities = EntitySet()
        with self.waitable:
            self.waitable.add_to_wait_set(entities)
            self._is_announced = self.waitable.is_ready(entities)
        return self._is_announced

    def forget_announcement(self) -> None:
        """Announce the waitable again, to another executor."""
        self._is_announced = False

    def pending(self) -> int:
        """0: executors ask for ready waitables by `announce_if_due`."""
        return 0

    def take(self) -> tuple[Callable[..., Any], tuple[Any, ...]] | None:
        """Take the data of the waitable."""
        self._is_announced = False
        executor = None if self.node is None else self.node.executor
        for future in self.waitable._futures:
            future._set_executor(executor)
        return self.waitable.execute, (self.waitable.take_data(),)
