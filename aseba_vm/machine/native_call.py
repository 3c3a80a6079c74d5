"""Calls of native functions: signature, arguments and access to the memory.

Source: docs/spec/aseba-bytecode-vm.md section 11.
"""

from __future__ import annotations

from collections.abc import Callable, MutableSequence, Sequence
from dataclasses import dataclass
from typing import Protocol

from aseba_vm.kernel.integers import wrap
from aseba_vm.machine.costs import FREE, Cost
from aseba_vm.machine.data_memory import Variables
from aseba_vm.machine.machine_messages import NativeCalled
from aseba_vm.target import NativeFunction


class NativeMachine(Protocol):
    """The part of the machine that natives may access."""

    variables: Variables
    random: MutableSequence[int]
    node_id: int

    def charge(self, instructions: int) -> None:
        """Add to the cost of the call."""


@dataclass(frozen=True, slots=True)
class Signature:
    """A native ready to be called: the number of words it pops, and the size of each parameter.

    A size that is pushed by the caller is given as minus its index in the popped words. `cost` is the cost of a call.
    """

    native: NativeFunction
    count: int
    sizes: tuple[int, ...]
    cost: Cost = FREE

    @classmethod
    def of(cls, native: NativeFunction, cost: Cost = FREE) -> Signature:
        """Derive the signature from the declaration."""
        count = len(native.parameters)
        places: dict[int, int] = {}
        for place, index in enumerate(native.free_sizes, start=count):
            places[_size_key(native, index)] = place
        sizes = tuple(
            parameter.size if parameter.size > 0 else -places[_size_key(native, index)]
            for index, parameter in enumerate(native.parameters)
        )
        return cls(native, count + len(places), sizes, cost)

    def call_cost(self, popped: Sequence[int]) -> int:
        """The cost of a call beyond its instruction, given the words it pops."""
        if not self.cost.per_word:
            return self.cost.base
        return self.cost.of(sum([size if size > 0 else popped[-size] & 0xFFFF for size in self.sizes]))


def _size_key(native: NativeFunction, index: int) -> int:
    """A key that parameters of the same size have in common: the template, or the index of the parameter itself."""
    return native.parameters[index].size or index + 1


class NativeCall:
    """A call from one place of a program: address and size of each argument, and access to the words.

    `memory` is the whole variable memory, `popped` the words that the call pops, unsigned.
    """

    __slots__ = ("addresses", "machine", "memory", "native", "popped", "sizes")

    def __init__(self, machine: NativeMachine, signature: Signature, popped: Sequence[int]) -> None:
        """`popped` are the words of the stack from the top: addresses, then sizes in list order."""
        self.machine = machine
        self.memory = machine.variables.words
        self.native = signature.native
        self.popped = words = tuple([word & 0xFFFF for word in popped])
        self.sizes = signature.sizes
        self.addresses = words[: len(self.sizes)]
        if len(words) > len(self.sizes):
            self.sizes = tuple([size if size > 0 else words[-size] for size in self.sizes])

    @property
    def is_inside_memory(self) -> bool:
        """Whether every argument lies inside the variable memory."""
        end = len(self.memory)
        for address, size in zip(self.addresses, self.sizes, strict=True):  # noqa: SIM110  # twice as fast as all()
            if address + size > end:
                return False
        return True

    def read(self, argument: int) -> list[int]:
        """A copy of the words of an argument."""
        address = self.addresses[argument]
        return list(self.memory[address : address + self.sizes[argument]])

    def words(self) -> list[int]:
        """A copy of the words of all arguments, one after the other."""
        memory, words = self.memory, []
        for address, size in zip(self.addresses, self.sizes, strict=True):
            if size == 1:
                words.append(memory[address])
            else:
                words += memory[address : address + size]
        return words

    def value(self, argument: int) -> int:
        """The first word of an argument."""
        return self.memory[self.addresses[argument]]

    def write(self, argument: int, values: Sequence[int]) -> None:
        """Store values, wrapped to 16 bits, from the first word of an argument on, at most as many as it has."""
        address, size = self.addresses[argument], self.sizes[argument]
        words = [wrap(value) for value in values[:size]]
        self.memory[address : address + len(words)] = words

    def charge(self, instructions: int) -> None:
        """Add to the declared cost, for work whose amount only the call itself knows."""
        self.machine.charge(instructions)

    def record(self, number: int) -> NativeCalled:
        """The call as a value."""
        arguments = tuple(
            (address, size, tuple(self.memory[address : address + size]))
            for address, size in zip(self.addresses, self.sizes, strict=True)
        )
        return NativeCalled(number, self.native.name, arguments)


Native = Callable[[NativeCall], None]
"""Implementation of a native function of the target; it may raise `NativeFault`."""
