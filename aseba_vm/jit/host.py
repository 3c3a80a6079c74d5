"""What translated code works on: the variables of one machine, what its branches remember, its natives."""

from __future__ import annotations

from collections.abc import Callable, MutableSequence
from typing import Any, Protocol

from aseba_vm.machine.data_memory import Variables

Run = Callable[[int], tuple[int, int, int, Any]]
"""Run with a budget. Returns the budget left, the address, the kind of exit, and the words to push, false if none."""


class TranslatedMachine(Protocol):
    """What translated code needs of its machine; none of it may raise."""

    random_state: int

    @property
    def variables(self) -> Variables:
        """The machine's words."""

    def call_native(self, number: int, pc: int, popped: tuple[int, ...]) -> int:
        """Call a native by number, from an address, with the words it pops.

        Return 0 if the event goes on, 1 if translated code must be left, 2 if nothing was done.
        """

    def stop_on_translated_fault(self, pc: int, reason: int) -> None:
        """Let the event end at an address for what went wrong in a native that is translated itself."""

    def emit(self, number: int, words: tuple[int, ...]) -> None:
        """Emit an event."""


class JitHost(Protocol):
    """One machine's side of translated code."""

    edges: MutableSequence[int]
    """What branches remember, 0 or 1."""

    def reserve_edges(self, branches: int) -> None:
        """Make room for what the branches of a program remember."""

    def instantiate(self, code: Any) -> Run:
        """Return what runs a translation on this machine."""

    def close(self) -> None:
        """Give the variables back."""


class PythonHost:
    """What the functions of one machine work on."""

    def __init__(self, machine: TranslatedMachine) -> None:
        """Use the variables where they are."""
        self._machine = machine
        self.edges: MutableSequence[int] = []

    def close(self) -> None:
        """Nothing is held."""

    def reserve_edges(self, branches: int) -> None:
        """Make room for what the branches of a program remember."""
        self.edges = [0] * branches

    def instantiate(self, code: Callable[..., Run]) -> Run:
        """Return the function of a structure for this machine."""
        machine = self._machine
        return code(machine.variables.words, self.edges, machine.call_native, machine.emit)
