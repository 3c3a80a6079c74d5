"""CBOR of clients: what is accepted, and that hostile messages cost little."""

from __future__ import annotations

import cbor2
import pytest
from hypothesis import given
from hypothesis import strategies as st

from thymio_sim_ros.bridge.rosbridge.bounded_cbor import MAX_ITEMS, loads

VALUES = st.recursive(
    st.none()
    | st.booleans()
    | st.integers(-(1 << 63), (1 << 64) - 1)
    | st.floats(allow_nan=False)
    | st.text()
    | st.binary(),
    lambda inner: st.lists(inner) | st.dictionaries(st.text(), inner),
    max_leaves=20,
)


@given(VALUES)
def test_a_value_survives(value: object) -> None:
    assert loads(cbor2.dumps(value)) == value


@given(st.binary(max_size=200))
def test_any_bytes_are_decoded_as_by_the_library_or_rejected(data: bytes) -> None:
    try:
        found = loads(data)
    except ValueError:
        return
    assert cbor2.dumps(found) == cbor2.dumps(cbor2.loads(data))


def test_a_long_byte_string_is_one_item() -> None:
    data = bytes(4 << 20)
    assert loads(cbor2.dumps({"bytes": data})) == {"bytes": data}


@pytest.mark.parametrize(
    ("data", "text"),
    [
        (b"", "expected 1 more items, found the end after 0 bytes"),
        (b"\x82\x01", "expected 1 more items, found the end after 2 bytes"),
        (b"\x45ab", "expected 6 bytes, found 3"),
        (b"\x01\x02", "expected 1 bytes, found 2"),
        (b"\x9a\x00\x10\x00\x00" + b"\x80" * (1 << 20), f"more than {MAX_ITEMS} items"),
        (b"\x9b" + b"\xff" * 8, f"more than {MAX_ITEMS} items"),
        (b"\x9f\xff", "byte 0: expected no tag and no indefinite length, found 0x9f"),
        (cbor2.dumps(1 << 80), "byte 0: expected no tag and no indefinite length, found 0xc2"),
        (b"\x81" * 5000 + b"\x01", "nesting"),
        (b"\x61\xff", "text string"),
    ],
    ids=["empty", "short list", "short bytes", "rest", "many", "huge", "indefinite", "tag", "deep", "text"],
)
def test_a_hostile_message_is_rejected_with_the_reason(data: bytes, text: str) -> None:
    with pytest.raises(ValueError, match=r".+") as caught:
        loads(data)
    assert text in str(caught.value)
