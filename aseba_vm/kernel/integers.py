"""Integer functions that WebAssembly has as an instruction or two; Python runs them as they are."""

from __future__ import annotations

__all__ = ["floor_log2", "instruction_of", "quotient", "remainder", "wrap", "wrap32"]


def wrap(value: int) -> int:
    """Wrap a number to 16 bits, two's complement. This is the only place that does it."""
    return ((value + 0x8000) & 0xFFFF) - 0x8000


def wrap32(value: int) -> int:
    """Wrap a number to 32 bits, two's complement."""
    return ((value + 0x80000000) & 0xFFFFFFFF) - 0x80000000


def quotient(left: int, right: int) -> int:
    """Divide, truncated towards 0. Raises ZeroDivisionError."""
    result = abs(left) // abs(right)
    return result if (left < 0) == (right < 0) else -result


def remainder(left: int, right: int) -> int:
    """The remainder of `quotient`, which has the sign of `left`. Raises ZeroDivisionError."""
    result = abs(left) % abs(right)
    return -result if left < 0 else result


def floor_log2(value: int) -> int:
    """The number of the highest bit of a 32-bit word that is set: 31 if it is negative, 0 for 0."""
    return ((value & 0xFFFFFFFF) | 1).bit_length() - 1


_INSTRUCTIONS: dict[object, str] = {
    wrap: "(i32.extend16_s {})",
    wrap32: "{}",  # the integers of kernels have 32 bits
    quotient: "(i32.div_s {} {})",
    remainder: "(i32.rem_s {} {})",
    floor_log2: "(i32.sub (i32.const 31) (i32.clz (i32.or {} (i32.const 1))))",
}


def instruction_of(function: object) -> str | None:
    """The WebAssembly text of a function of this module, with `{}` for its arguments; None for any other object."""
    return _INSTRUCTIONS.get(function) if callable(function) else None
