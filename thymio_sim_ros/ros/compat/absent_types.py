"""Types of messages, services and actions that are not installed and that cannot be built without a compiler.

A file that imports such a type can be loaded; the first use of the type raises an error that says what to do. The type
support at run time (`typesupport`) builds only messages with one field, a sequence of an installed type.
"""

from __future__ import annotations

from typing import Any, NoReturn

from thymio_sim_ros.errors import ThymioSimError

__all__ = ["AbsentType", "AbsentTypeError", "absent", "without_action"]


class AbsentTypeError(ThymioSimError, RuntimeError):
    """A type is used that is not installed; the text says how to get it, or what to use instead."""


class AbsentType(type):
    """The class of such types. Making an object, an endpoint, or reading a name such as `Request` raises the error."""

    _TYPE_SUPPORT = None
    """rclpy calls `__import_type_support__` of the class of a type that has no type support."""

    def __call__(cls, *_args: Any, **_kwargs: Any) -> NoReturn:
        raise _error(cls)

    def __getattr__(cls, name: str) -> NoReturn:
        if name.startswith("__"):  # Python and its tools ask for these
            raise AttributeError(name)
        raise _error(cls)


def absent(module: str, name: str, *, twin: str = "") -> AbsentType:
    """A type that can be imported but not used; `twin` is the installed type with the same fields."""

    def import_type_support() -> NoReturn:
        raise _error(made)

    own = type(f"Metaclass_{name}", (AbsentType,), {"__import_type_support__": staticmethod(import_type_support)})
    made: AbsentType = own(name, (), {"__module__": module, "__twin__": twin})
    return made


def without_action(name: str, action: str, instead: str) -> ImportError:
    """The error for importing what needs an action type that is not installed."""
    return ImportError(
        f"{name} needs the action {action}, which is not installed, and no wheel has it: use {instead}, or use ROS 2"
        f" from packages of the system, with {_debian(action)}"
    )


def _error(kind: AbsentType) -> AbsentTypeError:
    twin = kind.__dict__["__twin__"]
    instead = f"use {twin}, which has the same fields, or " if twin else ""
    return AbsentTypeError(
        f"{kind.__module__}.{kind.__name__} is not installed, and no wheel has it: {instead}use ROS 2 from packages of"
        f" the system, with {_debian(kind.__module__)}"
    )


def _debian(name: str) -> str:
    return f"ros-<distribution>-{name.partition('.')[0].replace('_', '-')}"
