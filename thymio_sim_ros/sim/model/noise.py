"""Repeatable random numbers: a function of seed, robot, user (a sensor or actuator), tick and number in this tick.

There is no generator with a state: what one sensor draws, or whether it measures at all, changes no other number and no
later one. A number is a hash of these five. The hash mixes 32 bits by Wellons' `lowbias32`, a public-domain
function found by search (https://nullprogram.com/blog/2018/07/31/), once for each word of the input. Normal numbers are
made of two uniform ones (Box-Muller).
"""

from __future__ import annotations

import hashlib
import math

from aseba_vm.kernel.integers import wrap32
from aseba_vm.kernel.record import Record
from aseba_vm.kernel.types import Ints, kernel
from thymio_sim_ros.sim.kernel.elementary import cos, log
from thymio_sim_ros.sim.model.clock import TICK_NS, SimClock

__all__ = ["Noise", "NoiseKeys", "noise_keys", "normal", "tick_number", "uniform"]

_FACTOR_1 = 0x7FEB352D
_FACTOR_2 = wrap32(0x846CA68B)
_HALF = 2147483648.5
_WHOLE = 4294967296.0
_TURN = math.tau


@kernel
def _mix(x: int) -> int:
    """A number that looks random for each number of 32 bits; no two give the same."""
    x = x ^ ((x >> 16) & 0xFFFF)
    x = wrap32(x * _FACTOR_1)
    x = x ^ ((x >> 15) & 0x1FFFF)
    x = wrap32(x * _FACTOR_2)
    return x ^ ((x >> 16) & 0xFFFF)


@kernel
def uniform(key_1: int, key_2: int, tick: int, number: int) -> float:
    """The uniform random number in (0, 1) with this number in a tick; the keys are those of `noise_keys`."""
    return (_mix(key_1 ^ _mix(tick ^ _mix(key_2 ^ number))) + _HALF) / _WHOLE


@kernel
def normal(key_1: int, key_2: int, tick: int, number: int) -> float:
    """The normal random number of mean 0 and deviation 1 made of the uniform ones `2 number`, `2 number + 1`."""
    angle = uniform(key_1, key_2, tick, 2 * number) * _TURN
    return cos(angle) * math.sqrt(-2.0 * log(uniform(key_1, key_2, tick, 2 * number + 1)))


def noise_keys(seed: int, robot: str, user: str) -> tuple[int, int]:
    """The two keys of the random numbers of a sensor or actuator on a robot, 32 bits each."""
    digest = hashlib.blake2b(f"{seed}/{robot}/{user}".encode(), digest_size=8).digest()
    return int.from_bytes(digest[:4], "big", signed=True), int.from_bytes(digest[4:], "big", signed=True)


def tick_number(now_ns: int) -> int:
    """The number of the tick that ends at a time, with 31 bits."""
    return now_ns // TICK_NS & 0x7FFFFFFF


class NoiseKeys(Record):
    """The keys of one user on each robot; `is_on` is 0 where noise is off."""

    key_1: Ints
    key_2: Ints
    is_on: Ints


class Noise:
    """The random numbers of one user: a sensor or actuator on one robot; the next number of the present tick."""

    __slots__ = ("_clock", "_keys", "_number", "_tick", "enabled")

    def __init__(
        self, seed: int, robot: str, user: str, *, enabled: bool = True, clock: SimClock | None = None
    ) -> None:
        """`clock`: simulated time; None: it stays in one tick."""
        self._keys = noise_keys(seed, robot, user)
        self._clock = clock
        self._tick = self._number = 0
        self.enabled = enabled
        """Whether noise is on."""

    def gauss(self, sigma: float) -> float:
        """A normal random number with mean 0 and standard deviation `sigma`; exactly 0 if noise is off."""
        if not self.enabled:
            return 0.0
        number = (self._next_number() + 1) // 2
        self._number = 2 * number + 2
        return normal(*self._keys, self._tick, number) * sigma

    def uniform(self, low: float, high: float) -> float:
        """A uniform random number in (low, high); the mean of both if noise is off."""
        if not self.enabled:
            return (low + high) / 2
        number = self._next_number()
        self._number = number + 1
        return low + (high - low) * uniform(*self._keys, self._tick, number)

    def _next_number(self) -> int:
        if self._clock is not None:
            tick = tick_number(self._clock.now_ns)
            if tick != self._tick:
                self._tick, self._number = tick, 0
        return self._number
