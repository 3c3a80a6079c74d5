"""Local events of a device: which of them its program handles, and which a user watches."""

from __future__ import annotations

from collections.abc import Collection

from aseba_vm import TargetDescription
from thymio_sim_ros.device.event_queue import EventQueue
from thymio_sim_ros.device.firmware.indicators import Indicators
from thymio_sim_ros.device.outputs import Outputs
from thymio_sim_ros.device.programs.program import ThymioProgram

__all__ = ["FIRST_LOCAL_EVENT", "LocalEvents"]

FIRST_LOCAL_EVENT = 0xFFFE
"""Number of the local event with index 0; the others follow downwards (docs/spec/aseba-bytecode-vm.md section 2)."""


class LocalEvents:
    """Delivers the local events of one device to its program and to users that watch them.

    Events are given by index: their position in the list of the target.
    """

    def __init__(self, target: TargetDescription, queue: EventQueue, indicators: Indicators, outputs: Outputs) -> None:
        """Events for the program go to `queue`, those that the firmware shows also to `indicators`.

        `outputs` are asked whether the program has used sound.
        """
        self.names = tuple(event.name for event in target.local_events)
        """Name of each event."""
        self.wanted: frozenset[int] = frozenset()
        """Events that have a receiver; causing any other event has no effect."""
        self._queue, self._indicators, self._outputs = queue, indicators, outputs
        self._sound_finished, self._rc5 = (
            FIRST_LOCAL_EVENT - target.local_event_number(name) for name in ("sound.finished", "rc5")
        )
        self._handled: frozenset[int] = frozenset()
        self._watched: frozenset[int] = frozenset()
        self._occurred: list[str] = []

    def set_program(self, program: ThymioProgram) -> None:
        """Replace the events that the program handles."""
        self._handled = frozenset(FIRST_LOCAL_EVENT - event.number for event in program.program.events)
        self._select()

    def watch(self, names: Collection[str]) -> None:
        """Select the events that `pop` returns, whether or not the program handles them. Unknown names are ignored."""
        self._watched = frozenset(index for index, name in enumerate(self.names) if name in names)
        self._select()

    @property
    def has_occurred(self) -> bool:
        """Whether `pop` would return events."""
        return bool(self._occurred)

    def pop(self) -> list[str]:
        """Return and clear the names of the watched events that occurred, in order."""
        occurred, self._occurred = self._occurred, []
        return occurred

    def cause(self, index: int) -> None:
        """Deliver an event that a reading has caused."""
        if index == self._rc5:
            self._indicators.flash_remote()
        if index == self._sound_finished and not self._outputs.has_used_sound:
            return  # the end of a sound of the firmware
        if index in self._handled:
            self._queue.add_local(index)
        self.record(index)

    def record(self, index: int) -> None:
        """Note that an event has occurred, if it is watched."""
        if index in self._watched:
            self._occurred.append(self.names[index])

    def _select(self) -> None:
        self.wanted = self._handled | self._watched | {self._rc5}
