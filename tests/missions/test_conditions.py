"""Conditions of missions over time."""

from __future__ import annotations

import pytest

from thymio_sim_ros.missions.conditions import names_in, read_condition
from thymio_sim_ros.sim.model.fields import FieldError

NAMES = ("a", "b", "c")


def values(data: object, ticks: str) -> list[bool]:
    """What a condition says in each tick; a tick is the facts that are true, as in "a ab -"; ticks are 0.5 s."""
    condition = read_condition(data, "success", NAMES)
    facts = [{name: name in tick for name in NAMES} for tick in ticks.split()]
    return [condition.update(tick, number / 2) for number, tick in enumerate(facts)]


@pytest.mark.parametrize(
    ("data", "ticks", "wanted"),
    [
        ("a", "- a -", "010"),
        ({"all": ["a", "b"]}, "a b ab", "001"),
        ({"any": ["a", "b"]}, "- b ab", "011"),
        ({"not": "a"}, "- a", "10"),
        ({"once": "a"}, "- a -", "011"),
        ({"then": ["a", "b"]}, "b - a - b -", "000011"),
        ({"then": ["a", "b"]}, "ab", "1"),
        ({"then": ["a", "b", "a"]}, "a b - a", "0001"),
        ({"hold": "a", "for_s": 1}, "a a - a a a a", "0000011"),
        ({"at_most": 1, "of": "a"}, "- a a - - a -", "1111100"),
        ({"at_most": 0, "of": "a"}, "- a -", "100"),
        ({"all": [{"once": "a"}, {"hold": {"not": "b"}, "for_s": 1}]}, "a - - b -", "00100"),
    ],
)
def test_a_condition_has_its_value_in_each_tick(data: object, ticks: str, wanted: str) -> None:
    assert values(data, ticks) == [value == "1" for value in wanted]


@pytest.mark.parametrize(
    ("data", "error"),
    [
        ("d", "success: found 'd', expected a fact: one of a, b, c"),
        (3, "success: found 3, expected the name of a fact or an object"),
        ({}, "success: found {}, expected one of all, any, not, once, then, hold, at_most"),
        ({"all": ["a"], "any": ["b"]}, "success: found all, any, expected one of"),
        ({"all": []}, r"success.all: found \[\], expected a list of 1 to 30 conditions"),
        ({"any": ["a", {"not": "x"}]}, r"success.any\[1\].not: found 'x'"),
        ({"hold": "a"}, "success.for_s: found None, expected seconds above 0"),
        ({"hold": "a", "for_s": True}, "success.for_s: found True"),
        ({"at_most": 1.5, "of": "a"}, "success.at_most: found 1.5, expected a whole number"),
        ({"at_most": 1}, "success.of: found nothing, expected a condition"),
        ({"once": "a", "text": "x"}, "success.text: found an unknown key, expected one of once"),
    ],
)
def test_a_condition_that_is_wrong_names_its_place(data: object, error: str) -> None:
    with pytest.raises(FieldError, match=error):
        read_condition(data, "success", NAMES)


def test_a_condition_that_is_too_deep_is_refused() -> None:
    data: object = "a"
    for _ in range(50):
        data = {"not": data}
    with pytest.raises(FieldError, match="at most 8 deep"):
        read_condition(data, "success", NAMES)


def test_a_condition_that_would_slow_down_each_tick_is_refused() -> None:
    data: object = "a"
    for _ in range(3):
        data = {"all": [data] * 30}
    with pytest.raises(FieldError, match="success: found 27000 names of facts, expected at most 200"):
        read_condition(data, "success", NAMES)


def test_the_facts_of_a_condition_are_known_in_order() -> None:
    data = {"then": [{"hold": "b", "for_s": 2}, {"any": ["a", {"at_most": 2, "of": "c"}]}]}
    assert list(names_in(data)) == ["b", "a", "c"]
