"""Missions judged on an engine: facts, checklist, stars."""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import pytest

from thymio_sim_ros.device.programs.program import load_program
from thymio_sim_ros.engine.engine import Engine
from thymio_sim_ros.files.loading import load_playground
from thymio_sim_ros.missions import Judge, MissionError, State, Verdict, load_mission
from thymio_sim_ros.sim.commands import MoveRobot
from thymio_sim_ros.sim.model.fields import FieldError

PLAYGROUND = {
    "format": 1,
    "title": "Hall",
    "shapes": [
        {"kind": "rectangle", "name": "floor", "size_x_m": 2.0, "size_y_m": 2.0, "color": "#ffffff"},
        {"kind": "box", "name": "post", "x_m": 0.3, "y_m": 0.0, "size_x_m": 0.1, "size_y_m": 0.1, "height_m": 0.1,
         "color": "#a0a0a0"},
    ],
    "robots": [{"name": "anna", "x_m": 0.0, "y_m": 0.0}, {"name": "bert", "x_m": -0.5, "y_m": 0.0}],
}  # fmt: skip
DRIVE = "motor.left.target = 300\nmotor.right.target = 300\n"
HEAD = {"format": 1, "title": "A mission", "playground": "hall.json"}

Run = Callable[..., Verdict]


@pytest.fixture
def mission(tmp_path: Path) -> Callable[..., Path]:
    """Write a mission with some facts."""
    (tmp_path / "hall.json").write_text(json.dumps(PLAYGROUND))

    def write(facts: Mapping[str, Any], **members: Any) -> Path:
        path = tmp_path / "mission.json"
        path.write_text(json.dumps(HEAD | {"facts": facts, "success": next(iter(facts))} | members))
        return path

    return write


@pytest.fixture
def run(mission: Callable[..., Path]) -> Run:
    """Judge a program of anna."""

    def run(program: str, facts: Mapping[str, Any], *, do: Callable[[Engine], object] = id, **members: Any) -> Verdict:
        loaded = load_mission(mission(facts, **members))
        engine = Engine(load_playground(loaded.playground)[1], {"anna": load_program(program, "p")}, noise=False)
        judge = Judge(loaded, engine)
        do(engine)
        while not judge.is_over:
            engine.step(())
            judge.tick()
        return judge.verdict

    return run


@pytest.mark.parametrize(
    ("program", "fact", "at_s"),
    [
        (DRIVE, {"kind": "inside", "zone": "ahead"}, 1.0),
        (DRIVE, {"kind": "touches", "what": "post"}, 2.0),
        (DRIVE, {"kind": "touches"}, 2.0),
        (DRIVE, {"kind": "driven", "distance_m": 0.1}, 1.3),
        (DRIVE, {"kind": "faster", "speed_m_s": 0.08}, 0.3),
        (DRIVE.replace("300", "-300"), {"kind": "faster", "speed_m_s": 0.08, "direction": "backward"}, 0.3),
        ("motor.left.target = 100\nmotor.right.target = -100", {"kind": "turns", "direction": "right"}, 0.3),
        ("call leds.top(0, 32, 0)", {"kind": "lights", "color": "green"}, 0.1),
        ("call sound.freq(440, 60)", {"kind": "sound"}, 0.1),
        ("", {"kind": "still"}, 0.1),
        ("motor.left.target = -100\nmotor.right.target = 100", {"kind": "heading", "direction_deg": 90}, 3.0),
    ],
)
def test_a_fact_becomes_true_when_it_happens(run: Run, program: str, fact: Any, at_s: float) -> None:
    zones = {"ahead": {"kind": "disc", "x_m": 0.1, "y_m": 0.0, "radius_m": 0.05}}
    found = run(program, {"goal": fact}, zones=zones, time_s=10)
    assert found.state is State.PASSED
    assert found.at_s <= at_s + 0.5
    assert run("motor.left.target = 20", {"goal": fact | {"robot": "bert"}}, zones=zones, time_s=1).state is (
        State.PASSED if fact["kind"] == "still" else State.FAILED
    )


def test_an_event_counts_in_the_tick_in_which_the_program_of_that_robot_emits_it(run: Run) -> None:
    code = "timer.period[0] = 500\nonevent timer0\nemit done"
    aesl = f'<network><event size="0" name="done"/><node name="thymio-II">{code}</node></network>'
    fact = {"kind": "emits", "event": "done"}
    assert run(aesl, {"done": fact}, time_s=2).at_s == pytest.approx(0.5, abs=0.03)
    assert run(aesl, {"done": fact | {"robot": "bert"}}, time_s=2).is_late


def test_what_breaks_the_mission_is_named_and_the_checklist_stays(run: Run) -> None:
    facts = {
        "there": {"kind": "inside", "zone": "far"},
        "green": {"kind": "lights", "color": "green"},
        "crash": {"kind": "touches"},
    }
    zones = {"far": {"kind": "rectangle", "x_m": 0.8, "y_m": 0.0, "size_x_m": 0.2, "size_y_m": 0.2}}
    program = f"call leds.top(0, 32, 0)\n{DRIVE}"
    found = run(program, facts, zones=zones, success={"all": ["there", "green"]}, failure={"any": ["crash"]})
    assert (found.state, found.broken, found.is_late) == (State.FAILED, ("crash",), False)
    assert [(item.facts, item.is_done) for item in found.checklist] == [(("there",), False), (("green",), True)]
    assert found.stars == (False,)


def test_further_stars_are_for_time_length_and_a_condition(run: Run) -> None:
    facts = {"driven": {"kind": "driven", "distance_m": 0.1}, "red": {"kind": "lights", "color": "red"}}
    in_time = run(DRIVE, facts, stars=[{"within_s": 3}, {"length": 2}])
    assert in_time.stars == (True, True, True)
    late = run(DRIVE, facts, stars=[{"within_s": 0.5}, {"length": 1}])
    assert late.stars == (True, False, False)
    extra = {"once": "red"}
    assert run(DRIVE, facts, stars=[{"when": extra}]).stars == (True, False)
    assert run(f"call leds.top(32, 0, 0)\n{DRIVE}", facts, stars=[{"when": extra}]).stars == (True, True)


def test_what_happens_in_a_mission_is_done_to_the_robot_at_its_time(run: Run) -> None:
    program = "onevent button.center\nif button.center == 1 then\ncall leds.top(0, 0, 32)\nend"
    happens = [{"at_s": 1.5, "release": "center"}, {"at_s": 1.0, "press": "center"}]
    facts = {"blue": {"kind": "lights", "color": "blue"}}
    assert run(program, facts, happens=happens).at_s == pytest.approx(1.0, abs=0.05)


def test_a_lap_is_counted_and_a_lost_line_noticed(mission: Callable[..., Path]) -> None:
    facts = {"lap": {"kind": "lap"}, "lost": {"kind": "off_line"}}
    loaded = load_mission(mission(facts, playground="line", failure="lost", time_s=5))
    engine = Engine(load_playground("line")[1], {})
    judge = Judge(loaded, engine)
    engine.post(judge.robot, MoveRobot(0.0, 0.0, 0.0))
    while not judge.is_over:
        engine.step(())
        judge.tick()
    assert judge.verdict.broken == ("lost",)


def test_the_same_run_gets_the_same_verdict_and_trace_twice(mission: Callable[..., Path]) -> None:
    found = []
    for _ in range(2):
        loaded = load_mission(mission({"driven": {"kind": "driven", "distance_m": 0.15}}))
        engine = Engine(load_playground(loaded.playground)[1], {"anna": load_program(DRIVE, "p")}, seed=7)
        judge = Judge(loaded, engine)
        while not judge.is_over:
            engine.step(())
            judge.tick()
        found.append((judge.verdict, judge.trace))
    assert found[0] == found[1]
    assert len(found[0][1]) > 5


@pytest.mark.parametrize(
    ("facts", "members", "error"),
    [
        ({"a": {"kind": "inside", "zone": "x"}}, {}, "facts.a.zone: found 'x'"),
        ({"a": {"kind": "touches", "what": "pots"}}, {}, "facts.a.what: found 'pots', expected 'post'"),
        ({"a": {"kind": "still", "robot": "carl"}}, {}, "facts.a.robot: found 'carl', expected one of anna, bert"),
        ({"a": {"kind": "lap", "track": "x"}}, {}, "facts.a.track: found 'x'"),
        ({"a": {"kind": "still"}}, {"robot": "carl"}, "facts.a.robot: found 'carl'"),
        ({"a": {"kind": "still"}}, {"happens": [{"at_s": 1, "tap": True, "robot": "carl"}]}, r"happens\[0\].robot"),
    ],
)
def test_names_that_the_playground_lacks_are_refused_before_the_run(
    mission: Callable[..., Path], facts: Any, members: Any, error: str
) -> None:
    loaded = load_mission(mission(facts, **members))
    with pytest.raises(FieldError, match=error):
        Judge(loaded, Engine(load_playground(loaded.playground)[1]))


STILL = {"a": {"kind": "still"}}


@pytest.mark.parametrize(
    ("facts", "members", "error"),
    [
        (STILL, {"format": 2}, "format: found 2, expected 1"),
        (STILL, {"stories": "x"}, "stories: found an unknown key, expected 'story'"),
        (STILL, {"title": 3}, "title: found 3"),
        ({"a": {"kind": "inner"}}, {}, "facts.a.kind: found 'inner', expected one of inside"),
        ({"a": {"kind": "driven"}}, {}, "facts.a.distance_m: found nothing, expected a number of m"),
        ({"a": {"kind": "lights", "color": "pink"}}, {}, "facts.a.color: found 'pink', expected one of off, red"),
        ({"a b": {"kind": "still"}}, {}, "facts.a b: found this name"),
        (STILL, {"success": "b"}, "success: found 'b'"),
        (STILL, {"failure": {"all": ["b"]}}, r"failure.all\[0\]: found 'b'"),
        (STILL, {"zones": {"z": {"kind": "disc", "x_m": 0, "y_m": 0}}}, "zones.z.radius_m: found nothing"),
        (STILL, {"happens": [{"at_s": 1}]}, r"happens\[0\]: found nothing, expected one of press"),
        (STILL, {"happens": [{"at_s": 1, "press": "up"}]}, r"happens\[0\].press: found 'up'"),
        (STILL, {"stars": [{}]}, r"stars\[0\]: found nothing, expected one of within_s"),
        (STILL, {"stars": [{"within_s": 1}] * 3}, "stars: found"),
        (STILL, {"languages": ["vpl3"]}, r"languages\[0\]: found 'vpl3', expected 'vpl'"),
        (STILL, {"languages": ["text"], "programs": {"vpl": "a.aesl"}}, "programs.vpl: found an unknown language"),
        (STILL, {"translations": {"german": {}}}, "translations.german: found 'german'"),
        (STILL, {"translations": {"de": {"facts": {"b": "x"}}}}, "translations.de.facts.b: found an unknown fact"),
        (STILL, {"hints": ["one\ntwo"]}, r"hints\[0\]: found"),
        (
            STILL,
            {"languages": ["text", "vpl", "text"]},
            r"languages\[2\]: found 'text' again, expected each language once",
        ),
        (
            {f"a{number}": {"kind": "still"} for number in range(10_000)},
            {},
            "facts: found 10000 of them, expected at most 50",
        ),
        (STILL, {"time_s": math.nan}, "line .*: found NaN, expected finite numbers"),
        (STILL, {"time_s": math.inf}, "line .*: found Infinity, expected finite numbers"),
        (STILL, {"time_s": 10**400}, "time_s: found 1000"),
        (STILL, {"stars": [{"within_s": 10**400}]}, r"stars\[0\].within_s: found 1000"),
        (STILL, {"happens": [{"at_s": -1, "tap": True}]}, r"happens\[0\].at_s: found -1"),
        (STILL, {"success": {"hold": "a", "for_s": 10**400}}, "success.for_s: found 1000"),
    ],
)
def test_a_file_that_is_wrong_names_the_field(
    mission: Callable[..., Path], facts: Any, members: Any, error: str
) -> None:
    with pytest.raises(MissionError, match=f"mission.json: {error}"):
        load_mission(mission(facts, **members))


@pytest.mark.parametrize(
    "text", ["", "[]", "{", "\xff", "[" * 100_000, '{"format": 1, "title": ' + "[" * 900 + "]" * 900 + "}"]
)
def test_a_file_that_is_no_mission_is_refused(tmp_path: Path, text: str) -> None:
    path = tmp_path / "mission.json"
    path.write_bytes(text.encode("latin-1"))
    with pytest.raises(MissionError, match=r"mission\.json: "):
        load_mission(path)


def test_a_name_that_is_there_twice_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "mission.json"
    path.write_text('{"format": 1,\n "facts": {"a": {"kind": "still"}, "a": {"kind": "fallen"}}}')
    with pytest.raises(MissionError, match="line 2, column 36: found the duplicate key 'a', expected unique keys"):
        load_mission(path)
