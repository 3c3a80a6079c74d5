"""Readings of sensors: written to the machine's variables, with the local events that they cause."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from aseba_vm import VirtualMachine
from thymio_sim_ros.device import bindings
from thymio_sim_ros.device.bindings import Slot
from thymio_sim_ros.device.local_events import LocalEvents
from thymio_sim_ros.device.variables import DeviceVariables

__all__ = ["Inputs"]


class Inputs:
    """Readings of one device. Invariant: the last words fed are in the memory unless overwritten since."""

    def __init__(
        self,
        layout: str,
        periods_ns: Mapping[str, int],
        vm: VirtualMachine,
        variables: DeviceVariables,
        local_events: LocalEvents,
    ) -> None:
        """Create the inputs of a machine without readings.

        Args:
            layout: name of the memory layout (`layout.LAYOUTS`).
            periods_ns: shortest time between two readings in ns, by sensor; the other sensors are not limited.
            vm: the machine whose variables are written.
            variables: the same variables, with the count of other writes.
            local_events: receives the events that readings cause.
        """
        self.changes = 0
        """Number of readings that differed from the memory."""
        self._sensors = bindings.sensors(layout)
        self._periods_ns, self._vm, self._variables, self._local_events = periods_ns, vm, variables, local_events
        self._last_period: dict[str, int] = {}
        self._sensor_at = {slot.address: name for name, binding in self._sensors.items() for slot in binding.slots}
        self._last: dict[str, tuple[tuple[int, ...], int]] = {}
        """The last words of each sensor, and `variables.writes` at that time."""

    def is_measured(self, address: int) -> bool:
        """Whether a sensor wrote a variable since the memory was cleared; True for variables without a sensor."""
        sensor = self._sensor_at.get(address)
        return sensor is None or (sensor in self._last and self._last[sensor][1] >= self._variables.last_clear)

    def feed(self, sensor: str, words: Sequence[int], now_ns: int) -> None:
        """Store the words of a reading. Raises KeyError (unknown sensor) or ValueError (wrong number of words)."""
        binding = self._sensors[sensor]
        if len(words) != binding.size:
            raise ValueError(f"{len(words)} words found, expected {binding.size}")
        if sensor in self._periods_ns and not self._is_due(sensor, now_ns):
            return
        memory = self._vm.variables.words
        old, new = self._last.get(sensor), (tuple(words), self._variables.writes)
        if new != old:
            for address, address_end, begin, end in binding.runs:
                memory[address:address_end] = words[begin:end]
            self.changes += 1
            self._last[sensor] = new
            if binding.edges:
                self._cause_edge_events(old[0] if old is not None else (0,) * binding.size, new[0], binding.edges)
        event, above = binding.event, binding.above
        if event in self._local_events.wanted and (above is None or words[0] > memory[above] != 0):
            self._local_events.cause(event)

    def restore(self) -> None:
        """Write the last words of all sensors to the memory after it was cleared."""
        for sensor, (words, _) in self._last.items():
            self._last[sensor] = (words, self._variables.writes)
            for address, _, begin, end in self._sensors[sensor].runs:
                self._vm.write_variables(address, words[begin:end])

    def clear(self) -> None:
        """Drop the last words, so that the next reading of each sensor counts as a change."""
        self._last.clear()

    def _cause_edge_events(self, old: Sequence[int], new: Sequence[int], edges: Sequence[Slot]) -> None:
        """Cause the events of the variables that have changed."""
        if new != old:
            for slot in edges:
                begin, end = slot.begin, slot.begin + slot.size
                if slot.edge in self._local_events.wanted and new[begin:end] != old[begin:end]:
                    self._local_events.cause(slot.edge)

    def _is_due(self, sensor: str, now_ns: int) -> bool:
        """Whether a new period of a rate-limited sensor has begun."""
        number = now_ns // self._periods_ns[sensor]
        before, self._last_period[sensor] = self._last_period.get(sensor), number
        return number != before
