"""Messages in several parts."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from thymio_sim_ros.bridge.protocol.errors import FrameError
from thymio_sim_ros.bridge.rosbridge.fragments import MAX_OPEN, Fragments, split


def _part(key: str, number: int, total: int, data: str = "ab") -> dict[str, object]:
    return {"op": "fragment", "id": key, "num": number, "total": total, "data": data}


@given(st.text(max_size=2000), st.integers(0, 500), st.randoms())
def test_a_message_survives_in_parts_that_arrive_in_any_order(text: str, size: int, random: object) -> None:
    parts = list(split(text, size, "7"))
    random.shuffle(parts)  # type: ignore[attr-defined]
    fragments = Fragments(1 << 20)
    found = [fragments.add(part) for part in parts]
    assert found == [*[None] * (len(parts) - 1), text] if parts else text == ""


def test_the_parts_of_two_messages_may_alternate() -> None:
    fragments = Fragments(10_000)
    found = [fragments.add(_part(key, number, 2, f"{key}{number}")) for number in (0, 1) for key in "xy"]
    assert found == [None, None, "x0x1", "y0y1"]


def test_a_part_that_comes_again_replaces_the_first_one() -> None:
    fragments = Fragments(10_000)
    assert [fragments.add(_part("x", number, 2, data)) for number, data in ((0, "a"), (0, "b"), (1, "c"))][-1] == "bc"


@pytest.mark.parametrize(("number", "total", "where"), [(0, 0, "total"), (2, 2, "num"), (0, 1 << 20, "total")])
def test_an_impossible_part_is_rejected(number: int, total: int, where: str) -> None:
    with pytest.raises(FrameError) as caught:
        Fragments(10_000).add(_part("x", number, total))
    assert caught.value.where == f"fragment.{where}"


def test_incomplete_messages_are_dropped_above_their_size_and_number() -> None:
    fragments = Fragments(10_000)
    fragments.add(_part("x", 0, 3, "a" * 9000))
    with pytest.raises(FrameError, match="incomplete messages of at most 10000 characters"):
        fragments.add(_part("x", 1, 3, "a" * 1000))
    fragments.add(_part("first", 0, 2))
    for number in range(MAX_OPEN):
        fragments.add(_part(str(number), 0, 2))
    assert fragments.add(_part("first", 1, 2)) is None
    assert fragments.add(_part("15", 1, 2)) == "abab"
