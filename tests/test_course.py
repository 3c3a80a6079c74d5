"""docs/course is true: its programs get the marks that the overview promises, and its pages fit their files."""

from __future__ import annotations

import importlib.util
import json
import os
import re
import shutil
import subprocess
import sys
import tomllib
import xml.etree.ElementTree as ElementTree
from fractions import Fraction
from pathlib import Path

import pytest

from tests import pages, terminals
from tests.patience import PROGRAM_S
from thymio_sim_ros.grading.errors import GradingError
from thymio_sim_ros.grading.points import points_of
from thymio_sim_ros.grading.sandbox.levels import best_level
from thymio_sim_ros.sim.playground import reader

COURSE = Path(__file__).parents[1] / "docs" / "course"
OVERVIEW = (COURSE / "README.md").read_text(encoding="utf-8")
LESSONS = sorted(path.parent.name for path in COURSE.glob("*/assignment.toml"))
MARKS = {
    lesson: dict(zip(("start", "mistake", "solution"), map(int, marks), strict=True))
    for lesson, *marks in re.findall(
        r"^\| \[`([\w-]+)`\]\(.*?\) \| (\d+) \| (\d+) \| (\d+) \|$", OVERVIEW, re.MULTILINE
    )
}
"""Points of the three programs of each lesson, as the overview promises them."""


def assignment_of(lesson: str) -> dict[str, list[str]]:
    return tomllib.loads((COURSE / lesson / "assignment.toml").read_text(encoding="utf-8"))


class Tally:
    """pytest plug-in that adds up the points of the tests that pass."""

    def __init__(self) -> None:
        self.points: dict[str, Fraction] = {}
        self.lost: set[str] = set()

    @pytest.hookimpl(trylast=True)
    def pytest_collection_modifyitems(self, items: list[pytest.Item]) -> None:
        self.points = dict(zip([item.nodeid for item in items], points_of(items), strict=True))

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        if not report.passed:
            self.lost.add(report.nodeid)

    def mark(self) -> tuple[Fraction, Fraction]:
        """Points of the passed tests, and of all tests."""
        return sum((self.points[test] for test in self.points.keys() - self.lost), Fraction()), sum(
            self.points.values(), Fraction()
        )


def tally_of(test: Path) -> Tally:
    """Run a test file in this process, as `thymio-sim grade` does in a sandbox."""
    tally = Tally()
    options = ["-p", "no:cacheprovider", "-c", os.devnull, "--import-mode=importlib", f"--rootdir={test.parent}"]
    pytest.main([*options, str(test)], plugins=[tally])
    return tally


def test_there_are_six_lessons_with_promised_marks() -> None:
    assert [lesson.partition("-")[0] for lesson in LESSONS] == list("123456")
    assert list(MARKS) == LESSONS
    for marks in MARKS.values():
        assert marks["solution"] == 10
        assert marks["start"] <= 3
        assert marks["start"] < marks["mistake"] < marks["solution"]


def graded_programs() -> list[object]:
    """Every program of every lesson; `make test` has the solutions."""
    landing = {(lesson, "solution") for lesson in LESSONS}
    return [
        pytest.param(lesson, program, marks=() if (lesson, program) in landing else pytest.mark.slow)
        for lesson in LESSONS
        for program in ("start", "mistake", "solution")
    ]


def handed_in(lesson: str, program: str, folder: Path) -> Path:
    """The test of a lesson in a folder with a program."""
    assignment = assignment_of(lesson)
    (expected,), (test,) = assignment["files"], assignment["tests"]
    for name in (test, *assignment["data"]):
        shutil.copy(COURSE / lesson / name, folder)
    shutil.copy(COURSE / lesson / "programs" / f"{program}{Path(expected).suffix}", folder / expected)
    return folder / test


@pytest.mark.process
@pytest.mark.parametrize(("lesson", "program"), graded_programs())
def test_a_program_gets_its_mark(tmp_path: Path, lesson: str, program: str) -> None:
    tally = tally_of(handed_in(lesson, program, tmp_path))
    assert tally.mark() == (MARKS[lesson][program], 10), sorted(tally.lost)


WITH_ROS = ("5-topics", "6-node")
ELSEWHERE = (
    "import sys; from pathlib import Path; from tests.test_course import tally_of; tally = tally_of(Path(sys.argv[1]))"
)


@pytest.mark.process
@pytest.mark.parametrize("lesson", WITH_ROS)
@pytest.mark.parametrize("program", [pytest.param("start", marks=pytest.mark.slow), "mistake", "solution"])
def test_a_program_for_ros_has_the_same_mark_on_the_embedded_graph(tmp_path: Path, lesson: str, program: str) -> None:
    """This process may have an installed ROS, which the test above uses then; another process has none."""
    test = handed_in(lesson, program, tmp_path)
    check = f"{ELSEWHERE}; assert 'portable_ros' in sys.modules['rclpy'].__name__; print(*tally.mark())"
    done = subprocess.run(
        [sys.executable, "-c", check, str(test)],
        cwd=pages.ROOT,
        capture_output=True,
        text=True,
        timeout=PROGRAM_S,
        check=False,
    )
    assert done.stdout.splitlines()[-1:] == [f"{MARKS[lesson][program]} 10"], done.stdout + done.stderr


PLAYGROUNDS = [path for path in sorted(COURSE.glob("*/*.json")) if path.stem != "mission"]


@pytest.mark.parametrize("path", PLAYGROUNDS, ids=lambda path: path.stem)
def test_a_playground_loads_and_is_translated(path: Path) -> None:
    playground = reader.load(path)
    assert sorted(code for code, _ in playground.translations) == ["de", "fr", "it"]


PAGES = sorted(COURSE.glob("*/*.md"))
LANGUAGES = COURSE.parents[1] / "aseba_vm" / "languages"


def language_of(page: Path) -> str:
    """The language of a page: `lesson.de.md` is German, `lesson.md` English."""
    return page.suffixes[0].lstrip(".") if len(page.suffixes) == 2 else "en"


def in_english(page: Path) -> Path:
    return page.with_name(page.name.split(".")[0] + ".md")


@pytest.mark.parametrize("page", [COURSE / "README.md", *PAGES], ids=lambda page: f"{page.parent.name}/{page.name}")
def test_every_word_of_the_page_is_on_it(page: Path) -> None:
    """What pupils choose, in bold, has this name in the page of their language."""
    tables = [json.loads(path.read_text("utf-8")) for path in (LANGUAGES / language_of(page)).glob("*.json")]
    words = {word for table in tables for word in table.values() if isinstance(word, str)}
    assert set(re.findall(r"\*\*([^*]+)\*\*", page.read_text(encoding="utf-8"))) - words == set()


def test_two_lessons_are_translated_and_every_lesson_has_its_pages() -> None:
    names = {lesson: {page.name for page in PAGES if page.parent.name == lesson} for lesson in LESSONS}
    english = {"lesson.md", "worksheet.md"}
    translated = english | {f"{name}.{code}.md" for name in ("lesson", "worksheet") for code in ("de", "fr")}
    assert names == {lesson: translated if lesson[0] in "12" else english for lesson in LESSONS}


@pytest.mark.parametrize("page", [page for page in PAGES if language_of(page) != "en"], ids=lambda page: page.name)
def test_a_translation_has_the_parts_of_the_original(page: Path) -> None:
    """The same headings, table rows, list items and pictures, and the same commands."""

    def parts(path: Path) -> tuple[list[str], int]:
        text = path.read_text(encoding="utf-8")
        marks = [re.match(r"#+|\||- |\d\.|!\[|```", line) for line in text.splitlines()]
        return [mark[0] for mark in marks if mark], text.count("\\_")

    assert parts(page) == parts(in_english(page))


@pytest.mark.parametrize("lesson", ["3-blocks", "4-text", "5-topics", "6-node"])
def test_the_solution_on_the_page_is_the_file(lesson: str) -> None:
    page = (COURSE / lesson / "lesson.md").read_text(encoding="utf-8")
    (path,) = (COURSE / lesson / "programs").glob("solution.*")
    code = path.read_text(encoding="utf-8")
    if path.suffix == ".aesl":
        code = "".join(next(ElementTree.fromstring(code).iter("node")).text or "").replace("\t", "    ")
    assert f"```{'python' * (path.suffix == '.py')}\n{code.strip()}\n```" in page


@pytest.mark.parametrize("page", PAGES, ids=lambda page: f"{page.parent.name}/{page.name}")
def test_points_and_paths_on_a_lesson_page_are_those_of_the_files(page: Path) -> None:
    text = page.read_text(encoding="utf-8")
    for path in re.findall(r"docs/course/[\w./-]+", text):
        assert (COURSE.parents[1] / path).exists(), path
    if page.name.startswith("worksheet"):
        return
    table = re.findall(r"^\| [^|]+ \| ([\d +]+) \| (\d*) ?\| (\d*) ?\|$", text, re.MULTILINE)
    columns = [sum(sum(map(int, cell.split("+"))) for cell in column if cell) for column in zip(*table, strict=True)]
    marks = MARKS[page.parent.name]
    assert columns == [marks["solution"], marks["start"], marks["mistake"]]


@pytest.mark.slow
@pytest.mark.process
def test_the_grading_example_prints_what_the_page_says(tmp_path: Path) -> None:
    try:
        level = best_level()
    except GradingError as error:
        pytest.skip(str(error))
    if level == "landlock":
        pytest.skip("namespaces are not available here")
    follow("README.md", tmp_path, domain=0)


@pytest.mark.process
def test_the_terminals_of_lesson_5_print_what_the_page_says(ros_domain: int, tmp_path: Path) -> None:
    pytest.importorskip("rclpy")
    follow("5-topics/lesson.md", tmp_path, ros_domain)


def follow(page: str, folder: Path, domain: int) -> None:
    """Type the commands of a page as a reader in the folder of the project."""
    if shutil.which("setsid") is None:
        pytest.skip("the program setsid is not installed")
    with terminals.reader(folder, domain) as reader:
        (folder / "reader" / "docs").symlink_to(COURSE.parent)
        reader.follow(pages.read(COURSE / page))
    if reader.has_skipped:
        pytest.skip(f"executed: {terminals.NO_ROS2}")


@pytest.mark.process
@pytest.mark.slow
def test_the_test_that_pupils_write_passes(tmp_path: Path) -> None:
    if importlib.util.find_spec("rclpy") is None:
        pytest.skip("needs ROS")
    (test,) = (
        text for text in pages.blocks(pages.read(COURSE / "6-node/worksheet.md"), "python") if "def test" in text
    )
    (tmp_path / "test_town.py").write_text(test, encoding="utf-8")
    shutil.copy(COURSE / "6-node/town.json", tmp_path)
    shutil.copy(COURSE / "6-node/programs/solution.py", tmp_path / "follower.py")
    assert tally_of(tmp_path / "test_town.py").mark() == (1, 1)
