"""The JSON tables of docs/spec/ match the compiler and the machine."""

from __future__ import annotations

import json
import re
import sys
from pathlib import Path
from typing import Any

from aseba_vm.frontend.identifiers import LETTER_OR_DIGIT
from aseba_vm.machine.fixed_point_trigonometry import ARCTANGENT, SINE
from aseba_vm.messages import MESSAGES

SPEC = Path(__file__).parents[2] / "docs" / "spec"


def table(name: str) -> dict[str, Any]:
    content: dict[str, Any] = json.loads((SPEC / name).read_text(encoding="utf-8"))
    return content


def test_letters_and_digits_of_names() -> None:
    is_in_names = re.compile(f"[{LETTER_OR_DIGIT}]").fullmatch
    ours = {point for point in range(sys.maxunicode + 1) if is_in_names(chr(point))}
    listed = {
        point for first, last in table("aseba-identifier-ranges.json")["ranges"] for point in range(first, last + 1)
    }
    assert ours == listed


def test_sine_and_arc_tangent() -> None:
    tables = table("aseba-native-tables.json")
    assert (tuple(tables["sin"]), tuple(tables["atan"])) == (SINE, ARCTANGENT)


def test_wording_of_errors() -> None:
    templates = table("aseba-messages.json")["templates"]
    assert templates == {kind: MESSAGES[kind] for kind in templates}
