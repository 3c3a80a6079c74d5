"""Timers count simulated milliseconds and lose nothing."""

from __future__ import annotations

import pytest

from thymio_sim_ros.device.timers import MILLISECOND_NS, Timer

MINUTE_MS = 60_000


@pytest.mark.parametrize("step_ms", [1, 10, 20, 30, 7])
@pytest.mark.parametrize("period_ms", [1, 15, 100, 333, 1000])
def test_a_minute_has_its_number_of_periods(period_ms, step_ms):
    timer = Timer()
    timer.elapsed(period_ms, 0)
    total = sum(timer.elapsed(period_ms, now * MILLISECOND_NS) for now in range(0, MINUTE_MS + 1, step_ms))
    last_ms = MINUTE_MS // step_ms * step_ms
    assert total == last_ms // period_ms


def test_a_new_period_starts_anew():
    timer = Timer()
    timer.elapsed(100, 0)
    assert timer.elapsed(50, 90 * MILLISECOND_NS) == 0
    assert timer.elapsed(50, 139 * MILLISECOND_NS) == 0
    assert timer.elapsed(50, 140 * MILLISECOND_NS) == 1


@pytest.mark.parametrize("period_ms", [0, -5])
def test_no_period_no_event(period_ms):
    timer = Timer()
    timer.elapsed(period_ms, 0)
    assert timer.elapsed(period_ms, 10**12) == 0


def test_time_that_goes_back_starts_it_anew():
    timer = Timer()
    timer.elapsed(100, 5000 * MILLISECOND_NS)
    assert timer.elapsed(100, 0) == 0
    assert timer.elapsed(100, 100 * MILLISECOND_NS) == 1
