"""Programs of VPL compile, and to the words of the original: `tests/data/web/vpl/programs.jsonl.gz`."""

from __future__ import annotations

import json
import subprocess
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import pytest

from aseba_vm import compile as compile_program
from aseba_vm.targets import THYMIO_II
from web_ui import build

SCRIPT = Path(__file__).with_name("print_vpl.js")
RANDOM_PROGRAMS = 8
EVENTS = (("pair_run", 1), ("debug_log", 14), ("PairExecuted", 1))

pytestmark = pytest.mark.process


@pytest.fixture(scope="module")
def printed() -> list[dict[str, Any]]:
    node = build.find_node()
    if node is None:
        pytest.skip("no Node on this machine")
    command = [node.folder / "node", SCRIPT, str(RANDOM_PROGRAMS)]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    return [json.loads(line) for line in done.stdout.splitlines()]


def words(text: str, events: Sequence[tuple[str, int]] = EVENTS) -> list[int]:
    return list(compile_program(text, THYMIO_II, events).words)


def test_the_golden_programs_have_the_words_of_the_original(printed: list[dict[str, Any]]) -> None:
    golden = [program for program in printed if "words" in program]
    assert len(golden) == 203
    assert [each["id"] for each in golden if words(each["text"], EVENTS[:2]) != each["words"]] == []


def test_what_any_version_generates_compiles(printed: list[dict[str, Any]]) -> None:
    others = [program for program in printed if "words" not in program]
    assert len(others) > RANDOM_PROGRAMS
    for program in others:
        assert words(program["text"]), program["id"]
