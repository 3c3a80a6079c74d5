"""The past of one robot."""

from __future__ import annotations

from thymio_sim_ros.sim.commands import BodyTwist, MoveRobot
from thymio_sim_ros.testing import Classroom, Event


def test_a_thing_that_is_left_and_met_again_is_touched_twice() -> None:
    room = Classroom("base", noise=False)
    (thymio,) = room
    for _ in range(2):
        thymio.post(MoveRobot(0.0, 0.0, 0.0))
        room.run(0.05)
        thymio.post(BodyTwist(0.15, 0.0))
        room.until(lambda: thymio.touching, 20.0)
    assert [touch.other for touch in thymio.touches] == ["east wall", "east wall"]
    assert thymio.touches[0].at_s < thymio.touches[1].at_s


def test_what_is_touched_all_the_time_is_touched_once_in_each_run() -> None:
    room = Classroom("base", "motor.left.target = 200\nmotor.right.target = 200", noise=False)
    (thymio,) = room
    runs = []
    for _ in range(2):
        thymio.post(MoveRobot(0.3, 0.0, 0.0))
        room.until(lambda: thymio.touching, 20.0)
        room.run(0.5)
        runs.append(list(thymio.touches))
        room.reset()
    assert len(runs[0]) == 1
    assert runs[0] == runs[1]


def test_what_is_touched_when_the_past_is_forgotten_is_touched_anew() -> None:
    room = Classroom("base", "motor.left.target = 200\nmotor.right.target = 200", noise=False)
    (thymio,) = room
    room.until(lambda: thymio.touching, 60.0)
    thymio.record.clear()
    room.run(0.1)
    assert [touch.other for touch in thymio.touches] == ["east wall"]


def test_moments_are_returned_from_a_time_on_and_cleared() -> None:
    (thymio,) = Classroom("base")
    thymio.run(0.1)
    thymio.record.add_event("ping", [1, 2], 150_000_000)
    assert [round(moment.at_s, 2) for moment in thymio.record.since(0.08)] == [0.08, 0.09, 0.1]
    assert thymio.events == [Event(0.15, "ping", (1, 2))]
    thymio.record.clear()
    assert (thymio.path, thymio.events, thymio.touches) == ([], [], [])
