"""Bytecode memory: words that are decoded when they are written, so the interpreter finds executable operations."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from aseba_vm.bytecode import LENGTH, WAS_TRUE, Op
from aseba_vm.machine.operations import STOP, Decoded, decode


class CodeMemory:
    """``words`` are unsigned; ``operations`` has the decoded operation at each address.

    Change the words through the methods only, which keep both in step.
    """

    __slots__ = ("_events", "operations", "words")

    def __init__(self, size: int) -> None:
        """Create a memory of zeros."""
        self._events: dict[int, int] | None = None
        self.words: list[int] = [0] * size
        self.operations: list[Decoded] = [(STOP, 0, 0)] * size

    def address_of(self, event: int) -> int:
        """Return the address of the code of an event, 0 if there is none."""
        if self._events is None:
            words = self.words
            places = range(1, min(words[0], len(words) - 1), 2) if words else range(0)
            # Reversed, so that the first of several entries for an event wins.
            self._events = {words[place]: words[place + 1] for place in reversed(places)}
        return self._events.get(event, 0)

    def write(self, start: int, words: Sequence[int]) -> None:
        """Write words, which must fit, and decode them."""
        self.words[start : start + len(words)] = [word & 0xFFFF for word in words]
        self._decode(start, start + len(words))

    def toggle_edge(self, pc: int) -> None:
        """Toggle the edge flag of the BRANCH at ``pc``."""
        self.words[pc] ^= WAS_TRUE
        self._decode(pc, pc + 1)

    def store_edges(self, edges: Iterable[tuple[int, int]]) -> None:
        """Set the edge flags of branches: pairs of address and flag, 0 or 1."""
        for pc, value in edges:
            if self.words[pc] >> 9 & 1 != value:
                self.toggle_edge(pc)

    def clear_edges(self) -> None:
        """Clear the edge flags, from the word on at which the reference starts its scan.

        Source: docs/spec/aseba-bytecode-vm.md section 10.4.
        """
        words = self.words
        pc = 2 * words[0] + 1 if words else 0
        while pc < len(words):
            word = words[pc]
            if word >> 12 == Op.BRANCH and word & WAS_TRUE:
                self.toggle_edge(pc)
            pc += LENGTH[word >> 12]

    def _decode(self, start: int, end: int) -> None:
        """Decode the operations that contain the words start..end-1; an operation has up to three words."""
        if start == 0 or start < self.words[0]:
            self._events = None
        words = [*self.words[max(start - 2, 0) : end], *self.words[end : end + 2], 0, 0]
        for place, pc in enumerate(range(max(start - 2, 0), end)):
            self.operations[pc] = decode(words[place], words[place + 1], words[place + 2])
