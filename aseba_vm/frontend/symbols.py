"""Symbol table and memory allocation while parsing (docs/spec/aseba-language.md sections 5 and 10)."""

from __future__ import annotations

from collections.abc import Sequence

from aseba_vm.errors import CompileError, SourcePos
from aseba_vm.frontend.suggestions import unknown_name_error
from aseba_vm.frontend.syntax_tree import Memory, Number, OnEvent, Sub
from aseba_vm.target import NativeFunction, TargetDescription

#: Number of the event that runs when a program is loaded.
INIT_EVENT = 0xFFFF


class SymbolTable:
    """All names in the order of declaration. A name that is defined twice has its last meaning.

    Raises CompileError if the variables of the target do not fit into its memory.
    """

    def __init__(
        self,
        target: TargetDescription,
        events: Sequence[tuple[str, int]],
        constants: Sequence[tuple[str, int]],
    ) -> None:
        self.memory_size = target.variables_size
        self.allocated = target.variables_end
        if self.allocated > self.memory_size:
            raise CompileError("target-too-small")
        self.temporaries = 0
        self.constants = dict(constants)
        self.variables = {name: Memory(name, *place) for name, place in target.addresses.items()}
        self.natives = {native.name: number for number, native in enumerate(target.natives)}
        self.native_functions = target.natives
        self.events = {name: (number, size) for number, (name, size) in enumerate(events)}
        self.local_events = {event.name: 0xFFFE - index for index, event in enumerate(target.local_events)}
        self.handled: set[int] = set()
        self.subs: dict[str, Sub] = {}
        self._declared: list[Memory] = []

    @property
    def declared(self) -> tuple[Memory, ...]:
        """Variables of the program in order of address."""
        return tuple(self._declared)

    def check_new_variable(self, name: str, pos: SourcePos) -> None:
        """Raise CompileError if the name is already in use."""
        if name in self.variables:
            raise CompileError("duplicate-variable", (name,), pos)
        if name in self.constants:
            raise CompileError("variable-constant-clash", (name,), pos)

    def declare(self, name: str, size: int, pos: SourcePos) -> Memory:
        """Allocate the next free words to a variable. Raises CompileError if the memory is full."""
        variable = Memory(name, self.allocated, size)
        self.allocated += size
        if self.allocated > self.memory_size:
            raise CompileError("out-of-variable-memory", (), pos)
        self.variables[name] = variable
        self._declared.append(variable)
        return variable

    def allocate(self, size: int, pos: SourcePos) -> int:
        """Allocate temporary words and return their address. Raises CompileError if the memory is full."""
        address = self.memory_size - self.temporaries - size
        self.temporaries += size
        if self.allocated + self.temporaries > self.memory_size:
            raise CompileError("out-of-temporary-memory", (), pos)
        return address

    def variable(self, name: str, pos: SourcePos) -> Memory:
        """A variable of the target or the program. Raises CompileError for an unknown name."""
        if name not in self.variables:
            raise unknown_name_error("unknown-variable", name, self.variables, pos)
        return self.variables[name]

    def constant(self, name: str, pos: SourcePos) -> Number:
        """The value of a constant. Raises CompileError if it is unknown or out of range."""
        if name not in self.constants:
            raise unknown_name_error("unknown-constant", name, self.constants, pos)
        value = self.constants[name]
        if not -32768 <= value <= 32767:
            raise CompileError("constant-range", (name, value), pos)
        return Number(value, pos)

    def native(self, name: str, pos: SourcePos) -> tuple[int, NativeFunction]:
        """Number and declaration of a native function. Raises CompileError for an unknown name."""
        if name not in self.natives:
            raise unknown_name_error("unknown-function", name, self.natives, pos)
        number = self.natives[name]
        return number, self.native_functions[number]

    def global_event(self, name: str, pos: SourcePos) -> tuple[int, int]:
        """Number and size of an event to emit. Raises CompileError for an unknown or local event."""
        if name in self.events:
            return self.events[name]
        if name in self.local_events:
            raise CompileError("emit-of-local-event", (name,), pos)
        raise unknown_name_error("unknown-event", name, self.events, pos)

    def open_event(self, name: str, pos: SourcePos) -> OnEvent:
        """Begin an event handler: its marker. Raises CompileError for an unknown event or a second handler."""
        if name in self.local_events:
            number = self.local_events[name]
        elif name in self.events:
            number = self.events[name][0]
        else:
            raise unknown_name_error("unknown-event", name, self.events.keys() | self.local_events.keys(), pos)
        if number in self.handled:
            raise CompileError("duplicate-event-handler", (name,), pos)
        self.handled.add(number)
        return OnEvent(number, name, pos)

    def open_sub(self, name: str, name_pos: SourcePos, pos: SourcePos) -> Sub:
        """Begin a subroutine: its marker. Raises CompileError for a duplicate name."""
        if name in self.subs:
            raise CompileError("duplicate-subroutine", (name,), name_pos)
        self.subs[name] = Sub(len(self.subs), name, pos)
        return self.subs[name]
