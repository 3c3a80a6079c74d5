"""Results of benchmarks: goals, storing and rendering."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

from benchmarks import simulator_runner
from benchmarks.lib import page, report, rounds
from benchmarks.lib.report import Goal, Report, Table

REPORT = Report(
    [Table(["what", "ms"], [["fast", 0.1236], ["slow", 1234.5], ["failed", math.inf], ["unknown", None]], "Times")],
    [Goal("fast", 0.1, 0.1236, "ms"), Goal("ratio", 2.0, 2.5, "×", is_least=True)],
)

OTHER_CHECKOUT = {
    "__init__.py": "",
    "engine/engine.py": """
from types import SimpleNamespace

class Engine:
    world = SimpleNamespace(robots=["thymio"])

    def __init__(self, _playground):
        pass

    def post(self, *_command):
        pass

    def run(self, seconds):
        print("another engine runs", seconds)
""",
    "files/loading.py": "load_playground = lambda _path: (None, None)\nread_program = None\n",
    "sim/commands.py": "MotorTargets = lambda *_speeds: None\n",
    "sim/playground/reader.py": "Playground = RobotStart = loads = None\n",
}
"""Modules of `thymio_sim_ros` that the benchmark `simulator_runner` imports, with an engine that prints."""


@pytest.mark.parametrize(
    ("measured", "is_least", "is_reached"),
    [(1.0, False, True), (1.01, False, False), (1.0, True, True), (0.99, True, False), ("1 to 2", False, False)],
)
def test_a_goal_is_reached_up_to_its_limit(measured: float | str, is_least: bool, is_reached: bool) -> None:
    assert Goal("time", 1.0, measured, is_least=is_least).is_reached is is_reached


@pytest.mark.process
def test_a_result_is_stored_and_rendered(tmp_path: Path) -> None:
    path = tmp_path / "one.json"
    report.save(path, report.result("one", REPORT, ["--rounds", "2"], None, 0.5))
    stored = report.load(path)
    assert stored["tables"][0]["rows"] == [["fast", 0.1236], ["slow", 1234.0], ["failed", None], ["unknown", None]]
    text = report.markdown(stored)
    assert text.startswith("Times:\n\n| what | ms |\n| --- | ---: |\n| fast | 0.124 |\n| slow | 1234 |\n| failed |  |")
    assert "`python -m benchmarks one --rounds 2`: commit " in text
    assert text.endswith("load average 0.5.")


@pytest.mark.process
def test_a_section_of_the_page_is_rendered_again(tmp_path: Path) -> None:
    report.save(tmp_path / "one.json", report.result("one", REPORT, [], None, 0.5))
    end = "<!-- end of results -->\n"
    text = f"before\n<!-- results: goals -->\nold\n{end}<!-- results: two -->\n{end}"
    first = page.rendered(text, tmp_path)
    assert "old" not in first
    assert "| one | fast | ≤ 0.1 ms | 0.124 ms | no |\n| one | ratio | ≥ 2 × | 2.5 × | yes |" in first
    assert "Not stored yet: `python -m benchmarks two`." in first
    assert page.rendered(first, tmp_path) == first


def test_measures_run_in_turn_and_the_first_round_does_not_count() -> None:
    order: list[str] = []

    def run(name: str) -> float:
        order.append(name)
        return float(len(order))

    found = rounds.in_turn({"a": lambda: run("a"), "b": lambda: run("b")}, 2)
    assert order == ["a", "b"] * 3
    assert found == {"a": [3.0, 5.0], "b": [4.0, 6.0]}
    assert rounds.medians(found) == {"a": 4.0, "b": 5.0}


@pytest.mark.process
def test_a_worker_measures_with_the_packages_of_another_checkout(tmp_path: Path, capfd) -> None:
    for name, text in OTHER_CHECKOUT.items():
        path = tmp_path / "thymio_sim_ros" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
    worker = rounds.Worker(tmp_path, "simulator_runner:runner_of", simulator_runner.IDLE, 7.0)
    assert worker() > 0.0
    worker.close()
    assert capfd.readouterr().err == "another engine runs 7.0\n"


@pytest.mark.process
def test_a_worker_that_fails_is_an_error(tmp_path: Path) -> None:
    worker = rounds.Worker(tmp_path, "simulator_runner:nothing")
    with pytest.raises(RuntimeError, match="a worker failed"):
        worker()
    worker.close()
