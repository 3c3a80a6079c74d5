"""The interfaces of all packages: messages, services and actions, and the texts of their definitions.

Each file of `definitions/` has a package: the text of each `.msg`, `.srv` and `.action` file below a line such as
`=== msg/Bool`. Services and actions are made of messages, which are named by them: `std_srvs/srv/Empty_Request`.
"""

from __future__ import annotations

import functools
import re
from collections.abc import Iterator, Mapping
from importlib import resources

__all__ = [
    "ACTION_PARTS",
    "ACTION_SERVICES",
    "FEEDBACK_MESSAGE",
    "FORMS",
    "PACKAGES",
    "SERVICE_PARTS",
    "interfaces",
    "is_action",
    "is_service",
    "messages",
    "module_of",
    "names",
    "sections",
    "services",
    "snake_case",
    "text_of",
]

_FOLDER = resources.files(__package__).joinpath("definitions")
_SUFFIX = ".txt"
PACKAGES = frozenset(file.name.removesuffix(_SUFFIX) for file in _FOLDER.iterdir() if file.name.endswith(_SUFFIX))
"""The packages that have definitions."""

FORMS = ("msg", "srv", "action")
SERVICE_PARTS = ("Request", "Response", "Event")
"""The messages of a service; a file has the first two."""
ACTION_PARTS = ("Goal", "Result", "Feedback")
"""The messages of an action that its file has."""
ACTION_SERVICES = ("SendGoal", "GetResult")
"""The services of an action that have its name, such as `test_msgs/action/Fibonacci_SendGoal`."""
FEEDBACK_MESSAGE = "FeedbackMessage"
"""The message of an action that is published: its feedback with the id of the goal."""

_ADDED_TO_NAMES = {"srv": SERVICE_PARTS, "action": (*SERVICE_PARTS, *ACTION_SERVICES, *ACTION_PARTS, FEEDBACK_MESSAGE)}
_PARTS = {"srv": SERVICE_PARTS[:2], "action": ACTION_PARTS}


@functools.cache
def interfaces(package: str) -> Mapping[str, str]:
    """The texts of a package by `msg/Name`, `srv/Name` or `action/Name`."""
    content = _FOLDER.joinpath(f"{package}{_SUFFIX}").read_text(encoding="utf-8")
    _, *parts = re.split(r"^=== (.+)$", content, flags=re.MULTILINE)
    return {name: text.lstrip("\n") for name, text in zip(parts[::2], parts[1::2], strict=True)}


def names(package: str, form: str) -> Iterator[str]:
    """The names of all messages, services or actions of a package, in the order of its file."""
    for name in interfaces(package):
        kind, _, short = name.partition("/")
        if kind == form:
            yield short


def text_of(name: str) -> str:
    """The text of an interface by its full name. Raises KeyError if there is none."""
    package, _, rest = name.partition("/")
    if not _exists(name):
        raise KeyError(name)
    return interfaces(package)[rest]


@functools.cache
def sections(name: str) -> Mapping[str, str]:
    """The texts of a service or an action by part, such as `Request`; empty for any other name."""
    _, form, *_ = name.split("/") if _exists(name) else ("", "")
    if form not in _PARTS:
        return {}
    texts = re.split(r"^---$", text_of(name), flags=re.MULTILINE)
    return {part: text.removeprefix("\n") for part, text in zip(_PARTS[form], texts, strict=True)}


def is_action(name: str) -> bool:
    """Whether there is an action of this full name."""
    return ACTION_PARTS[0] in sections(name)


def is_service(name: str) -> bool:
    """Whether there is a service of this full name, also one of an action."""
    action, _, service = name.rpartition("_")
    return SERVICE_PARTS[0] in sections(name) or (service in ACTION_SERVICES and is_action(action))


def services(name: str) -> list[str]:
    """The full names of the services of an interface: a service is its own, an action has two, a message none."""
    if is_action(name):
        return [f"{name}_{service}" for service in ACTION_SERVICES]
    return [name] if is_service(name) else []


def messages(name: str) -> list[str]:
    """The full names of the messages of an interface: a message is its own."""
    of_services = [f"{service}_{part}" for service in services(name) for part in SERVICE_PARTS]
    if is_action(name):
        return [*(f"{name}_{part}" for part in ACTION_PARTS), *of_services, f"{name}_{FEEDBACK_MESSAGE}"]
    return of_services or [name]


def module_of(name: str) -> str:
    """The module in which rosidl has a class; tools make the name of the type from it."""
    package, form, short = name.split("/")
    for part in _ADDED_TO_NAMES.get(form, ()):
        short = short.removesuffix(f"_{part}")
    return f"{package}.{form}._{snake_case(short)}"


def snake_case(name: str) -> str:
    """A name such as `SendGoal` in lower case, such as `send_goal`."""
    words = re.sub(r"(.)([A-Z][a-z]+)", r"\1_\2", name)
    return re.sub(r"([a-z0-9])([A-Z])", r"\1_\2", words).lower()


def _exists(name: str) -> bool:
    package, _, rest = name.partition("/")
    return package in PACKAGES and rest in interfaces(package)
