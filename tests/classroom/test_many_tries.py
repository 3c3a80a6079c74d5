"""Pupils who try a mission often and get no further."""

from __future__ import annotations

from thymio_sim_ros.classroom.many_tries import MANY_TRIES, TryHistory
from thymio_sim_ros.classroom.suite_state import MissionTry


def play(history: TryHistory, number: int, *, done: int = 0, passes: bool = False, mission: str = "bay") -> None:
    """A whole try."""
    history.add(MissionTry(mission, number, False, 0, 0.0, ""))
    history.add(MissionTry(mission, number, passes, int(passes), 3.0, "", done=done, is_over=True))


def test_many_tries_in_vain_are_stuck_and_fewer_are_not() -> None:
    history = TryHistory()
    for number in range(1, MANY_TRIES):
        play(history, number)
    history.add(MissionTry("bay", MANY_TRIES, False, 0, 0.0, ""))
    assert not history.is_stuck
    play(history, MANY_TRIES)
    assert history.is_stuck


def test_a_line_more_of_the_checklist_is_progress_and_the_same_again_is_not() -> None:
    history = TryHistory()
    for number in range(1, 20):
        play(history, number, done=number // 3)
        assert not history.is_stuck
    for number in range(20, 20 + MANY_TRIES):
        play(history, number, done=6)
    assert history.is_stuck
    history.add(MissionTry("bay", 30, False, 0, 1.0, "", done=7))
    assert not history.is_stuck


def test_a_try_that_passes_or_another_mission_ends_it() -> None:
    history = TryHistory()
    for number in range(1, 10):
        play(history, number)
    play(history, 10, passes=True)
    assert not history.is_stuck
    for number in range(11, 20):  # for more stars
        play(history, number)
    assert not history.is_stuck
    play(history, 1, mission="wall")
    assert history.in_vain == 1
    history.add(MissionTry("wall", 0, False, 0, 0.0, ""))  # opened anew
    assert history.in_vain == 0


def test_stopping_a_try_counts_when_the_next_one_begins() -> None:
    history = TryHistory()
    for number in range(1, MANY_TRIES + 1):
        history.add(MissionTry("bay", number, False, 0, 0.0, ""))
    assert not history.is_stuck
    history.add(MissionTry("bay", MANY_TRIES + 1, False, 0, 0.0, ""))
    assert history.is_stuck
