"""Readings of sensors: written to the machine's variables, with the local events that they cause."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

from aseba_vm import VirtualMachine
from thymio_sim_ros.device import bindings
from thymio_sim_ros.device.bindings import Slot

__all__ = ["Inputs"]


class Inputs:
    """Readings of one device. Invariant: the last words fed are in the memory unless overwritten since."""

    def __init__(
        self, layout: str, slow: Mapping[str, int], vm: VirtualMachine, raise_event: Callable[[int], None]
    ) -> None:
        """Create the inputs of a machine.

        Args:
            layout: name of the memory layout (`layout.LAYOUTS`).
            slow: shortest time between two readings in ns, by sensor; the other sensors are not limited.
            vm: the machine whose variables are written.
            raise_event: called with the index of each local event that is in `wanted`.
        """
        self.wanted: frozenset[int] = frozenset()
        """Indexes of the local events to report."""
        self.is_memory_changed = True
        """Whether the memory may have changed since the last update of the indicators."""
        self._sensors = bindings.sensors(layout)
        self._slow, self._vm, self._raise_event = slow, vm, raise_event
        self._last_period: dict[str, int] = {}
        self._writes = self._cleared = 0
        """Number of possible writes to the memory, and this number at the last clearing."""
        self._sensor_at = {slot.address: name for name, binding in self._sensors.items() for slot in binding.slots}
        self._last: dict[str, tuple[tuple[int, ...], int]] = {}
        """The last words of each sensor, and the number of writes at that time."""

    def mark_changed(self) -> None:
        """Note that the memory may have been written."""
        self._writes += 1
        self.is_memory_changed = True

    def mark_cleared(self) -> None:
        """Note that the memory was cleared."""
        self.mark_changed()
        self._cleared = self._writes

    def is_measured(self, address: int) -> bool:
        """Whether a sensor wrote a variable since the memory was cleared; True for variables without a sensor."""
        sensor = self._sensor_at.get(address)
        return sensor is None or (sensor in self._last and self._last[sensor][1] >= self._cleared)

    def feed(self, sensor: str, words: Sequence[int], now_ns: int) -> None:
        """Store the words of a reading. Raises KeyError (unknown sensor) or ValueError (wrong number of words)."""
        binding = self._sensors[sensor]
        if len(words) != binding.size:
            raise ValueError(f"{len(words)} words found, expected {binding.size}")
        if sensor in self._slow and not self._is_due(sensor, now_ns):
            return
        memory = self._vm.variables.words
        old, new = self._last.get(sensor), (tuple(words), self._writes)
        if new != old:
            for address, address_end, begin, end in binding.runs:
                memory[address:address_end] = words[begin:end]
            self.is_memory_changed = True
            self._last[sensor] = new
            if binding.edges:
                self._compare(old[0] if old is not None else (0,) * binding.size, new[0], binding.edges)
        if binding.event in self.wanted and (binding.above is None or words[0] > memory[binding.above] != 0):
            self._raise_event(binding.event)

    def restore(self) -> None:
        """Write the last words of all sensors to the memory after it was cleared."""
        for sensor, (words, _) in self._last.items():
            self._last[sensor] = (words, self._writes)
            for address, _, begin, end in self._sensors[sensor].runs:
                self._vm.write_variables(address, words[begin:end])

    def clear(self) -> None:
        """Forget the last words, so that the next reading of each sensor counts as a change."""
        self._last.clear()

    def _compare(self, old: Sequence[int], new: Sequence[int], edges: Sequence[Slot]) -> None:
        """Raise the events of the variables that have changed."""
        if new != old:
            for slot in edges:
                begin, end = slot.begin, slot.begin + slot.size
                if slot.edge in self.wanted and new[begin:end] != old[begin:end]:
                    self._raise_event(slot.edge)

    def _is_due(self, sensor: str, now_ns: int) -> bool:
        """Whether a new period of a rate-limited sensor has begun."""
        number = now_ns // self._slow[sensor]
        before, self._last_period[sensor] = self._last_period.get(sensor), number
        return number != before
