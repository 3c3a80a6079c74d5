"""The modules of the room are those of rclpy; what they are made of is elsewhere."""

from __future__ import annotations

from importlib.machinery import PathFinder
from pathlib import Path

from thymio_sim_ros.portable_ros import rclpy as ours

C_LIBRARY = {"_rclpy_pybind11"}


def _modules(folder: Path) -> set[str]:
    return {path.relative_to(folder).with_suffix("").as_posix() for path in folder.rglob("*.py")}


def test_each_module_is_one_of_rclpy() -> None:
    spec = PathFinder.find_spec("rclpy")
    assert spec is not None
    assert spec.origin is not None
    real = _modules(Path(spec.origin).parent)
    found = _modules(Path(ours.__path__[0]))
    assert found - real == C_LIBRARY
    assert real - found == {"destroyable", "qos_event"}  # a protocol of handles, and a name that is no longer used
