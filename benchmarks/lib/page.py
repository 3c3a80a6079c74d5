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
    """Return the page with all tables made again."""
    return _MARKED.sub(lambda match: f"{match[1]}\n{_section(match['name'], results)}\n\n{match[3]}", text)


def names(text: str) -> list[str]:
    """Return the names at the markers of a page."""
    return [match["name"] for match in _MARKED.finditer(text)]


def render() -> None:
    """Write the tables of the page again."""
    PAGE.write_text(rendered(PAGE.read_text(encoding="utf-8")), encoding="utf-8")


def _section(name: str, results: Path) -> str:
    if name != "goals":
        path = results / f"{name}.json"
        if not path.is_file():
            return f"Not stored yet: `python -m benchmarks {name}`."
        return report.markdown(report.load(path))
    return report.goals_table([report.load(path) for path in sorted(results.glob("*.json"))])
