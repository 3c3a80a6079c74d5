"""The table of all targets."""

from __future__ import annotations

from importlib import import_module
from importlib.util import find_spec

from tests.fuzz.target import Target

__all__ = ["MODULE_OF", "TARGETS", "targets_of"]

_MODULES = ("aseba", "networks", "bridge", "playgrounds", "robot_files", "runs", "classes", "ros", "student_nodes")


def targets_of(module: str) -> dict[str, Target]:
    """Return the targets of a module of `tests.fuzz.targets` by name; none of ROS where it is not installed."""
    if module == "ros" and find_spec("rclpy") is None:
        return {}
    found = import_module(f"tests.fuzz.targets.{module}").TARGETS
    return {target.name: target for target in found}


_BY_MODULE = {module: targets_of(module) for module in _MODULES}
TARGETS = {name: target for targets in _BY_MODULE.values() for name, target in targets.items()}
MODULE_OF = {name: module for module, targets in _BY_MODULE.items() for name in targets}
