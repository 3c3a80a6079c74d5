"""Simulated time, schedules of sensors, and the pace against wall time."""

from __future__ import annotations

import pytest

from thymio_sim_ros.sim.model.clock import TICK_NS, Pacer, Schedule, SimClock, next_due_ns

SECOND_NS = 1_000_000_000


def times_due(period_ns: int, ticks: int, phase_ns: int = 0) -> list[int]:
    schedule = Schedule([(period_ns, phase_ns)])
    return [tick for tick in range(1, ticks + 1) if schedule.due(tick * TICK_NS) == [0]]


def test_the_clock_counts_ticks_of_ten_milliseconds() -> None:
    clock = SimClock()
    assert [clock.advance(), clock.advance()] == [10_000_000, 20_000_000]


def test_a_schedule_is_due_at_every_multiple_of_its_period() -> None:
    assert times_due(50_000_000, 15) == [5, 10, 15]


def test_a_phase_shifts_a_schedule_and_nothing_is_due_before_it() -> None:
    assert times_due(50_000_000, 15, phase_ns=10_000_000) == [1, 6, 11]


def test_a_period_that_is_no_whole_number_of_ticks_keeps_its_rate() -> None:
    assert len(times_due(62_500_000, 1600)) == 16 * 16
    assert len(times_due(16_384_000, 1000)) == 610


def test_a_schedule_returns_all_that_is_due_in_order() -> None:
    schedule = Schedule([(20_000_000, 0), (10_000_000, 0), (1 << 62, 0)])
    assert [schedule.due(tick * TICK_NS) for tick in (1, 2, 3)] == [[1], [0, 1], [1]]


def test_a_schedule_returns_the_selected_ones_at_their_own_times() -> None:
    periods = [(20_000_000, 0), (16_384_000, 0), (30_000_000, 0)]
    everything, some = Schedule(periods), Schedule(periods)
    for tick in range(1, 300):
        if tick % 50 == 0:
            some.select({1, 2} if tick % 100 else None)
        wanted = {1, 2} if tick % 100 >= 50 else {0, 1, 2}
        assert list(some.due(tick * TICK_NS)) == [n for n in everything.due(tick * TICK_NS) if n in wanted]


@pytest.mark.parametrize("period_ns", [10_000_000, 16_384_000, 50_000_000, 62_500_000, 7_000_000])
@pytest.mark.parametrize("phase_ns", [0, 10_000_000, 25_000_000])
def test_the_next_due_time_is_known_without_asking_every_tick(period_ns: int, phase_ns: int) -> None:
    ticks = times_due(period_ns, 200, phase_ns)
    for tick in range(150):
        assert next_due_ns(period_ns, phase_ns, tick * TICK_NS) == next(due for due in ticks if due > tick) * TICK_NS


def test_the_pacer_owes_one_tick_for_each_period_of_wall_time() -> None:
    pacer = Pacer(1.0)
    assert [pacer.owed(now * 5_000_000) for now in range(7)] == [0, 0, 1, 0, 1, 0, 1]


def test_a_factor_of_two_owes_twice_as_many_ticks() -> None:
    pacer = Pacer(2.0)
    assert sum(pacer.owed(now * TICK_NS) for now in range(101)) == 200


def test_what_cannot_be_caught_up_is_dropped_and_counted() -> None:
    pacer = Pacer(1.0, max_batch=10)
    pacer.owed(0)
    assert pacer.owed(SECOND_NS) == 10
    assert pacer.dropped_ticks == 90
    assert pacer.owed(SECOND_NS + TICK_NS) == 1


def test_the_achieved_factor_shows_what_was_dropped() -> None:
    pacer = Pacer(1.0, max_batch=10)
    for now in range(0, 5 * SECOND_NS, SECOND_NS // 5):
        pacer.owed(now)
    assert pacer.achieved == pytest.approx(0.5)


def test_a_fast_pace_may_owe_more_than_a_batch_at_once() -> None:
    pacer = Pacer(100.0, max_batch=10)
    pacer.owed(0)
    assert pacer.owed(2 * TICK_NS) == 200
    assert pacer.dropped_ticks == 0
    assert pacer.owed(5 * TICK_NS) == 200
    assert pacer.dropped_ticks == 100


def test_the_achieved_factor_is_known_after_a_tenth_of_a_second() -> None:
    pacer = Pacer(1.0)
    achieved = []
    for tick in range(12):
        pacer.owed(tick * TICK_NS)
        achieved.append(pacer.achieved)
    assert achieved == [0.0] * 10 + [pytest.approx(0.9, abs=0.11)] * 2


def test_factor_zero_owes_a_full_batch_at_once_and_never_waits() -> None:
    pacer = Pacer(0.0, max_batch=10)
    assert [pacer.owed(0), pacer.owed(1), pacer.owed(2)] == [10, 10, 10]
    assert pacer.wait_ns(3) == 0


def test_the_wait_ends_when_a_tick_is_owed() -> None:
    pacer = Pacer(1.0)
    pacer.owed(0)
    wait = pacer.wait_ns(4_000_000)
    assert pacer.owed(4_000_000 + wait) == 1


def test_the_wait_for_some_ticks_ends_when_they_are_owed() -> None:
    pacer = Pacer(2.0)
    assert pacer.wait_ns(0, 5) == 0
    pacer.owed(0)
    wait = pacer.wait_ns(1_000_000, 5)
    assert pacer.owed(wait + 1_000_000 - 2) == 4
    assert pacer.owed(wait + 1_000_000) == 1


def test_the_ticks_until_a_moment_are_at_least_one() -> None:
    pacer = Pacer(1.0)
    assert pacer.ticks_until(SECOND_NS) == 1
    pacer.owed(0)
    assert [pacer.ticks_until(at * 1_000_000) for at in (0, 10, 11, 20, 21)] == [1, 1, 2, 2, 3]


@pytest.mark.parametrize("factor", [-1.0, float("inf"), float("nan")])
def test_a_factor_that_is_no_pace_is_refused(factor: float) -> None:
    with pytest.raises(ValueError, match="real-time factor"):
        Pacer(factor)
