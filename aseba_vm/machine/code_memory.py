"""Bytecode memory: words that are decoded when they are written, so the interpreter finds executable operations."""

from __future__ import annotations

from collections.abc import MutableSequence, Sequence

from aseba_vm.bytecode import LENGTH, WAS_TRUE, Op
from aseba_vm.machine.operations import OTHER, Decoded, decode

_FLAG = WAS_TRUE.bit_length() - 1
_BRANCH = int(Op.BRANCH)  # compared with every word of the memory, where a member of an enumeration takes twice as long


class CodeMemory:
    """The bytecode of a machine, changed by its methods only.

    `operations` has the decoded operation at each address. `edges` has the edge flag of each word that is a BRANCH,
    0 or 1, in whatever storage the active engine needs; the flag in a word is that of its last writing. Code that
    changes the flag of an `overlapped` word, which another instruction may read as its operand, calls `refresh`.
    """

    __slots__ = ("_branches", "_words", "addresses", "edges", "operations", "overlapped")

    def __init__(self, size: int) -> None:
        """Create a memory of zeros."""
        self._words = [0] * size
        self._branches: list[int] = []
        """Places of the words that are a BRANCH."""
        self.addresses: dict[int, int] = {}
        """Address of the code of each event."""
        self.edges: MutableSequence[int] = [0] * size
        self.overlapped: set[int] = set()
        self.operations: list[Decoded] = [(OTHER, 0, 0)] * size

    def __len__(self) -> int:
        """The size of the memory in words."""
        return len(self._words)

    def word(self, pc: int) -> int:
        """An unsigned word with its edge flag; 0 beyond the memory."""
        word = self._words[pc] if pc < len(self._words) else 0
        return (word & ~WAS_TRUE) | self.edges[pc] << _FLAG if word >> 12 == _BRANCH else word

    @property
    def words(self) -> tuple[int, ...]:
        """All words, unsigned, with their edge flags."""
        return tuple(self._with_edges())

    def write(self, start: int, words: Sequence[int]) -> None:
        """Write words, which must fit, and decode them."""
        end = start + len(words)
        self._words[start:end] = [word & 0xFFFF for word in words]
        self.edges[start:end] = [word >> _FLAG & 1 for word in self._words[start:end]]
        self._branches = [pc for pc, word in enumerate(self._words) if word >> 12 == _BRANCH]
        self.overlapped = {pc for pc in self._branches if self._is_overlapped(pc)}
        first, flagged = max(start - 2, 0), [*self._with_edges(), 0]
        self.operations[first:end] = map(decode, flagged[first:end], flagged[first + 1 : end + 1])
        self._find_events()

    def refresh(self, pc: int) -> None:
        """Decode the instructions that may contain the word at `pc` again, because its edge flag may have changed."""
        for place in range(max(pc - 2, 0), pc):
            self._decode(place)
        if pc <= self.word(0):
            self._find_events()

    def clear_edges(self) -> None:
        """Clear the edge flags, from the word on at which the reference starts its scan.

        Source: docs/spec/aseba-bytecode-vm.md section 10.4.
        """
        words, edges = self._words, self.edges
        if not any(edges[pc] for pc in self._branches):
            return
        pc = 2 * self.word(0) + 1
        while pc < len(words):
            kind = words[pc] >> 12
            if kind == _BRANCH and edges[pc]:
                edges[pc] = 0
                if pc in self.overlapped:
                    self.refresh(pc)
            pc += LENGTH[kind]

    def _with_edges(self) -> list[int]:
        words = self._words.copy()
        for pc in self._branches:
            words[pc] = (words[pc] & ~WAS_TRUE) | self.edges[pc] << _FLAG
        return words

    def _find_events(self) -> None:
        """Read the table of events."""
        size = min(self.word(0), len(self) - 1)
        # Reversed, so that the first of several entries for an event wins.
        self.addresses = {self.word(place): self.word(place + 1) for place in reversed(range(1, size, 2))}

    def _is_overlapped(self, pc: int) -> bool:
        """Whether another instruction, or the table of events, may contain the word at `pc`."""
        words = self._words
        is_operand = any(LENGTH[words[pc - place] >> 12] > place for place in (1, 2) if pc >= place)
        return is_operand or pc <= words[0]

    def _decode(self, pc: int) -> None:
        self.operations[pc] = decode(self.word(pc), self.word(pc + 1))
