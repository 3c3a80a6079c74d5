"""Every document that code, tests and pages cite is in the repository, and has the section that is named."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator
from functools import cache
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


@cache
def headings(page: Path) -> tuple[str, ...]:
    return tuple(re.findall(r"^#{1,6} (.+)$", page.read_text(encoding="utf-8"), re.MULTILINE))


def faults(text: str, path: Path) -> Iterator[tuple[int, str]]:
    """What is wrong with the citations in the text of a file: where in the text, and a sentence."""
    for match in NAMELESS.finditer(text):
        yield match.start(), f"a document without a file name: {match[0]!r}"
    if ".md" not in text:
        return  # as in most files; the other patterns take longer
    for match in PAGES.finditer(text):
        if not (ROOT / match[0]).is_file():
            yield match.start(), f"{match[0]} is not there"
    for match in SECTIONS.finditer(text):
        page = page_of(match["page"], path)
        if not page.is_file():
            yield match.start(), f"{match['page']} is not there"
            continue
        known = {heading.split()[0].rstrip(".") for heading in headings(page)}
        for number in re.findall(r"\d+(?:\.\d+)*", match["numbers"]):
            if number not in known:
                yield match.start(), f"{match['page']} has no section {number}"
    for match in TITLES.finditer(text):
        page = page_of(match["page"], path)
        if not page.is_file() or match["title"] not in headings(page):
            yield match.start(), f'{match["page"]} has no heading "{match["title"]}"'


def anchors(page: Path) -> set[str]:
    """The anchors that a site gives the headings of a page."""
    words = (re.sub(r"[`*]|\[([^]]*)\]\([^)]*\)", r"\1", heading).lower() for heading in headings(page))
    return {re.sub(r"[^\w\- ]", "", heading).replace(" ", "-") for heading in words}


def broken_links(text: str, page: Path) -> Iterator[tuple[int, str]]:
    """The relative links of a page that lead nowhere, code aside: where in the text, and the link."""
    blocks = [range(*match.span()) for match in re.finditer(r"^```.*?^```", text, re.MULTILINE | re.DOTALL)]
    for match in re.finditer(r"\]\((?!https?:|mailto:)([^)\s]+)\)", text):
        path, _, anchor = match[1].partition("#")
        target = page.parent / path if path else page
        is_broken = not target.exists() or (anchor and anchor not in anchors(target))
        if is_broken and not any(match.start() in block for block in blocks):
            yield match.start(), f"{match[1]} leads nowhere"


def missing_tests(text: str, page: Path) -> Iterator[tuple[int, str]]:
    """The tests that a page names and that do not exist: where in the text, and the name."""
    for match in TESTS.finditer(text):
        if not list(ROOT.glob(match[1])):
            yield match.start(), f"{match[1]} is not there"


def found_in(paths: Iterable[Path], check: Callable[[str, Path], Iterator[tuple[int, str]]]) -> str:
    """What a check finds in files, a line each with file and line number."""
    lines = []
    for path in paths:
        text = path.read_text(encoding="utf-8")
        for start, sentence in check(text, path):
            lines.append(f"{path.relative_to(ROOT)}:{text.count(chr(10), 0, start) + 1}: {sentence}")
    return "\n".join(lines)


def test_every_relative_link_leads_somewhere() -> None:
    found = found_in(PAGES_OF_OURS, broken_links)
    assert not found, found


def test_every_test_that_a_page_names_is_there() -> None:
    found = found_in(PAGES_OF_OURS, missing_tests)
    assert not found, found


def test_every_cited_document_and_section_is_there() -> None:
    found = found_in(texts(), faults)
    assert not found, found


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
def test_a_citation_of_what_is_not_there_is_found(text, fault) -> None:
    assert fault in [sentence for _, sentence in faults(text, ROOT / "tests" / "module.py")]


@pytest.mark.parametrize("link", ["nothing.md", "architecture.md#nothing", "#nothing"])
def test_a_link_to_what_is_not_there_is_found(link) -> None:
    page = ROOT / "docs" / "glossary.md"
    assert list(broken_links(f"[here]({link})", page)) == [(5, f"{link} leads nowhere")]
    assert list(broken_links(f"```\n[here]({link})\n```", page)) == []


def test_a_test_that_is_not_there_is_found() -> None:
    assert list(missing_tests("`tests/test_nothing.py`", ROOT / "README.md")) == [
        (0, "tests/test_nothing.py is not there")
    ]
