"""The list of missions and their pictures, as the server of the page has them."""

from __future__ import annotations

import json

import pytest

from thymio_sim_ros.missions import documents
from thymio_sim_ros.missions.shipped import shipped


def test_the_list_names_no_path_of_this_computer() -> None:
    found = documents.find(["missions.json"])
    assert found is not None
    assert found[1] == ".json"
    steps = json.loads(found[0])["steps"]
    assert [step["name"] for step in steps] == [step.name for step in shipped()]
    missions = [mission for step in steps for mission in step["missions"]]
    assert missions
    for mission in missions:
        assert set(mission) >= {"name", "titles", "picture", "stars", "languages"}
        assert "path" not in mission
        assert mission["picture"] == "" or mission["picture"].startswith(f"missions/{mission['name']}.")


def test_each_picture_of_the_list_is_there() -> None:
    found = documents.find(["missions.json"])
    assert found is not None
    pictures = [mission["picture"] for step in json.loads(found[0])["steps"] for mission in step["missions"]]
    for picture in filter(None, pictures):
        document = documents.find(picture.split("/"))
        assert document is not None
        assert document[0]
        assert picture.endswith(document[1])


@pytest.mark.parametrize("names", [[], ["missions"], ["missions", "index.json"], ["missions", "../pyproject.toml"],
                                   ["missions", "forward.json"], ["missions", "1-drive", "forward.json"]])  # fmt: skip
def test_nothing_else_is_served(names: list[str]) -> None:
    assert documents.find(names) is None


def test_each_mission_leads_to_the_next_one() -> None:
    names = [each.name for step in shipped() for each in step.missions]
    assert [documents.mission_after(name) for name in names] == [*names[1:], ""]
    assert documents.mission_after("nowhere") == ""
