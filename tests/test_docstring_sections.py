"""Docstrings in the reference of `make docs`."""

from __future__ import annotations

import importlib.util
from pathlib import Path
from types import ModuleType

import pytest

SOURCE = Path(__file__).parent.parent / "docs" / "docstring_sections.py"


@pytest.fixture(name="sections", scope="module")
def _sections() -> ModuleType:
    pytest.importorskip("myst_parser", reason="comes with the extra docs")
    spec = importlib.util.spec_from_file_location("docstring_sections", SOURCE)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_sections_become_lists(sections: ModuleType) -> None:
    docstring = """Execute the event.

Args:
    limit: maximum number of instructions,
        0 for no limit.
    is_quiet: whether nothing is printed.

Returns:
    Whether anything
    was executed.

Raises:
    ValueError: The limit is negative.

Nothing else: a colon here is a colon."""
    assert sections.with_lists(docstring).splitlines() == [
        "Execute the event.",
        "",
        "**Args**",
        "- `limit`: maximum number of instructions,",
        "  0 for no limit.",
        "- `is_quiet`: whether nothing is printed.",
        "",
        "**Returns**",
        "- Whether anything",
        "  was executed.",
        "",
        "**Raises**",
        "- `ValueError`: The limit is negative.",
        "",
        "Nothing else: a colon here is a colon.",
    ]


def test_a_docstring_without_sections_stays_as_it_is(sections: ModuleType) -> None:
    docstring = "One line.\n\n    >>> code\n    42\n"
    assert sections.with_lists(docstring) == docstring.rstrip("\n")
