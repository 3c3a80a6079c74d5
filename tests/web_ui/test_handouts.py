"""A lesson: a teacher and two pupils in Chromium; hand-out, raised hand, collect, and the marks of the zip."""

from __future__ import annotations

import base64
import csv
import io
import sys
import zipfile
from collections.abc import Iterator
from pathlib import Path

import pytest

playwright = pytest.importorskip("playwright.sync_api")

from tests.classroom.class_support import RunningClass
from tests.web_ui.page_support import MARKS, open_editor, open_menu, open_page
from tests.web_ui.test_classroom import page_of
from tests.web_ui.test_page_access import findings_in_all_sizes
from thymio_sim_ros.cli.main import main
from thymio_sim_ros.files import resources

pytestmark = MARKS

START = "# Drive\nvar done = 0\n"
TEST = """
import pytest
pytestmark = pytest.mark.thymio(program="_b_bus_b_.aesl")


@pytest.mark.points(2)
def test_it_drives(thymio):
    thymio.run(1.0)
    assert thymio.pose.x_m > 0.03
"""


@pytest.fixture(scope="module")
def group(tmp_path_factory: pytest.TempPathFactory) -> Iterator[RunningClass]:
    """The class of Ada and Jürg."""
    running = RunningClass(tmp_path_factory.mktemp("class"), ["Ada", "Jürg"], arguments=("--playground", "base"))
    yield running
    running.end()


def give(teacher, path: Path) -> None:
    """Hand out a file in the dialog that is open."""
    teacher.set_input_files("#handout-file", str(path))
    teacher.click("[data-verb=give]")
    teacher.locator("#handout-title").wait_for(state="hidden")


@pytest.mark.slow
def test_a_lesson_from_the_hand_out_to_the_marks(group: RunningClass, page, other_page, own_page, tmp_path) -> None:
    teacher, ada, jurg = page, other_page, own_page
    task = tmp_path / "<b>bus<b>.aesl"
    task.write_text(START)
    open_page(ada, page_of(group, "ada"))
    open_editor(ada)
    ada.locator(".cm-content").fill("var mine = 7")
    teacher.goto(group.address)
    teacher.locator("#count", has_text="2 / 2").wait_for()
    teacher.click("[data-verb=handouts]")
    teacher.get_by_text("Nothing is handed out yet.").wait_for()
    teacher.click("[data-verb=handout]")
    teacher.fill("#handout-due", "2001-01-01T10:00")
    assert findings_in_all_sizes(teacher) == []
    give(teacher, task)
    teacher.locator("th .handout-name").wait_for()
    assert teacher.locator("td", has_text="not opened").count() == 2

    note = ada.locator(".teacher-note", has_text="Your teacher has handed out:")
    note.locator("[data-handout=newest]").click()
    ada.locator("dialog.sharing", has_text="Program, Text").wait_for()
    assert findings_in_all_sizes(ada) == []
    ada.click("[data-share=open]")
    ada.locator(".cm-content", has_text="var done = 0").wait_for()
    note.wait_for(state="hidden")
    ada.locator(".cm-content").fill("motor.left.target = 200\nmotor.right.target = 200")
    ada.click("[data-verb=run]")
    teacher.locator("td", has_text="runs: 1").wait_for()
    teacher.locator("td", has_text="late").wait_for()
    teacher.locator("td", has_text="not opened").wait_for()
    assert findings_in_all_sizes(teacher) == []

    open_page(jurg, page_of(group, "jurg"))
    jurg.locator("#pupil .pupil-new", has_text="1").wait_for()
    open_menu(jurg, "#pupil")
    assert findings_in_all_sizes(jurg) == []
    jurg.click("#raise-hand")
    jurg.locator("#raise-hand", has_text="Lower your hand").wait_for()
    jurg.keyboard.press("Escape")
    teacher.click("[data-verb=back]")
    teacher.click("[data-filter=help]")
    teacher.locator("[data-pupil=jurg] [data-verb=lower]").click()
    jurg.locator("#pupil[data-hand=false]").wait_for()
    open_menu(jurg, "#pupil")
    jurg.locator("#raise-hand", has_text="Raise your hand").wait_for()
    teacher.click("[data-filter=all]")

    zipped = tmp_path / "programs.zip"
    with teacher.expect_download() as download:
        teacher.click("[data-verb=collect]")
    download.value.save_as(zipped)
    with zipfile.ZipFile(zipped) as archive:
        (work,) = [name for name in archive.namelist() if name.endswith("bus_b_.aesl")]
        assert work.startswith("Ada/")
        assert b"motor.left.target = 200" in archive.read(work)
        assert b"var mine = 7" not in archive.read("Ada/program.aesl")
    if sys.platform.startswith("linux"):
        assert marks(tmp_path, zipped) == {"Ada": "2", "Jürg": "0"}


def marks(folder: Path, zipped: Path) -> dict[str, str]:
    """The points of an assignment by pupil."""
    (folder / "test_bus.py").write_text(TEST)
    assignment = folder / "assignment.toml"
    assignment.write_text('tests = ["test_bus.py"]\nfiles = ["_b_bus_b_.aesl"]\n')
    main(["grade", str(zipped), "--assignment", str(assignment), "--output", str(folder / "grades")])
    table = (folder / "grades" / "marks.csv").read_text("utf-8-sig")
    return {row["name"]: row["points"] for row in csv.DictReader(table.splitlines())}


def test_a_solution_a_playground_and_a_link_of_the_class(group: RunningClass, page, other_page, tmp_path) -> None:
    teacher, pupil = page, other_page
    content = base64.b64encode(START.encode()).decode()
    task = {"kind": "program", "name": "task.aesl", "content": content, "due": "", "pupils": None}
    group.request("handout", task)
    teacher.goto(group.address)
    teacher.locator("#count", has_text="2 / 2").wait_for()
    teacher.click("[data-verb=handouts]")
    teacher.locator("[data-verb=sendSolution]").first.click()
    (tmp_path / "solution.aesl").write_text("var solved = 1")
    give(teacher, tmp_path / "solution.aesl")
    teacher.click("[data-verb=handout]")
    wrong = tmp_path / "wrong.json"
    wrong.write_text("{}")
    teacher.set_input_files("#handout-file", str(wrong))
    teacher.click("[data-verb=give]")
    teacher.get_by_text("It was not handed out: wrong.json").wait_for()
    teacher.uncheck(".handout-pupils [value=ada]")
    give(teacher, resources.playgrounds()["table"])
    teacher.locator("th .handout-name", has_text="table.json").wait_for()
    teacher.locator("[data-verb=handoutLink]").first.click()
    link = teacher.locator(".class-content a")
    link.wait_for()
    address = str(link.get_attribute("href")).replace("localhost", "127.0.0.1")

    pupil.goto(address)
    pupil.get_by_role("link", name="Ada").click()  # who did not get it
    pupil.locator("dialog.sharing").get_by_text("Playground", exact=True).wait_for()
    assert "handout=" in pupil.url
    pupil.click("[data-share=open]")
    pupil.locator("[data-own]").wait_for()
    assert pupil.url == f"http://127.0.0.1:{group.port}/p/ada/"
    pupil.wait_for_function("() => window.thymio.state().simulator?.title === 'Table'")
    open_menu(pupil, "#pupil")
    pupil.get_by_text("Solution of task.aesl").wait_for()
    pupil.locator("#pupil-sheet [data-handout]", has_text="table.json").wait_for()
    teacher.click("[data-verb=close]")
    teacher.locator("[data-verb=takeBack]").first.click()
    teacher.click("[data-verb=yes]")
    pupil.locator("#pupil-sheet [data-handout]", has_text="table.json").wait_for(state="detached")


def test_stars_of_a_mission_that_was_handed_out_are_in_the_table(group: RunningClass, page, other_page) -> None:
    teacher, pupil = page, other_page
    teacher.goto(group.address)
    teacher.locator("#count", has_text="2 / 2").wait_for()
    teacher.click("[data-verb=handouts]")
    teacher.click("[data-verb=handout]")
    teacher.select_option("#handout-mission", "forward")
    teacher.click("[data-verb=give]")
    teacher.locator("th .handout-name", has_text="Off you go").wait_for()

    open_page(pupil, page_of(group, "ada"))
    open_menu(pupil, "#pupil")
    pupil.locator("#pupil-sheet [data-handout]", has_text="Off you go").click()
    pupil.click("[data-share=open]")
    pupil.click("[data-mission-language=text]")
    pupil.locator(".cm-content").fill(
        "onevent buttons\nwhen button.forward == 1 do\nmotor.left.target = 300\nmotor.right.target = 300\nend"
    )
    pupil.click("[data-verb=run]")
    teacher.locator("td", has_text="★★").wait_for()
    teacher.locator("td", has_text="tries: 1").wait_for()
    with zipfile.ZipFile(io.BytesIO(group.request("programs.zip"))) as archive:
        assert b"motor.left.target = 300" in archive.read("Ada/forward.aesl")
