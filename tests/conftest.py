"""Fixtures of all tests; those that need ROS come from the package itself, as a teacher would use them."""

import signal
from collections.abc import Iterator
from pathlib import Path

import hypothesis
import pytest

# Whatever a shell starts in the background ignores Ctrl-C, and so would every program that a test starts.
if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)

hypothesis.settings.register_profile("thymio", deadline=None)  # a loaded machine is no defect
hypothesis.settings.load_profile("thymio")

# The same name as the entry point: where the package is installed, pytest has loaded it already.
pytest_plugins = ["pytester", "thymio_sim_ros.pytest_plugin"]


@pytest.fixture(autouse=True)
def _signal_handlers() -> Iterator[None]:
    """Restore the handlers: `run_main` ignores signals at its end, and programs of later tests would inherit that."""
    numbers = (signal.SIGINT, signal.SIGTERM)
    before = [signal.getsignal(number) for number in numbers]
    yield
    for number, handler in zip(numbers, before, strict=True):
        if signal.getsignal(number) is not handler:
            signal.signal(number, handler)


def pytest_addoption(parser):
    about = "run tests/aseba_vm and tests/sim on the vectors of this folder (plain or .gz) instead of ours"
    parser.addoption("--vectors", metavar="DIR", type=Path, default=None, help=about)


def pytest_collection_modifyitems(items):
    """Mark the tests that need ROS, so that `make check` can leave them out: by their folder or by their fixtures."""
    folders = [Path(__file__).parent / name for name in ("ros", "testing/ros", "tf")]
    for item in items:
        fixtures = {"ros", "ros_domain"}.intersection(getattr(item, "fixturenames", ()))
        if fixtures or any(folder in item.path.parents for folder in folders):
            item.add_marker("ros")
