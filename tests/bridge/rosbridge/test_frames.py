"""Operations as messages, and pictures that are messages."""

from __future__ import annotations

import base64
import io

import cbor2
import pytest
from hypothesis import given
from hypothesis import strategies as st
from PIL import Image

from thymio_sim_ros.bridge.protocol.errors import FrameError
from thymio_sim_ros.bridge.rosbridge import frames


@pytest.mark.parametrize(
    "frame",
    ['{"op":"x","id":1}', b'{"op":"x","id":1}', cbor2.dumps({"op": "x", "id": 1})],
    ids=["text", "bytes", "cbor"],
)
def test_an_operation_is_json_or_cbor(frame: str | bytes) -> None:
    assert frames.decode(frame) == {"op": "x", "id": 1}


@pytest.mark.parametrize(
    ("frame", "text"),
    [
        ("{", "message: expected an operation in JSON or CBOR, found '{': Expecting property name"),
        (b"{\xff", "message: expected an operation in JSON or CBOR, found b'{\\xff': 'utf-8'"),
        ("[]", "message: expected an object with the key \"op\", found '[]'"),
        (b"\x80", "message: expected an object with the key \"op\", found b'\\x80'"),
        ('{"op":7}', "op: expected the name of an operation, found 7"),
        ("{}", "op: expected the name of an operation, found None"),
        ('{"op":' + "[" * 5000, "message: expected an operation in JSON or CBOR"),
        ('{"op":"x","msg":[' + "1," * 100_000 + "1]}", "more than 131072 characters outside of strings"),
    ],
    ids=["half", "utf-8", "list", "cbor list", "number", "none", "deep", "long"],
)
def test_any_other_message_is_rejected_with_the_reason(frame: str | bytes, text: str) -> None:
    with pytest.raises(FrameError) as caught:
        frames.decode(frame)
    assert text in str(caught.value)


@given(st.text(alphabet=st.characters(exclude_characters="\n", codec="utf-8"), min_size=1, max_size=300))
def test_a_text_survives_as_a_picture(text: str) -> None:
    picture = Image.open(io.BytesIO(base64.b64decode(frames.as_png(text))))
    assert picture.convert("RGB").tobytes().decode().rstrip("\n") == text


def test_a_status_has_the_id_of_its_operation() -> None:
    assert frames.status("error", "no", 7) == {"op": "status", "level": "error", "msg": "no", "id": 7}
    assert frames.status("info", "yes") == {"op": "status", "level": "info", "msg": "yes"}
