"""Decides how many ticks of the world are due at a time.

Ticks follow absolute deadlines of wall time (`Pacer`). Ticks without a result that any subscriber would see are
deferred and executed together (docs/architecture.md, "Threads").
"""

from __future__ import annotations

from thymio_sim_ros.ros.interface.subscriber_demand import SubscriberDemand
from thymio_sim_ros.ros.simulator.clock_publisher import ClockPublisher
from thymio_sim_ros.sim.model.clock import TICK_NS, Pacer

__all__ = ["MAX_CATCH_UP_TICKS", "MAX_DEFERRED_TICKS", "TickScheduler"]

MAX_DEFERRED_TICKS = 10
"""Largest number of deferred ticks: changes are published at most this much later (0.1 s of wall time)."""

MAX_CATCH_UP_TICKS = 2 * MAX_DEFERRED_TICKS
"""Largest number of ticks executed at once after the machine was busy; further late ticks are dropped."""


class TickScheduler:
    """Paces the world by wall time and defers ticks until the next one with a visible result.

    Times named `wall_ns` are of `time.monotonic_ns`, times named `now_ns` are simulated.
    """

    def __init__(
        self, real_time_factor: float, demand: SubscriberDemand, clock: ClockPublisher, *, batch_ticks: int = 1
    ) -> None:
        """`demand` and `clock` know when the next periodic message is due.

        With `batch_ticks` above 1, so many ticks are deferred also if a subscriber would see their results.
        """
        self.is_prompt = False
        """Whether no tick is deferred, since events of programs have receivers at any time."""
        self._batch_ticks = batch_ticks
        self._demand, self._clock = demand, clock
        self._prompt_until_ns = 0
        """Simulated time until which no tick is deferred, since a message has arrived."""
        self.set_factor(real_time_factor)

    @property
    def achieved(self) -> float:
        """The real-time factor over about the last second of wall time."""
        return self._pacer.achieved

    @property
    def late_ticks(self) -> int:
        """Number of ticks executed later than planned since the last change of pace."""
        return self._late_ticks

    @property
    def dropped_ticks(self) -> int:
        """Number of ticks dropped since the last change of pace because the machine was too slow."""
        return self._pacer.dropped_ticks

    def set_factor(self, real_time_factor: float) -> None:
        """Change the pace: simulated seconds per second, 0 for as fast as possible. Deadlines begin anew."""
        self._factor = real_time_factor
        self._normal_ticks = max(1, round(real_time_factor))
        self._max_deferred_ticks = max(1, min(MAX_DEFERRED_TICKS, int(MAX_DEFERRED_TICKS * real_time_factor)))
        self.resume()

    def resume(self) -> None:
        """Begin the deadlines anew, as after a pause: no tick is owed for the time before."""
        self._pacer = Pacer(self._factor, max_batch=MAX_CATCH_UP_TICKS)
        self._late_ticks = 0

    def reset(self) -> None:
        """Begin the deadlines anew for a world whose time starts at zero."""
        self.resume()
        self._prompt_until_ns = 0

    def require_next_tick(self, now_ns: int) -> None:
        """Do not defer the tick that follows `now_ns`: it shows the effect of a command or request."""
        self._prompt_until_ns = now_ns + TICK_NS

    def wait_ns(self, wall_ns: int, now_ns: int) -> int:
        """Return the wall time until ticks have to be executed; 0 if they are due."""
        return self._pacer.wait_ns(wall_ns, self._wanted_ticks(now_ns))

    def pop_owed(self, wall_ns: int, now_ns: int) -> int:
        """Return the number of ticks to execute now, including deferred ones, and count those that are late."""
        expected = max(self._normal_ticks, self._wanted_ticks(now_ns))
        ticks = self._pacer.owed(wall_ns)
        if self._factor > 0.0:
            self._late_ticks += max(0, ticks - expected)
        return ticks

    def drop(self, ticks: int) -> None:
        """Take back ticks of `pop_owed` that are not executed, since they would take too long."""
        self._pacer.drop(ticks)

    def _wanted_ticks(self, now_ns: int) -> int:
        """Return the number of ticks until the next one with a result for a subscriber or a command."""
        if self.is_prompt or now_ns < self._prompt_until_ns:
            return 1
        if self._batch_ticks > 1:
            return min(self._batch_ticks, self._max_deferred_ticks)
        ticks = min(self._max_deferred_ticks, (self._demand.due_ns(now_ns) - now_ns) // TICK_NS)
        if ticks <= 1:
            return ticks
        clock_ns = self._clock.due_ns
        return ticks if clock_ns is None else min(ticks, self._pacer.ticks_until(clock_ns))
