"""Finds functions of the tests that a submission has replaced in the process of the test.

Code in the same interpreter can change anything, also this check. It finds assignments to functions, methods and
classes of the fixtures, the checks, pytest and the tests, methods that are added to their classes, and functions of
Python that the tests use: those that are built in, and those of modules such as `math`.
"""

from __future__ import annotations

import builtins
import sys
from collections.abc import Iterator
from pathlib import Path
from types import BuiltinFunctionType, FunctionType, ModuleType
from typing import Any

__all__ = ["TestFunctions"]

_PACKAGES = ("thymio_sim_ros", "aseba_vm", "_pytest", "pluggy")
_OF_PYTHON = ("builtins", "math", "cmath", "operator", "statistics", "itertools", "functools", "re", "json")
"""Modules that compute what tests compare. No program has a reason to change them, as it has with hooks of `sys`."""


class TestFunctions:
    """The functions that verdicts depend on, as they were before a submission was there."""

    __test__ = False

    def __init__(self) -> None:
        self._known: list[tuple[str, Any, str, Any, tuple[Any, ...]]] = []
        """Path of a name, its owner, name, value, and the code that the value runs."""
        self._owners: list[tuple[str, Any, frozenset[str]]] = []
        """Path of a module or class of the tests, and the names that it had."""

    def remember(self, folder: Path) -> None:
        """Remember the functions of pytest, of this package, and of the tests in a folder."""
        modules = [module for module in list(sys.modules.values()) if _is_of_tests(module, folder)]
        owners = [pair for module in modules for pair in _owners(module)]
        self._known = [
            (f"{path}.{name}", owner, name, value, _code(value))
            for path, owner in [*owners, *((name, sys.modules[name]) for name in _OF_PYTHON if name in sys.modules)]
            for name, value in list(vars(owner).items())
            if _code(value)
        ]
        self._owners = [(path, owner, frozenset(vars(owner))) for path, owner in owners]

    def replaced(self) -> list[str]:
        """Return a message for each function that is another one now."""
        changed = [
            path
            for path, owner, name, value, code in self._known
            if vars(owner).get(name) is not value or _code(value) != code
        ]
        added = [
            f"{path}.{name}"
            for path, owner, names in self._owners
            for name, value in list(vars(owner).items())
            if name not in names and _code(value) and (isinstance(owner, type) or hasattr(builtins, name))
        ]
        return [f"the submission replaced {path}, a function of the tests: remove that" for path in [*changed, *added]]


def _is_of_tests(module: ModuleType, folder: Path) -> bool:
    name = getattr(module, "__name__", "")
    return name.partition(".")[0] in _PACKAGES or Path(getattr(module, "__file__", None) or "/").is_relative_to(folder)


def _owners(module: ModuleType) -> Iterator[tuple[str, Any]]:
    """The module and the classes that it defines, with their paths."""
    yield module.__name__, module
    for name, value in list(vars(module).items()):
        if isinstance(value, type) and value.__module__ == module.__name__:
            yield f"{module.__name__}.{name}", value


def _code(value: object) -> tuple[Any, ...]:
    """The code that a function, method or property runs, or the class itself; empty for anything else."""
    if isinstance(value, FunctionType):
        return (value.__code__,)
    if isinstance(value, BuiltinFunctionType | type):
        return (value,)
    if isinstance(value, staticmethod | classmethod):
        return _code(value.__func__)
    if isinstance(value, property):
        return tuple(code for part in (value.fget, value.fset) for code in _code(part))
    return ()
