"""The types of kernels: what their parameters may be, and how arrays of them are stored."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

__all__ = ["ALIGNMENT", "DTYPES", "ITEM_SIZES", "Floats", "Ints", "Kernel", "Words", "is_kernel", "kernel", "wrap_int"]

Floats = Any
"""A flat array of float64."""
Ints = Any
"""A flat array of int32."""
Words = Any
"""A flat array of uint16."""

DTYPES = {"Floats": "float64", "Ints": "int32", "Words": "uint16"}
"""Type of the elements of each kind of array, as numpy names it."""
ITEM_SIZES = {"Floats": 8, "Ints": 4, "Words": 2}
"""Bytes of an element of each kind of array."""
ALIGNMENT = 16
"""Every array begins at a multiple of so many bytes."""

Kernel = Callable[..., Any]
K = TypeVar("K", bound=Kernel)


def kernel(function: K) -> K:
    """Mark a function as a kernel: other kernels may call it."""
    function.is_kernel = True  # type: ignore[attr-defined]
    return function


def wrap_int(number: int) -> int:
    """Wrap an integer to 32 bits, as integers of compiled kernels always are; kernels call it where they rely on it."""
    return (number + 0x80000000 & 0xFFFFFFFF) - 0x80000000


def is_kernel(candidate: object) -> bool:
    """Whether something is a kernel."""
    return getattr(candidate, "is_kernel", False) is True
