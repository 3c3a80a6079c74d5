"""Isolates plug-ins of other packages: an error is logged, and the plug-in is switched off on that robot.

Plug-ins of this package are not isolated: an error stops the world with its traceback.
"""

from __future__ import annotations

import logging
from collections.abc import Callable, Mapping
from typing import Any, TypeVar

__all__ = ["DisabledState", "PluginGuard", "guarded_sensor"]

R = TypeVar("R")

_BROKEN = "guards.broken"


class DisabledState:
    """The state of a plug-in whose `begin` has raised."""


class PluginGuard:
    """Runs the functions of one actuator or stimulus; on each robot it is switched off by its first error."""

    def __init__(self, kind: str, name: str) -> None:
        self._kind, self._name = kind, name
        self._broken: dict[int, Any] = {}
        """States by identity; the references keep an id from being used again."""

    def begin(self, make: Callable[[], Any]) -> Any:
        """A new state for one robot."""
        try:
            return make()
        except Exception:
            _log(self._kind, self._name)
            return DisabledState()

    def run(self, act: Callable[..., None], state: Any, *arguments: Any) -> None:
        """Call `act` unless the plug-in is switched off on this robot."""
        if isinstance(state, DisabledState) or id(state) in self._broken:
            return
        try:
            act(state, *arguments)
        except Exception:
            self._broken[id(state)] = state
            _log(self._kind, self._name)

    def show(self, shows: Callable[[Any], Mapping[str, Any]], state: Any) -> Mapping[str, Any]:
        """The result of `shows` for a state; empty once the plug-in is switched off."""
        shown: dict[str, Any] = {}
        self.run(lambda state: shown.update(shows(state)), state)
        return shown


def guarded_sensor(name: str, measure: Callable[[Any], R]) -> Callable[[Any], R | None]:
    """`measure` of a sensor, guarded: it returns None once it has raised on that robot."""

    def guarded(view: Any) -> R | None:
        if _BROKEN in view.memory:
            return None
        try:
            return measure(view)
        except Exception:
            view.memory[_BROKEN] = True
            _log("sensor", name)
            return None

    return guarded


def _log(kind: str, name: str) -> None:
    logging.getLogger(__name__).exception("the %s '%s' of another package is switched off on a robot", kind, name)
