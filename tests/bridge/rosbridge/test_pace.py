"""The throttle and the queue of a subscription."""

from __future__ import annotations

from thymio_sim_ros.bridge.rosbridge.pace import Pace


def _sent(pace: Pace[int], offers: dict[float, int], until_s: float) -> list[tuple[float, int]]:
    """What is sent, and when, if `due` is called every 0.5 s."""
    found = []
    for step in range(int(2 * until_s)):
        now_s = step / 2
        due = pace.offer(offers[now_s], now_s) if now_s in offers else pace.due(now_s)
        if due is not None:
            found.append((now_s, due))
    return found


EVERY_HALF_SECOND = {step / 2: step for step in range(8)}


def test_without_a_throttle_everything_is_sent_at_once() -> None:
    assert _sent(Pace(0.0, 3), EVERY_HALF_SECOND, 10) == [(step / 2, step) for step in range(8)]


def test_without_a_queue_messages_within_the_throttle_are_dropped() -> None:
    assert _sent(Pace(1.0, 0), EVERY_HALF_SECOND, 10) == [(0.0, 0), (1.0, 2), (2.0, 4), (3.0, 6)]


def test_with_a_queue_the_last_messages_are_sent_later_in_order() -> None:
    pace: Pace[int] = Pace(1.0, 2)
    assert _sent(pace, EVERY_HALF_SECOND, 10) == [(0.0, 0), (1.0, 1), (2.0, 2), (3.0, 4), (4.0, 6), (5.0, 7)]
    assert not pace.is_waiting
