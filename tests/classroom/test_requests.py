"""The interface of the teacher's page, with a class whose suites are not started."""

from __future__ import annotations

import asyncio
import base64
import io
import json
import zipfile
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from thymio_sim_ros.access import RefusedError, TrustedProxies, Visitor
from thymio_sim_ros.classroom.address import ClassAddress
from thymio_sim_ros.classroom.classroom import Classroom
from thymio_sim_ros.classroom.folder import ClassFolder, Work
from thymio_sim_ros.classroom.requests import Answer, answer
from thymio_sim_ros.classroom.suite_process import SuiteOptions

OPTIONS = SuiteOptions("desk", "welcome")
URL = "https://school.example/thymio/"
PLACE = ClassAddress("127.0.0.1", 8100, TrustedProxies(["127.0.0.1"]))
PUPIL = Visitor("192.0.2.7", "school.example", "https", "/thymio", is_proxied=True)


def encoded(text: str) -> str:
    """A file in base64, as the page sends it."""
    return base64.b64encode(text.encode()).decode()


GIVEN = {"kind": "program", "name": "bus.aesl", "content": encoded("onevent prox\n"), "due": "", "pupils": None}


class Teacher:
    """A class of two, and requests to it."""

    def __init__(self, path: Path) -> None:
        self.folder = ClassFolder(path)
        self.places = self.folder.places(["Ada", "Ben", "Eve", "Zoë"])

    def ask(self, *requests: tuple[str, str, Any], place: ClassAddress = PLACE) -> list[Answer]:
        """The answers to requests: method, name, fields."""

        async def talk() -> list[Answer]:
            classroom = Classroom(self.places, OPTIONS, self.folder)
            return [
                await answer(
                    classroom, place, PUPIL, method, name, b"" if fields is None else json.dumps(fields).encode()
                )
                for method, name, fields in requests
            ]

        return asyncio.run(talk())


@pytest.fixture
def teacher(tmp_path: Path) -> Teacher:
    return Teacher(tmp_path)


def test_a_message_is_for_one_or_for_all(teacher: Teacher) -> None:
    *_, state = teacher.ask(
        ("POST", "message", {"pupils": None, "text": "Look up"}),
        ("POST", "message", {"pupils": ["ben"], "text": " Well done "}),
        ("GET", "state", None),
    )
    pupils = json.loads(state.body)["pupils"]
    assert [(pupil["id"], pupil["notice"]) for pupil in pupils[:2]] == [("ada", "Look up"), ("ben", "Well done")]


def test_a_pause_of_the_teacher_is_told_from_one_of_the_pupil(teacher: Teacher) -> None:
    *_, state = teacher.ask(("POST", "pause", {"pupils": ["ada"], "paused": True}), ("GET", "state", None))
    assert [pupil["held"] for pupil in json.loads(state.body)["pupils"]] == [True, False, False, False]


def test_programs_are_collected_by_pupil(teacher: Teacher) -> None:
    ada, ben, eve, _ = teacher.places
    teacher.folder.keep(ada, Work("onevent prox\n", draft="onevent prox\n"))
    teacher.folder.keep(ben, Work("onevent tap\n", draft="onevent tap\nvar"))
    teacher.folder.keep(eve, Work(draft="onevent"))
    packed, missing = teacher.ask(("GET", "programs.zip", None), ("GET", "missing", None))
    assert json.loads(missing.body) == ["Zoë"]
    with zipfile.ZipFile(io.BytesIO(packed.body)) as archive:
        assert {name: archive.read(name).decode() for name in archive.namelist()} == {
            "Ada/": "",
            "Ada/program.aesl": "onevent prox\n",
            "Ben/": "",
            "Ben/program.aesl": "onevent tap\n",
            "Ben/draft.aesl": "onevent tap\nvar",
            "Eve/": "",
            "Eve/draft.aesl": "onevent",
            "Zoë/": "",
        }


def test_no_one_is_missing_when_all_have_a_program(teacher: Teacher) -> None:
    for place in teacher.places:
        teacher.folder.keep(place, Work("onevent prox\n"))
    [missing] = teacher.ask(("GET", "missing", None))
    assert json.loads(missing.body) == []


def test_the_sheet_has_a_link_for_each_pupil(teacher: Teacher) -> None:
    [sheet] = teacher.ask(("GET", "sheet", None))
    links = json.loads(sheet.body)
    assert [link["name"] for link in links] == ["Ada", "Ben", "Eve", "Zoë"]
    assert links[0]["url"] == f"{URL}p/ada/#token={teacher.places[0].token}"


def test_the_room_has_an_address_and_a_code(teacher: Teacher) -> None:
    [answered] = teacher.ask(("GET", "room", None))
    room, code = json.loads(answered.body), teacher.folder.room_code
    assert (room["address"], room["code"], room["url"]) == (URL, code, f"{URL}#token={code}")
    assert room["qr"].startswith("<svg")


def test_with_links_only_there_is_no_room(teacher: Teacher) -> None:
    links_only = replace(PLACE, has_room=False)
    assert json.loads(teacher.ask(("GET", "state", None), place=links_only)[0].body)["has_room"] is False
    with pytest.raises(RefusedError) as raised:
        teacher.ask(("GET", "room", None), place=links_only)
    assert raised.value.status == 404
    assert json.loads(teacher.ask(("GET", "state", None))[0].body)["has_room"] is True


def test_plans_are_those_of_pupils(teacher: Teacher) -> None:
    [state] = teacher.ask(("GET", "state", None))
    [plan] = teacher.ask(("GET", f"plans/{json.loads(state.body)['pupils'][0]['plan']}", None))
    assert json.loads(plan.body)["solids"]


@pytest.mark.parametrize(
    ("method", "name", "fields", "status"),
    [
        ("GET", "plans/../class.json", None, 404),
        ("GET", "nothing", None, 404),
        ("POST", "nothing", {}, 404),
        ("PUT", "message", {}, 405),
        ("POST", "message", [], 400),
        ("POST", "message", {"text": 3}, 400),
        ("POST", "message", {"text": "x" * 501}, 400),
        ("POST", "pause", {"pupils": ["mia"], "paused": True}, 400),
        ("POST", "pause", {"pupils": "ada", "paused": True}, 400),
        ("POST", "pause", {"paused": 1}, 400),
        ("POST", "show", {"pupil": ["ada"]}, 400),
        ("POST", "lower", {"pupils": ["mia"]}, 400),
        ("POST", "take_back", {"handout": "bus"}, 400),
        ("GET", "handouts/bus", None, 404),
        ("POST", "handout", GIVEN | {"kind": "worksheet"}, 400),
        ("POST", "handout", GIVEN | {"name": None}, 400),
        ("POST", "handout", GIVEN | {"content": "?"}, 400),
        ("POST", "handout", GIVEN | {"content": ""}, 400),
        ("POST", "handout", GIVEN | {"content": encoded("<network><node")}, 400),
        ("POST", "handout", GIVEN | {"kind": "playground"}, 400),
        pytest.param("POST", "handout", GIVEN | {"kind": "mission"}, 400, marks=pytest.mark.process),  # it is checked
        ("POST", "handout", GIVEN | {"due": "tomorrow"}, 400),
        ("POST", "handout", GIVEN | {"due": "2026-12-01"}, 400),
        ("POST", "handout", GIVEN | {"due": None}, 400),
        ("POST", "handout", GIVEN | {"solution_of": "bus"}, 400),
        ("POST", "handout", GIVEN | {"pupils": ["mia"]}, 400),
    ],
)
def test_wrong_requests_are_refused(teacher: Teacher, method: str, name: str, fields: Any, status: int) -> None:
    with pytest.raises(RefusedError) as raised:
        teacher.ask((method, name, fields))
    assert raised.value.status == status
