"""Every document that code, tests and pages cite is in the repository, and has the section that is named."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent
FOLDERS = ("aseba_vm", "thymio_sim_ros", "web_ui", "tests", "benchmarks", "docs", ".ci")
SUFFIXES = {".py", ".js", ".css", ".grammar", ".html", ".json", ".md", ".sh", ".xml", ".toml"}
GENERATED = {"node_modules", "dist", "__pycache__", "vectors"}

PAGES_OF_OURS = [*sorted((ROOT / "docs").rglob("*.md")), *sorted(ROOT.glob("*.md"))]

#: `docs/spec/thymio-robot.md sections 7.2 and 7.4`; a line break may be anywhere, also behind the mark of a comment.
GAP = r"(?:\s|#|//|\*)+"
SECTIONS = re.compile(
    rf"(?P<page>[\w./-]+\.md),?{GAP}sections?{GAP}(?P<numbers>\d+(?:\.\d+)*(?:(?:,|{GAP}(?:and|to)){GAP}\d+(?:\.\d+)*)*)"
)
#: `docs/architecture.md, "Threads"`
TITLES = re.compile(rf"(?P<page>[\w./-]+\.md),{GAP}\"(?P<title>[^\"\n]+)\"")
PAGES = re.compile(r"(?<![\w/])docs/[\w./-]+\.md")
#: `tests/sim/physics`, `tests/sim/*.py`, `tests/test_readme.py`
TESTS = re.compile(r"`(tests/[\w./*-]+)`")
#: Documents without a file name cannot be opened.
NAMELESS = re.compile(rf"(?i)\b(?:spec|paper|language|vm|protocol|architecture|performance),?{GAP}section{GAP}\d")


def texts() -> list[Path]:
    """All files of ours that people read, without what is built or recorded."""
    inside = [path for folder in FOLDERS for path in (ROOT / folder).rglob("*")]
    found = [path for path in [*inside, *ROOT.glob("*")] if path.is_file() and path.suffix in SUFFIXES]
    return [path for path in found if GENERATED.isdisjoint(path.relative_to(ROOT).parts) and path != Path(__file__)]


def page_of(cited: str, citing: Path) -> Path:
    """The cited file: below the repository for `docs/…`, beside the citing page for a bare name in `docs/`."""
    return ROOT / cited if cited.startswith("docs/") else citing.parent / cited


def headings(page: Path) -> list[str]:
    return re.findall(r"^#{1,6} (.+)$", page.read_text(encoding="utf-8"), re.MULTILINE)


def faults(path: Path) -> list[str]:
    """What is wrong with the citations of one file, each as a sentence."""
    text = path.read_text(encoding="utf-8")
    found = [f"{page} is not there" for page in PAGES.findall(text) if not (ROOT / page).is_file()]
    found += [f"a document without a file name: {match[0]!r}" for match in NAMELESS.finditer(text)]
    for match in SECTIONS.finditer(text):
        page = page_of(match["page"], path)
        if not page.is_file():
            found.append(f"{match['page']} is not there")
            continue
        known = {heading.split()[0].rstrip(".") for heading in headings(page)}
        cited = re.findall(r"\d+(?:\.\d+)*", match["numbers"])
        found += [f"{match['page']} has no section {number}" for number in cited if number not in known]
    for match in TITLES.finditer(text):
        page = page_of(match["page"], path)
        if not page.is_file() or match["title"] not in headings(page):
            found.append(f'{match["page"]} has no heading "{match["title"]}"')
    return found


def anchors(page: Path) -> set[str]:
    """The anchors that a site gives the headings of a page."""
    words = (re.sub(r"[`*]|\[([^]]*)\]\([^)]*\)", r"\1", heading).lower() for heading in headings(page))
    return {re.sub(r"[^\w\- ]", "", heading).replace(" ", "-") for heading in words}


@pytest.mark.parametrize("page", PAGES_OF_OURS, ids=lambda page: str(page.relative_to(ROOT)))
def test_every_relative_link_leads_somewhere(page: Path) -> None:
    text = re.sub(r"^```.*?^```", "", page.read_text(encoding="utf-8"), flags=re.MULTILINE | re.DOTALL)
    broken = []
    for link in re.findall(r"\]\((?!https?:|mailto:)([^)\s]+)\)", text):
        path, _, anchor = link.partition("#")
        target = page.parent / path if path else page
        if not target.exists() or (anchor and anchor not in anchors(target)):
            broken.append(link)
    assert broken == []


@pytest.mark.parametrize("page", PAGES_OF_OURS, ids=lambda page: str(page.relative_to(ROOT)))
def test_every_test_that_a_page_names_is_there(page: Path) -> None:
    names = TESTS.findall(page.read_text(encoding="utf-8"))
    assert [name for name in names if not list(ROOT.glob(name))] == []


def test_every_cited_document_and_section_is_there() -> None:
    wrong = {str(path.relative_to(ROOT)): said for path in texts() if (said := faults(path))}
    assert wrong == {}


@pytest.mark.parametrize(
    ("text", "fault"),
    [
        ("docs/spec/nothing.md", "docs/spec/nothing.md is not there"),
        ("nothing.md section 3", "nothing.md is not there"),
        ("docs/spec/thymio-robot.md section 77.1", "docs/spec/thymio-robot.md has no section 77.1"),
        ("docs/spec/thymio-robot.md sections 7.1 and\n# 77", "docs/spec/thymio-robot.md has no section 77"),
        ('docs/architecture.md, "Nothing"', 'docs/architecture.md has no heading "Nothing"'),
        ("VM spec, section 3", "a document without a file name: 'spec, section 3'"),
    ],
)
def test_a_citation_of_what_is_not_there_is_found(tmp_path, text, fault) -> None:
    path = tmp_path / "module.py"
    path.write_text(text, encoding="utf-8")
    assert fault in faults(path)
