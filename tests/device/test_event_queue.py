"""Events that wait: as flags, or one by one."""

from __future__ import annotations

import pytest

from thymio_sim_ros.device.due_time import DueTime
from thymio_sim_ros.device.event_queue import FIRMWARE, MAX_PENDING, PLAYGROUND, POLICIES, EventQueue, GlobalEvent

HELLO = GlobalEvent(0, 2, (7,))
MILLISECOND_NS = 1_000_000


def queue(policy: str) -> EventQueue:
    return EventQueue(POLICIES[policy], (15, 16), DueTime())


def everything(waiting: EventQueue) -> list[int | GlobalEvent]:
    """All events in the order in which they are heard."""
    taken = []
    while waiting.has_events:
        event = waiting.pop()
        if event is not None:
            taken.append(event)
    return taken


@pytest.mark.parametrize(("policy", "heard"), [(FIRMWARE, [5, 6, 14]), (PLAYGROUND, [14, 5, 14, 6])])
def test_local_events_are_flags_on_the_robot_and_one_by_one_in_the_playground(policy: str, heard: list[int]) -> None:
    waiting = queue(policy)
    for index in (14, 5, 14, 6):
        waiting.add_local(index)
    assert everything(waiting) == heard


def test_timers_that_fired_before_come_before_what_arrives_now() -> None:
    waiting = queue(FIRMWARE)
    waiting.advance(0)
    waiting.set_timer_periods([3, 0])
    waiting.advance(10 * MILLISECOND_NS)
    waiting.add_local(5)
    assert everything(waiting) == [15, 15, 15, 5]


def test_global_events_wait_in_line_before_local_ones() -> None:
    waiting = queue(FIRMWARE)
    waiting.add_local(5)
    waiting.add_global(HELLO)
    waiting.add_global(HELLO)
    assert everything(waiting) == [HELLO, HELLO, 5]


def test_there_is_room_for_so_many_global_events() -> None:
    waiting = queue(FIRMWARE)
    assert [waiting.add_global(HELLO) for _ in range(MAX_PENDING + 1)] == [True] * MAX_PENDING + [False]


def test_what_waits_is_forgotten_and_timers_stop() -> None:
    waiting = queue(FIRMWARE)
    waiting.advance(0)
    waiting.set_timer_periods([10, 0])
    waiting.add_local(5)
    waiting.add_global(HELLO)
    waiting.reset()
    waiting.advance(0)
    waiting.advance(100 * MILLISECOND_NS)
    assert everything(waiting) == []


def test_unhandled_timer_events_are_dropped_too() -> None:
    waiting = queue(PLAYGROUND)
    waiting.advance(0)
    waiting.set_timer_periods([10, 0])
    waiting.advance(25 * MILLISECOND_NS)
    assert waiting.pop() == 15
    waiting.advance(30 * MILLISECOND_NS)
    waiting.advance(31 * MILLISECOND_NS)
    waiting.clear()
    assert not waiting.has_events


def test_a_machine_that_stands_still_collects_no_events_without_end() -> None:
    waiting = queue(PLAYGROUND)
    for _ in range(10 * MAX_PENDING):
        waiting.add_local(5)
    assert len(everything(waiting)) == MAX_PENDING
