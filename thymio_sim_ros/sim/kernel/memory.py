"""Memory that Python and compiled kernels share, and kernels bound to arrays in it.

Kernels run in WebAssembly. Where wasmtime does not work, Python runs the same functions: slowly, with the same bits. A
compiled kernel that reads beyond its arrays would not be noticed; the tests run all kernels in Python too.
"""

from __future__ import annotations

import ctypes
from collections.abc import Callable
from functools import cache, partial
from typing import Any

import numpy as np
import numpy.typing as npt

from aseba_vm.kernel.compiler import KernelError, parameters, translate
from aseba_vm.kernel.record import Record, fields
from aseba_vm.kernel.types import ALIGNMENT, DTYPES, Kernel
from aseba_vm.kernel.wasm_calls import make_caller
from aseba_vm.kernel.wasm_runtime import WasmRuntime, is_usable

__all__ = ["Argument", "KernelMemory"]

_PAGE = 0x10000

Shape = int | tuple[int, ...]
Argument = Record | npt.NDArray[Any] | float


class KernelMemory:
    """A fixed number of bytes in which arrays are allocated. An array stays where it is while its memory is open."""

    def __init__(self, size: int, *, is_compiled: bool | None = None) -> None:
        """Allocate `size` bytes. `is_compiled`: whether kernels are compiled; None: if that is possible."""
        self._wasmtime: Any = None
        self._instances: dict[Kernel, Any] = {}
        """Of each kernel one: a store keeps all instances, and takes ten thousand."""
        if is_usable() if is_compiled is None else is_compiled:
            runtime = WasmRuntime.get()
            self._wasmtime = wasmtime = runtime.wasmtime
            self._store = wasmtime.Store(runtime.engine)
            pages = -(-size // _PAGE)
            memory = wasmtime.Memory(self._store, wasmtime.MemoryType(wasmtime.Limits(pages, pages)))
            self._memory = memory
            block: Any = (ctypes.c_ubyte * (pages * _PAGE)).from_address(
                ctypes.addressof(memory.data_ptr(self._store).contents)
            )
            block.owner = (
                self._store,
                memory,
            )  # arrays keep the block alive; numpy would hide a cycle from the collector
            self._bytes = np.ctypeslib.as_array(block)
            runtime.register(self)
        else:
            self._bytes = np.zeros(size + ALIGNMENT, dtype=np.uint8)
        self._base = self._bytes.ctypes.data
        self.used = 0
        """Number of bytes in use; set it back to free the arrays allocated since."""
        self._touched = 0
        """Number of bytes that have ever been in use; those behind are zero."""

    @staticmethod
    def room(shape: Shape, kind: npt.DTypeLike) -> int:
        """Bytes that an array takes at most."""
        return int(np.prod(shape)) * np.dtype(kind).itemsize + ALIGNMENT

    def array(self, shape: Shape, kind: npt.DTypeLike) -> npt.NDArray[Any]:
        """Allocate an array of zeros. Raises MemoryError when there is no room."""
        start = -(-self.used // ALIGNMENT) * ALIGNMENT
        end = start + int(np.prod(shape)) * np.dtype(kind).itemsize
        if end > len(self._bytes):
            raise MemoryError(
                f"an array of {shape}: found {len(self._bytes) - start} free bytes, expected {end - start}"
            )
        self.used = end
        self._bytes[start : min(end, self._touched)] = 0
        self._touched = max(self._touched, end)
        return self._bytes[start:end].view(kind).reshape(shape)

    def bind(self, kernel: Kernel, *arguments: Argument) -> Callable[[], Any]:
        """A function that calls a kernel with these numbers, arrays and records, always the same.

        The arrays must be of this memory. Raises KernelError for arguments that do not fit the parameters.
        """
        kinds, result = parameters(kernel)
        if result != "None":
            raise KernelError(f"{kernel.__name__}: result is {result}, expected None of a kernel that Python calls")
        if len(kinds) != len(arguments):
            raise KernelError(f"{kernel.__name__}: found {len(arguments)} arguments, expected {len(kinds)}")
        for (name, kind), argument in zip(kinds.items(), arguments, strict=True):
            if isinstance(kind, type) and type(argument) is not kind:
                raise KernelError(f"{kernel.__name__}: {name} is {type(argument).__name__}, expected {kind.__name__}")
        if self._wasmtime is None:
            return partial(kernel, *map(_as_python, arguments))
        values: list[float] = []
        for argument, kind in zip(arguments, kinds.values(), strict=True):
            if isinstance(argument, Record):
                values.append(argument.count)
                values += [
                    self._place(getattr(argument, name), array) for name, array in fields(type(argument)).items()
                ]
            elif isinstance(argument, np.ndarray):
                values.append(self._place(argument, str(kind)))
            else:
                values.append(float(argument) if kind == "float" else argument)
        if kernel not in self._instances:
            instance = self._wasmtime.Instance(self._store, _compiled(kernel), [self._memory])
            self._instances[kernel] = instance.exports(self._store)[kernel.__name__]
        return make_caller(self._wasmtime, self._store, self._instances[kernel], values)

    def close(self) -> None:
        """Free the memory; its arrays and bound kernels must not be used any more."""
        if self._wasmtime is not None:
            self._store.close()

    def _place(self, array: npt.NDArray[Any], kind: str) -> int:
        place = array.ctypes.data - self._base
        if array.dtype != DTYPES[kind] or not array.flags.c_contiguous or not 0 <= place <= len(self._bytes):
            raise KernelError(
                f"an array of {array.dtype}, expected a contiguous array of {DTYPES[kind]} in this memory"
            )
        return place


def _as_python(argument: Argument) -> Any:
    """An argument as Python kernels read it fastest."""
    if isinstance(argument, Record):
        return argument.view
    return memoryview(argument.reshape(-1).data) if isinstance(argument, np.ndarray) else argument


@cache
def _compiled(kernel: Kernel) -> Any:
    """A kernel and those that it calls, compiled once per process."""
    return WasmRuntime.get().compile(translate([kernel]))
