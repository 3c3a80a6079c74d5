"""What a machine says: values left in its outbox, in order (docs/spec/aseba-bytecode-vm.md sections 10.1 to 10.5)."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass

from aseba_vm.bytecode import signed
from aseba_vm.messages import LANGUAGES, MESSAGES, format_message


@dataclass(frozen=True, slots=True)
class Emitted:
    """A global event and its arguments."""

    number: int
    arguments: tuple[int, ...]


@dataclass(frozen=True, slots=True)
class NativeCalled:
    """A call of a native that the machine has no function for: address, size and words of each argument."""

    number: int
    name: str
    arguments: tuple[tuple[int, int, tuple[int, ...]], ...]


@dataclass(frozen=True, slots=True)
class ExecutionState:
    """Where the machine is and in which mode."""

    pc: int
    flags: int


@dataclass(frozen=True, slots=True)
class BreakpointSet:
    """Answer to a new breakpoint."""

    pc: int
    is_set: bool


@dataclass(frozen=True, slots=True)
class VariablesRead:
    """Words of the variable memory that were asked for."""

    start: int
    values: tuple[int, ...]


@dataclass(frozen=True, slots=True)
class EventKilled:
    """An event was abandoned at ``pc``: by a new one, or because it took too long."""

    pc: int


class _Fault(ABC):
    """Why an event ended: a kind of `messages` and its arguments."""

    __slots__ = ()

    @property
    @abstractmethod
    def kind_and_arguments(self) -> tuple[str, tuple[object, ...]]:
        """The kind, and what its sentence is about; a kind that no table has is its own sentence."""

    @property
    def message(self) -> str:
        """The fault in words."""
        return self.message_in("en")

    def message_in(self, language: str) -> str:
        """The fault in words of a language of `LANGUAGES`; others get English."""
        return format_message(*self.kind_and_arguments, LANGUAGES.get(language, MESSAGES))


@dataclass(frozen=True, slots=True)
class OutOfBounds(_Fault):
    """An index outside an array, as an unsigned word; without size and index when a deque was misused."""

    pc: int
    size: int | None = None
    index: int | None = None

    @property
    def kind_and_arguments(self) -> tuple[str, tuple[object, ...]]:
        """See `_Fault`."""
        if self.size is None or self.index is None:
            return "fault-deque", ()
        return "fault-index", (signed(self.index), self.size)


@dataclass(frozen=True, slots=True)
class DivisionByZero(_Fault):
    """A division or remainder by 0."""

    pc: int

    @property
    def kind_and_arguments(self) -> tuple[str, tuple[object, ...]]:
        """See `_Fault`."""
        return "fault-division-by-zero", ()


@dataclass(frozen=True, slots=True)
class NodeSpecific(_Fault):
    """A native refused its arguments; ``reason`` is what it said."""

    pc: int
    reason: str

    @property
    def kind_and_arguments(self) -> tuple[str, tuple[object, ...]]:
        """See `_Fault`."""
        return _kind(self.reason), ()


@dataclass(frozen=True, slots=True)
class BadCode(_Fault):
    """Bytecode that no compiler makes, or a stack that overflows; the reference stops its whole process here.

    ``reason`` is an identifier.
    """

    pc: int
    reason: str

    @property
    def kind_and_arguments(self) -> tuple[str, tuple[object, ...]]:
        """See `_Fault`."""
        return _kind(self.reason), ()


def _kind(reason: str) -> str:
    return f"fault-{reason}" if f"fault-{reason}" in MESSAGES else reason


Fault = OutOfBounds | DivisionByZero | NodeSpecific | BadCode
Message = Emitted | NativeCalled | ExecutionState | BreakpointSet | VariablesRead | EventKilled | Fault
