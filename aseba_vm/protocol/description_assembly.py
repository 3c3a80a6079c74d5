"""Descriptions: from the messages of a node to a target description, and back.

Source: docs/spec/aseba-protocol.md section 1.4.
"""

from __future__ import annotations

from dataclasses import dataclass, field

from aseba_vm.protocol.messages import (
    Description,
    LocalEventDescription,
    NamedVariable,
    NativeFunctionDescription,
)
from aseba_vm.target import LocalEvent, NativeFunction, TargetDescription, Variable

__all__ = ["DescriptionAssembly", "DescriptionItem"]

DescriptionItem = NamedVariable | LocalEventDescription | NativeFunctionDescription


@dataclass(slots=True)
class DescriptionAssembly:
    """The parts of one description that have arrived. Items beyond the announced numbers are ignored."""

    header: Description
    _variables: list[Variable] = field(default_factory=list)
    _events: list[LocalEvent] = field(default_factory=list)
    _natives: list[NativeFunction] = field(default_factory=list)

    def add(self, item: DescriptionItem) -> None:
        """Add the next item of its kind."""
        match item:
            case NamedVariable(name=name, size=size):
                if len(self._variables) < self.header.variable_count:
                    self._variables.append(Variable(name, size))
            case LocalEventDescription(name=name, description=text):
                if len(self._events) < self.header.event_count:
                    self._events.append(LocalEvent(name, text))
            case NativeFunctionDescription(name=name, description=text, parameters=parameters):
                if len(self._natives) < self.header.native_count:
                    self._natives.append(NativeFunction(name, parameters, text))

    @property
    def missing(self) -> str:
        """A text about the parts that have not arrived, for the user; empty once the description is complete."""
        kinds = (
            ("variables", self._variables, self.header.variable_count),
            ("local events", self._events, self.header.event_count),
            ("native functions", self._natives, self.header.native_count),
        )
        return ", ".join(f"{len(found)} of {count} {name}" for name, found, count in kinds if len(found) < count)

    @property
    def target(self) -> TargetDescription:
        """The description as far as it has arrived."""
        header = self.header
        return TargetDescription(
            header.name,
            header.variables_size,
            header.bytecode_size,
            header.stack_size,
            tuple(self._variables),
            tuple(self._events),
            tuple(self._natives),
        )
