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
    assert [touch.other for touch in thymio.touches] == ["ground", "ground"]
    assert thymio.touches[0].at_s < thymio.touches[1].at_s


def test_moments_are_told_from_a_time_on_and_forgotten() -> None:
    (thymio,) = Classroom("base")
    thymio.run(0.1)
    thymio.record.hear("ping", [1, 2], 50_000_000)
    assert [round(moment.at_s, 2) for moment in thymio.record.since(0.08)] == [0.08, 0.09, 0.1]
    assert thymio.events == [Event(0.05, "ping", (1, 2))]
    thymio.record.clear()
    assert (thymio.path, thymio.events, thymio.touches) == ([], [], [])
