"""Kernels compiled, and run by Python."""

from __future__ import annotations

import pytest

from thymio_sim_ros.sim.kernel import memory


@pytest.fixture(params=["compiled", "by Python"])
def kernels(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> str:
    """How kernels are run in a test; each test runs both ways."""
    if request.param != "compiled":
        monkeypatch.setattr(memory, "is_available", lambda: False)
    return str(request.param)
