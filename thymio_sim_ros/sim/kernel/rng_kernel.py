"""Kernel: hand out numbers that were drawn ahead to their users, as `NormalBank.draw` does."""

from __future__ import annotations

from thymio_sim_ros.sim.kernel.types import Floats, Ints, kernel

__all__ = ["COUNTS", "draw"]

COUNTS = ("turns", "width", "is_short")
"""What each of `counts` is: so many turns, so many numbers in a row; the last is an answer."""
_TURNS, _WIDTH, _IS_SHORT = range(len(COUNTS))


@kernel
def draw(counts: Ints, users: Ints, numbers: Floats, used: Ints, drawn: Floats) -> None:
    """The next number for each turn of a user, unless one has too few: then none is dealt."""
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
