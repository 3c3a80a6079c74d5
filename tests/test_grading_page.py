"""docs/grading.md is true: its examples pass, and those that fail say what the page says."""

from __future__ import annotations

import importlib.util
import re
import shlex
import tomllib
from pathlib import Path

import pytest

from tests import pages
from tests.patience import PROGRAM_S

ROOT = Path(__file__).parents[1]
PAGE = pages.read("grading.md")
FAILURE = re.compile(r"`(test_\w+\.py)`[^`]*:\n\n```python\n[^`]*```\n[^`]*:\n\n```text\n(.*?)```", re.DOTALL)
FILES = pages.files(PAGE)
WORKFLOW = ".github/workflows/grade.yml"
FAILING = dict(FAILURE.findall(PAGE))
NEED_ROS = {name for name, text in FILES.items() if name.startswith("test_") and re.search(r"\(.*\bros\b.*\):", text)}
HAS_ROS = importlib.util.find_spec("rclpy") is not None


@pytest.fixture
def folder(pytester: pytest.Pytester, monkeypatch: pytest.MonkeyPatch) -> Path:
    """All files of the page in one folder, as a student would have them."""
    monkeypatch.setenv("PYTHONPATH", str(ROOT))
    for name, text in FILES.items():
        path = pytester.path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    return pytester.path


def run(pytester: pytest.Pytester, *arguments: str) -> pytest.RunResult:
    """pytest in that folder, in a process of its own."""
    plugin = ["-p", "thymio_sim_ros.pytest_plugin", "-p", "no:cacheprovider"]
    return pytester.runpytest_subprocess(*plugin, *arguments, timeout=PROGRAM_S)


LONG = {"test_avoider.py", "test_follower.py", "test_misspelt.py", "test_two_nodes.py"}
"""Examples that only `make test-all` executes: others that need ROS, too, are executed by `make test`."""


def slow_if_long(name: str) -> object:
    return pytest.param(name, marks=pytest.mark.slow if name in LONG else ())


def test_the_page_has_its_examples() -> None:
    assert {"follower.aesl", "avoider.py", "caller.aesl", "comer.aesl", WORKFLOW} <= FILES.keys()
    assert FAILING.keys() == {"test_button.py", "test_misspelt.py"}
    assert {"test_avoider.py", "test_misspelt.py", "test_patrol.py", "test_two_nodes.py"} == NEED_ROS
    assert PAGE.count("```") == 2 * (len(FILES) + len(FAILING))


@pytest.mark.process
@pytest.mark.parametrize(
    "name",
    [slow_if_long(name) for name in sorted(FILES) if name.startswith("test_") and name not in FAILING],
)
def test_an_example_passes(pytester: pytest.Pytester, folder: Path, name: str) -> None:
    result = run(pytester, name)
    seeds = [int(number) for number in re.findall(r"range\((\d+)\)", FILES[name])]
    result.assert_outcomes(passed=FILES[name].count("\ndef test_") + sum(seeds) - len(seeds))


@pytest.mark.process
@pytest.mark.parametrize("name", [slow_if_long(name) for name in sorted(FAILING)])
def test_an_example_fails_as_the_page_says(pytester: pytest.Pytester, folder: Path, name: str) -> None:
    result = run(pytester, name)
    result.assert_outcomes(failed=1)
    said = "\n".join(line.rstrip() for line in result.outlines)
    assert FAILING[name].rstrip() in said


@pytest.mark.process
def test_examples_are_skipped_where_the_installed_ros_that_they_want_is_missing(
    pytester: pytest.Pytester, folder: Path
) -> None:
    (folder / "conftest.py").write_text(
        "import sys\nfor name in 'rclpy', 'geometry_msgs', 'sensor_msgs':\n    sys.modules[name] = None\n"
    )
    result = run(pytester, "--ros", "test_call.py", *(name for name in NEED_ROS if name != "test_avoider.py"))
    result.assert_outcomes(passed=1, skipped=3)  # a file that imports messages does without --ros where no ROS is


@pytest.mark.slow
@pytest.mark.process
def test_the_workflow_runs_what_there_is(pytester: pytest.Pytester, folder: Path) -> None:
    pytest.importorskip("xdist")
    install, command = re.findall(r"- run: (.*)", FILES[WORKFLOW])
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    requirement = shlex.split(install)[2]
    assert requirement == project["name"]
    words = shlex.split(command)
    begin = words.index("python")
    assert words[:begin] == ["timeout", "--kill-after=10s", "8m", "prlimit", "--cpu=300"]
    assert words[begin : begin + 3] == ["python", "-m", "pytest"]
    run(pytester, *words[begin + 3 :], "test_follower.py").assert_outcomes(passed=5)
    assert "<testcase" in (folder / "report.xml").read_text()


def test_every_name_of_the_page_s_tables_exists() -> None:
    from thymio_sim_ros import pytest_plugin, testing
    from thymio_sim_ros.testing import Thymio

    fixtures = re.findall(r"^\| `(\w+)` \|", PAGE, re.MULTILINE)
    assert all(hasattr(pytest_plugin, name) for name in fixtures)
    robot = PAGE.split("## A robot")[1].split("## Checks")[0]
    names = {name for row in re.findall(r"^\| (.*?) \|", robot, re.MULTILINE) for name in re.findall(r"`(\w+)", row)}
    missing = {name for name in names - {"thymio"} if not hasattr(Thymio, name)}
    assert missing == set()
    checks = PAGE.split("## Checks")[1].split("## ROS")[0]
    assert all(hasattr(testing, name) for name in re.findall(r"^\| `(\w+)\(", checks, re.MULTILINE))


@pytest.mark.skipif(not HAS_ROS, reason="needs ROS")
def test_every_name_of_the_page_s_ros_table_exists() -> None:
    from thymio_sim_ros.testing.ros import Recorder, Ros, Simulation

    table = PAGE.split("## ROS\n")[1]
    assert [name for name in re.findall(r"`ros\.(\w+)", table) if not hasattr(Ros, name)] == []
    assert [
        name for name in re.findall(r"`sim\.(\w+)", table) if name != "simulator" and not hasattr(Simulation, name)
    ] == []
    assert all(hasattr(Recorder, name) for name in ("latest", "next", "wait", "clear"))
