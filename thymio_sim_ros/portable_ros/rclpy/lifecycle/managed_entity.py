"""What a lifecycle node manages: entities with callbacks for its transitions."""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import Any

from thymio_sim_ros.portable_ros.rclpy_parts.state_machine import LifecycleState, TransitionCallbackReturn

__all__ = ["ManagedEntity", "SimpleManagedEntity"]


class ManagedEntity:
    """Base of entities: each callback gets the state before the transition, and succeeds."""

    def on_configure(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Prepare."""
        return TransitionCallbackReturn.SUCCESS

    def on_cleanup(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Undo `on_configure`."""
        return TransitionCallbackReturn.SUCCESS

    def on_shutdown(self, state: LifecycleState) -> TransitionCallbackReturn:
        """End."""
        return TransitionCallbackReturn.SUCCESS

    def on_activate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Start."""
        return TransitionCallbackReturn.SUCCESS

    def on_deactivate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Stop."""
        return TransitionCallbackReturn.SUCCESS

    def on_error(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Clean up after another callback has failed."""
        return TransitionCallbackReturn.SUCCESS


class SimpleManagedEntity(ManagedEntity):
    """An entity that is active or not."""

    def __init__(self) -> None:
        self._enabled = False

    def on_activate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Become active."""
        self._enabled = True
        return TransitionCallbackReturn.SUCCESS

    def on_deactivate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Become inactive."""
        self._enabled = False
        return TransitionCallbackReturn.SUCCESS

    @property
    def is_activated(self) -> bool:
        """Whether the entity is active."""
        return self._enabled

    @staticmethod
    def when_enabled(
        wrapped: Callable[..., Any] | None = None, *, when_not_enabled: Callable[[], object] | None = None
    ) -> Callable[..., Any]:
        """Decorate a method that has an effect in active entities only; in others `when_not_enabled` is called."""

        def decorated(method: Callable[..., Any]) -> Callable[..., None]:
            @functools.wraps(method)
            def call(self: SimpleManagedEntity, *args: Any, **kwargs: Any) -> None:
                if self._enabled:
                    method(self, *args, **kwargs)
                elif when_not_enabled is not None:
                    when_not_enabled()

            return call

        return decorated if wrapped is None else decorated(wrapped)
