"""Missions judged live: tries begin with a program, and get the verdict of `thymio-sim mission`."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from thymio_sim_ros.device.programs.program import ThymioProgram, load_program
from thymio_sim_ros.engine.engine import Engine
from thymio_sim_ros.engine.inputs import Controlled
from thymio_sim_ros.files.loading import load_playground, read_program
from thymio_sim_ros.missions import Judge, load_mission
from thymio_sim_ros.missions.description import described, progress
from thymio_sim_ros.missions.live import LiveMission, Trouble
from thymio_sim_ros.missions.shipped import ShippedMission, shipped
from thymio_sim_ros.missions.trial import judged_run, programs_of_others
from thymio_sim_ros.sim.commands import MoveRobot
from thymio_sim_ros.sim.model.fields import FieldError

LESSON = Path(__file__).parents[2] / "docs" / "course" / "1-buttons"
DRIVE = "motor.left.target = 300\nmotor.right.target = 300\n"
HALL = {
    "format": 1,
    "title": "Hall",
    "shapes": [
        {"kind": "rectangle", "name": "floor", "size_x_m": 2.0, "size_y_m": 2.0, "color": "#ffffff"},
        {"kind": "box", "name": "post", "x_m": 0.3, "y_m": 0.0, "size_x_m": 0.1, "size_y_m": 0.1, "height_m": 0.1,
         "color": "#a0a0a0"},
    ],
    "robots": [{"name": "anna", "x_m": 0.0, "y_m": 0.0}, {"name": "bert", "x_m": -0.5, "y_m": 0.0}],
}  # fmt: skip
FACTS = {"far": {"kind": "driven", "distance_m": 0.15}, "bumped": {"kind": "touches", "what": "post"}}


class Live:
    """An engine with a mission, as a simulator runs them."""

    def __init__(self, path: Path) -> None:
        mission = load_mission(path)
        playground = load_playground(mission.playground)[1]
        robots = [robot.name for robot in playground.robots]
        self.engine = Engine(playground, dict.fromkeys(robots, program("")))
        self.mission = LiveMission(mission, self.engine, self.engine.reset)

    def tick(self, ticks: int = 1) -> None:
        for _ in range(ticks):
            self.mission.before_tick()
            self.engine.step()
            self.mission.after_tick()

    def play(self, program: ThymioProgram) -> dict[str, Any]:
        """Load a program, and run until the try is over."""
        self.engine.load(self.mission.robot, program)
        self.tick()
        while self.mission.is_running:
            self.tick()
        return progress(self.mission)


def program(text: str) -> ThymioProgram:
    return load_program(text, "p")


@pytest.fixture
def hall(tmp_path: Path) -> Callable[..., Live]:
    """A mission of anna in a hall."""
    (tmp_path / "hall.json").write_text(json.dumps(HALL))

    def make(**members: Any) -> Live:
        path = tmp_path / "mission.json"
        head = {"format": 1, "title": "A mission", "playground": "hall.json", "facts": FACTS, "success": "far"}
        path.write_text(json.dumps(head | members))
        return Live(path)

    return make


@pytest.mark.parametrize("name", ["solution", "start"])
def test_a_try_gets_the_verdict_and_the_way_of_the_command(name: str) -> None:
    path = LESSON / "mission.json"
    tried = read_program(str(LESSON / "programs" / f"{name}.aesl"))
    mission = load_mission(path)
    engine = Engine(load_playground(mission.playground)[1], {"thymio": tried})
    judge = Judge(mission, engine)
    while not judge.is_over:
        engine.step(())
        judge.tick()
    live = Live(path)
    live.tick(77)  # the pupil has driven around before
    live.engine.load("thymio", program(DRIVE))
    live.tick(123)
    for _ in range(2):
        live.play(tried)
        assert live.mission.judge is not None
        assert live.mission.verdict == judge.verdict
        assert live.mission.judge.trace == judge.trace


def test_nothing_is_judged_before_a_program_runs(hall: Callable[..., Live]) -> None:
    live = hall()
    live.tick(100)
    assert progress(live.mission) == {
        "tries": 0, "trouble": "", "checklist": [["far"]], "done": [False], "state": "waiting", "reason": "",
        "at_s": 0.0, "stars": [], "broken": [], "missing": [], "measured": {}, "trace": [],
    }  # fmt: skip


def test_a_reset_of_the_world_begins_a_try(hall: Callable[..., Live]) -> None:
    live = hall()
    live.tick(100)
    live.engine.reset()
    live.tick(3)
    assert (live.mission.tries, progress(live.mission)["at_s"], live.engine.tick) == (1, 0.03, 3)


def test_a_program_that_was_stopped_begins_a_try_when_it_runs_again(hall: Callable[..., Live]) -> None:
    live = hall()
    live.engine.load("anna", program(DRIVE))
    live.tick(50)
    live.engine.apply(Controlled("anna", "stop"))
    live.tick()
    assert progress(live.mission)["state"] == "waiting"
    live.engine.apply(Controlled("anna", "reset"))
    live.engine.apply(Controlled("anna", "run"))
    live.tick(10)
    assert (live.mission.tries, live.engine.tick) == (2, 10)


def test_a_program_that_was_paused_goes_on(hall: Callable[..., Live]) -> None:
    live = hall()
    live.engine.load("anna", program(DRIVE))
    live.tick(50)
    live.engine.apply(Controlled("anna", "pause"))
    live.engine.apply(Controlled("anna", "run"))
    live.tick(50)
    assert (live.mission.tries, progress(live.mission)["at_s"]) == (1, 1.0)


def test_a_program_of_another_robot_begins_no_try(hall: Callable[..., Live]) -> None:
    live = hall()
    live.engine.load("bert", program(DRIVE))
    live.tick(10)
    assert live.mission.tries == 0


def test_the_way_is_published_when_the_try_is_over(hall: Callable[..., Live]) -> None:
    live = hall()
    live.engine.load("anna", program(DRIVE))
    live.tick(50)
    before = progress(live.mission)
    assert before["trace"] == []
    assert before["measured"]["far"] == [pytest.approx(0.049, abs=0.002), 0.15, "m"]
    found = live.play(program(DRIVE))
    assert (found["state"], found["stars"], found["done"]) == ("passed", [True], [True])
    assert found["trace"][0] == [0.01, 0.0]  # after ten ticks
    assert 0.13 < found["trace"][-1][0] < 0.16


def test_a_failed_try_says_why(hall: Callable[..., Live]) -> None:
    found = hall(success={"all": ["far", {"not": "far"}]}, time_s=3).play(program(""))
    assert (found["reason"], found["missing"]) == ("time", ["far"])
    found = hall(success={"all": ["far", {"not": "far"}]}, failure="bumped").play(program(DRIVE))
    assert (found["state"], found["reason"], found["broken"]) == ("failed", "facts", ["bumped"])


def test_a_robot_that_a_hand_moves_gets_no_star(hall: Callable[..., Live]) -> None:
    live = hall()
    live.engine.post("anna", MoveRobot(0.0, 0.3, 0.0))  # before a try it may
    live.tick()
    live.engine.load("anna", program(DRIVE))
    live.tick(20)
    assert live.mission.is_running
    live.engine.post("anna", MoveRobot(0.0, 0.3, 0.0))
    live.tick(500)
    found = progress(live.mission)
    assert (found["state"], found["reason"], found["stars"]) == ("failed", "hand", [False])
    assert live.play(program(DRIVE))["state"] == "passed"


@pytest.mark.parametrize(
    ("text", "seconds", "trouble"),
    [
        (DRIVE, 2.0, Trouble.NONE),
        (DRIVE, 7.0, Trouble.STUCK),
        ("motor.left.target = 100\nmotor.right.target = -100", 9.0, Trouble.NONE),
        ("var a = 1", 6.0, Trouble.NONE),
        ("var a = 1", 9.0, Trouble.IDLE),
        ("call leds.top(32, 0, 0)", 9.0, Trouble.NONE),
    ],
)
def test_trouble_is_noticed(hall: Callable[..., Live], text: str, seconds: float, trouble: Trouble) -> None:
    live = hall(success={"all": ["far", {"not": "far"}]})
    live.engine.load("anna", program(text))
    live.tick(round(seconds * 100))
    assert live.mission.trouble is trouble


def test_a_fallen_robot_is_noticed(hall: Callable[..., Live]) -> None:
    live = hall(success={"all": ["far", {"not": "far"}]}, robot="bert")
    live.engine.load("bert", program("motor.left.target = -300\nmotor.right.target = -300"))
    live.tick(700)
    assert live.mission.trouble is Trouble.FALLEN


def test_a_mission_that_does_not_fit_its_playground_changes_nothing(hall: Callable[..., Live]) -> None:
    live = hall(happens=[{"at_s": 0, "press": "forward"}])
    before = live.engine.digest()
    other = replace(live.mission.mission, robot="carl")
    with pytest.raises(FieldError, match="'carl'"):
        LiveMission(other, live.engine, live.engine.reset)
    LiveMission(live.mission.mission, live.engine, live.engine.reset)
    live.engine.step()
    assert live.engine.digest() != before  # time has passed
    assert live.engine.world.read("anna", "buttons").words == (0, 0, 0, 0, 0)


def test_the_description_has_what_a_pupil_needs() -> None:
    found = described(load_mission(LESSON / "mission.json"))
    assert found["zones"]["bay"] == {
        "kind": "rectangle", "x_m": 0.3, "y_m": 0.265, "size_x_m": 0.2, "size_y_m": 0.23,
    }  # fmt: skip
    assert found["programs"]["vpl"].startswith("<")
    assert json.loads(json.dumps(found)) == found


SOLVED = [
    pytest.param(each, language, id=f"{each.name}-{language}", marks=[pytest.mark.slow] if at % 4 else [])
    for at, (each, language) in enumerate(
        (each, language)
        for step in shipped()
        for each in step.missions
        for language in each.mission.solutions
        if language != "ros"
    )
]


@pytest.mark.parametrize(("shipped_one", "language"), SOLVED)
def test_a_shipped_mission_gets_live_what_it_gets_headless(shipped_one: ShippedMission, language: str) -> None:
    mission = shipped_one.mission
    solution = mission.solutions[language]
    judge = judged_run(mission, solution)
    assert all(judge.verdict.stars)
    playground = load_playground(mission.playground)[1]
    engine = Engine(playground, behaviour="menu")  # as robots without a program are on the page
    live = LiveMission(mission, engine, engine.reset)
    for robot, other in programs_of_others(mission, playground).items():
        engine.load(robot, other)
    for name in engine.hosts:
        engine.apply(Controlled(name, "stop"))
    engine.load(live.robot, read_program(solution))
    live.before_tick()
    while live.is_running:
        engine.step()
        live.after_tick()
        live.before_tick()
    assert live.judge is not None
    assert live.verdict == judge.verdict
    assert live.judge.trace == judge.trace
