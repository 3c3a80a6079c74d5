"""Fixtures of all tests; those that need ROS come from the package itself, as a teacher would use them."""

import importlib.util
from pathlib import Path

import hypothesis

hypothesis.settings.register_profile("thymio", deadline=None)  # a loaded machine is no defect
hypothesis.settings.load_profile("thymio")

if importlib.util.find_spec("rclpy") is not None:
    pytest_plugins = ["thymio_sim_ros.testing"]


def pytest_addoption(parser):
    about = "run tests/aseba_vm and tests/sim on the vectors of this folder (plain or .gz) instead of ours"
    parser.addoption("--vectors", metavar="DIR", type=Path, default=None, help=about)
