"""The fields of operations."""

from __future__ import annotations

from typing import Any

import pytest

from thymio_sim_ros.bridge.protocol.errors import FrameError
from thymio_sim_ros.bridge.rosbridge.operations import OPERATIONS, check


def test_null_is_a_missing_field_and_unknown_fields_stay() -> None:
    given = {"op": "advertise", "topic": "/a", "type": "std_msgs/Bool", "id": None, "new": 1}
    assert check(given) == {"op": "advertise", "topic": "/a", "type": "std_msgs/Bool", "new": 1}


@pytest.mark.parametrize("name", OPERATIONS)
def test_an_operation_without_a_needed_field_is_rejected_by_its_name(name: str) -> None:
    for field in OPERATIONS[name].needs:
        whole: dict[str, Any] = {"op": name, **dict.fromkeys(OPERATIONS[name].needs, "1")}
        whole.update({"num": 0, "total": 1, "level": "info"} if name in ("fragment", "set_level") else {})
        del whole[field]
        with pytest.raises(FrameError) as caught:
            check(whole)
        assert caught.value.where == f"{name}.{field}"
        assert caught.value.found == "nothing"


@pytest.mark.parametrize(
    ("given", "text"),
    [
        ({"op": "fly"}, "op: expected one of advertise, "),
        ({"op": "subscribe", "topic": 1}, "subscribe.topic: expected a text of at most 1024 characters, found 1"),
        ({"op": "subscribe", "topic": "/" * 1025}, "subscribe.topic: expected a text of at most 1024 characters"),
        ({"op": "subscribe", "topic": "/a", "throttle_rate": -1}, "subscribe.throttle_rate: expected a finite number"),
        ({"op": "subscribe", "topic": "/a", "queue_length": True}, "subscribe.queue_length: expected an integer"),
        ({"op": "subscribe", "topic": "/a", "throttle_rate": float("nan")}, "subscribe.throttle_rate: expected a"),
        (
            {"op": "subscribe", "topic": "/a", "fragment_size": float("inf")},
            "subscribe.fragment_size: expected an integer",
        ),
        ({"op": "subscribe", "topic": "/a", "compression": "zip"}, "compression: expected one of none, cbor, cbor-raw"),
        ({"op": "subscribe", "topic": "/a", "compression": []}, "compression: expected one of none, cbor, cbor-raw"),
        ({"op": "subscribe", "topic": "/a", "qos": 1}, "subscribe.qos: expected an object, found 1"),
        ({"op": "subscribe", "topic": "/a", "id": [1]}, "subscribe.id: expected a text or an integer, found [1]"),
        ({"op": "subscribe", "topic": "/a", "id": "i" * 1025}, "subscribe.id: expected a text or an integer"),
        ({"op": "subscribe", "topic": "/a", "id": "\ud800"}, "subscribe.id: expected a text or an integer"),
        ({"op": "set_level", "level": "loud"}, "set_level.level: expected one of info, warning, error, none"),
        (
            {"op": "advertise", "topic": "/a", "type": "t", "latch": 1},
            "advertise.latch: expected true or false, found 1",
        ),
    ],
)
def test_a_wrong_field_is_rejected_with_what_was_expected_and_found(given: dict[str, Any], text: str) -> None:
    with pytest.raises(FrameError) as caught:
        check(given)
    assert text in str(caught.value)
