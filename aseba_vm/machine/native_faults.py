"""Exceptions of natives, and the numbers that standard natives return in place of them."""

from __future__ import annotations

from collections.abc import Callable

SQUARE_ROOT_FAULT = "sqrt-of-negative"
"""Reason of the fault for the square root of a negative number."""

OK, DIVISION, SQUARE_ROOT, DEQUE, DEQUE_TWICE = range(5)
"""Results of standard natives. After the last one, both halves of the work have failed."""


class NativeFault(Exception):  # noqa: N818  # a fault, in the words of docs/spec/aseba-bytecode-vm.md section 11
    """Raised by a native that cannot do its work; the event ends and the reason is reported."""

    def __init__(self, reason: str) -> None:
        super().__init__(reason)
        self.reason = reason


class DivisionFault(NativeFault):
    """A division by zero in a native."""

    def __init__(self) -> None:
        super().__init__("division-by-zero")


class DequeFault(NativeFault):
    """A wrong index or too many values for a deque; `times`: how often it is reported."""

    def __init__(self, times: int = 1) -> None:
        super().__init__("deque")
        self.times = times


FAULTS: dict[int, Callable[[], NativeFault]] = {
    DIVISION: DivisionFault,
    SQUARE_ROOT: lambda: NativeFault(SQUARE_ROOT_FAULT),
    DEQUE: DequeFault,
    DEQUE_TWICE: lambda: DequeFault(2),
}
"""The fault that a result stands for."""
