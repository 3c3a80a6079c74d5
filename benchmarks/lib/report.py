"""The result of a benchmark: tables and goals, which are stored as JSON and rendered as Markdown."""

from __future__ import annotations

import dataclasses
import datetime
import json
import math
import os
import platform
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


def result(name: str, report: Report, arguments: Sequence[str], against: Path | None, *, is_quick: bool) -> Any:
    """Return what is stored as JSON: the report, and how, when and where it was measured."""
    return {
        "benchmark": name,
        "command": " ".join(["python -m benchmarks", name, *arguments]),
        "date": datetime.datetime.now(tz=datetime.UTC).date().isoformat(),
        "commit": commit(ROOT),
        "against": None if against is None else commit(against),
        "machine": machine(),
        "load": round(os.getloadavg()[0], 1),
        "is_quick": is_quick,
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
    """Return the short commit of a checkout, with "+" if files are changed; empty without git."""
    command = ["git", "-C", str(checkout), "describe", "--always", "--abbrev=7", "--dirty=+", "--exclude=*"]
    found = subprocess.run(command, capture_output=True, text=True, check=False)
    return found.stdout.strip()


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
    """Render the tables and goals of a stored result, and a line that says how they were measured."""
    parts = []
    for table in stored["tables"]:
        text = markdown_table(table["columns"], table["rows"])
        parts.append(f"{table['title']}:\n\n{text}" if table["title"] else text)
    if stored["goals"]:
        parts.append(markdown_table(GOAL_COLUMNS, [goal_row(goal) for goal in stored["goals"]]))
    against = f", in turn with commit {stored['against']}" if stored["against"] else ""
    source = f"commit {stored['commit']}, " if stored["commit"] else ""
    load = "" if stored["load"] is None else f"; load average {stored['load']}"
    parts.append(f"`{stored['command']}`: {source}{stored['date']}{against}; {stored['machine']}{load}.")
    return "\n\n".join(parts)


GOAL_COLUMNS = ("goal", "limit", "measured", "reached")


def goal_row(goal: Any) -> list[Cell]:
    """Return the row of a stored goal."""
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
    """Render a table; all columns but the first are aligned to the right."""
    texts = [[_text(cell) for cell in row] for row in rows]
    marks = ["---" if column == 0 else "---:" for column in range(len(columns))]
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
    """Write a result, a line for each row of a table."""
    text = json.dumps(stored, indent=1, ensure_ascii=False)
    path.write_text(text + "\n", encoding="utf-8")
