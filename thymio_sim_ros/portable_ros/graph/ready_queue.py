"""What an executor has to run: entities with events, and tasks."""

from __future__ import annotations

from collections import deque
from collections.abc import Container
from typing import Any

from thymio_sim_ros.portable_ros.graph.entity import Entity
from thymio_sim_ros.portable_ros.rclpy.task import Task

__all__ = ["ReadyQueue"]


class ReadyQueue:
    """Entities, once for each event, and tasks, in the order in which they are run. The owner has the lock.

    Entities and resumed tasks keep the order in which they became ready, but a client lets everything else that is
    ready pass once: rclpy runs subscriptions before clients, so that what a server publishes while it answers comes
    before the response. Tasks that a program creates come before what
    is ready, the newest first, as in rclpy. Those that are created meanwhile wait until all of this has been run, so
    that a task that always creates another one delays entities and does not stop them.
    """

    def __init__(self) -> None:
        self._ready: deque[Entity | Task] = deque()
        self._created: list[Task] = []
        self._left = 0
        """How much of what was ready when tasks came to it has not been handed out."""
        self._held: list[Entity] = []
        """Entities that are ready while another callback of their group runs."""
        self._passed: set[Entity] = set()
        """Clients that have let others pass."""
        self._round: dict[Entity | Task, None] | None = None
        """What the present round still hands out, None outside of rounds."""

    def add_created(self, task: Task) -> None:
        """Add a new task."""
        self._created.append(task)

    def append(self, ready: Entity | Task) -> None:
        """Append what has become ready."""
        self._ready.append(ready)

    def forget(self, node: Any) -> None:
        """Remove the entities of a node."""
        self._ready = deque(one for one in self._ready if isinstance(one, Task) or one.node is not node)
        self._passed = {one for one in self._passed if one.node is not node}

    def clear(self) -> None:
        """Remove all."""
        self._ready.clear()
        self._created.clear()
        self._passed.clear()

    def begin_round(self) -> None:
        """Hand out what is ready now, each entity once, and no more until `end_round`. No effect within a round."""
        if self._round is None:
            self._take_created()
            self._round = dict.fromkeys(self._ready)

    def end_round(self) -> None:
        """Hand out all that is ready from now on."""
        self._round = None

    def pop(self, nodes: Container[Any]) -> Entity | Task | None:
        """Remove the first entity of one of the nodes, or task, that may start, and begin its execution."""
        self._take_created()
        while (found := self._next_of_round()) is not None:
            self._left -= 1
            if isinstance(found, Task):
                return found
            if self._lets_pass(found):
                self._left += 1
                self._ready.append(found)
                continue
            if not found.is_destroyed and found.node in nodes:
                if found.callback_group is None or found.callback_group.beginning_execution(found):
                    return found
                self._held.append(found)
        return None

    def release(self) -> None:
        """Make ready again what had to wait for the end of a callback."""
        if self._held:
            self._ready.extendleft(reversed(self._held))
            self._held.clear()

    def _lets_pass(self, entity: Entity) -> bool:
        """Whether an entity is a client that lets others pass now."""
        if not entity.lets_pass or self._round is not None or entity in self._passed:
            self._passed.discard(entity)
            return False
        self._passed.add(entity)
        return True

    def _next_of_round(self) -> Entity | Task | None:
        if self._round is None:
            return self._ready.popleft() if self._ready else None
        at = next((at for at, one in enumerate(self._ready) if one in self._round), None)
        if at is None:
            return None
        found = self._ready[at]
        del self._ready[at], self._round[found]
        return found

    def _take_created(self) -> None:
        if self._created and (self._left <= 0 or not self._ready):
            self._ready.extendleft(self._created)
            self._created.clear()
            self._left = len(self._ready)
