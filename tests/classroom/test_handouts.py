"""What a teacher hands out, how far pupils are with it, and what is collected, without suites and sockets."""

from __future__ import annotations

import asyncio
import base64
import csv
import hashlib
import io
import json
import zipfile
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from tests.classroom.test_requests import GIVEN, OPTIONS, PLACE, PUPIL, URL, encoded
from thymio_sim_ros.access import RefusedError
from thymio_sim_ros.classroom.address import ClassAddress
from thymio_sim_ros.classroom.bridge_client import NODE_DRAFT, RAISED_HAND, SOURCE
from thymio_sim_ros.classroom.classroom import Classroom
from thymio_sim_ros.classroom.errors import ClassError
from thymio_sim_ros.classroom.folder import ClassFolder
from thymio_sim_ros.classroom.handouts import MAX_CONTENT, MAX_HANDOUTS, Handouts, checked_content
from thymio_sim_ros.classroom.requests import answer, opened
from thymio_sim_ros.classroom.suite_state import MissionTry
from thymio_sim_ros.files import resources
from thymio_sim_ros.grading.submissions import find, prepared

STILL = {"format": 1, "title": "The bus", "facts": {"home": {"kind": "still", "text": "It waits"}}}
MISSION = json.dumps(STILL | {"playground": "base", "success": {"hold": "home", "for_s": 1}})
DRIVE = "motor.left.target = 200\nmotor.right.target = 200\n"
STRANGE = "../../<script>alert(1)</script>\0:bus?.aesl"


class Group:
    """A class of Ada, Ben and Jürg in a folder; another one of the same folder is the class after a restart."""

    def __init__(self, path: Path) -> None:
        self.path = path
        folder = ClassFolder(path)
        self.classroom = Classroom(folder.places(["Ada", "Ben", "Jürg / 5b"]), OPTIONS, folder)

    def ask(self, method: str, name: str, fields: Any = None, *, place: ClassAddress = PLACE) -> Any:
        """The answer to a request of the teacher: JSON, or the body."""
        body = b"" if fields is None else json.dumps(fields).encode()
        found = asyncio.run(answer(self.classroom, place, PUPIL, method, name, body))
        return json.loads(found.body) if found.media_type == "application/json" else found.body

    def hand_out(self, **fields: Any) -> str:
        """Hand out a program, and return the id."""
        self.ask("POST", "handout", GIVEN | fields)
        return str(self.ask("GET", "handouts")[-1]["id"])

    def open(self, pupil: str, number: str) -> Any:
        """What the page of a pupil gets."""
        return json.loads(asyncio.run(opened(self.classroom, pupil, number)).body)

    def run(self, pupil: str, text: str) -> None:
        """The suite of a pupil reports that a program runs."""
        self.classroom.seats[pupil]._on_parameter(SOURCE, text)

    def page(self, pupil: str) -> Any:
        """The hand-outs on the page of a pupil."""
        return json.loads(str(self.classroom.seats[pupil]._page["handouts"]))


@pytest.fixture
def unchecked(monkeypatch: pytest.MonkeyPatch) -> None:
    """Missions are handed out without a process that checks them."""
    monkeypatch.setattr("thymio_sim_ros.classroom.handouts.check_mission", lambda _name, _content: None)


@pytest.fixture
def group(tmp_path: Path) -> Group:
    return Group(tmp_path / "class")


def test_a_program_is_handed_out_to_some_and_the_teacher_sees_who_has_opened_and_run_it(group: Group) -> None:
    number = group.hand_out(pupils=["ada", "ben"], due="2099-01-01T09:00:00+01:00")
    assert [one["name"] for one in group.page("ada")] == ["bus.aesl"]
    assert group.page("jurg-5b") == []
    assert group.page("ada")[0]["opened"] is False
    given = group.open("ada", number)
    assert (given["kind"], given["name"]) == ("program", "bus.aesl")
    assert base64.b64decode(given["content"]) == b"onevent prox\n"
    assert group.page("ada")[0]["opened"] is True
    group.run("ada", "var mine = 1")
    group.run("ben", "var other = 1")  # without having opened it
    [handout] = group.ask("GET", "handouts")
    ada, ben = handout["progress"]["ada"], handout["progress"]["ben"]
    assert ada["opened"]
    assert (ada["tries"], ada["late"], ben["opened"], ben["tries"]) == (1, False, "", 0)
    assert "jurg-5b" not in handout["progress"]


def test_a_program_that_runs_in_a_playground_of_the_teacher_is_still_for_its_task(group: Group) -> None:
    task = group.hand_out()
    table = resources.playgrounds()["table"].read_bytes()
    room = group.hand_out(kind="playground", name="table.json", content=base64.b64encode(table).decode())
    solution = group.hand_out(name="solution.aesl", solution_of=task)
    seat = group.classroom.seats["ada"]
    for number, text in ((task, "var mine = 1"), (room, "var mine = 2"), (solution, "var solved = 1")):
        group.open("ada", number)
        group.run("ada", text)
    works = [seat.progress.program(handout) for handout in group.classroom.handouts.all()]
    assert works == ["var mine = 2", None, "var solved = 1"]


def test_all_of_it_is_there_after_a_restart_of_the_class(group: Group) -> None:
    number = group.hand_out()
    group.open("ada", number)
    group.run("ada", "var mine = 1")
    before = group.ask("GET", "handouts")
    after = Group(group.path)
    assert after.ask("GET", "handouts") == before
    after.run("ada", "var mine = 2")
    assert after.ask("GET", "handouts")[0]["progress"]["ada"]["tries"] == 2
    assert after.open("ben", number)["name"] == "bus.aesl"


def test_a_pupil_who_opens_the_link_of_another_one_has_it_too(group: Group) -> None:
    number = group.hand_out(pupils=["ada"])
    link = group.ask("GET", f"handouts/{number}")
    assert link["url"] == f"{URL}#token={group.classroom.folder.room_code}&handout={number}"
    assert link["qr"].startswith("<svg")
    group.open("ben", number)
    assert set(group.ask("GET", "handouts")[0]["progress"]) == {"ada", "ben"}
    with pytest.raises(RefusedError):  # without a code, such a link would lead nowhere
        group.ask("GET", f"handouts/{number}", place=replace(PLACE, has_room=False))


def test_what_is_taken_back_cannot_be_opened_and_the_work_stays(group: Group) -> None:
    number = group.hand_out()
    group.open("ada", number)
    group.run("ada", "var mine = 1")
    group.ask("POST", "take_back", {"handout": number})
    assert group.page("ada") == []
    with pytest.raises(RefusedError) as raised:
        group.open("ada", number)
    assert raised.value.status == 404
    group.run("ada", "var mine = 2")
    with zipfile.ZipFile(io.BytesIO(group.ask("GET", "programs.zip"))) as archive:
        assert archive.read("Ada/program.aesl") == b"var mine = 2"
    assert list((group.path / "handouts").glob("*.bin")) == []


def test_a_solution_names_its_task(group: Group) -> None:
    number = group.hand_out()
    group.hand_out(name="solution.aesl", solution_of=number)
    assert [one["solution_of"] for one in group.page("ben")] == ["", "bus.aesl"]


@pytest.mark.usefixtures("unchecked")
def test_stars_tries_and_time_of_a_mission_come_from_the_suite(group: Group) -> None:
    number = group.hand_out(kind="mission", name="bus.json", content=encoded(MISSION))
    seat = group.classroom.seats["ada"]
    digest = hashlib.sha256(MISSION.encode()).hexdigest()
    for tries, has_passed, stars, at_s in (
        (0, False, 0, 0.0), (1, False, 0, 0.0), (1, False, 0, 9.5), (2, False, 0, 0.1), (2, True, 2, 7.25),
        (2, True, 2, 7.25), (1, False, 0, 0.0), (1, True, 1, 3.0), (2, True, 2, 1.0),
    ):  # fmt: skip
        seat._on_try(MissionTry("bus", tries, has_passed, stars, at_s, "", file=digest))
        seat._on_try(MissionTry("bus", 1, True, 3, 1.0, "", file="another file of this name"))
    progress = group.ask("GET", "handouts")[0]["progress"]["ada"]
    assert (progress["stars"], progress["best_s"]) == (2, 7.25)
    assert progress["passed"]
    assert progress["tries"] == 4
    assert group.page("ada")[0]["stars"] == 2
    group.run("ada", "var mine = 1")
    assert group.ask("GET", "handouts")[0]["progress"]["ada"]["tries"] == 4
    assert seat.progress.program(group.classroom.handouts.find(number)) == "var mine = 1"


@pytest.mark.usefixtures("unchecked")
def test_a_shipped_mission_is_handed_out_by_its_name_and_to_more_pupils_later(group: Group) -> None:
    number = group.hand_out(kind="mission", name="forward", content="", title="Off you go", pupils=["ada"])
    assert group.open("ada", number) == {"kind": "mission", "name": "forward", "content": ""}
    group.classroom.seats["ada"]._on_try(MissionTry("forward", 1, True, 1, 3.0, ""))
    group.classroom.seats["ada"]._on_try(MissionTry("forward", 2, True, 3, 3.0, "", file="of the pupil"))
    assert group.hand_out(kind="mission", name="forward", content="", pupils=["ben"]) == number
    [handout] = group.ask("GET", "handouts")
    assert (handout["progress"]["ada"]["stars"], handout["progress"]["ben"]["stars"]) == (1, 0)
    assert group.page("ben")[0]["name"] == "Off you go"
    group.hand_out(kind="mission", name="forward", content=encoded(MISSION))
    assert [one["name"] for one in group.ask("GET", "handouts")] == ["forward", "forward 2.json"]
    with pytest.raises(RefusedError):
        group.hand_out(kind="mission", name="../forward", content="")


def zipped(**files: str) -> str:
    """The zip of a mission in base64; a double underscore stands for the dot of a name."""
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w") as archive:
        for name, text in files.items():
            archive.writestr(name.replace("__", "."), text)
    return base64.b64encode(packed.getvalue()).decode()


@pytest.mark.process
@pytest.mark.parametrize(
    ("content", "reason"),
    [
        (encoded('{"format": 1}'), "bus.json: success: found nothing, expected a condition"),
        (
            zipped(mission__json=json.dumps({**json.loads(MISSION), "solutions": {"text": "go.aesl"}, "time_s": 3}),
                   go__aesl=DRIVE),
            "bus.zip: solutions.text: found 0 of 1 stars, expected all of them",
        ),
    ],
)  # fmt: skip
def test_a_mission_is_checked_before_anything_is_handed_out(group: Group, content: str, reason: str) -> None:
    name = "bus.zip" if base64.b64decode(content).startswith(b"PK") else "bus.json"
    with pytest.raises(RefusedError, match=reason):
        group.hand_out(kind="mission", name=name, content=content)
    assert group.ask("GET", "handouts") == []


def test_the_table_has_a_row_for_each_pupil_and_says_who_is_late(group: Group) -> None:
    number = group.hand_out(due="2001-01-01T00:00:00+00:00")
    group.open("ada", number)
    group.run("ada", "var mine = 1")
    rows = list(csv.DictReader(io.StringIO(group.ask("GET", "results.csv").decode("utf-8-sig"))))
    assert [(row["pupil"], row["handout"], row["tries"], row["late"]) for row in rows] == [
        ("Ada", "bus.aesl", "1", "yes"),
        ("Ben", "bus.aesl", "0", ""),
        ("Jürg / 5b", "bus.aesl", "0", ""),
    ]


def test_the_zip_is_read_by_the_grader_with_the_names_of_the_pupils(group: Group, tmp_path: Path) -> None:
    number = group.hand_out()
    group.open("ada", number)
    group.run("ada", "var mine = 1")
    group.run("ben", "var other = 1")
    zipped = tmp_path / "programs.zip"
    zipped.write_bytes(group.ask("GET", "programs.zip"))
    ada, ben, jurg = (prepared(one, ["bus.aesl"]) for one in find(zipped))
    assert (ada.name, ada.files["bus.aesl"], ada.problem) == ("Ada", b"var mine = 1", "")
    assert ben.name == "Ben"
    assert (jurg.name, jurg.problem) == ("Jürg _ 5b", "no file was handed in: hand in bus.aesl")


@pytest.mark.usefixtures("unchecked")
def test_nodes_are_collected_with_the_names_of_what_they_are_for(group: Group, tmp_path: Path) -> None:
    ada, ben, _ = group.classroom.seats.values()
    ben._on_parameter(NODE_DRAFT, "import rclpy\n")
    number = group.hand_out(kind="mission", name="ros_drive.json", content=encoded(MISSION))
    group.open("ada", number)
    ada._on_parameter(NODE_DRAFT, "import rclpy  # 1\n")
    ada._on_parameter(NODE_DRAFT, "import rclpy  # 2\n")
    assert group.ask("GET", "missing") == ["Jürg / 5b"]
    progress = group.ask("GET", "handouts")[0]["progress"]["ada"]
    assert progress["changed"]
    assert progress["tries"] == 0
    zipped = tmp_path / "programs.zip"
    zipped.write_bytes(Group(group.path).ask("GET", "programs.zip"))
    found = find(zipped)
    assert [dict(one.files) for one in found] == [
        {"ros_drive.py": b"import rclpy  # 2\n"},
        {"draft.py": b"import rclpy\n"},
        {},
    ]
    assert prepared(found[1], ["ros_drive.py"]).files == {"ros_drive.py": b"import rclpy\n"}


def test_names_of_files_are_text_and_differ(group: Group) -> None:
    for name in (STRANGE, STRANGE, "program.aesl", "..", "x" * 300 + ".aesl"):
        group.hand_out(name=name)
    names = [one["name"] for one in group.ask("GET", "handouts")]
    assert names[:4] == ["script___bus_.aesl", "script___bus_ 2.aesl", "program 2.aesl", "file.aesl"]
    assert len(names[4]) == 80
    assert sorted(path.name for path in group.path.iterdir()) == ["class.json", "handouts", "pupils"]


def test_a_raised_hand_is_seen_until_it_is_lowered(group: Group) -> None:
    seat = group.classroom.seats["ada"]
    seat._on_parameter(RAISED_HAND, True)
    assert seat.hand == "", "the suite has not got the state of the class yet"
    seat.phase = "running"
    seat._on_parameter(RAISED_HAND, True)
    assert group.ask("GET", "state")["pupils"][0]["hand"]
    assert seat._page["raised_hand"] is True
    group.ask("POST", "lower", {"pupils": ["ada"]})
    assert group.ask("GET", "state")["pupils"][0]["hand"] == ""
    assert seat._page["raised_hand"] is False


def test_hand_outs_are_limited(group: Group, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("thymio_sim_ros.classroom.handouts.MAX_HANDOUTS", 2)
    assert MAX_HANDOUTS > 2
    group.hand_out()
    group.hand_out()
    with pytest.raises(RefusedError, match="remove one"):
        group.hand_out()


def test_playgrounds_can_be_handed_out_if_all_of_them_is_in_the_file() -> None:
    shipped = resources.playgrounds()
    with pytest.raises(ClassError, match=r"^line_gradient.json: shapes\[1\].image: found the file"):
        checked_content(
            "playground", "line_gradient.json", base64.b64encode(shipped["line_gradient"].read_bytes()).decode()
        )
    for name in shipped.keys() - {"line_gradient"}:
        content = shipped[name].read_bytes()
        assert checked_content("playground", f"{name}.json", base64.b64encode(content).decode()) == content


def test_a_file_that_is_too_large_is_refused_with_its_size() -> None:
    with pytest.raises(ClassError, match=rf"found {MAX_CONTENT + 1} bytes"):
        checked_content("program", "bus.aesl", base64.b64encode(bytes(MAX_CONTENT + 1)).decode())


@pytest.mark.parametrize("text", ["{", "3", "[3]", "[" * 3000, '[{"id": "x"}]', '[{"id": 3}]'])
def test_a_list_that_is_damaged_is_an_error_with_the_file(tmp_path: Path, text: str) -> None:
    (tmp_path / "handouts.json").write_text(text)
    with pytest.raises(ClassError, match=r"handouts.json: .*restore or delete it"):
        Handouts(tmp_path)


@pytest.mark.parametrize("text", ["{", "3", '{"current": 3, "handouts": {"x": 3}}', '{"handouts": []}'])
def test_damaged_progress_of_a_pupil_counts_as_none(tmp_path: Path, text: str) -> None:
    group = Group(tmp_path)
    number = group.hand_out()
    (tmp_path / "pupils" / "ada" / "handouts.json").write_text(text)
    again = Group(tmp_path)
    again.open("ada", number)
    assert again.page("ada")[0]["opened"] is True
