"""Costs of natives and emitted events, in instructions beyond the one that calls them.

Costs are part of the semantics of a program under a budget. They depend only on the operation and the sizes of its
arguments, so every engine ends a run at the same place on every computer.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType


@dataclass(frozen=True, slots=True)
class Cost:
    """Cost of an operation in instructions: `base`, plus `per_word` for each word of its arguments."""

    base: int = 0
    per_word: int = 0

    def of(self, words: int) -> int:
        """The cost for arguments with `words` words in total."""
        return self.base + self.per_word * words


FREE = Cost()


@dataclass(frozen=True, slots=True)
class Costs:
    """Costs of natives by name, of all `others`, and of an emitted event."""

    natives: Mapping[str, Cost] = field(default_factory=lambda: MappingProxyType({}))
    others: Cost = FREE
    emit: Cost = FREE

    def of(self, native: str) -> Cost:
        """The cost of a native by name."""
        return self.natives.get(native, self.others)


NO_COSTS = Costs()
"""Costs of the reference: a native counts as one instruction."""
