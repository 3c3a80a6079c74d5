"""Conditions in words."""

from __future__ import annotations

from functools import partial

from thymio_sim_ros.testing.failure_messages import describe_condition

COUNT = [3]


def has_come() -> bool:
    """A condition."""
    return bool(COUNT)


def test_a_function_is_described_by_its_name() -> None:
    assert describe_condition(has_come) == "has_come"
    assert describe_condition(COUNT.__len__).startswith("<")


def test_a_lambda_is_described_by_its_source() -> None:
    assert describe_condition(lambda: COUNT[0] > 5) == "COUNT[0] > 5"
    text = describe_condition(
        lambda: (
            sum(COUNT) > 4  # shortened to one line
        )
    )
    assert text == "sum(COUNT) > 4"


def test_a_lambda_inside_a_statement_is_described_by_its_part_of_the_source() -> None:
    for told_text in [describe_condition(lambda: COUNT == []) for _ in range(1)]:
        assert told_text == "COUNT == []"
    with_block = describe_condition((lambda: COUNT[0]))  # noqa: UP034  (brackets of its own)
    assert with_block == "COUNT[0]"


def test_a_lambda_without_a_source_is_described_by_its_line() -> None:
    assert describe_condition(eval("lambda: 1")) == "the lambda of line 1"


def test_other_conditions_are_described_by_their_repr() -> None:
    assert describe_condition(partial(int, "1")) == "functools.partial(<class 'int'>, '1')"
