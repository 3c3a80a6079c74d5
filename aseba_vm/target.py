"""Target descriptions: memory sizes, variables, local events and native functions of one kind of node."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from aseba_vm.errors import TargetError

#: Number of words that 16-bit addresses can reach.
LARGEST_MEMORY = 65536


@dataclass(frozen=True, slots=True)
class Variable:
    """A named range of variable memory, `size` in words. Its address follows from the order of declaration."""

    name: str
    size: int


@dataclass(frozen=True, slots=True)
class LocalEvent:
    """An event that the node raises itself."""

    name: str
    description: str = ""


@dataclass(frozen=True, slots=True)
class Parameter:
    """A parameter of a native. Size n > 0: exactly n words; n < 0: any size, equal for equal n; 0: any size."""

    name: str
    size: int


@dataclass(frozen=True, slots=True)
class NativeFunction:
    """A function of the node that programs can call."""

    name: str
    parameters: tuple[Parameter, ...] = ()
    description: str = ""

    @property
    def free_sizes(self) -> tuple[int, ...]:
        """For each size that a call pushes, in list order, the index of a parameter that has it.

        Source: docs/spec/aseba-bytecode-vm.md section 6.
        """
        free = [index for index, parameter in enumerate(self.parameters) if parameter.size == 0]
        lowest = min((parameter.size for parameter in self.parameters), default=0)
        sizes = [parameter.size for parameter in self.parameters]
        return (*free, *(sizes.index(size) for size in range(-1, lowest - 1, -1) if size in sizes))


@dataclass(frozen=True, slots=True)
class TargetDescription:
    """A kind of node. Sizes are in words; the address of a variable is the sum of the sizes before it."""

    name: str
    variables_size: int
    bytecode_size: int
    stack_size: int
    variables: tuple[Variable, ...] = ()
    local_events: tuple[LocalEvent, ...] = ()
    natives: tuple[NativeFunction, ...] = ()

    @property
    def variables_end(self) -> int:
        """First address after the target's own variables."""
        return sum(variable.size for variable in self.variables)

    @property
    def addresses(self) -> dict[str, tuple[int, int]]:
        """Address and size of each variable by name; the last one wins where a name occurs twice."""
        addresses: dict[str, tuple[int, int]] = {}
        address = 0
        for variable in self.variables:
            addresses[variable.name] = (address, variable.size)
            address += variable.size
        return addresses

    def local_event_number(self, name: str) -> int:
        """The number of a local event, from 0xFFFE downwards. Raises KeyError for an unknown name."""
        for index in range(len(self.local_events) - 1, -1, -1):
            if self.local_events[index].name == name:
                return 0xFFFE - index
        raise KeyError(name)

    @classmethod
    def from_data(cls, data: Mapping[str, Any]) -> TargetDescription:
        """A target from plain data as read from JSON: variables as pairs, events as names, natives with params.

        Raises TargetError with the field that is missing or has a wrong type.
        """
        try:
            target = cls(
                name=str(data["name"]),
                variables_size=int(data["variables_size"]),
                bytecode_size=int(data["bytecode_size"]),
                stack_size=int(data["stack_size"]),
                variables=tuple(Variable(str(name), int(size)) for name, size in data["variables"]),
                local_events=tuple(LocalEvent(str(name)) for name in data["local_events"]),
                natives=tuple(
                    NativeFunction(
                        str(native["name"]),
                        tuple(Parameter(str(name), int(size)) for name, size in native["params"]),
                    )
                    for native in data["natives"]
                ),
            )
            sizes = [target.variables_size, target.bytecode_size, target.stack_size]
            sizes += [variable.size for variable in target.variables]
            if not all(0 <= size <= LARGEST_MEMORY for size in sizes):
                raise ValueError(f"a size is not in 0..{LARGEST_MEMORY}")
            return target
        except KeyError as err:
            raise TargetError(f"target description: field {err} is missing") from err
        except (TypeError, ValueError, OverflowError) as err:
            raise TargetError(f"target description: {err}") from err
