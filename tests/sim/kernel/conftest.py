"""Kernels compiled, and run by Python."""

from __future__ import annotations

import pytest

from tests.sim.kernel.engines import run_by_python
from thymio_sim_ros.sim.kernel.memory import KernelMemory


@pytest.fixture(params=["compiled", "by Python"])
def kernels(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> str:
    """How kernels are run in a test; each test runs both ways."""
    if request.param != "compiled":
        monkeypatch.setattr(KernelMemory, "bind", run_by_python)
    return str(request.param)
