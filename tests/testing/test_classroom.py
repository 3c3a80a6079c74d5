"""A classroom: robots and programs in lock-step, seen and touched by a test."""

from __future__ import annotations

from pathlib import Path

import pytest

from thymio_sim_ros.device.programs.program import ProgramError
from thymio_sim_ros.files.resources import ResourceError
from thymio_sim_ros.sim.model.geometry import Pose
from thymio_sim_ros.testing import Classroom, Event

DRIVE = "motor.left.target = 200\nmotor.right.target = 200"
GREET = """<!DOCTYPE aesl-source>
<network>
<event size="2" name="hello"/>
<node nodeId="1" name="thymio-II">var heard = 0
onevent hello
heard = event.args[1]
onevent button.center
if button.center == 1 then
    emit hello [1, 7]
end
</node>
</network>
"""


TWO = """<network>
<event name="tick" size="1"/>
<node nodeId="1" name="red">var sent = 1</node>
<node nodeId="2" name="blue">var got = 2</node>
<node nodeId="3" name="green">var lost = 3</node>
</network>"""


def test_each_robot_runs_the_node_with_its_name(caplog):
    room = Classroom("two_robots", TWO)
    assert room["red"].variables["sent"] == 1
    assert room["blue"].variables["got"] == 2
    assert caplog.messages == ["program: red, blue: no robot is left for node 'green' 3"]


def test_a_program_that_is_loaded_later_is_that_of_the_robot(tmp_path):
    (tmp_path / "two.aesl").write_text(TWO)
    room = Classroom("two_robots", {"blue": "two.aesl"}, folder=tmp_path)
    room["red"].load("two.aesl")
    assert (room["red"].variables["sent"], room["blue"].variables["got"]) == (1, 2)


def test_a_program_drives_the_robot() -> None:
    room = Classroom(programs=DRIVE)
    (thymio,) = room
    room.run(1.0)
    assert room.now == 1.0
    assert thymio.pose.x_m > 0.04
    assert thymio["motor.left.target"] == 200


def test_the_same_seed_gives_the_same_run_and_another_one_another() -> None:
    def end(seed: int) -> Pose:
        room = Classroom("obstacle", "explorer", seed=seed)
        room.run(5.0)
        return next(iter(room)).pose

    assert end(1) == end(1) != end(2)


def test_a_reset_begins_anew_and_forgets() -> None:
    room = Classroom(programs=DRIVE)
    (thymio,) = room
    room.run(1.0)
    path = list(thymio.path)
    room.reset()
    assert (room.now, thymio.path) == (0.0, [])
    room.run(1.0)
    assert thymio.path == path


def test_robots_hear_each_other_s_events_and_the_test_hears_all() -> None:
    room = Classroom("two_robots", GREET)
    names = list(room.robots)
    first, second = (room[name] for name in names)
    first.touch("center")
    assert [(event.name, event.args) for event in first.events] == [("hello", (1, 7))]
    assert 0.0 < first.events[0].at_s <= 0.2
    assert (first["heard"], second["heard"]) == (0, 7)
    assert second.events == []


def test_each_robot_may_have_a_program_of_its_own() -> None:
    names = list(Classroom("two_robots").robots)
    room = Classroom("two_robots", {names[1]: DRIVE})
    begin = [thymio.pose for thymio in room]
    room.run(0.5)
    assert [thymio.pose != pose for thymio, pose in zip(room, begin, strict=True)] == [False, True]


def test_an_event_from_outside_reaches_the_programs() -> None:
    room = Classroom(programs=GREET)
    (thymio,) = room
    thymio.emit("hello", 3, 4)
    room.run(0.01)
    assert thymio["heard"] == 4
    with pytest.raises(LookupError, match="no program declares the event 'helo', only hello"):
        thymio.emit("helo")


def test_a_program_that_is_loaded_later_begins_at_once() -> None:
    room = Classroom()
    (thymio,) = room
    room.run(0.5)
    thymio.load('<network><event size="0" name="begun"/><node name="thymio-II">emit begun</node></network>')
    assert thymio.events == [Event(0.5, "begun", ())]


def test_files_beside_the_test_are_found_first(tmp_path: Path) -> None:
    (tmp_path / "mine.aesl").write_text(GREET)
    room = Classroom(programs="mine.aesl", folder=tmp_path)
    program = next(iter(room)).program
    assert program is not None
    assert program.name == "mine.aesl"
    (tmp_path / "hall.json").write_text('{"format": 1, "title": "Hall", "robots": [{"name": "a", "x_m": 0, "y_m": 1}]}')
    assert list(Classroom("hall.json", folder=tmp_path).robots) == ["a"]


@pytest.mark.parametrize(
    ("program", "error", "text"),
    [
        ("missing.aesl", ResourceError, "no program 'missing.aesl'"),
        (Path("missing file.aesl"), ResourceError, "no program 'missing file.aesl'"),
        ("motor.left.target = ", ProgramError, "line 1, column 20"),
        ("explorr", ResourceError, "did you mean 'explorer'"),
    ],
)
def test_the_error_of_an_invalid_program_says_what_is_wrong(
    program: str | Path, error: type[Exception], text: str
) -> None:
    with pytest.raises(error, match=text):
        Classroom(programs=program)


def test_an_unknown_robot_is_named_with_those_there_are() -> None:
    room = Classroom("two_robots")
    name = next(iter(room.robots))
    with pytest.raises(KeyError, match=f"did you mean '{name}'"):
        room[name[:-1]]
    with pytest.raises(KeyError, match="no robot 'x', only"):
        Classroom("two_robots", {"x": DRIVE})


def test_a_time_out_reports_poses_and_the_failed_line() -> None:
    room = Classroom(
        programs="var a = 0\nmotor.left.target = 100\nonevent timer0\na = 1 / a\nonevent buttons\na = 1 / a"
    )
    with pytest.raises(pytest.fail.Exception) as caught:
        room.until(lambda: room.now < 0, 0.5)
    assert room.now == 0.5
    assert str(caught.value).splitlines() == [
        "not within 0.5 simulated s: room.now < 0",
        "thymio: at (0.000, 0.000) m, turned 0°, 0.000 m/s",
        "  program program: fault in buttons, line 6: division by zero",
    ]


def test_a_condition_s_value_is_given_back() -> None:
    room = Classroom(programs=GREET)
    (thymio,) = room
    thymio.press("center")
    assert room.until(lambda: thymio.events, 1.0)[0].name == "hello"
