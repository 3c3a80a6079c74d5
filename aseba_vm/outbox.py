"""What a machine says: values left in its outbox, in order (VM spec, sections 10.1 to 10.5)."""

from __future__ import annotations

from dataclasses import dataclass


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


@dataclass(frozen=True, slots=True)
class OutOfBounds:
    """An index outside an array; without size and index when a deque was misused."""

    pc: int
    size: int | None = None
    index: int | None = None

    @property
    def reason(self) -> str:
        """The fault in words."""
        if self.size is None:
            return "a deque was given a wrong index or too many values"
        return f"index {self.index} is outside an array of {self.size}"


@dataclass(frozen=True, slots=True)
class DivisionByZero:
    """A division or remainder by 0."""

    pc: int

    @property
    def reason(self) -> str:
        """The fault in words."""
        return "division by zero"


@dataclass(frozen=True, slots=True)
class NodeSpecific:
    """A native refused its arguments."""

    pc: int
    reason: str


@dataclass(frozen=True, slots=True)
class BadCode:
    """Bytecode that no compiler makes, or a stack that overflows; the reference stops its whole process here."""

    pc: int
    reason: str


Fault = OutOfBounds | DivisionByZero | NodeSpecific | BadCode
Message = Emitted | NativeCalled | ExecutionState | BreakpointSet | VariablesRead | EventKilled | Fault
