"""Turns of two threads."""

from __future__ import annotations

import threading

from thymio_sim_ros.bridge.turn import Turn

DEADLINE_S = 20.0


def test_a_turn_is_taken_only_when_it_is_free() -> None:
    turn = Turn()
    assert turn.take()
    assert not turn.take()
    turn.give_back()
    with turn:
        assert not turn.take()
    assert turn.take()


def test_nobody_takes_a_turn_for_which_another_waits() -> None:
    turn = Turn()
    has_it, may_end = threading.Event(), threading.Event()

    def wait_for_it() -> None:
        with turn:
            has_it.set()
            assert may_end.wait(DEADLINE_S)

    assert turn.take()
    waiter = threading.Thread(target=wait_for_it)
    waiter.start()
    while not has_it.is_set():  # as often as one likes, once it waits no more
        turn.give_back()
        if not turn.take():
            break
    assert has_it.wait(DEADLINE_S)
    assert not turn.take()
    may_end.set()
    waiter.join()
    assert turn.take()
