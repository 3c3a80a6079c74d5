"""The texts of definitions (`.msg`, and the parts of `.srv` and `.action`): their fields and constants, line by line.

The rules are those of rosidl: a field is a type, a name and perhaps a default, a constant has `=` after its name, and a
comment begins with `#`.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum
from typing import Any

from thymio_sim_ros.errors import ThymioSimError
from thymio_sim_ros.portable_ros.messages.primitives import PRIMITIVES

__all__ = ["Constant", "DefinitionError", "Field", "FieldType", "Section", "Shape", "parsed"]

_TYPE = re.compile(
    r"(?P<base>[A-Za-z]\w*(?:/\w+)*)(?:<=(?P<text_bound>\d+))?(?P<array>\[(?:(?P<bounded><=)?(?P<size>\d+))?\])?"
)
_FIELD_NAME = re.compile(r"(?!.*__)(?!.*_$)[a-z][a-z0-9_]*")
_CONSTANT_NAME = re.compile(r"(?!.*__)(?!.*_$)[A-Z][A-Z0-9_]*")
_TEXTS = ("string", "wstring")
_BOOLEANS = {"true": True, "1": True, "false": False, "0": False}


class DefinitionError(ThymioSimError, ValueError):
    """A definition of an interface is wrong; the text has the file and the line."""


class Shape(Enum):
    """How many values a field has."""

    SCALAR = "scalar"
    ARRAY = "array"
    SEQUENCE = "sequence"


@dataclass(frozen=True, slots=True)
class FieldType:
    """The type of a field: a primitive or the full name of a message.

    `size` is the length of an array or the limit of a sequence, `text_bound` that of a text; 0 stands for no limit.
    """

    base: str
    shape: Shape = Shape.SCALAR
    size: int = 0
    text_bound: int = 0

    @property
    def is_primitive(self) -> bool:
        """Whether the values are numbers, booleans, octets or texts."""
        return self.base in PRIMITIVES


@dataclass(frozen=True, slots=True)
class Field:
    """A field; `default` is the value in the definition, None without one."""

    name: str
    type: FieldType
    default: Any = None


@dataclass(frozen=True, slots=True)
class Constant:
    """A constant of a message."""

    name: str
    base: str
    value: Any


@dataclass(frozen=True, slots=True)
class Section:
    """The text of a message, and where it is: the name of a file or an interface, and the number of the first line."""

    text: str
    place: str
    first_line: int = 1


def parsed(section: Section, package: str, is_message: Callable[[str], bool]) -> tuple[list[Field], list[Constant]]:
    """The fields and constants of a text of a package; `is_message` is whether there is a message of a full name.

    Raises DefinitionError.
    """
    found: dict[str, Field | Constant] = {}
    for number, whole in enumerate(section.text.splitlines(), section.first_line):
        line = whole.partition("#")[0].strip()
        if not line:
            continue
        try:
            one = _parsed_line(line, package, is_message)
            if one.name in found:
                raise DefinitionError(f"found a second {one.name!r}, expected each name once")
        except DefinitionError as error:
            raise DefinitionError(f"{section.place}:{number}: {error}") from None
        found[one.name] = one
    fields = [one for one in found.values() if isinstance(one, Field)]
    return fields, [one for one in found.values() if isinstance(one, Constant)]


def _parsed_line(line: str, package: str, is_message: Callable[[str], bool]) -> Field | Constant:
    kind, _, rest = line.replace("\t", " ").partition(" ")
    rest = rest.strip()
    found = _TYPE.fullmatch(kind)
    if found is None or not rest:
        raise DefinitionError(f"found {line!r}, expected a field such as 'bool on' or a constant such as 'uint8 A=1'")
    if "=" in rest:
        name, _, value = rest.partition("=")
        return _constant(found, name.strip(), value.strip())
    name, _, default = rest.partition(" ")
    if not _FIELD_NAME.fullmatch(name):
        raise DefinitionError(f"found the name {name!r}, expected lower case letters, digits and single underscores")
    of = _type(found, package, is_message)
    return Field(name, of, _default(of, default.strip()) if default else None)


def _constant(kind: re.Match[str], name: str, value: str) -> Constant:
    if not _CONSTANT_NAME.fullmatch(name):
        raise DefinitionError(f"found the name {name!r}, expected upper case letters, digits and single underscores")
    if kind["base"] not in PRIMITIVES or kind["array"]:
        raise DefinitionError(f"found a constant of type {kind[0]!r}, expected one of {', '.join(PRIMITIVES)}")
    return Constant(name, kind["base"], _value(kind["base"], value))


def _type(kind: re.Match[str], package: str, is_message: Callable[[str], bool]) -> FieldType:
    base, shape = _full(package, kind["base"]), Shape.SCALAR
    if base not in PRIMITIVES and not is_message(base):
        raise DefinitionError(
            f"found the type {kind['base']!r}, expected one of {', '.join(PRIMITIVES)}, or another message"
        )
    if kind["text_bound"] and base not in _TEXTS:
        raise DefinitionError(f"found {kind[0]!r}, expected a limit only of string and wstring")
    if kind["array"]:
        shape = Shape.ARRAY if kind["size"] and not kind["bounded"] else Shape.SEQUENCE
    if kind["size"] and not int(kind["size"]):
        raise DefinitionError(f"found {kind[0]!r}, expected a size above 0")
    return FieldType(base, shape, int(kind["size"] or 0), int(kind["text_bound"] or 0))


def _full(package: str, base: str) -> str:
    """The full name of a type of a field, as it is written in a definition of the package."""
    if base in PRIMITIVES:
        return base
    owner, _, name = base.rpartition("/")
    if base == "Header":
        owner = "std_msgs"
    return f"{(owner or package).removesuffix('/msg')}/msg/{name}"


def _default(of: FieldType, text: str) -> Any:
    """The default of a field; that of an array or a sequence is such as `[1, 2]`."""
    if not of.is_primitive:
        raise DefinitionError(f"found the default {text!r} of a message, expected none")
    if of.shape is Shape.SCALAR:
        value = _value(of.base, text)
        if of.text_bound and len(value) > of.text_bound:
            raise DefinitionError(f"found the default {text}, expected at most {of.text_bound} characters")
        return value
    if not (text.startswith("[") and text.endswith("]")):
        raise DefinitionError(f"found the default {text!r}, expected a list such as [1, 2]")
    values = tuple(_value(of.base, one) for one in re.findall(r"\"[^\"]*\"|'[^']*'|[^\[\],\s]+", text))
    if len(values) > of.size > 0 or (of.shape is Shape.ARRAY and len(values) != of.size):
        most = "" if of.shape is Shape.ARRAY else "at most "
        raise DefinitionError(f"found a default with {len(values)} values, expected {most}{of.size}")
    return values


def _value(base: str, text: str) -> Any:
    """A constant or a default, as the value that the Python class has."""
    primitive = PRIMITIVES[base]
    try:
        if base in _TEXTS:
            return ast.literal_eval(text) if text[:1] in ("'", '"') else text
        if base == "bool":
            return _BOOLEANS[text.lower()]
        if base.startswith("float"):
            return float(text)
        number = int(text) if text.lstrip("+-").isdigit() else int(text, 0)
    except (KeyError, SyntaxError, ValueError):
        raise DefinitionError(f"found the value {text!r}, expected one of type {base}") from None
    least, most = primitive.limits or (0, 255)
    if not least <= number <= most:
        raise DefinitionError(f"found the value {text}, expected {least}…{most} for {base}")
    return bytes([number]) if base == "byte" else number
