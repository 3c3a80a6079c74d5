"""The types of kernels: what their parameters may be, and how arrays of them are stored."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

__all__ = ["ALIGNMENT", "DTYPES", "ITEM_SIZES", "Floats", "Ints", "Kernel", "Shorts", "Words", "is_kernel", "kernel"]

Floats = Any
"""A flat array of float64."""
Ints = Any
"""A flat array of int32."""
Words = Any
"""A flat array of uint16."""
Shorts = Any
"""A flat array of int16. Kernels wrap what they store (`integers.wrap`), as lists do not."""

DTYPES = {"Floats": "float64", "Ints": "int32", "Words": "uint16", "Shorts": "int16"}
"""Type of the elements of each kind of array, as numpy names it."""
ITEM_SIZES = {"Floats": 8, "Ints": 4, "Words": 2, "Shorts": 2}
"""Bytes of an element of each kind of array."""
ALIGNMENT = 16
"""Every array begins at a multiple of so many bytes."""

Kernel = Callable[..., Any]
K = TypeVar("K", bound=Kernel)


def kernel(function: K) -> K:
    """Mark a function as a kernel: other kernels may call it."""
    function.is_kernel = True  # type: ignore[attr-defined]
    return function


def is_kernel(candidate: object) -> bool:
    """Whether something is a kernel."""
    return getattr(candidate, "is_kernel", False) is True
