"""Readings of sensors: written to the machine's variables, with the local events that they cause."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence

from aseba_vm import VirtualMachine
from thymio_sim_ros.device import bindings
from thymio_sim_ros.device.bindings import SensorBinding, Slot
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
        self._sensors = bindings.sensors(layout)
        self._periods_ns, self._vm, self._variables, self._local_events = periods_ns, vm, variables, local_events
        self._last_period: dict[str, int] = {}
        self._sensor_at = {slot.address: name for name, binding in self._sensors.items() for slot in binding.slots}
        self._last: dict[str, tuple[tuple[int, ...], int]] = {}
        """The last words of each sensor, and `variables.writes` at that time."""

    def sensors_of(self, addresses: Collection[int]) -> dict[str, int]:
        """Return the sensors that write variables at these addresses, and the address of the first variable of each."""
        sensors = {self._sensor_at[address] for address in addresses if address in self._sensor_at}
        return {sensor: self._sensors[sensor].slots[0].address for sensor in sensors}

    def addresses_of(self, sensors: Collection[str]) -> frozenset[int]:
        """Return the addresses of all variables of sensors."""
        runs = (run for sensor in sensors for run in self._sensors[sensor].runs)
        return frozenset(address for run in runs for address in range(run.address, run.address_end))

    def wants_event(self, sensor: str) -> bool:
        """Whether the event of a sensor, or of one of its variables, has a receiver."""
        binding, wanted = self._sensors[sensor], self._local_events.wanted
        return binding.event in wanted or any(slot.edge in wanted for slot in binding.edges)

    def is_measured(self, address: int) -> bool:
        """Whether a sensor wrote a variable since the memory was cleared; True for variables without a sensor."""
        sensor = self._sensor_at.get(address)
        return sensor is None or (sensor in self._last and self._last[sensor][1] >= self._variables.last_clear)

    def feed(self, sensor: str, words: Sequence[int], now_ns: int) -> bool:
        """Store the words of a reading and cause its events; return whether the variables were not measured or differ.

        Raises KeyError for an unknown sensor and ValueError for a wrong number of words.
        """
        binding = self._sensors[sensor]
        if len(words) != binding.size:
            raise ValueError(f"{len(words)} words found, expected {binding.size}")
        if sensor in self._periods_ns and not self._is_due(sensor, now_ns):
            return False
        old, new = self._last.get(sensor), (tuple(words), self._variables.writes)
        has_changed = False
        if new != old:
            has_changed = self._write(sensor, binding, new) or old is None or old[1] < self._variables.last_clear
            if binding.edges:
                self._cause_edge_events(old[0] if old is not None else (0,) * binding.size, new[0], binding.edges)
        event, above = binding.event, binding.above
        if event in self._local_events.wanted and (above is None or words[0] > self._vm.variables.words[above] != 0):
            self._local_events.cause(event)
        return has_changed

    def store(self, sensor: str, words: Sequence[int]) -> None:
        """Store the words of a reading that is measured because a variable is read; it causes no event."""
        new = (tuple(words), self._variables.writes)
        if new != self._last.get(sensor):
            self._write(sensor, self._sensors[sensor], new)

    def restore(self) -> None:
        """Write the last words of all sensors to the memory after it was cleared."""
        for sensor, (words, _) in self._last.items():
            self._write(sensor, self._sensors[sensor], (words, self._variables.writes))

    def clear(self) -> None:
        """Drop the last words, so that the next reading of each sensor counts as a change."""
        self._last.clear()

    def _write(self, sensor: str, binding: SensorBinding, new: tuple[tuple[int, ...], int]) -> bool:
        """Write new words to the memory; return whether it had others."""
        memory, words, is_new = self._vm.variables.words, list(new[0]), False
        for address, address_end, begin, end in binding.runs:
            part = words[begin:end]
            if memory[address:address_end] != part:
                memory[address:address_end] = part
                is_new = True
        self._last[sensor] = new
        return is_new

    def _cause_edge_events(self, old: Sequence[int], new: Sequence[int], edges: Sequence[Slot]) -> None:
        """Cause the events of the variables that have changed."""
        if new != old:
            for slot in edges:
                begin, end = slot.begin, slot.begin + slot.size
                if slot.edge in self._local_events.wanted and new[begin:end] != old[begin:end]:
                    self._local_events.cause(slot.edge)

    def _is_due(self, sensor: str, now_ns: int) -> bool:
        """Whether a new period of a rate-limited sensor has begun."""
        number = max(0, now_ns - 1) // self._periods_ns[sensor]
        before, self._last_period[sensor] = self._last_period.get(sensor), number
        return number != before
