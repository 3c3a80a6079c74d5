"""The primitive types of fields: their names, Python types, ranges and arrays."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Protocol

__all__ = ["FLOATS", "PRIMITIVES", "Float", "Primitive"]

FLOATS = {"float": 3.402823466e38, "double": 1.7976931348623157e308}
"""The largest finite values, by the name of the type in IDL."""


class Float(Protocol):
    """A float and no int, for type checkers: rclpy sends an int in a float field as another number."""

    def __float__(self) -> float: ...

    def hex(self) -> str: ...  # which int lacks


@dataclass(frozen=True, slots=True)
class Primitive:
    """A primitive type of definitions.

    Args:
        idl: Its name in IDL.
        python: The Python type of its values.
        wire: The name of the type with the same bytes, as rosbags has it.
        code: The type code of an `array.array`, empty for a type that has lists.
        dtype: The name of the NumPy type of an array.
        limits: The smallest and the largest integer.
    """

    idl: str
    python: type
    wire: str
    code: str = ""
    dtype: str = ""
    limits: tuple[int, int] | None = None

    @property
    def default(self) -> Any:
        """The value of a field without one."""
        return b"\0" if self.python is bytes else self.python()


def _integer(bits: int, code: str, *, is_signed: bool) -> Primitive:
    name = f"{'' if is_signed else 'u'}int{bits}"
    limits = (-(2 ** (bits - 1)), 2 ** (bits - 1) - 1) if is_signed else (0, 2**bits - 1)
    return Primitive(name, int, name, code, name, limits)


PRIMITIVES = {
    "bool": Primitive("boolean", bool, "bool"),
    "byte": Primitive("octet", bytes, "uint8"),
    "char": _integer(8, "B", is_signed=False),
    "int8": _integer(8, "b", is_signed=True),
    "uint8": _integer(8, "B", is_signed=False),
    "int16": _integer(16, "h", is_signed=True),
    "uint16": _integer(16, "H", is_signed=False),
    "int32": _integer(32, "i", is_signed=True),
    "uint32": _integer(32, "I", is_signed=False),
    "int64": _integer(64, "q", is_signed=True),
    "uint64": _integer(64, "Q", is_signed=False),
    "float32": Primitive("float", float, "float32", "f", "float32"),
    "float64": Primitive("double", float, "float64", "d", "float64"),
    "string": Primitive("string", str, "string"),
    "wstring": Primitive("wstring", str, "wstring"),
}
"""By their names in definitions."""
