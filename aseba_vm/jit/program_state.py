"""States of the program in the bytecode memory, as the tiering knows them, and their transitions."""

from __future__ import annotations

from collections.abc import Mapping
from enum import Enum, auto


class State(Enum):
    """The state of the program in the bytecode memory."""

    COLD = auto()
    """It is interpreted until a run is long, or runs often begin at one address."""
    TRANSLATED = auto()
    """The translation is that of the program; translated code may run."""
    WRITTEN = auto()
    """The memory was written from outside: it must be compared with the translation before translated code runs."""
    INTERPRETED = auto()
    """WebAssembly does not work here."""


class Change(Enum):
    """A cause of a transition."""

    TRANSLATED = auto()
    """A run was long, or at an address where runs often begin."""
    FAILED = auto()
    """So it was, but WebAssembly does not work."""
    WRITTEN = auto()
    """Bytecode was written, or executed instruction by instruction."""
    FOUND_EQUAL = auto()
    """The program is the one that was translated."""
    FOUND_DIFFERENT = auto()
    """The program is another one."""


TRANSITIONS: Mapping[tuple[State, Change], State] = {
    (State.COLD, Change.TRANSLATED): State.TRANSLATED,
    (State.COLD, Change.FAILED): State.INTERPRETED,
    (State.COLD, Change.WRITTEN): State.COLD,
    (State.TRANSLATED, Change.WRITTEN): State.WRITTEN,
    (State.WRITTEN, Change.WRITTEN): State.WRITTEN,
    (State.WRITTEN, Change.FOUND_EQUAL): State.TRANSLATED,
    (State.WRITTEN, Change.FOUND_DIFFERENT): State.COLD,
    (State.INTERPRETED, Change.WRITTEN): State.INTERPRETED,
}
