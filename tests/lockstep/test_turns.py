"""Turns: which thread of a program runs, and at which simulated time."""

from __future__ import annotations

import pytest

from thymio_sim_ros.lockstep.turns import FREE_POLLS, POLL_NS, Turns

TICK_NS = 10_000_000


@pytest.fixture
def turns() -> Turns:
    """Turns of one tick each."""
    made = Turns(lambda: made.begin(made.until_ns, made.until_ns + TICK_NS))
    return made


def test_a_sleep_ends_at_its_time_even_between_ticks(turns: Turns) -> None:
    turns.sleep(25_000_000)
    turns.sleep(1_000_000)
    assert turns.now_ns == 26_000_000
    assert turns.until_ns == 30_000_000


def test_a_wait_ends_when_it_is_ready_or_at_its_deadline(turns: Turns) -> None:
    assert turns.wait(lambda: turns.now_ns >= 2 * TICK_NS, 10 * TICK_NS)
    assert turns.now_ns == 2 * TICK_NS
    assert not turns.wait(lambda: False, 4 * TICK_NS)
    assert turns.now_ns == 4 * TICK_NS


def test_questions_without_a_wait_let_time_pass_in_the_end(turns: Turns) -> None:
    for _ in range(FREE_POLLS):
        turns.poll()
    assert turns.now_ns == 0
    for _ in range(3):
        turns.poll()
    assert turns.now_ns == 3 * POLL_NS


def test_an_interrupt_ends_the_wait_of_the_main_thread() -> None:
    turns = Turns(lambda: turns.interrupt())
    with pytest.raises(KeyboardInterrupt):
        turns.sleep(1)
