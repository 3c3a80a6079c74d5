"""Tables: the same bytes for the same rows, read back exactly, and refused where they belong to something else."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest

from thymio_sim_ros.sweep.description import Description
from thymio_sim_ros.sweep.errors import SweepError
from thymio_sim_ros.sweep.grid import Sweep
from thymio_sim_ros.sweep.run import Row, failed_row
from thymio_sim_ros.sweep.table import check_suffix, columns, read_table, write_table

SUFFIXES = [".csv", ".parquet"]


@pytest.fixture
def sweep(describe: Callable[..., Description]) -> Sweep:
    parameters = {"SPEED": (100, 200), "noise": (True, False)}
    return describe(measures=("x_m", "contacts", "fallen"), parameters=parameters).sweep()


@pytest.fixture
def rows(sweep: Sweep) -> dict[int, list[Row]]:
    done = {"x_m": 0.1 + 0.2, "contacts": 3, "fallen": False, "robot": "thymio", "error": None}
    return {
        3: [failed_row(sweep, 3, 'ValueError: "a", b')],
        0: [failed_row(sweep, 0, "") | done],
        2: [failed_row(sweep, 2, "") | done | {"x_m": 1e-17, "fallen": True, "fault": "x: größer, \ny"}],
    }


@pytest.fixture(params=SUFFIXES)
def path(request: pytest.FixtureRequest, tmp_path: Path) -> Path:
    if request.param == ".parquet":
        pytest.importorskip("pyarrow")
    return tmp_path / f"table{request.param}"


def test_a_table_is_read_back_exactly_and_written_the_same(
    path: Path, sweep: Sweep, rows: dict[int, list[Row]]
) -> None:
    write_table(path, sweep, rows)
    first = path.read_bytes()
    found = read_table(path, sweep)
    assert found == rows
    assert list(found) == [0, 2, 3]
    write_table(path, sweep, {number: found[number] for number in (3, 0, 2)})
    assert path.read_bytes() == first


def test_a_large_table_digests_its_sweep_once(
    path: Path, sweep: Sweep, rows: dict[int, list[Row]], monkeypatch: pytest.MonkeyPatch
) -> None:
    digested: list[Sweep] = []
    monkeypatch.setattr(Sweep, "fingerprint", property(lambda one: digested.append(one) or "0" * 12))
    write_table(path, sweep, rows)
    read_table(path, sweep)
    assert len(digested) == 2


def test_columns_have_types(sweep: Sweep) -> None:
    types = {name: kind.__name__ for name, kind in columns(sweep).items()}
    assert types == {
        "sweep": "str", "run": "int", "program": "str", "playground": "str", "SPEED": "int", "noise": "bool",
        "seed": "int", "robot": "str", "x_m": "float", "contacts": "int", "fallen": "bool", "fault": "str",
        "error": "str",
    }  # fmt: skip


def test_a_file_that_is_not_there_has_no_rows(path: Path, sweep: Sweep) -> None:
    assert read_table(path, sweep) == {}


def test_the_table_of_another_sweep_is_refused(path: Path, sweep: Sweep, rows: dict[int, list[Row]]) -> None:
    write_table(path, sweep, rows)
    with pytest.raises(SweepError, match=r"results of another sweep \(.*choose another file with --output"):
        read_table(path, replace(sweep, seconds=3.0))
    with pytest.raises(SweepError, match=r"not a table of this sweep \(columns sweep, run, program, "):
        read_table(path, replace(sweep, measures=("y_m",)))


@pytest.mark.parametrize(
    ("content", "message"),
    [("a,b\n1,2\n", "not a table of this sweep"), ("", "not a table of this sweep"), ("{head}\nx,y\n", "line 2")],
)
def test_a_csv_file_that_is_no_table_is_refused(tmp_path: Path, sweep: Sweep, content: str, message: str) -> None:
    path = tmp_path / "table.csv"
    path.write_text(content.replace("{head}", ",".join(columns(sweep))))
    with pytest.raises(SweepError, match=message):
        read_table(path, sweep)


def test_a_parquet_file_that_is_none_is_refused(tmp_path: Path, sweep: Sweep) -> None:
    pytest.importorskip("pyarrow")
    path = tmp_path / "table.parquet"
    path.write_text("nonsense")
    with pytest.raises(SweepError, match="not a Parquet file"):
        read_table(path, sweep)


def test_other_suffixes_are_refused() -> None:
    with pytest.raises(SweepError, match=r"table\.xlsx: expected a name that ends in \.csv or \.parquet"):
        check_suffix(Path("table.xlsx"))
