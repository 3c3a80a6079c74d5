"""Records: named arrays of one length that kernels take as one parameter.

A record class lists its arrays as annotations (`x: Floats`). `Record.x` is then a numpy array, and `Record.view.x` the
same memory as Python reads it fastest: a memoryview, whose elements are Python's own numbers.
"""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING, Self

from thymio_sim_ros.sim.kernel.types import ALIGNMENT, DTYPES

if TYPE_CHECKING:
    from thymio_sim_ros.sim.kernel.memory import KernelMemory

__all__ = ["Record", "fields"]


@cache
def fields(record: type[Record]) -> dict[str, str]:
    """The arrays of a record class by name, and their types `Floats`, `Ints` or `Words`; in the order of the class."""
    found = {}
    for base in reversed(record.__mro__):
        for name, kind in base.__dict__.get("__annotations__", {}).items():
            if kind in DTYPES:
                found[name] = str(kind)
    return found


class Record:
    """Base of all records. `count` is the length of all arrays."""

    count: int
    memory: KernelMemory
    view: Self
    """The same record with memoryviews in place of arrays, for Python that reads single elements."""

    def __init__(self, memory: KernelMemory, count: int) -> None:
        """Allocate the arrays, all zero.

        Raises:
            MemoryError: The memory has no room for them.
        """
        self.count, self.memory = count, memory
        self.view = object.__new__(type(self))
        self.view.count = count
        self.view.view = self.view
        for name, kind in fields(type(self)).items():
            array = memory.array(count, DTYPES[kind].type)
            setattr(self, name, array)
            setattr(self.view, name, memoryview(array))

    @classmethod
    def size(cls, count: int) -> int:
        """Bytes that a record of this length takes at most."""
        return sum(count * DTYPES[kind].itemsize + ALIGNMENT for kind in fields(cls).values())

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
