"""Global events of a device: those that its program declares, and those that it has emitted."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from aseba_vm.machine.machine_messages import Emitted
from thymio_sim_ros.device.event_queue import GlobalEvent
from thymio_sim_ros.device.programs.load import LoadMeter
from thymio_sim_ros.device.programs.program import ThymioProgram

__all__ = ["EmittedEvent", "NetworkEvents"]


@dataclass(frozen=True, slots=True)
class EmittedEvent:
    """A global event emitted by a program: name and arguments (int16)."""

    name: str
    args: tuple[int, ...]


class NetworkEvents:
    """Converts global events between names, which devices share, and numbers, which belong to one program."""

    def __init__(self, meter: LoadMeter) -> None:
        """Create the events of a device without a program; `meter` counts the emitted ones."""
        self._meter = meter
        self._names: list[str] = []
        self._emitted: list[EmittedEvent] = []

    @property
    def has_emitted(self) -> bool:
        """Whether `pop` would return events."""
        return bool(self._emitted)

    def set_program(self, program: ThymioProgram) -> None:
        """Replace the declared events. Events emitted by the old program stay in the list."""
        self._names = [name for name, _ in program.events]

    def declares(self, name: str) -> bool:
        """Whether the program declares a global event of this name."""
        return name in self._names

    def encode(self, name: str, args: Sequence[int], source: int) -> GlobalEvent:
        """Return the event with the program's number for it. Raises KeyError if the program does not declare it."""
        if name not in self._names:
            raise KeyError(name)
        return GlobalEvent(self._names.index(name), source, tuple(args))

    def name_of(self, event: GlobalEvent) -> str:
        """Name of an event of the current program; a number beyond its list of events has a name made of it."""
        return self._names[event.number] if event.number < len(self._names) else f"event_{event.number}"

    def add_emitted(self, message: Emitted) -> None:
        """Add an event that the program has emitted; one with an undeclared number has no name and is dropped."""
        if message.number < len(self._names):
            name = self._names[message.number]
            self._meter.count_event(name, len(message.arguments))
            self._emitted.append(EmittedEvent(name, message.arguments))

    def pop(self) -> list[EmittedEvent]:
        """Return and clear the emitted events, in order."""
        emitted, self._emitted = self._emitted, []
        return emitted
