"""An actuator or stimulus on one robot."""

from __future__ import annotations

from typing import Any

from thymio_sim_ros.sim.plugin_api.command_plugin import CommandPlugin
from thymio_sim_ros.sim.plugin_api.view import ActuatorView

__all__ = ["PluginInstance"]


class PluginInstance:
    """An actuator or stimulus with its state; it acts in every tick in which it is busy."""

    __slots__ = ("_is_idle", "is_busy", "state", "update", "view")

    def __init__(self, plugin: CommandPlugin, state: Any, view: ActuatorView) -> None:
        assert plugin.update is not None
        self.update, self._is_idle, self.state, self.view = plugin.update, plugin.is_idle, state, view
        self.is_busy = not self.rests

    @property
    def rests(self) -> bool:
        """Whether `update` has nothing to do until the next command."""
        return self._is_idle is not None and self._is_idle(self.state)
