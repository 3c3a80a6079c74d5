"""Stubs with which mypy checks programs against the room.

`python -m thymio_sim_ros.portable_ros.type_stubs FOLDER [PACKAGE …]` writes them; the packages are those of the user
that are found from the current folder.

The stubs of `rclpy`, `rosidl_parser` and samples of messages import the modules of the room, so that mypy reads each
class once. Those of the packages of messages are written from the definitions, since their classes are made at run
time.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

from thymio_sim_ros.portable_ros.import_hook import APIS, MODULES
from thymio_sim_ros.portable_ros.messages.definitions import Definition, Field, FieldType, Shape, definition
from thymio_sim_ros.portable_ros.messages.interface_files import (
    ACTION_PARTS,
    ACTION_SERVICES,
    FEEDBACK_MESSAGE,
    FORMS,
    PACKAGES,
    SERVICE_PARTS,
    is_action,
    is_package,
    messages,
    names,
    services,
)
from thymio_sim_ros.portable_ros.messages.primitives import PRIMITIVES
from thymio_sim_ros.portable_ros.rclpy_parts.borrowed_names import sources as sources_of

__all__ = ["stubs", "write"]

_ROOM = Path(__file__).parent
_IMPORTS = f"""from array import array
from collections.abc import Sequence, Set
from typing import Final, TypeAlias

import numpy as np
from numpy.typing import NDArray

from {__package__}.messages.action_class import Action
from {__package__}.messages.message_class import Message, Service
from {__package__}.messages.primitives import Float
"""


def write(folder: Path, texts: Mapping[str, str]) -> None:
    """Write stubs by their paths into a folder; a file that is right already keeps its time."""
    for name, text in texts.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        if not path.is_file() or path.read_text(encoding="utf-8") != text:
            path.write_text(text, encoding="utf-8")


def stubs(own: Sequence[str] = ()) -> dict[str, str]:
    """The texts of all stubs by their paths, such as `std_msgs/msg.pyi`, also of own packages.

    Raises DefinitionError for a wrong definition, KeyError for a package that is not found.
    """
    found = {}
    sources = [source for api in APIS for source in (_ROOM / api).rglob("*.py")]
    sources += [_ROOM / f"{module.replace('.', '/')}.py" for module in MODULES]
    for source in sources:
        path = source.relative_to(_ROOM).with_suffix(".pyi")
        module = ".".join((__package__, *path.with_suffix("").parts)).removesuffix(".__init__")
        borrowed = sources_of(module.removeprefix(f"{__package__}.")).items()
        lines = [f"from {module} import *", *(f"from {place} import {name} as {name}" for name, place in borrowed)]
        found[path.as_posix()] = "".join(f"{line}\n" for line in lines)
    for package in (*PACKAGES, *own):
        found[f"{package}/__init__.pyi"] = ""
        for form in FORMS:
            if shorts := list(names(package, form)):
                found[f"{package}/{form}.pyi"] = _module([f"{package}/{form}/{short}" for short in shorts])
    return found


def _module(of: list[str]) -> str:
    """The stub of a module with these messages, services or actions."""
    made = [definition(message) for name in of for message in messages(name)]
    actions = [name for name in of if is_action(name)]
    used = {_class(name.rpartition("/")[0]) for one in made for name in (one.name, *_messages_in(one))}
    used |= {f"action_msgs.{form}" for form in ("msg", "srv") if actions}
    imports = "".join(f"import {module}\n" for module in sorted(used))
    classes = (*map(_message, made), *(_service(one) for name in of for one in services(name)), *map(_action, actions))
    return "\n".join((_IMPORTS + imports, *classes))


def _messages_in(of: Definition) -> Iterator[str]:
    return (field.type.base for field in of.fields if not field.type.is_primitive)


def _service(name: str) -> str:
    full, short = _class(name), name.rpartition("/")[2]
    aliases = "".join(f"    {part}: TypeAlias = {full}_{part}\n" for part in SERVICE_PARTS)
    return f"class {short}(Service[{full}_Request, {full}_Response]):\n{aliases}"


def _action(name: str) -> str:
    full, short = _class(name), name.rpartition("/")[2]
    ends = {
        **{f"{one}Service": f"{full}_{one}" for one in ACTION_SERVICES},
        FEEDBACK_MESSAGE: f"{full}_{FEEDBACK_MESSAGE}",
        "CancelGoalService": "action_msgs.srv.CancelGoal",
        "GoalStatusMessage": "action_msgs.msg.GoalStatusArray",
    }
    arguments = ", ".join(f"{full}_{part}" for part in ACTION_PARTS)
    lines = [
        f"class {short}(Action[{arguments}]):",
        *(f"    {part}: TypeAlias = {full}_{part}" for part in ACTION_PARTS),
        "    class Impl:",
        *(f"        {one}: TypeAlias = {kind}" for one, kind in ends.items()),
    ]
    return "".join(f"{line}\n" for line in lines)


def _message(of: Definition) -> str:
    arguments = "".join(f"{field.name}: {_assigned(field.type)} = ..., " for field in of.fields)
    lines = [
        f"class {of.name.rpartition('/')[2]}(Message):",
        *(f"    {constant.name}: Final = {constant.value!r}" for constant in of.constants),
        f"    def __init__(self, *, {arguments}check_fields: bool = ...) -> None: ...",
        *(line for field in of.fields for line in _attribute(field)),
    ]
    return "".join(f"{line}\n" for line in lines)


def _attribute(field: Field) -> Iterator[str]:
    yield "    @property"
    yield f"    def {field.name}(self) -> {_kept(field.type)}: ..."
    yield f"    @{field.name}.setter"
    yield f"    def {field.name}(self, value: {_assigned(field.type)}) -> None: ..."


def _class(name: str) -> str:
    return name.replace("/", ".")


def _element(of: FieldType) -> str:
    return PRIMITIVES[of.base].python.__name__ if of.is_primitive else _class(of.base)


def _kept(of: FieldType) -> str:
    """The type of the value of a field."""
    element = _element(of)
    if of.shape is Shape.SCALAR:
        return element
    if not of.is_primitive or not PRIMITIVES[of.base].code:
        return f"list[{element}]"
    return f"NDArray[np.{PRIMITIVES[of.base].dtype}]" if of.shape is Shape.ARRAY else f"array[{element}]"


def _assigned(of: FieldType) -> str:
    """The type of what a field can be set to."""
    if of.shape is Shape.SCALAR:
        return "Float" if _element(of) == "float" else _element(of)
    given = f"Sequence[{_element(of)}] | Set[{_element(of)}]"
    return f"{_kept(of)} | {given}" if of.shape is Shape.ARRAY and of.is_primitive else given


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description="Writes stubs of rclpy and of the packages of messages for mypy.")
    parser.add_argument("folder", type=Path, help="a folder of the search path of mypy (mypy_path)")
    parser.add_argument("packages", nargs="*", help="packages of messages of your own", metavar="PACKAGE")
    arguments = parser.parse_args()
    if unknown := [package for package in arguments.packages if not is_package(package)]:
        parser.error(f"found no package {unknown[0]} with definitions here or in a folder above, expected one")
    write(arguments.folder, stubs(arguments.packages))
