"""Untrusted JSON is decoded in a bounded time."""

from __future__ import annotations

import json

import pytest

from thymio_sim_ros.bridge.protocol.bounded_json import MAX_STRUCTURE, TooMuchStructureError, loads


@pytest.mark.parametrize(
    "text",
    [
        "[" + "[]," * MAX_STRUCTURE + "1]",
        "1" * (MAX_STRUCTURE + 1),
        "[" * (MAX_STRUCTURE + 1),
        json.dumps(["x"] * MAX_STRUCTURE),
        json.dumps({"text": "x" * MAX_STRUCTURE, "list": list(range(MAX_STRUCTURE))}),
        '"' + '\\"' * MAX_STRUCTURE + '"' + "," * MAX_STRUCTURE,
    ],
    ids=["lists", "digits", "brackets", "strings", "list behind text", "commas behind quotes"],
)
def test_much_structure_is_rejected(text: str) -> None:
    with pytest.raises(TooMuchStructureError):
        loads(text)


@pytest.mark.parametrize(
    "value",
    [
        "x" * 4_000_000,
        {"parameters": [{"name": "/simulator.playground", "value": json.dumps({"image": "A" * 3_000_000})}]},
        ['a "quoted" text \\ é ' * MAX_STRUCTURE] * 3,
        {"subscriptions": [{"id": number, "channelId": number} for number in range(3500)]},
    ],
    ids=["text", "playground", "escapes", "subscriptions"],
)
def test_long_texts_are_read(value: object) -> None:
    assert loads(json.dumps(value)) == value
    assert loads(json.dumps(value, ensure_ascii=False)) == value


@pytest.mark.parametrize("text", ['"' + "x" * MAX_STRUCTURE, '["a\nb' + "x" * MAX_STRUCTURE + '"]', "nonsense"])
def test_invalid_json_is_a_value_error(text: str) -> None:
    with pytest.raises(ValueError, match=r"line|Expecting"):
        loads(text)
