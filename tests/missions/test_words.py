"""Words of missions: what happens, messages and sounds, amounts, what is missing, zones that cannot be reached."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import pytest

from thymio_sim_ros.missions import Judge, MissionError, State, load_mission
from thymio_sim_ros.missions.facts import Measured
from thymio_sim_ros.missions.trial import judged_run
from thymio_sim_ros.sim.model.fields import FieldError

PLAYGROUND = {
    "format": 1,
    "title": "Hall",
    "shapes": [
        {"kind": "rectangle", "name": "floor", "size_x_m": 2.0, "size_y_m": 2.0, "color": "#ffffff"},
        {"kind": "box", "name": "pillar", "x_m": 0.0, "y_m": 0.6, "size_x_m": 0.4, "size_y_m": 0.4, "height_m": 0.1,
         "color": "#a0a0a0"},
        {"kind": "cylinder", "name": "can", "x_m": 0.6, "y_m": -0.6, "radius_m": 0.03, "height_m": 0.1,
         "color": "#a02020", "mass_kg": 0.1},
    ],
    "robots": [{"name": "anna", "x_m": 0.0, "y_m": 0.0}, {"name": "bert", "x_m": -0.3, "y_m": 0.0}],
}  # fmt: skip
DRIVE = "motor.left.target = 300\nmotor.right.target = 300\n"
CALL = "call prox.comm.enable(1)\nprox.comm.tx = 7\n"
ANSWER = f"{CALL}onevent prox.comm\nif prox.comm.rx == 7 then\ncall leds.top(0,32,0)\nend"

Play = Callable[..., Judge]


@pytest.fixture
def play(tmp_path: Path) -> Play:
    """Judge a program of anna by a mission with these facts."""
    (tmp_path / "hall.json").write_text(json.dumps(PLAYGROUND))

    def play(program: str, facts: Mapping[str, Any], **members: Any) -> Judge:
        mission = {"format": 1, "title": "A mission", "playground": "hall.json", "time_s": 5, "facts": facts}
        (tmp_path / "mission.json").write_text(json.dumps(mission | {"success": next(iter(facts))} | members))
        (tmp_path / "anna.aesl").write_text(program)
        return judged_run(load_mission(tmp_path / "mission.json"), str(tmp_path / "anna.aesl"))

    return play


def test_a_message_is_sent_and_received_by_a_robot_with_a_program_of_its_own(play: Play, tmp_path: Path) -> None:
    (tmp_path / "bert.aesl").write_text(
        f"{CALL}onevent prox.comm\nif prox.comm.rx == 7 then\ncall leds.top(0,32,0)\nend"
    )
    facts = {
        "sent": {"kind": "sends", "value": 7},
        "got": {"kind": "receives", "value": 7, "robot": "bert"},
        "green": {"kind": "lights", "color": "green", "robot": "bert"},
    }
    success = {"all": ["sent", "got", "green"]}
    assert play(CALL, facts, success=success, robots={"bert": "bert.aesl"}).verdict.is_passed
    assert play("", facts, success=success, robots={"bert": "bert.aesl"}).verdict.is_late
    assert play(CALL.replace("7", "8"), facts, success=success, robots={"bert": "bert.aesl"}).verdict.is_late


def test_a_clap_is_heard_and_the_hand_seen(play: Play) -> None:
    happens = [{"at_s": 1, "clap": 200}, {"at_s": 2, "hand": "center"}, {"at_s": 3, "hand": "away"}]
    facts = {
        "clap": {"kind": "hears", "loudness": 100},
        "near": {"kind": "reads", "variable": "prox.horizontal", "index": 2, "at_least": 3000},
        "gone": {"kind": "reads", "variable": "prox.horizontal", "index": 2, "at_most": 1000},
        "left": {"kind": "reads", "variable": "prox.horizontal", "index": 0, "at_least": 1000},
    }
    success = {"then": ["gone", "clap", "near", "gone"]}
    found = play("onevent prox\n", facts, happens=happens, success=success, failure="left")
    assert found.verdict.is_passed
    assert 3.0 <= found.verdict.at_s <= 3.3


def test_an_object_is_moved_and_a_place_that_is_occupied_is_waited_for(play: Play) -> None:
    facts = {"bump": {"kind": "touches", "what": "can"}}
    happens = [{"at_s": 0.5, "move": "can", "x_m": 0.25, "y_m": 0.0}]
    assert play(DRIVE, facts, happens=happens).verdict.is_passed
    assert play(DRIVE, facts).verdict.is_late
    onto_anna = [{"at_s": 0.0, "move": "can", "x_m": 0.0, "y_m": 0.0}]
    assert play(DRIVE, facts, happens=onto_anna).verdict.is_late


def test_what_is_missing_has_its_amount(play: Play) -> None:
    facts = {
        "driven": {"kind": "driven", "distance_m": 9},
        "red": {"kind": "lights", "color": "red"},
        "count": {"kind": "reads", "variable": "count", "at_least": 3},
    }
    found = play(f"var count = 2\n{DRIVE}", facts, success={"then": ["driven", "red"]}, time_s=4)
    assert found.missing() == ("driven",)
    measured = found.measured()
    assert measured["count"] == Measured(2, 3, "")
    assert (measured["driven"].goal, measured["driven"].unit) == (9, "m")
    assert 0.3 < measured["driven"].value < 0.5
    assert "red" not in measured
    found = play(f"var count = 2\n{DRIVE}", facts, success={"all": ["driven", "red"]}, time_s=4)
    assert found.missing() == ("driven", "red")


def test_a_program_without_the_variable_does_not_reach_the_fact(play: Play) -> None:
    found = play(DRIVE, {"count": {"kind": "reads", "variable": "count", "at_least": 0}})
    assert found.verdict.state is State.FAILED
    assert found.measured() == {}


INSIDE = {"there": {"kind": "inside", "zone": "z"}}
DISC = {"kind": "disc", "x_m": 0, "y_m": 0.6, "radius_m": 0.1}
SMALL = {"kind": "rectangle", "size_x_m": 0.1, "size_y_m": 0.1}


@pytest.mark.parametrize(
    ("facts", "members", "error"),
    [
        (INSIDE, {"zones": {"z": SMALL | {"x_m": 3, "y_m": 0}}}, "zones.z: found a zone without ground"),
        (INSIDE, {"zones": {"z": SMALL | {"x_m": 0, "y_m": 0.6}}}, "zones.z: found a zone inside of 'pillar'"),
        (INSIDE, {"zones": {"z": DISC}}, "zones.z: found a zone inside"),
        ({"a": {"kind": "still"}}, {"robots": {"anna": "anna.aesl"}}, "robots.anna: found 'anna', expected another"),
        ({"a": {"kind": "still"}}, {"robots": {"carl": "anna.aesl"}}, "robots.carl: found 'carl'"),
        ({"a": {"kind": "still"}}, {"happens": [{"at_s": 1, "move": "pillar", "x_m": 0, "y_m": 0}]},
         r"happens\[0\].move: found 'pillar', expected a movable object"),
        ({"a": {"kind": "reads", "variable": "x", "at_least": 2, "at_most": 1}}, {}, "facts.a.at_least: found 2"),
    ],
)  # fmt: skip
def test_a_mission_that_does_not_fit_its_playground_is_refused(
    play: Play, facts: Any, members: Any, error: str
) -> None:
    with pytest.raises(FieldError, match=error):
        play("", facts, **members)


@pytest.mark.parametrize("zone", [{"x_m": 0.2, "y_m": 0.6}, {"x_m": 0, "y_m": 0}, {"x_m": 0.99, "y_m": 0.9}])
def test_a_zone_that_is_partly_free_is_accepted(play: Play, zone: Any) -> None:
    wide = {"kind": "rectangle", "size_x_m": 0.4, "size_y_m": 0.3}
    assert play("", INSIDE, zones={"z": wide | zone}).verdict is not None


@pytest.mark.parametrize(
    ("members", "error"),
    [
        (
            {"happens": [{"at_s": 1, "hand": "front"}]},
            r"happens\[0\].hand: found 'front', expected one of left, center_left",
        ),
        ({"happens": [{"at_s": 1, "move": "can"}]}, r"happens\[0\]: found 'can' without a place, expected x_m and y_m"),
        ({"toolbox": {"hides": ["move"]}}, "toolbox.hides: found an unknown key, expected 'hide'"),
        ({"solutions": {"python": "a.py"}}, "solutions.python: found an unknown language"),
        ({"translations": {"de": {"stars": ["eins"]}}}, "translations.de.stars: found"),
        ({"translations": {"de": {"missing": {"b": "x"}}}}, "translations.de.missing.b: found an unknown fact"),
        ({"facts": {"a": {"kind": "sends", "value": 9999}}}, "facts.a.value: found 9999"),
        ({"facts": {"a": {"kind": "receives"}}}, "facts.a.value: found nothing"),
    ],
)
def test_a_word_that_is_wrong_names_its_place(play: Play, members: Any, error: str) -> None:
    with pytest.raises(MissionError, match=error):
        play("", **{"facts": {"a": {"kind": "still"}}, **members})


def test_texts_of_a_pupils_language_are_used(play: Play, tmp_path: Path) -> None:
    german = {"facts": {"a": "Er steht"}, "missing": {"a": "Er steht noch nicht"}, "stars": ["Schnell"]}
    facts = {"a": {"kind": "still", "text": "It stands", "missing": "It does not stand yet"}}
    play("", facts, translations={"de": german}, stars=[{"within_s": 1, "text": "Fast"}])
    mission = load_mission(tmp_path / "mission.json")
    assert (mission.text_of("a", "de"), mission.missing_text("a", "de")) == ("Er steht", "Er steht noch nicht")
    assert (mission.missing_text("a"), mission.star_text(0), mission.star_text(0, "de")) == (
        "It does not stand yet", "Fast", "Schnell"
    )  # fmt: skip
    script = "<script>alert(1)</script>"
    play("", {"a": {"kind": "still", "text": script}}, story=script)
    assert load_mission(tmp_path / "mission.json").text_of("a") == script
