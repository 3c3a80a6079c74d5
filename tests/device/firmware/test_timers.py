"""Timers count simulated milliseconds and lose nothing while a program handles their event."""

from __future__ import annotations

import pytest

from thymio_sim_ros.device.firmware.timers import MAX_LAG_MS, MILLISECOND_NS, Timers

MINUTE_MS = 60_000


def started(*periods):
    timers = Timers()
    timers.set_clock(0)
    timers.set_periods(periods)
    return timers


def heard(timers, now_ms):
    """Every firing up to a moment, by a machine that is always free."""
    fired = list(timers.set_clock(now_ms * MILLISECOND_NS))
    while timers.lag_ms:
        fired += timers.next_firing()
    return fired


@pytest.mark.parametrize("step_ms", [1, 10, 20, 30, 7])
@pytest.mark.parametrize("period_ms", [1, 15, 100, 333, 1000])
def test_a_minute_has_its_number_of_periods(period_ms, step_ms):
    timers = started(period_ms, 0)
    total = sum(len(heard(timers, now_ms)) for now_ms in range(0, MINUTE_MS + 1, step_ms))
    assert total == MINUTE_MS // step_ms * step_ms // period_ms


def test_timers_fire_in_the_order_of_their_moments():
    assert heard(started(4, 3), 12) == [1, 0, 1, 0, 1, 0, 1]


def test_a_changed_period_starts_the_count_again():
    timers = started(100, 0)
    assert heard(timers, 90) == []
    timers.set_periods((50, 0))
    assert heard(timers, 139) == []
    assert heard(timers, 140) == [0]


@pytest.mark.parametrize("is_counted", [True, False])
def test_after_a_reset_the_count_begins_with_the_present(is_counted):
    timers = started(100, 0)
    if is_counted:
        assert heard(timers, 90) == []
    else:
        timers.set_clock(90 * MILLISECOND_NS)
    timers.reset()
    timers.set_periods((50, 0))
    assert heard(timers, 139) == []
    assert heard(timers, 140) == [0]


def test_a_period_begins_where_the_machine_has_counted_to_not_at_the_clock():
    timers = started(100, 0)
    timers.set_clock(50 * MILLISECOND_NS)
    timers.set_periods((100, 20))
    assert [timers.next_firing() for _ in range(3)] == [(1,), (1,), ()]
    assert timers.lag_ms == 0


def test_the_same_moment_again_changes_nothing():
    timers = started(10, 0)
    assert [len(heard(timers, 6 * look)) for look in (0, 1, 1, 2, 2, 3, 3, 4)] == [0, 0, 0, 1, 0, 0, 0, 1]


def test_a_timer_that_fires_several_times_unhandled_causes_one_event():
    timers = started(10, 0)
    assert timers.set_clock(95 * MILLISECOND_NS) == ()
    assert timers.set_clock(96 * MILLISECOND_NS) == (0,)
    assert heard(timers, 100) == [0]


def test_a_long_jump_is_made_up_for_in_part():
    assert len(heard(started(1, 0), 3_600_000)) == MAX_LAG_MS + 1


@pytest.mark.parametrize("period_ms", [0, -5])
def test_no_period_no_event(period_ms):
    assert heard(started(period_ms, 0), 10_000) == []


def test_time_that_goes_back_starts_them_anew():
    timers = started(100, 0)
    heard(timers, 5050)
    assert heard(timers, 0) == []
    assert heard(timers, 99) == []
    assert heard(timers, 100) == [0]
