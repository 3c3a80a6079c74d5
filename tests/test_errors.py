"""All exceptions of the package have one base: `thymio_sim_ros.errors.ThymioSimError`."""

from __future__ import annotations

import importlib
import inspect
import pkgutil
from importlib.util import find_spec

import thymio_sim_ros
from thymio_sim_ros.errors import ThymioSimError

NEEDED = {
    "thymio_sim_ros.launch": "launch_ros",
    "thymio_sim_ros.lockstep": "rclpy",
    "thymio_sim_ros.ros": "rclpy",
    "thymio_sim_ros.testing.ros": "rclpy",
    "thymio_sim_ros.tf": "rclpy",
    "thymio_sim_ros.turtlesim": "turtlesim",
}
"""Packages that not every installation has, by the modules that need them."""

MODULES = [
    module.name
    for module in pkgutil.walk_packages(thymio_sim_ros.__path__, "thymio_sim_ros.")
    if not module.name.endswith(("__main__", "cli.preload"))
]
"""All that do nothing when they are imported."""


def _exceptions(module: str) -> list[type[Exception]]:
    """Classes of errors that a module defines. What `except Exception` must not catch is no error."""
    classes = inspect.getmembers(importlib.import_module(module), inspect.isclass)
    return [kind for _, kind in classes if issubclass(kind, Exception) and kind.__module__ == module]


OF_RCLPY = ("thymio_sim_ros.portable_ros.rclpy.", "thymio_sim_ros.portable_ros.rclpy_parts.")
"""Its exceptions have the bases of rclpy's."""


def _is_importable(module: str) -> bool:
    needed = [package for name, package in NEEDED.items() if module.startswith(name)]
    return all(find_spec(package) is not None for package in needed)


def test_every_exception_of_a_module_has_the_common_base() -> None:
    wrong = [
        f"{module}:{inspect.getsourcelines(kind)[1]}: {kind.__name__} does not inherit ThymioSimError"
        for module in MODULES
        if _is_importable(module) and not module.startswith(OF_RCLPY)
        for kind in _exceptions(module)
        if not issubclass(kind, ThymioSimError)
    ]
    assert not wrong, "\n".join(wrong)


def test_the_walk_finds_exceptions_that_exist() -> None:
    found = {
        kind.__name__
        for module in ("files.registry", "sim.model.fields")
        for kind in _exceptions(f"thymio_sim_ros.{module}")
    }
    assert found == {"FieldError", "RegistryError"}


def test_built_in_bases_that_callers_rely_on_are_kept() -> None:
    from thymio_sim_ros.device.options import OptionError
    from thymio_sim_ros.engine.command_codec import CommandJsonError

    assert issubclass(OptionError, ValueError)
    assert issubclass(CommandJsonError, ValueError)
