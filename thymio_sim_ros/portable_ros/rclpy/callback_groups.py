"""Callback groups: which callbacks may run at the same time."""

from __future__ import annotations

import threading
import weakref
from typing import Any

__all__ = ["CallbackGroup", "MutuallyExclusiveCallbackGroup", "ReentrantCallbackGroup"]


class CallbackGroup:
    """A group of entities. Executors ask it before they run a callback."""

    def __init__(self) -> None:
        self.entities: set[weakref.ref[Any]] = set()

    def add_entity(self, entity: Any) -> None:
        """Add an entity to the group."""
        self.entities.add(weakref.ref(entity))

    def has_entity(self, entity: Any) -> bool:
        """Whether an entity belongs to the group."""
        return weakref.ref(entity) in self.entities

    def can_execute(self, entity: Any) -> bool:
        """Whether a callback of an entity may start now."""
        raise NotImplementedError

    def beginning_execution(self, entity: Any) -> bool:
        """Note that a callback starts; return whether it may."""
        raise NotImplementedError

    def ending_execution(self, entity: Any) -> None:
        """Note that a callback ended."""
        raise NotImplementedError


class ReentrantCallbackGroup(CallbackGroup):
    """A group whose callbacks may all run at the same time."""

    def can_execute(self, entity: Any) -> bool:
        """Always true."""
        return True

    def beginning_execution(self, entity: Any) -> bool:
        """Always true."""
        return True

    def ending_execution(self, entity: Any) -> None:
        """Need nothing."""


class MutuallyExclusiveCallbackGroup(CallbackGroup):
    """A group with one running callback at most."""

    def __init__(self) -> None:
        super().__init__()
        self._active: Any = None
        self._lock = threading.Lock()

    def can_execute(self, entity: Any) -> bool:
        """Whether no callback runs."""
        with self._lock:
            return self._active is None and self.has_entity(entity)

    def beginning_execution(self, entity: Any) -> bool:
        """Note that a callback starts; return whether none ran."""
        with self._lock:
            if self._active is not None:
                return False
            self._active = entity
            return True

    def ending_execution(self, entity: Any) -> None:
        """Note that the callback ended."""
        with self._lock:
            if self._active is entity:
                self._active = None
