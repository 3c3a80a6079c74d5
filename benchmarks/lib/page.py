"""The page of results: what is between its markers is rendered from the stored results.

    <!-- results: NAME -->  …  <!-- end of results -->

`goals` stands for the goals of all benchmarks.
"""

from __future__ import annotations

import re
from pathlib import Path

from benchmarks.lib import report

RESULTS = report.ROOT / "benchmarks" / "results"
PAGE = report.ROOT / "docs" / "performance.md"
_MARKED = re.compile(r"(<!-- results: (?P<name>\w+) -->\n).*?(<!-- end of results -->)", re.DOTALL)


def rendered(text: str, results: Path = RESULTS) -> str:
    """Return the page with all tables made again. Raises FileNotFoundError for a name without a result."""
    return _MARKED.sub(lambda match: f"{match[1]}\n{_section(match['name'], results)}\n\n{match[3]}", text)


def names(text: str) -> list[str]:
    """Return the names at the markers of a page."""
    return [match["name"] for match in _MARKED.finditer(text)]


def render() -> None:
    """Write the tables of the page again."""
    PAGE.write_text(rendered(PAGE.read_text(encoding="utf-8")), encoding="utf-8")


def _section(name: str, results: Path) -> str:
    if name != "goals":
        return report.markdown(report.load(results / f"{name}.json"))
    stored = [report.load(path) for path in sorted(results.glob("*.json"))]
    rows = [[one["benchmark"], *report.goal_row(goal)] for one in stored for goal in one["goals"]]
    return report.markdown_table(("benchmark", *report.GOAL_COLUMNS), rows)
