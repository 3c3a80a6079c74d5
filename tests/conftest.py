"""Fixtures of all tests; those that need ROS come from the package itself, as a teacher would use them."""

from pathlib import Path

import hypothesis

hypothesis.settings.register_profile("thymio", deadline=None)  # a loaded machine is no defect
hypothesis.settings.load_profile("thymio")

# The same name as the entry point: where the package is installed, pytest has loaded it already.
pytest_plugins = ["pytester", "thymio_sim_ros.pytest_plugin"]


def pytest_addoption(parser):
    about = "run tests/aseba_vm and tests/sim on the vectors of this folder (plain or .gz) instead of ours"
    parser.addoption("--vectors", metavar="DIR", type=Path, default=None, help=about)
