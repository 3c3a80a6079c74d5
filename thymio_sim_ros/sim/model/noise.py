"""Repeatable random numbers: one generator per robot and sensor or actuator, and banks of generators for batches.

Every generator is a sequence of uniform random numbers in [0, 1). Normal numbers are made of two of them at a time
(Box-Muller). A bank draws ahead for many generators at once and returns unused numbers, so that the sequence of each
stays the same as without a bank.
"""

from __future__ import annotations

import hashlib
import math
import random
from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from thymio_sim_ros.sim.kernel.memory import is_available
from thymio_sim_ros.sim.kernel.rng_binding import RngBinding

__all__ = ["Noise", "NormalBank", "UniformBank"]

Values = npt.NDArray[np.float64]

_BLOCK = 128
"""Numbers that a bank draws ahead per user; a multiple of 2, since normal numbers come in pairs."""
_WIDTH = 2 * _BLOCK
"""Numbers that a bank of normal numbers keeps per user: the block in use and the next one."""


class Noise:
    """The random numbers of one user: a sensor or actuator on one robot.

    Invariant: the sequence depends on (seed, robot, user) alone, not on other users.
    """

    __slots__ = ("_ahead", "_enabled", "_pending", "_random")

    def __init__(self, seed: int, robot: str, user: str, *, enabled: bool = True) -> None:
        digest = hashlib.blake2b(f"{seed}/{robot}/{user}".encode(), digest_size=8).digest()
        self._random = random.Random(int.from_bytes(digest, "big"))
        self._enabled = enabled
        self._pending: float | None = None
        self._ahead: list[float] = []
        """Numbers drawn but not used; the next one is last."""

    @property
    def enabled(self) -> bool:
        """Whether noise is on."""
        return self._enabled

    def gauss(self, sigma: float) -> float:
        """Return a normal random number with mean 0 and standard deviation `sigma`; exactly 0 if noise is off."""
        if not self._enabled:
            return 0.0
        number = self._pending
        if number is not None:
            self._pending = None
            return number * sigma
        # Box-Muller: two uniform numbers give two independent normal numbers, cosine and sine of the angle times
        # the length. 1 - u is in (0, 1], so the logarithm is finite.
        angle, length = self._draw() * math.tau, math.sqrt(-2.0 * math.log(1.0 - self._draw()))
        self._pending = math.sin(angle) * length
        return math.cos(angle) * length * sigma

    def uniform(self, low: float, high: float) -> float:
        """Return a uniform random number in [low, high); the mean of both if noise is off."""
        if not self._enabled:
            return (low + high) / 2
        return low + (high - low) * (self._ahead.pop() if self._ahead else self._random.random())

    def draw_ahead(self, count: int) -> bytes | Values:
        """Draw the next `count` numbers, as floats or, for `uniforms`, as 8 bytes each.

        Unused numbers must be returned by `release`.
        """
        # `randbytes` takes the same 32-bit words from the generator as `random`, but all in one call.
        if len(self._ahead) == 0:
            return self._random.randbytes(8 * count)
        return np.array([self._draw() for _ in range(count)])

    def take_pending(self) -> float | None:
        """Remove and return the second normal number of a pair whose first is used; None if there is none."""
        pending, self._pending = self._pending, None
        return pending

    def release(self, numbers: Sequence[float], pending: float | None = None) -> None:
        """Return numbers that were drawn ahead and not used, in order, and the rest of a pair of normal numbers."""
        self._ahead += reversed(numbers)
        self._pending = pending

    def _draw(self) -> float:
        return self._ahead.pop() if self._ahead else self._random.random()


def uniforms(blocks: Sequence[bytes | Values]) -> Values:
    """Return blocks of `Noise.draw_ahead` as uniform numbers, shape (blocks, numbers).

    `random.random` combines 27 and 26 bits of two 32-bit words of the generator; the same is done here on arrays.
    """
    raw = [block for block in blocks if isinstance(block, bytes)]
    # (a >> 5) * 2**26 + (b >> 6) is an integer of 53 bits, divided by 2**53: exactly the float that Python makes.
    words = np.frombuffer(b"".join(raw), dtype="<u4").reshape(len(raw), len(raw[0]) // 4 if raw else 0)
    made = iter(((words[:, 0::2] >> 5) * 67108864.0 + (words[:, 1::2] >> 6)) / 9007199254740992.0)
    return np.array([next(made) if isinstance(block, bytes) else block for block in blocks])


class UniformBank:
    """Uniform numbers for users that always draw equally many."""

    def __init__(self, noises: Sequence[Noise]) -> None:
        self._noises = noises
        self._numbers = np.zeros((0, len(noises)))
        self._used = 0
        self._limits: tuple[float, float] | None = None
        self._between = self._numbers
        """The numbers scaled to these limits."""

    def draw(self, low: float, high: float, count: int) -> Values:
        """Return the next `count` numbers in [low, high) of every user, shape (count, users), read only.

        All are the mean of `low` and `high` if noise is off.
        """
        if not self._noises or not self._noises[0].enabled:
            return np.full((count, len(self._noises)), (low + high) / 2)
        while self._used + count > len(self._numbers):
            fresh = uniforms([noise.draw_ahead(_BLOCK) for noise in self._noises]).T
            self._numbers = np.concatenate((self._numbers[self._used :], fresh))
            self._used = 0
            self._limits = None
        if self._limits != (low, high):
            self._limits = (low, high)
            self._between = self._numbers * (high - low) + low
        first, self._used = self._used, self._used + count
        return self._between[first : self._used]

    def release(self) -> None:
        """Return the unused numbers, so that users draw from their own generators again."""
        for noise, numbers in zip(self._noises, self._numbers[self._used :].T.tolist(), strict=True):
            noise.release(numbers)
        self._numbers, self._used, self._limits = np.zeros((0, len(self._noises))), 0, None


class NormalBank:
    """Normal numbers for many users."""

    def __init__(self, noises: Sequence[Noise], *, is_compiled: bool | None = None) -> None:
        """`is_compiled`: use a kernel, or numpy; None: a kernel if available. The numbers are the same."""
        self._noises = noises
        self._is_compiled = is_available() if is_compiled is None else is_compiled
        self._rng_binding: RngBinding | None = None
        self._uniforms = np.zeros((len(noises), _WIDTH))
        self._numbers = np.zeros((len(noises), _WIDTH))
        self._used: npt.NDArray[np.integer] = np.full(len(noises), _WIDTH)
        """Numbers used per row; a user that has used one number of a pair starts with the other."""
        for row, noise in enumerate(noises):
            pending = noise.take_pending()
            if pending is not None:
                self._used[row], self._numbers[row, -1] = _WIDTH - 1, pending

    def draw(self, users: npt.NDArray[np.intp], sigma: float) -> Values:
        """Return one normal number with standard deviation `sigma` for each entry of `users`, shape (entries,).

        `users` are sorted indices; each may occur at most `_BLOCK` times. All are 0 if noise is off.
        """
        if len(users) == 0 or not self._noises[0].enabled:
            return np.zeros(len(users))
        draw = self._draw_compiled if self._is_compiled else self._draw_numpy
        dealt = draw(users)
        if dealt is None:
            self._refill(np.flatnonzero(self._used >= _BLOCK))
            dealt = draw(users)
            assert dealt is not None  # every user has a full block now
        drawn: Values = dealt * sigma
        return drawn

    def release(self) -> None:
        """Return the unused numbers, so that users draw from their own generators again."""
        # Normal numbers 2k and 2k + 1 are made of uniform numbers 2k and 2k + 1. If the first of a pair is used, the
        # second one is returned as it is, and only the uniform numbers after the pair.
        for row, (noise, used) in enumerate(zip(self._noises, self._used.tolist(), strict=True)):
            pending = float(self._numbers[row, used]) if used % 2 else None
            noise.release(self._uniforms[row, used + used % 2 :].tolist(), pending)
        self._used[:] = _WIDTH

    def _draw_numpy(self, users: npt.NDArray[np.intp]) -> Values | None:
        """Return the next number for each entry of `users`; None if a user has too few left."""
        # As `users` is sorted, the index minus that of the first equal entry counts the earlier entries of the user.
        before = np.arange(len(users)) - np.searchsorted(users, users)
        counts = np.bincount(users, minlength=len(self._noises))
        if (self._used + counts).max() > _WIDTH:
            return None
        dealt: Values = self._numbers[users, self._used[users] + before]
        self._used += counts
        return dealt

    def _draw_compiled(self, users: npt.NDArray[np.intp]) -> Values | None:
        """Do the same as `_draw_numpy` by a kernel."""
        binding = self._rng_binding
        if binding is None or binding.most < len(users):
            binding = RngBinding(*self._numbers.shape, most=2 * len(users))
            binding.numbers[:], binding.used[:] = self._numbers, self._used
            self._numbers, self._used = binding.numbers, binding.used
            self._rng_binding = binding  # last: the former arrays are needed until they are copied
        return binding.draw(users)

    def _refill(self, rows: npt.NDArray[np.intp]) -> None:
        """Append a block to these rows, whose first block is used up.

        All such rows are filled, not only those in need: filling many at once costs little more than filling one.
        """
        fresh = uniforms([self._noises[row].draw_ahead(_BLOCK) for row in rows.tolist()])
        angle, length = fresh[:, 0::2] * math.tau, np.sqrt(-2.0 * np.log(1.0 - fresh[:, 1::2]))
        for values in (self._uniforms, self._numbers):
            values[rows, :_BLOCK] = values[rows, _BLOCK:]
        self._uniforms[rows, _BLOCK:] = fresh
        numbers = np.empty(fresh.shape)
        numbers[:, 0::2], numbers[:, 1::2] = np.cos(angle) * length, np.sin(angle) * length
        self._numbers[rows, _BLOCK:] = numbers
        self._used[rows] -= _BLOCK
