"""Hosts of translated code: access to the variables, edge flags and natives of one machine."""

from __future__ import annotations

from collections.abc import Callable, MutableSequence
from typing import Any, Protocol

from aseba_vm.machine.data_memory import Variables

Run = Callable[[int], tuple[int, int, int, Any]]
"""Run with a budget; return the budget left, the address, the kind of exit and the words to push (falsy if none)."""


class TranslatedMachine(Protocol):
    """What translated code needs of its machine; none of these methods may raise."""

    random_state: int

    @property
    def variables(self) -> Variables:
        """The variables of the machine."""

    def call_native(self, number: int, pc: int, popped: tuple[int, ...]) -> int:
        """Call native ``number`` from address ``pc`` with the words it pops.

        Returns 0 to continue, 1 if translated code must exit, 2 if an argument was invalid and nothing was done.
        """

    def stop_on_translated_fault(self, pc: int, reason: int) -> None:
        """Stop the event at ``pc`` because of a fault in a translated native."""

    def emit(self, number: int, words: tuple[int, ...]) -> None:
        """Emit an event."""


class JitHost(Protocol):
    """Connection between translated code and one machine."""

    edges: MutableSequence[int]
    """Edge flags of the branches: the last condition of each, 0 or 1."""

    def reserve_edges(self, branches: int) -> None:
        """Allocate the edge flags of a program with this number of branches."""

    def instantiate(self, code: Any) -> Run:
        """Return the function that runs a translation on this machine."""

    def close(self) -> None:
        """Move the variables back to the machine."""


class PythonHost:
    """Host of code translated to Python."""

    def __init__(self, machine: TranslatedMachine) -> None:
        """Use the machine's variables in place."""
        self._machine = machine
        self.edges: MutableSequence[int] = []

    def close(self) -> None:
        """Do nothing: the variables were never moved."""

    def reserve_edges(self, branches: int) -> None:
        """Allocate the edge flags of a program with this number of branches."""
        self.edges = [0] * branches

    def instantiate(self, code: Callable[..., Run]) -> Run:
        """Return the function of a translation for this machine."""
        machine = self._machine
        return code(machine.variables.words, self.edges, machine.call_native, machine.emit)
