"""Seeds of tests that try the same with other random numbers."""

from __future__ import annotations

from typing import Any

import pytest


def seeds(count: int, *, landing: int = 1) -> list[Any]:
    """The parameters 0 to `count` - 1, of which `make test` has the first `landing`, and `make test-all` all."""
    return [pytest.param(seed, marks=() if seed < landing else pytest.mark.slow) for seed in range(count)]
