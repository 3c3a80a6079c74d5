"""The table of a sweep: a row for each run and robot, in the order of the runs, as CSV or Parquet by the file's suffix.

The file is replaced as a whole each time, so that it is complete whenever it is read; it is also what a sweep resumes
from. The same rows give the same bytes.
"""

from __future__ import annotations

import csv
import io
from collections.abc import Callable, Iterable, Mapping
from importlib.util import find_spec
from pathlib import Path

from aseba_vm.cli.output import write_file
from thymio_sim_ros.sweep.errors import SweepError
from thymio_sim_ros.sweep.grid import Sweep, Value
from thymio_sim_ros.sweep.measures import measure_of
from thymio_sim_ros.sweep.run import Row

__all__ = ["check_suffix", "columns", "read_table", "write_table"]

CSV, PARQUET = ".csv", ".parquet"

Columns = Mapping[str, type[Value]]
"""Type of each column by name, in order."""


def check_suffix(path: Path) -> None:
    """Raise SweepError if a file of this name cannot be written."""
    if path.suffix not in (CSV, PARQUET):
        raise SweepError(f"{path}: expected a name that ends in {CSV} or {PARQUET}")
    if path.suffix == PARQUET and find_spec("pyarrow") is None:
        raise SweepError(f"{path}: pyarrow is not installed; run `pip install pyarrow`, or choose a name in {CSV}")


def columns(sweep: Sweep) -> Columns:
    """The columns of the table of a sweep."""
    parameters = {name: _common_type(values) for name, values in sweep.parameters}
    measures = {name: measure_of(name).type for name in sweep.measures}
    head: dict[str, type[Value]] = {"sweep": str, "run": int, "program": str, "playground": str}
    return {**head, **parameters, "seed": int, "robot": str, **measures, "fault": str, "error": str}


def write_table(path: Path, sweep: Sweep, rows: Mapping[int, Iterable[Row]]) -> None:
    """Write the rows of runs, given by number of the run, in their order. Raises OSError."""
    types = columns(sweep)
    fingerprint = sweep.fingerprint  # of all texts and seeds: once, not for each row
    ordered = [{"sweep": fingerprint, **row} for number in sorted(rows) for row in rows[number]]
    encode = _parquet if path.suffix == PARQUET else _csv
    write_file(str(path), encode(types, ordered))


def read_table(path: Path, sweep: Sweep) -> dict[int, list[Row]]:
    """The rows of the finished runs of a sweep by number; none if there is no file.

    Raises SweepError if the file is not a table of this sweep, OSError if it cannot be read.
    """
    if not path.exists():
        return {}
    types = columns(sweep)
    rows = (_from_parquet if path.suffix == PARQUET else _from_csv)(path, types)
    finished: dict[int, list[Row]] = {}
    fingerprint = sweep.fingerprint
    for row in rows:
        found, number = row.pop("sweep"), row["run"]
        if found != fingerprint:
            raise _foreign(path, f"it has the results of another sweep ({found}, this one is {fingerprint})")
        if not isinstance(number, int) or number not in range(len(sweep)):
            raise _foreign(path, f"found run {number}, expected 0 to {len(sweep) - 1}")
        finished.setdefault(number, []).append(row)
    return finished


def _foreign(path: Path, why: str) -> SweepError:
    return SweepError(f"{path}: {why}; delete or move it, or choose another file with --output")


def _check_names(path: Path, found: Iterable[str], types: Columns) -> None:
    names = list(found)
    if names != list(types):
        shown = ", ".join(names[:6]) + (", …" if len(names) > 6 else "")
        raise _foreign(path, f"it is not a table of this sweep (columns {shown})")


def _common_type(values: tuple[Value, ...]) -> type[Value]:
    types = {type(value) for value in values}
    if len(types) == 1:
        return types.pop()
    return float if types == {int, float} else str


def _coerced(value: Value | None, kind: type[Value]) -> Value | None:
    """A value in the type of its column."""
    return value if value is None or type(value) is kind else kind(value)


def _csv(types: Columns, rows: list[Row]) -> bytes:
    text = io.StringIO(newline="")
    table = csv.writer(text, lineterminator="\n")
    table.writerow(types)
    for row in rows:
        table.writerow(_text(_coerced(row[name], kind)) for name, kind in types.items())
    return text.getvalue().encode("utf-8")


def _text(value: Value | None) -> str:
    if value is None:
        return ""
    return str(value).lower() if isinstance(value, bool) else str(value)


def _from_csv(path: Path, types: Columns) -> list[Row]:
    with path.open(encoding="utf-8", newline="") as file:
        lines = csv.reader(file)
        try:
            _check_names(path, next(lines, []), types)
            return [
                {name: _value(text, kind) for (name, kind), text in zip(types.items(), line, strict=True)}
                for line in lines
            ]
        except (ValueError, csv.Error) as error:
            if isinstance(error, SweepError):
                raise
            raise _foreign(path, f"line {lines.line_num}: {error}") from error


_PARSED: Mapping[type[Value], Callable[[str], Value]] = {
    bool: lambda text: text == "true",
    int: int,
    float: float,
    str: str,
}


def _value(text: str, kind: type[Value]) -> Value | None:
    return None if text == "" else _PARSED[kind](text)


def _parquet(types: Columns, rows: list[Row]) -> bytes:
    import pyarrow
    from pyarrow import parquet

    arrow = {bool: pyarrow.bool_(), int: pyarrow.int64(), float: pyarrow.float64(), str: pyarrow.string()}
    arrays = [pyarrow.array([_coerced(row[name], kind) for row in rows], arrow[kind]) for name, kind in types.items()]
    sink = pyarrow.BufferOutputStream()
    parquet.write_table(pyarrow.table(arrays, names=list(types)), sink)
    return bytes(sink.getvalue())


def _from_parquet(path: Path, types: Columns) -> list[Row]:
    import pyarrow
    from pyarrow import parquet

    try:
        table = parquet.read_table(path)
        _check_names(path, table.column_names, types)
        return list(table.to_pylist())
    except SweepError:
        raise
    except (pyarrow.ArrowException, ValueError) as error:  # ValueError: names and texts that are not UTF-8
        raise _foreign(path, f"it is not a Parquet file ({error})") from error
