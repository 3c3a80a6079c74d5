"""Kernel: hand out numbers that were drawn ahead to their users, as `NormalBank.draw` does."""

from __future__ import annotations

from aseba_vm.kernel.types import Floats, Ints, kernel

__all__ = ["COUNTS", "draw"]

COUNTS = ("turns", "width", "is_short")
"""Meaning of each element of `counts`: numbers to draw, numbers in a row; the last is a result."""
_TURNS, _WIDTH, _IS_SHORT = range(len(COUNTS))


@kernel
def draw(counts: Ints, users: Ints, numbers: Floats, used: Ints, drawn: Floats) -> None:
    """Write the next number of the user of each turn to `drawn`; if a user has too few, undo all and set `is_short`."""
    width = counts[_WIDTH]
    counts[_IS_SHORT] = 0
    for turn in range(counts[_TURNS]):
        user = users[turn]
        if used[user] >= width:
            counts[_IS_SHORT] = 1
            for earlier in range(turn):
                used[users[earlier]] -= 1
            return
        drawn[turn] = numbers[user * width + used[user]]
        used[user] += 1
