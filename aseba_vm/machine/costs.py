"""What natives and emitted events take of a machine's budget, beyond the instruction that calls them.

An instruction is the unit. Costs are part of the program's semantics under a budget: they depend on the operation and
the sizes of its arguments only, so that every engine ends a run at the same place on every machine.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType


@dataclass(frozen=True, slots=True)
class Cost:
    """Instructions that an operation takes as long as: ``base``, and ``per_word`` of all its arguments."""

    base: int = 0
    per_word: int = 0

    def of(self, words: int) -> int:
        """Return the cost for arguments of so many words together."""
        return self.base + self.per_word * words


FREE = Cost()


@dataclass(frozen=True, slots=True)
class Costs:
    """Costs of natives by name, of all ``others``, and of an emitted event."""

    natives: Mapping[str, Cost] = field(default_factory=lambda: MappingProxyType({}))
    others: Cost = FREE
    emit: Cost = FREE

    def of(self, native: str) -> Cost:
        """Return the cost of a native by name."""
        return self.natives.get(native, self.others)


NO_COSTS = Costs()
"""The reference's: a native counts as one instruction."""
