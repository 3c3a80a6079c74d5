"""The parameters of kernels, and what their types are in WebAssembly."""

from __future__ import annotations

from functools import cache

from aseba_vm.errors import AsebaError
from aseba_vm.kernel.record import Record
from aseba_vm.kernel.types import Kernel

__all__ = ["ARRAYS", "SCALARS", "KernelError", "Signature", "parameters"]

ARRAYS = {
    "Floats": ("f64", "f64.load", "f64.store", 3),
    "Ints": ("i32", "i32.load", "i32.store", 2),
    "Words": ("i32", "i32.load16_u", "i32.store16", 1),
    "Shorts": ("i32", "i32.load16_s", "i32.store16", 1),
}
"""Type of an element, instructions to read and write it, and the shift from its index to its offset."""
SCALARS = {"int": "i32", "float": "f64", "None": ""}

Signature = tuple[dict[str, "str | type[Record]"], str]
"""The type of each parameter, and that of the result."""


class KernelError(AsebaError):
    """A kernel uses what the language of kernels does not have; the message names the line."""


@cache
def parameters(kernel: Kernel) -> Signature:
    """The parameters of a kernel and its result. Raises KernelError for types that kernels do not have."""
    types: dict[str, str | type[Record]] = {}
    annotations = dict(kernel.__annotations__)
    result = str(annotations.pop("return", "missing"))
    for name, kind in annotations.items():
        known = getattr(kernel, "__globals__", {}).get(kind)
        if isinstance(known, type) and issubclass(known, Record):
            types[name] = known
        elif kind in ARRAYS or kind in ("int", "float"):
            types[name] = str(kind)
        else:
            raise KernelError(f"{kernel.__name__}: parameter {name} is {kind}, expected int, float, array or record")
    if result not in SCALARS:
        raise KernelError(f"{kernel.__name__}: result is {result}, expected int, float or None")
    return types, result
