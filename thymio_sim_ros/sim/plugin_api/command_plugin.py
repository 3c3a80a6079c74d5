"""The base of actuators and stimuli: a state on each robot that commands change and that may act in every tick."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import partial
from typing import Any, Protocol, TypeVar, runtime_checkable

from thymio_sim_ros.sim.model.geometry import Tilt
from thymio_sim_ros.sim.plugin_api.plugin_isolation import PluginGuard
from thymio_sim_ros.sim.plugin_api.view import ActuatorView

__all__ = ["CommandPlugin", "Tilting", "isolated"]


@dataclass(frozen=True, slots=True)
class CommandPlugin:
    """A plug-in that accepts commands; the base of `Actuator` and `Stimulus`.

    Args:
        name: Name of the plug-in, unique among the plug-ins of its kind; it also seeds the noise.
        accepts: Types of the commands that it accepts.
        begin: Returns the initial state on one robot.
        apply: Called with the state, a command and the simulated time in ns; raises ValueError for bad values.
        update: Called with the state, a view of the robot and the length of the tick in s, in every tick, or, with
            `is_idle`, in every tick in which the state is not idle.
        is_idle: Returns whether `update` has nothing to do for this state until the next command.
        shows: Returns what a viewer shows of the state; the items are merged into `RobotSnapshot.shown`.
    """

    name: str
    accepts: tuple[type[Any], ...]
    begin: Callable[[], Any]
    apply: Callable[[Any, Any, int], None]
    update: Callable[[Any, ActuatorView, float], None] | None = None
    is_idle: Callable[[Any], bool] | None = None
    shows: Callable[[Any], Mapping[str, Any]] | None = None


@runtime_checkable
class Tilting(Protocol):
    """The state of a plug-in that tilts its robot: any state with this attribute does."""

    tilt: Tilt
    """The angle at which the robot is held; level if it is not held."""


P = TypeVar("P", bound=CommandPlugin)


def isolated(kind: str, plugin: P) -> P:
    """A plug-in of another package with guarded functions, so that its errors do not stop the world.

    `kind` is the word for it in log messages.
    """
    guard, update, shows = PluginGuard(kind, plugin.name), plugin.update, plugin.shows
    return replace(
        plugin,
        begin=partial(guard.begin, plugin.begin),
        apply=partial(guard.run, plugin.apply),
        update=None if update is None else partial(guard.run, update),
        shows=None if shows is None else partial(guard.show, shows),
    )
