"""Conditions that need something that has not happened yet."""

from __future__ import annotations

import pytest

from thymio_sim_ros.testing.awaited import Awaited, NothingYetError


def test_a_condition_is_false_while_there_is_nothing_yet() -> None:
    arrived: list[int] = []

    def latest_is_positive() -> bool:
        if not arrived:
            raise NothingYetError("no message came on /numbers")
        return arrived[-1] > 0

    awaited = Awaited(latest_is_positive)
    assert awaited() is False
    assert awaited.missing() == "\n(no message came on /numbers)"
    arrived.append(1)
    assert awaited() is True
    assert awaited.missing() == ""


def test_other_errors_are_raised() -> None:
    with pytest.raises(KeyError):
        Awaited(lambda: {}["absent"])()
