"""Whatever a file holds: a playground, or a PlaygroundError with its name; never anything else."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from hypothesis import given
from hypothesis import strategies as st

from tests.sim.builders import PLAYGROUNDS
from thymio_sim_ros.sim.playground import reader
from thymio_sim_ros.sim.playground.reader import Playground, PlaygroundError
from thymio_sim_ros.sim.playground.writer import dumps
from thymio_sim_ros.sim.shapes import all_shapes

ASEBA = (
    '<aseba-playground><color name="w" r="1" g="1" b="1"/><world w="100" h="100" color="w"/><area name="a">'
    '<point x="-5" y="-5"/><point x="5" y="-5"/><point x="0" y="5"/></area><wall x="20" y="20" l1="5" l2="5" h="5" '
    'color="w" mass="3"/><door name="d" closedX="60" closedY="30" openedX="70" openedY="30" l1="10" l2="1" h="10" '
    'moveDuration="2" color="w"/><activation x="20" y="60" l1="5" l2="4" area="a" door="d"/><robot x="50" y="50"/>'
    "</aseba-playground>"
)
SHIPPED = [path for path in sorted(PLAYGROUNDS.glob("*.json")) if path.stem in ("obstacle", "gate", "arena", "line")]

NUMBERS = st.one_of(st.integers(), st.floats(), st.sampled_from([0, -0.0, 1e308, 5e-324, 10**400]))
VALUES = st.recursive(
    st.one_of(st.none(), st.booleans(), NUMBERS, st.text(max_size=10)),
    lambda inner: st.one_of(st.lists(inner, max_size=3), st.dictionaries(st.text(max_size=5), inner, max_size=3)),
    max_leaves=5,
)


def loaded(data: str | bytes) -> Playground | None:
    """What comes of it; any other error fails the test."""
    try:
        return reader.loads(data, "fuzz.json")
    except PlaygroundError as error:
        reported = (error.path == "fuzz.json", bool(error.found), bool(error.expected))
    assert reported == (True, True, True)
    return None


def paths(value: Any, path: tuple[Any, ...] = ()) -> list[tuple[Any, ...]]:
    """Every place in a JSON value."""
    items = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    return [path, *(found for key, inner in items for found in paths(inner, (*path, key)))]


def changed(text: str, place: int, value: Any) -> str:
    """The text of a JSON value with the value at one of its places replaced."""
    data = {"all": json.loads(text)}
    places = paths(data)[1:]
    *above, key = places[place % len(places)]
    target: Any = data
    for step in above:
        target = target[step]
    target[key] = value
    return json.dumps(data["all"])


@given(st.binary(max_size=200))
def test_bytes_of_any_kind(data: bytes) -> None:
    loaded(data)


@given(st.sampled_from([b"PK\x03\x04", b"<", b"{", b'{"format": 1, ']), st.binary(max_size=200))
def test_bytes_that_begin_well(begin: bytes, data: bytes) -> None:
    loaded(begin + data)


@given(VALUES)
def test_json_of_any_kind(value: Any) -> None:
    loaded(json.dumps(value))


@given(st.sampled_from(SHIPPED), st.integers(0, 10_000), VALUES)
def test_a_shipped_playground_with_one_value_changed(path: Path, place: int, value: Any) -> None:
    found = loaded(changed(path.read_text(), place, value))
    if found is not None:
        assert reader.loads(dumps(found), found.name) == found


@given(st.sampled_from([kind.name for kind in all_shapes()]), st.dictionaries(st.text(max_size=8), VALUES, max_size=4))
def test_shapes_of_any_fields(kind: str, members: dict[str, Any]) -> None:
    loaded(json.dumps({"format": 1, "title": "x", "shapes": [{**members, "kind": kind}]}))


@given(st.integers(0, len(ASEBA)), st.integers(0, 20), st.text(alphabet='<>"/= x1-.&;', max_size=8))
def test_an_aseba_playground_with_a_piece_replaced(place: int, size: int, piece: str) -> None:
    loaded(ASEBA[:place] + piece + ASEBA[place + size :])


@given(
    st.sampled_from(["planes", "octagons", "boxes", "cylinders", "uShapes", "tracks", "thymios", "playground"]),
    VALUES,
)
def test_a_playground_of_the_thesis_with_any_value(key: str, value: Any) -> None:
    loaded(json.dumps({"playground": "x", key: value}))
