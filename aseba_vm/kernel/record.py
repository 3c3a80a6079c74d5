"""Records: named arrays of one length that kernels take as one parameter.

A record class lists its arrays as annotations (`x: Floats`). `Record.x` is then a numpy array, and `Record.view.x` the
same memory as Python reads it fastest: a memoryview, whose elements are Python's own numbers.
"""

from __future__ import annotations

import inspect
from typing import Any, ClassVar, Protocol, Self

from aseba_vm.kernel.types import ALIGNMENT, DTYPES, ITEM_SIZES

__all__ = ["ArrayMemory", "Record", "fields"]


class ArrayMemory(Protocol):
    """Memory in which arrays are allocated; kernels are bound to arrays of one memory."""

    def array(self, shape: int, kind: str) -> Any:
        """Allocate an array of zeros of a type of `DTYPES`. Raises MemoryError when there is no room."""


class Record:
    """Base of all records. `count` is the length of all arrays."""

    count: int
    memory: ArrayMemory
    view: Self
    """The same record with memoryviews in place of arrays, for Python that reads single elements."""
    _fields: ClassVar[dict[str, str]] = {}

    def __init_subclass__(cls) -> None:
        """Add the arrays that the class lists to those of its base."""
        own = {name: str(kind) for name, kind in inspect.get_annotations(cls).items() if kind in DTYPES}
        cls._fields = {**cls._fields, **own}

    def __init__(self, memory: ArrayMemory, count: int) -> None:
        """Allocate the arrays, all zero.

        Raises:
            MemoryError: The memory has no room for them.
        """
        self.count, self.memory = count, memory
        view: Any = object.__new__(type(self))
        self.view = view  # without one of its own: such a cycle would keep the memory until the collector comes
        view.count = count
        for name, kind in fields(type(self)).items():
            array = memory.array(count, DTYPES[kind])
            setattr(self, name, array)
            setattr(view, name, memoryview(array))

    @classmethod
    def size(cls, count: int) -> int:
        """Bytes that a record of this length takes at most."""
        return sum(count * ITEM_SIZES[kind] + ALIGNMENT for kind in fields(cls).values())

    def copy_from(self, other: Self) -> None:
        """Copy the elements of another record; of the longer one, only the first."""
        count = min(self.count, other.count)
        for name in fields(type(self)):
            getattr(self, name)[:count] = getattr(other, name)[:count]

    def remove(self, index: int) -> None:
        """Remove an element; those behind it move up, and the last one becomes zero."""
        for name in fields(type(self)):
            array = getattr(self, name)
            array[index:-1] = array[index + 1 :]
            array[-1] = 0


def fields(record: type[Record]) -> dict[str, str]:
    """The arrays of a record class by name, and their types as `DTYPES` names them; in the order of the class."""
    return record._fields
