"""The modules of the room are those of rclpy; what they are made of is elsewhere."""

from __future__ import annotations

from importlib import import_module
from importlib.machinery import PathFinder
from pathlib import Path

import pytest

from thymio_sim_ros.portable_ros import rclpy as ours
from thymio_sim_ros.portable_ros.rclpy_parts.borrowed_names import BORROWED

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
    assert real - found == {"destroyable"}  # a protocol of handles


@pytest.mark.parametrize("module", BORROWED)
def test_names_that_modules_have_from_others_are_those_of_rclpy(module: str) -> None:
    names = {name for of_one in BORROWED[module].values() for name in of_one.split()}
    assert names <= set(dir(import_module(module)))
