"""Which Python is tested: `THYMIO_TEST_PYTHON`, by default that of the tests."""

from __future__ import annotations

import importlib.util
import sys

import pytest

from tests.processes import PYTHON


@pytest.fixture(scope="package", autouse=True)
def _computer_without_ros() -> None:
    """Skip these tests where all other tests of the suite run."""
    if sys.executable == PYTHON and importlib.util.find_spec("rclpy"):
        pytest.skip("here the other tests run; on another computer: make windows-test, make arm64-test")
