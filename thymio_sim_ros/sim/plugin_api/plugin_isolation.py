"""Lets a plug-in of another package break alone: what it raises is logged, then it keeps quiet on that robot.

Ours have no such guard: an error of theirs is a defect, and stops the world with its trace.
"""

from __future__ import annotations

import logging
from collections.abc import Callable
from typing import Any, TypeVar

__all__ = ["Broken", "Guard", "quiet_sensor"]

R = TypeVar("R")

_BROKEN = "guards.broken"


class Broken:
    """The state of an actuator that could not even begin."""


class Guard:
    """The functions of one actuator on all robots of a world: each robot's stops with its first error."""

    def __init__(self, name: str) -> None:
        self._name = name
        self._broken: dict[int, Any] = {}
        """States by their identity; held, so that no other takes it over."""

    def begin(self, make: Callable[[], Any]) -> Any:
        """A state for one robot."""
        try:
            return make()
        except Exception:
            _tell("actuator", self._name)
            return Broken()

    def run(self, act: Callable[..., None], state: Any, *arguments: Any) -> None:
        """Do it unless this robot's is broken."""
        if isinstance(state, Broken) or id(state) in self._broken:
            return
        try:
            act(state, *arguments)
        except Exception:
            self._broken[id(state)] = state
            _tell("actuator", self._name)


def quiet_sensor(name: str, measure: Callable[[Any], R]) -> Callable[[Any], R | None]:
    """`measure` of a sensor, which returns nothing any more once it has raised on that robot."""

    def guarded(view: Any) -> R | None:
        if _BROKEN in view.memory:
            return None
        try:
            return measure(view)
        except Exception:
            view.memory[_BROKEN] = True
            _tell("sensor", name)
            return None

    return guarded


def _tell(kind: str, name: str) -> None:
    logging.getLogger(__name__).exception("the %s '%s' of another package is switched off on a robot", kind, name)
