"""Functions that were replaced are found, and nothing else."""

from __future__ import annotations

import builtins
import json
import math
import sys
from collections.abc import Callable
from pathlib import Path
from types import ModuleType

import pytest

from thymio_sim_ros.grading.integrity import TestFunctions
from thymio_sim_ros.testing import Classroom, Thymio, no_contact

SOURCE = """
import functools
values = []
def helper(): return 1
class Base:
    def method(self): return 1
    @property
    def value(self): return 1
    @staticmethod
    def static(): return 1
"""


@pytest.fixture
def module(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> ModuleType:
    """A module of the tests of an assignment."""
    made = ModuleType("test_of_an_assignment")
    made.__file__ = str(tmp_path / "test_of_an_assignment.py")
    exec(SOURCE, vars(made))
    monkeypatch.setitem(sys.modules, made.__name__, made)
    return made


@pytest.fixture
def functions(module: ModuleType, tmp_path: Path) -> TestFunctions:
    """The functions as they are now."""
    remembered = TestFunctions()
    remembered.remember(tmp_path)
    return remembered


def other(*_: object) -> int:
    """Another function."""
    return 2


@pytest.mark.parametrize(
    ("replace", "name"),
    [
        (lambda module: setattr(module, "helper", other), "helper"),
        (lambda module: delattr(module, "helper"), "helper"),
        (lambda module: setattr(module.helper, "__code__", (lambda: 2).__code__), "helper"),
        (lambda module: setattr(module.Base, "method", other), "Base.method"),
        (lambda module: setattr(module.Base, "value", property(other)), "Base.value"),
        (lambda module: setattr(module.Base, "static", staticmethod(other)), "Base.static"),
        (lambda module: setattr(module, "Base", type("Base", (), {})), "Base"),
        (lambda module: setattr(module.Base, "__getattribute__", other), "Base.__getattribute__"),
        (lambda module: setattr(module, "abs", other), "abs"),
    ],
)
def test_what_is_replaced_is_found(
    module: ModuleType, functions: TestFunctions, replace: Callable[[ModuleType], None], name: str
) -> None:
    assert functions.replaced() == []
    replace(module)
    assert functions.replaced() == [
        f"the submission replaced test_of_an_assignment.{name}, a function of the tests: remove that"
    ]


def test_a_method_of_a_fixture_that_is_replaced_is_found(
    functions: TestFunctions, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(Thymio, "until", other)
    (message,) = functions.replaced()
    assert "thymio_sim_ros.testing.thymio.Thymio.until" in message


@pytest.mark.parametrize(("owner", "name"), [(builtins, "abs"), (builtins, "float"), (math, "hypot"), (json, "loads")])
def test_a_function_of_python_that_is_replaced_is_found(
    functions: TestFunctions, monkeypatch: pytest.MonkeyPatch, owner: ModuleType, name: str
) -> None:
    with monkeypatch.context() as patched:
        patched.setattr(owner, name, other)
        messages = functions.replaced()
    assert messages == [f"the submission replaced {owner.__name__}.{name}, a function of the tests: remove that"]


def test_a_world_that_runs_replaces_nothing(module: ModuleType, functions: TestFunctions) -> None:
    room = Classroom("line", "line_follower")
    room.run(0.5)
    assert no_contact(next(iter(room)))
    module.values.append(1)
    assert functions.replaced() == []
