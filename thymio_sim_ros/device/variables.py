"""Variables of a device by name, and a count of the times at which they may have been written."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence

from aseba_vm import VirtualMachine
from thymio_sim_ros.device.due_time import DueTime
from thymio_sim_ros.device.programs.program import ThymioProgram

__all__ = ["DeviceVariables"]

INT16 = range(-0x8000, 0x8000)


class DeviceVariables:
    """The variables of the robot and of its program, in the memory of the machine.

    A program writes the memory without notice. Parts that derive values from variables (commands, indicators) therefore
    compare `writes` first, and the memory itself only if that count has changed.
    """

    def __init__(self, vm: VirtualMachine, due: DueTime) -> None:
        """Create the variables of a machine. Possible writes make `due` now."""
        self.writes = 0
        """Number of runs, resets and calls of `set`, which may have written the memory; readings do not count."""
        self.last_clear = 0
        """Value of `writes` after the last `clear`."""
        self.sets = 0
        """Number of calls of `set`."""
        self._measure: Callable[[], None] | None = None
        self._measured: frozenset[int] = frozenset()
        self._program_words: Sequence[int] = ()
        self._are_measured_used = False
        """Whether the program may read variables that are measured when they are read."""
        self._vm, self._due = vm, due
        self._robot_addresses = vm.target.addresses
        self._program_addresses: Mapping[str, tuple[int, int]] = {}
        self._allocated = 0

    def set_program(self, program: ThymioProgram) -> None:
        """Replace the variables of the program. The memory stays as it is."""
        self._program_addresses = program.program.addresses
        self._allocated = program.program.allocated
        self._program_words = program.program.words
        self._find_uses()

    def measure_on_read(self, addresses: Collection[int], measure: Callable[[], None]) -> None:
        """Call `measure`, which writes the variables at these addresses, before any variable is read or written."""
        self._measured, self._measure = frozenset(addresses), measure
        self._find_uses()

    def refresh(self) -> None:
        """Write the variables that are measured when they are read."""
        if self._measure is not None:
            self._measure()

    def prepare_run(self) -> None:
        """Get ready for a run of the program."""
        if self._are_measured_used:
            self.refresh()
        self.count_write()

    def addresses(self) -> dict[str, tuple[int, int]]:
        """Address and size in words of every variable, including those of the program."""
        return {**self._robot_addresses, **self._program_addresses}

    def words(self) -> list[int]:
        """Words (int16) of all variables in order of address."""
        self.refresh()
        return list(self._vm.variables.words[: self._allocated])

    def get(self, name: str) -> tuple[int, ...]:
        """Words (int16) of a variable. Raises KeyError for an unknown name."""
        self.refresh()
        address, size = self.addresses()[name]
        return tuple(self._vm.variables[address : address + size])

    def set(self, name: str, words: Sequence[int]) -> None:
        """Write a whole variable. Raises KeyError for an unknown name, ValueError for a wrong size or value."""
        address, size = self.addresses()[name]
        if len(words) != size:
            raise ValueError(f"{name}: {len(words)} words found, expected {size}")
        wrong = [word for word in words if word not in INT16]
        if wrong:
            raise ValueError(f"{name}: {wrong[0]} found, expected -32768 to 32767")
        self._store(address, words)

    def read(self, start: int, count: int) -> tuple[int, ...]:
        """Words (int16) at these addresses, also of variables without a name, as far as the memory reaches."""
        self.refresh()
        return tuple(self._vm.variables[start : start + count])

    def write(self, start: int, words: Sequence[int]) -> None:
        """Write words (int16) at these addresses, as far as the memory reaches."""
        size = len(self._vm.variables)
        if start < size:
            self._store(start, words[: size - start])

    def clear(self, initial_values: Mapping[str, Sequence[int]]) -> None:
        """Set all words to 0, then these variables of the robot. Raises KeyError for an unknown name."""
        self.refresh()
        self._vm.variables[:] = [0] * len(self._vm.variables)
        for name, words in initial_values.items():
            self._vm.write_variables(self._robot_addresses[name][0], words)
        self.count_write()
        self.last_clear = self.writes

    def count_write(self) -> None:
        """Count a moment at which the program, or a step of it, may have written the memory."""
        self.writes += 1
        self._due.set_now()

    def _store(self, address: int, words: Sequence[int]) -> None:
        self.refresh()
        self._vm.write_variables(address, words)
        self.sets += 1
        self.count_write()

    def _find_uses(self) -> None:
        # Code refers to a variable by its address: the lower 12 bits of an instruction, or a word of its own. Other
        # words that look like one do no harm.
        self._are_measured_used = any(word & 0xFFF in self._measured for word in self._program_words)
