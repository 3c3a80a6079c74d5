"""The types of fields, as `SLOT_TYPES` of a message class has them; named as in rosidl_parser."""

from __future__ import annotations

from dataclasses import dataclass

__all__ = [
    "AbstractGenericString",
    "AbstractNestableType",
    "AbstractNestedType",
    "AbstractSequence",
    "AbstractString",
    "AbstractType",
    "AbstractWString",
    "Array",
    "BasicType",
    "BoundedSequence",
    "BoundedString",
    "BoundedWString",
    "NamespacedType",
    "UnboundedSequence",
    "UnboundedString",
    "UnboundedWString",
]


class AbstractType:
    """Any type of a field."""


class AbstractNestableType(AbstractType):
    """A type of which there are arrays and sequences."""


@dataclass(slots=True)
class BasicType(AbstractNestableType):
    """A number, boolean or octet, by its name in IDL."""

    typename: str


@dataclass(slots=True)
class NamespacedType(AbstractNestableType):
    """A message, such as `(["std_msgs", "msg"], "Header")`."""

    namespaces: list[str]
    name: str

    def namespaced_name(self) -> tuple[str, ...]:
        """The parts of the full name."""
        return (*self.namespaces, self.name)


class AbstractGenericString(AbstractNestableType):
    """A text of any encoding."""

    def has_maximum_size(self) -> bool:
        """Whether the length is limited."""
        return False


class AbstractString(AbstractGenericString):
    """A text in UTF-8."""


@dataclass(slots=True)
class BoundedString(AbstractString):
    """A text of limited length."""

    maximum_size: int

    def has_maximum_size(self) -> bool:
        """Whether the length is limited."""
        return True


@dataclass(slots=True)
class UnboundedString(AbstractString):
    """A text of any length."""


class AbstractWString(AbstractGenericString):
    """A text in UTF-16."""


@dataclass(slots=True)
class BoundedWString(AbstractWString):
    """A text of limited length."""

    maximum_size: int

    def has_maximum_size(self) -> bool:
        """Whether the length is limited."""
        return True


@dataclass(slots=True)
class UnboundedWString(AbstractWString):
    """A text of any length."""


@dataclass(slots=True)
class AbstractNestedType(AbstractType):
    """Several values of one type."""

    value_type: AbstractNestableType

    def has_maximum_size(self) -> bool:
        """Whether the number of values is limited."""
        return True


@dataclass(slots=True)
class Array(AbstractNestedType):
    """A fixed number of values."""

    size: int


@dataclass(slots=True)
class AbstractSequence(AbstractNestedType):
    """A variable number of values."""


@dataclass(slots=True)
class BoundedSequence(AbstractSequence):
    """At most so many values."""

    maximum_size: int


@dataclass(slots=True)
class UnboundedSequence(AbstractSequence):
    """Any number of values."""

    def has_maximum_size(self) -> bool:
        """Whether the number of values is limited."""
        return False
