"""What sensors read: stored in the machine's variables, and the local events that come of it."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

from aseba_vm import VirtualMachine
from thymio_sim_ros.device import bindings
from thymio_sim_ros.device.bindings import Slot

__all__ = ["Inputs"]


class Inputs:
    """Readings of one device. Invariant: what was fed last is in the memory, unless somebody wrote over it since."""

    def __init__(self, layout: str, slow: Mapping[str, int], vm: VirtualMachine, happen: Callable[[int], None]) -> None:
        """`slow`: periods in ns of sensors that are heard less often; `happen` takes the events that are `wanted`."""
        self.wanted: frozenset[int] = frozenset()
        """Indexes of local events that somebody wants to hear of."""
        self.is_news = True
        """Whether the memory may have changed since the robot's own rules looked at it."""
        self._sensors = bindings.sensors(layout)
        self._slow, self._vm, self._happen = slow, vm, happen
        self._heard: dict[str, int] = {}
        self._writes = self._cleared = 0
        """Times that somebody may have written to the memory, and this number when it was cleared."""
        self._sensor_at = {slot.address: name for name, binding in self._sensors.items() for slot in binding.slots}
        self._last: dict[str, tuple[tuple[int, ...], int]] = {}
        """The last words of each sensor, and the number of writes then."""

    def note_writing(self) -> None:
        """The program, or somebody else, may have written to the memory."""
        self._writes += 1
        self.is_news = True

    def note_clearing(self) -> None:
        """The memory was cleared."""
        self.note_writing()
        self._cleared = self._writes

    def knows(self, address: int) -> bool:
        """Whether a variable was fed since the memory was cleared; True for one that no sensor feeds."""
        sensor = self._sensor_at.get(address)
        return sensor is None or (sensor in self._last and self._last[sensor][1] >= self._cleared)

    def feed(self, sensor: str, words: Sequence[int], now_ns: int) -> None:
        """Store a reading's words. KeyError: no such sensor; ValueError: wrong number of words."""
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
            self.is_news = True
            self._last[sensor] = new
            if binding.edges:
                self._compare(old[0] if old is not None else (0,) * binding.size, new[0], binding.edges)
        if binding.event in self.wanted and (binding.above is None or words[0] > memory[binding.above] != 0):
            self._happen(binding.event)

    def restore(self) -> None:
        """Write all that was fed last to a memory that was cleared."""
        for sensor, (words, _) in self._last.items():
            self._last[sensor] = (words, self._writes)
            for address, _, begin, end in self._sensors[sensor].runs:
                self._vm.write_variables(address, words[begin:end])

    def forget(self) -> None:
        """Whatever is fed next is news."""
        self._last.clear()

    def _compare(self, old: Sequence[int], new: Sequence[int], edges: Sequence[Slot]) -> None:
        """Raise the events of variables that have changed."""
        if new != old:
            for slot in edges:
                begin, end = slot.begin, slot.begin + slot.size
                if slot.edge in self.wanted and new[begin:end] != old[begin:end]:
                    self._happen(slot.edge)

    def _is_due(self, sensor: str, now_ns: int) -> bool:
        """Whether a new period of a sensor that is heard less often has begun."""
        number = now_ns // self._slow[sensor]
        before, self._heard[sensor] = self._heard.get(sensor), number
        return number != before
