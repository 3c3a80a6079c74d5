"""One run: what its parameters change, and what its measures are."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import pytest

from thymio_sim_ros.sweep import parameters
from thymio_sim_ros.sweep.description import Description
from thymio_sim_ros.sweep.run import LimitError, Row, failed_row, run_robots

Describe = Callable[..., Description]


def rows_of(description: Description) -> list[Row]:
    """The rows of all runs."""
    sweep = description.sweep()
    return [row for number in range(len(sweep)) for row in run_robots(sweep, number)]


def test_a_row_says_what_ran_and_what_was_measured(describe: Describe) -> None:
    named = ("event.beat", "first.beat", "event.other", "first.other", "variable.n", "variable.history[1]")
    description = describe(measures=(*Description().measures, *named), parameters={"noise": (False,)})
    (row,) = rows_of(description)
    assert {key: row[key] for key in ("run", "program", "playground", "seed", "robot")} == {
        "run": 0, "program": "pulse.aesl", "playground": "hall.json", "seed": 0, "robot": "thymio",
    }  # fmt: skip
    assert row["seconds"] == 2.0
    assert row["distance_m"] == pytest.approx(row["x_m"]) == pytest.approx(0.065, abs=0.005)
    assert row["laps"] == pytest.approx(row["x_m"], abs=0.01)  # the track is 1 m long
    assert row["line_m"] == pytest.approx(0.0, abs=1e-6)
    assert (row["contacts"], row["contact_s"], row["fallen"]) == (0, 0.0, False)
    assert row["area_m2"] == 0.005
    assert (row["events"], row["event.beat"], row["event.other"], row["first.other"]) == (4, 4, 0, None)
    assert row["first.beat"] == pytest.approx(0.5, abs=0.03)
    assert (row["variable.n"], row["variable.history[1]"]) == (4, 4)
    assert (row["fault"], row["error"]) == (None, None)


def test_the_same_run_has_the_same_row(describe: Describe) -> None:
    sweep = describe(seeds=(3,), programs=("explorer",)).sweep()
    assert run_robots(sweep, 0) == run_robots(sweep, 0)


def test_a_run_does_not_depend_on_the_one_before(describe: Describe) -> None:
    sweep = describe(seeds=(3, 4, 5), programs=("explorer",)).sweep()
    after_another = [run_robots(sweep, number) for number in (0, 2, 1)]
    parameters._ground.cache_clear()  # as in a new process
    assert run_robots(sweep, 1) == after_another[-1]


def test_a_contact_is_counted_once(describe: Describe) -> None:
    (row,) = rows_of(describe(parameters={"playground.box.x_m": (0.25,), "SPEED": (500,)}))
    assert row["contacts"] == 1
    assert 0.5 < float(row["contact_s"] or 0) < 2.0


@pytest.mark.parametrize(
    ("parameters", "measure"),
    [
        ({"SPEED": (100, 300)}, "x_m"),
        ({"offset": (0, 200)}, "yaw_rad"),
        ({"noise": (True, False)}, "y_m"),
        ({"motors": ("ideal", "firmware")}, "x_m"),
        ({"playground.thymio.x_m": (-0.5, 0.0)}, "x_m"),
    ],
)
def test_a_parameter_changes_the_run(describe: Describe, parameters: dict[str, Any], measure: str) -> None:
    first, second = rows_of(describe(parameters=parameters))
    ((name, values),) = parameters.items()
    assert (first[name], second[name]) == values
    assert first[measure] != second[measure]


def test_the_models_of_the_proximity_sensors_are_a_parameter(describe: Describe) -> None:
    parameters = {"proximity": ("default", "cone"), "noise": (False,), "playground.box.x_m": (0.2,)}
    first, second = rows_of(describe(parameters=parameters, measures=("variable.prox.horizontal[1]",), seconds=1.0))
    assert first["variable.prox.horizontal[1]"] != second["variable.prox.horizontal[1]"]


def test_each_robot_has_a_row(describe: Describe) -> None:
    rows = rows_of(describe(playgrounds=("two_robots",), seconds=0.1))
    assert [row["robot"] for row in rows] == ["red", "blue"]
    assert [row["laps"] for row in rows] == [None, None]


def test_a_fault_is_part_of_the_row(describe: Describe) -> None:
    description = describe(programs=("divide.aesl",), seconds=0.1)
    (description.folder / "divide.aesl").write_text("var n\nn = 1 / n\n")
    (row,) = rows_of(description)
    assert row["fault"] == "divide.aesl: fault in init, line 2: division by zero"


def test_a_run_ends_at_its_limit(describe: Describe) -> None:
    sweep = describe(seconds=60.0, limit_s=math.ulp(1.0)).sweep()
    with pytest.raises(LimitError, match="of processor time, the limit of a run"):
        run_robots(sweep, 0)


def test_a_failed_run_has_a_row_with_the_same_columns(describe: Describe) -> None:
    sweep = describe(parameters={"SPEED": (7,)}).sweep()
    row = failed_row(sweep, 0, "why")
    assert row.keys() == run_robots(sweep, 0)[0].keys()
    assert (row["SPEED"], row["robot"], row["x_m"], row["error"]) == (7, None, None, "why")
