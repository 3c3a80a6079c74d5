"""The result of a benchmark: tables and goals, which are stored as JSON and rendered as Markdown."""

from __future__ import annotations

import dataclasses
import datetime
import json
import math
import os
import platform
import re
import subprocess
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from importlib import metadata
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[2]
PACKAGES = ("numpy", "pymunk", "wasmtime")
"""Packages whose version affects the figures."""

Cell = str | float | int | None

_NUMBER = re.compile(r"([≤≥] )?-?[\d.]*( to [\d.]+)?( (×|%|% CPU|[kmµ]?[sB]))?")
"""A number or a range, perhaps with a limit's sign and a unit; or nothing."""


@dataclass(frozen=True)
class Table:
    """Column heads and rows of cells; None is an empty cell. The title is a line above the table."""

    columns: Sequence[str]
    rows: Sequence[Sequence[Cell]]
    title: str = ""


@dataclass(frozen=True)
class Goal:
    """A limit that was set before the measurement: at most `limit`, or at least if `is_least`."""

    what: str
    limit: float
    measured: Cell
    unit: str = ""
    is_least: bool = False

    @property
    def is_reached(self) -> bool:
        """Whether the measured number respects the limit; False if it is text."""
        if not isinstance(self.measured, int | float):
            return False
        return self.measured >= self.limit if self.is_least else self.measured <= self.limit


@dataclass(frozen=True)
class Report:
    """What a benchmark returns."""

    tables: Sequence[Table]
    goals: Sequence[Goal] = field(default_factory=tuple)


def result(name: str, report: Report, arguments: Sequence[str], against: Path | None, load: float) -> Any:
    """Return what is stored as JSON: the report, and how, when and where it was measured.

    `load` is the load average before the measurement.
    """
    return {
        "benchmark": name,
        "command": " ".join(["python -m benchmarks", name, *arguments]),
        "date": datetime.datetime.now(tz=datetime.UTC).date().isoformat(),
        "commit": commit(ROOT),
        "against": None if against is None else commit(against),
        "machine": machine(),
        "load": round(load, 1),
        "tables": [dataclasses.asdict(table) | {"rows": _rounded(table.rows)} for table in report.tables],
        "goals": [
            dataclasses.asdict(goal) | {"measured": _rounded([[goal.measured]])[0][0], "is_reached": goal.is_reached}
            for goal in report.goals
        ],
    }


def _rounded(rows: Iterable[Iterable[Cell]]) -> list[list[Cell]]:
    return [[_round(cell) if isinstance(cell, float) else cell for cell in row] for row in rows]


def _round(value: float) -> float | None:
    return float(f"{value:.4g}") if math.isfinite(value) else None


def commit(checkout: Path) -> str:
    """Return the short commit of a checkout, with "+" if files are changed, apart from results; empty without git."""
    git = ["git", "-C", str(checkout)]
    found = subprocess.run([*git, "rev-parse", "--short=7", "HEAD"], capture_output=True, text=True, check=False)
    if found.returncode:
        return ""
    changed = [*git, "status", "--porcelain", "--", ".", ":!benchmarks/results", ":!docs"]
    is_changed = bool(subprocess.run(changed, capture_output=True, text=True, check=False).stdout)
    return found.stdout.strip() + "+" * is_changed


def machine() -> str:
    """Describe processor, system and packages on one line."""
    model = platform.processor() or platform.machine()
    cpu_info = Path("/proc/cpuinfo")
    if cpu_info.is_file():
        lines = (line.partition(":") for line in cpu_info.read_text(encoding="utf-8").splitlines())
        model = next((value.strip() for key, _, value in lines if key.strip() == "model name"), model)
    parts = [f"{os.cpu_count()} cores of {model}", f"Python {platform.python_version()}"]
    for package in PACKAGES:
        try:
            parts.append(f"{package} {metadata.version(package)}")
        except metadata.PackageNotFoundError:
            parts.append(f"no {package}")
    return ", ".join(parts)


def markdown(stored: Any) -> str:
    """Render the tables of a stored result, and a line that says how they were measured."""
    parts = []
    for table in stored["tables"]:
        text = markdown_table(table["columns"], table["rows"])
        parts.append(f"{table['title']}:\n\n{text}" if table["title"] else text)
    against = f", in turn with commit {stored['against']}" if stored["against"] else ""
    source = f"commit {stored['commit']}, " if stored["commit"] else ""
    load = "" if stored["load"] is None else f"; load average {stored['load']}"
    parts.append(f"`{stored['command']}`: {source}{stored['date']}{against}; {stored['machine']}{load}.")
    return "\n\n".join(parts)


def goals_table(stored: Sequence[Any]) -> str:
    """Render the goals of stored results."""
    rows = [[one["benchmark"], *_goal_row(goal)] for one in stored for goal in one["goals"]]
    return markdown_table(("benchmark", "goal", "limit", "measured", "reached"), rows)


def _goal_row(goal: Any) -> list[Cell]:
    limit = f"{'≥' if goal['is_least'] else '≤'} {_text(goal['limit'])}{_unit(goal)}"
    measured = _text(goal["measured"])
    return [
        goal["what"],
        limit,
        f"{measured}{_unit(goal)}" if measured else None,
        "yes" if goal["is_reached"] else "no",
    ]


def _unit(goal: Any) -> str:
    return f" {goal['unit']}" if goal["unit"] else ""


def markdown_table(columns: Sequence[str], rows: Sequence[Sequence[Cell]]) -> str:
    """Render a table; columns of numbers are aligned to the right."""
    texts = [[_text(cell) for cell in row] for row in rows]
    are_numbers = [all(map(_NUMBER.fullmatch, column)) for column in zip(*texts, strict=True)]
    marks = ["---", *("---:" if is_right else "---" for is_right in are_numbers[1:])]
    lines = [columns, marks, *texts]
    return "\n".join(f"| {' | '.join(line)} |" for line in lines)


def _text(cell: Cell) -> str:
    if cell is None:
        return ""
    if isinstance(cell, float):
        return f"{cell:.0f}" if abs(cell) >= 100 else f"{cell:.3g}"
    return str(cell)


def load(path: Path) -> Any:
    """Read a stored result."""
    return json.loads(path.read_text(encoding="utf-8"))


def save(path: Path, stored: Any) -> None:
    """Write a result, with a line for each row of a table and for each goal."""
    lines = ",\n".join(f"{json.dumps(key)}: {_lines(value)}" for key, value in stored.items())
    path.write_text(f"{{\n{lines}\n}}\n", encoding="utf-8")


def _lines(value: Any) -> str:
    if isinstance(value, dict) and "rows" in value:
        return f"{{{', '.join(f'{json.dumps(key)}: {_lines(part)}' for key, part in value.items())}}}"
    if isinstance(value, list) and value and not isinstance(value[0], str):
        return "[\n" + ",\n".join(map(_lines, value)) + "\n]"
    return json.dumps(value, ensure_ascii=False)
