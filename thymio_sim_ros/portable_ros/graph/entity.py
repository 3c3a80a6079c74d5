"""Base of what executors execute: subscriptions, services, clients, timers, guard conditions, events of endpoints."""

from __future__ import annotations

import weakref
from abc import ABC, abstractmethod
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from thymio_sim_ros.portable_ros.rclpy._rclpy_pybind11 import InvalidHandle

if TYPE_CHECKING:
    from types import TracebackType

    from thymio_sim_ros.portable_ros.rclpy.callback_groups import CallbackGroup

__all__ = ["Entity", "Handle"]


class Handle:
    """Stands for the resources of an object; a `with` block raises InvalidHandle once they are released."""

    def __init__(self, name: str, owner: Entity | None = None) -> None:
        self.name = name
        self.is_valid = True
        self.owner = (lambda: None) if owner is None else weakref.ref(owner)
        self._release: Callable[[], None] = lambda: None

    def on_release(self, release: Callable[[], None]) -> None:
        """Call back once when the resources are released."""
        self._release = release

    def __enter__(self) -> Handle:
        if not self.is_valid:
            raise InvalidHandle("cannot use Destroyable because destruction was requested")
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Keep the resources."""

    def destroy_when_not_in_use(self) -> None:
        """Release the resources."""
        if self.is_valid:
            self._release()
        self.is_valid = False


class Entity(ABC):
    """Has events, which its executor takes one by one.

    Invariant: the executor of the node, if there is one, was notified once for each event that has not been taken.
    """

    def __init__(self, callback_group: CallbackGroup | None) -> None:
        self.callback_group = callback_group
        self._handle = Handle(type(self).__name__, self)
        self._node: Callable[[], Any] = lambda: None
        self.context: Any = None
        """The context of the node that owns the entity."""
        self.lets_pass = False
        """Whether executors run everything else first that is ready when the turn of the entity comes."""
        self.is_part = False
        """Whether something else stands for the entity in lists of the node: the action that it is a part of."""

    @property
    def handle(self) -> Handle:
        """The handle of the entity."""
        return self._handle

    @property
    def is_destroyed(self) -> bool:
        """Whether the entity must not be used any more."""
        return not self._handle.is_valid

    @property
    def node(self) -> Any:
        """The node that owns the entity, None before `belong_to`."""
        return self._node()

    def belong_to(self, node: Any) -> None:
        """Make a node the owner."""
        self._node = weakref.ref(node)
        self.context = node.context

    def destroy(self) -> None:
        """Release the entity. Nodes have methods that do this, such as `destroy_timer`."""
        self._handle.destroy_when_not_in_use()

    def notify(self, count: int = 1) -> None:
        """Tell the executor about new events."""
        node = self._node()
        executor = None if node is None else node.executor
        if executor is not None:
            executor.enqueue(self, count)

    def is_blocked(self) -> bool:
        """Whether the callback that the calling thread runs keeps the executor from executing this."""
        node = self._node()
        executor = None if node is None else node.executor
        return executor is not None and executor.is_blocked_here(self)

    @abstractmethod
    def pending(self) -> int:
        """The number of events that have not been taken."""

    @abstractmethod
    def take(self) -> tuple[Callable[..., Any], tuple[Any, ...]] | None:
        """Take an event: what to call with which arguments; None if there is none."""
