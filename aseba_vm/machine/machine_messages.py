"""Messages of a machine, in its outbox in order (docs/spec/aseba-bytecode-vm.md sections 10.1 to 10.5)."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass

from aseba_vm.bytecode import signed
from aseba_vm.languages import texts
from aseba_vm.messages import MESSAGES, format_message


@dataclass(frozen=True, slots=True)
class Emitted:
    """A global event and its arguments."""

    number: int
    arguments: tuple[int, ...]


@dataclass(frozen=True, slots=True)
class NativeCalled:
    """A call of a native that has no implementation: address, size and words of each argument."""

    number: int
    name: str
    arguments: tuple[tuple[int, int, tuple[int, ...]], ...]


@dataclass(frozen=True, slots=True)
class ExecutionState:
    """Address and flags of the machine."""

    pc: int
    flags: int


@dataclass(frozen=True, slots=True)
class BreakpointSet:
    """Reply to a new breakpoint."""

    pc: int
    is_set: bool


@dataclass(frozen=True, slots=True)
class VariablesRead:
    """A requested range of the variable memory."""

    start: int
    values: tuple[int, ...]


@dataclass(frozen=True, slots=True)
class EventKilled:
    """An event was abandoned at `pc`, because of a new event or because it took too long."""

    pc: int


class _Fault(ABC):
    """A reason why an event ended."""

    __slots__ = ()

    @property
    @abstractmethod
    def kind_and_arguments(self) -> tuple[str, tuple[object, ...]]:
        """The kind in the table of messages and its arguments; an unknown kind is its own message."""

    @property
    def message(self) -> str:
        """The fault as an English sentence."""
        return self.message_in("en")

    def message_in(self, language: str) -> str:
        """The fault as a sentence in a language, such as "de"; English if the language is unknown."""
        return format_message(*self.kind_and_arguments, texts("compiler", language))


@dataclass(frozen=True, slots=True)
class OutOfBounds(_Fault):
    """An index outside an array, as an unsigned word. Size and index are None for a wrong use of a deque."""

    pc: int
    size: int | None = None
    index: int | None = None

    @property
    def kind_and_arguments(self) -> tuple[str, tuple[object, ...]]:
        """The index and the size, or the deque fault."""
        if self.size is None or self.index is None:
            return "fault-deque", ()
        return "fault-index", (signed(self.index), self.size)


@dataclass(frozen=True, slots=True)
class DivisionByZero(_Fault):
    """A division or remainder by 0."""

    pc: int

    @property
    def kind_and_arguments(self) -> tuple[str, tuple[object, ...]]:
        """The kind; it has no arguments."""
        return "fault-division-by-zero", ()


@dataclass(frozen=True, slots=True)
class NodeSpecific(_Fault):
    """A native rejected its arguments; `reason` is the text that it gave."""

    pc: int
    reason: str

    @property
    def kind_and_arguments(self) -> tuple[str, tuple[object, ...]]:
        """The reason, as a kind if the table of messages has it."""
        return _kind(self.reason), ()


@dataclass(frozen=True, slots=True)
class BadCode(_Fault):
    """Bytecode that no compiler generates, or a stack overflow; the reference aborts its process here.

    `reason` is an identifier.
    """

    pc: int
    reason: str

    @property
    def kind_and_arguments(self) -> tuple[str, tuple[object, ...]]:
        """The reason as a kind; it has no arguments."""
        return _kind(self.reason), ()


def _kind(reason: str) -> str:
    return f"fault-{reason}" if f"fault-{reason}" in MESSAGES else reason


Fault = OutOfBounds | DivisionByZero | NodeSpecific | BadCode
Message = Emitted | NativeCalled | ExecutionState | BreakpointSet | VariablesRead | EventKilled | Fault
