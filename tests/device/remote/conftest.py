"""Fixtures of the tests of remote robots."""

from __future__ import annotations

import pytest

from tests.device.remote.pair import Pair


@pytest.fixture
def pair() -> Pair:
    """A robot that has connected."""
    pair = Pair()
    pair.plug_in()
    return pair
