"""The published schema of missions, and the missions of the course."""

from __future__ import annotations

import json
from pathlib import Path

import jsonschema
import pytest

from thymio_sim_ros.missions import load_mission
from thymio_sim_ros.missions.schema import schema

ROOT = Path(__file__).parents[2]
COURSE = ROOT / "docs" / "course"
MISSIONS = sorted(COURSE.glob("*/mission.json"))
SCHEMA = json.loads((ROOT / "playgrounds" / "missions" / "mission.schema.json").read_text(encoding="utf-8"))


def test_the_published_schema_is_valid_and_the_one_of_the_reader() -> None:
    jsonschema.Draft202012Validator.check_schema(SCHEMA)
    assert json.loads(json.dumps(schema())) == SCHEMA


@pytest.mark.parametrize("path", MISSIONS, ids=lambda path: path.parent.name)
def test_a_mission_of_the_course_fits_it_and_its_files_are_there(path: Path) -> None:
    jsonschema.validate(json.loads(path.read_text(encoding="utf-8")), SCHEMA)
    mission = load_mission(path)
    assert [name for name in (mission.playground, *mission.programs.values()) if not Path(name).is_file()] == []
    assert all(fact.text for fact in mission.facts.values())


@pytest.mark.parametrize(
    "change",
    [{"success": {"all": []}}, {"facts": {"a": {"kind": "x"}}}, {"time_s": -1}, {"stories": ""}, {"stars": [{"x": 1}]}],
)
def test_the_schema_refuses_what_the_reader_refuses(change: dict[str, object]) -> None:
    mission = json.loads(MISSIONS[0].read_text(encoding="utf-8")) | change
    with pytest.raises(jsonschema.ValidationError):
        jsonschema.validate(mission, SCHEMA)
