"""The interfaces of all packages: messages, services and actions, and the texts of their definitions.

Each file of `definitions/` has a package: the text of each `.msg`, `.srv` and `.action` file below a line such as
`=== msg/Bool`. Services and actions are made of messages, which are named by them: `std_srvs/srv/Empty_Request`.
"""

from __future__ import annotations

import functools
import re
from collections.abc import Iterator, Mapping
from importlib import resources

from thymio_sim_ros.portable_ros.messages.definition_text import DefinitionError, Section
from thymio_sim_ros.portable_ros.messages.own_packages import FORMS, TAUGHT, own_folder, read

__all__ = [
    "ACTION_PARTS",
    "ACTION_SERVICES",
    "FEEDBACK_MESSAGE",
    "FORMS",
    "PACKAGES",
    "SEPARATOR",
    "SERVICE_PARTS",
    "interfaces",
    "is_action",
    "is_module",
    "is_package",
    "is_service",
    "messages",
    "module_of",
    "names",
    "of_module",
    "place_of",
    "sections",
    "services",
    "snake_case",
    "text_of",
]

_FOLDER = resources.files(__package__).joinpath("definitions")
_SUFFIX = ".txt"
PACKAGES = frozenset(file.name.removesuffix(_SUFFIX) for file in _FOLDER.iterdir() if file.name.endswith(_SUFFIX))
"""The packages that have definitions."""

SERVICE_PARTS = ("Request", "Response", "Event")
"""The messages of a service; a file has the first two."""
ACTION_PARTS = ("Goal", "Result", "Feedback")
"""The messages of an action that its file has."""
ACTION_SERVICES = ("SendGoal", "GetResult")
"""The services of an action that have its name, such as `test_msgs/action/Fibonacci_SendGoal`."""
FEEDBACK_MESSAGE = "FeedbackMessage"
"""The message of an action that is published: its feedback with the id of the goal."""

_ADDED_TO_NAMES = {"srv": SERVICE_PARTS, "action": (*SERVICE_PARTS, *ACTION_SERVICES, *ACTION_PARTS, FEEDBACK_MESSAGE)}
_PARTS = {"msg": ("",), "srv": SERVICE_PARTS[:2], "action": ACTION_PARTS}
SEPARATOR = "---"
"""The line between the parts of a service or an action."""


def is_package(name: str) -> bool:
    """Whether there are interfaces of a package: here, in a folder of the user, or sent by another program."""
    return name in PACKAGES or name in TAUGHT or own_folder(name) is not None


@functools.cache
def interfaces(package: str) -> Mapping[str, str]:
    """The texts of a package by `msg/Name`, `srv/Name` or `action/Name`. Raises KeyError if there is no such package.

    Those of a folder of the user are read once. Raises DefinitionError for a file that is no text or has a wrong name.
    """
    if package not in PACKAGES:
        folder = None if package in TAUGHT else own_folder(package)
        return TAUGHT[package] if folder is None else read(folder)
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
    return interfaces(package)[rest]


@functools.cache
def sections(name: str) -> Mapping[str, Section]:
    """The texts of an interface by part, such as `Request`; that of a message has no name. Empty for any other name.

    Raises DefinitionError if the text has another number of parts.
    """
    try:
        text = text_of(name)
    except KeyError:
        return {}
    form = name.split("/")[1]
    parts, place = _PARTS[form], place_of(name)
    lines = text.splitlines()
    ends = [number for number, line in enumerate(lines) if line == SEPARATOR and form != "msg"]
    if len(ends) != len(parts) - 1:
        raise DefinitionError(
            f"{place}: found {len(ends)} lines {SEPARATOR!r}, expected {len(parts) - 1}: between {' and '.join(parts)}"
        )
    starts = [0, *(end + 1 for end in ends)]
    return {
        part: Section("".join(f"{line}\n" for line in lines[start:end]), place, start + 1)
        for part, start, end in zip(parts, starts, [*ends, len(lines)], strict=True)
    }


def place_of(name: str) -> str:
    """Where the text of an interface is: its full name, or a file of the user."""
    package, form, short = name.split("/")
    folder = None if package in PACKAGES else own_folder(package)
    return name if folder is None else str(folder / form / f"{short}.{form}")


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


def of_module(module: str) -> Iterator[str]:
    """The full names of the interfaces of a module: `std_msgs.msg` has all of its form, `std_msgs.msg._string` one."""
    package, form, *own = module.split(".")
    for name in (f"{package}/{form}/{short}" for short in names(package, form)):
        if not own or module_of(name) == module:
            yield name


def is_module(module: str) -> bool:
    """Whether a package that there is has a module of this full name."""
    _, form, *own = module.split(".")
    return form in FORMS and (not own or any(True for _ in of_module(module)))


def snake_case(name: str) -> str:
    """A name such as `SendGoal` in lower case, such as `send_goal`."""
    words = re.sub(r"(.)([A-Z][a-z]+)", r"\1_\2", name)
    return re.sub(r"([a-z0-9])([A-Z])", r"\1_\2", words).lower()
