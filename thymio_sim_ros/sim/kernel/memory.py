"""Memory that Python and compiled kernels share, and kernels bound to arrays in it.

Kernels run in WebAssembly when the package wasmtime is installed (`pip install thymio-sim-ros[fast]`); nothing but time
depends on it. A kernel that reads beyond its arrays would not be noticed here: tests run all of them in Python too.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cache
from types import ModuleType
from typing import Any, TypeVar

import numpy as np
import numpy.typing as npt

from aseba_vm.jit.wasm_calls import make_caller
from aseba_vm.jit.wasm_runtime import WasmRuntime, is_usable
from thymio_sim_ros.sim.kernel.compiler import Kernel, KernelError, parameters, translate

__all__ = ["KernelMemory", "is_available"]

_PAGE = 0x10000
_ALIGNMENT = 16
_TYPES = {"Floats": np.dtype(np.float64), "Ints": np.dtype(np.int32), "Words": np.dtype(np.uint16)}

Shape = int | tuple[int, ...]
A = TypeVar("A", bound=np.generic)


def is_available() -> bool:
    """Return whether kernels can be compiled and run here."""
    return is_usable()


class KernelMemory:
    """A WebAssembly memory that numpy arrays and kernels share.

    Arrays are allocated one after the other and never freed alone. Invariant: the memory never grows, so an array keeps
    its address until `close`. An array does not keep the memory alive: its owner must.
    """

    def __init__(self, size: int) -> None:
        """Allocate `size` bytes, rounded up to pages of 64 kB. Needs wasmtime (`is_available`)."""
        runtime = WasmRuntime.get()
        self._wasmtime = wasmtime = runtime.wasmtime
        self._store = wasmtime.Store(runtime.engine)
        pages = -(-size // _PAGE)
        memory = wasmtime.Memory(self._store, wasmtime.MemoryType(wasmtime.Limits(pages, pages)))
        self._memory = memory
        self._instances: dict[ModuleType, Any] = {}
        self._bytes = np.ctypeslib.as_array(memory.data_ptr(self._store), (pages * _PAGE,))
        self._base = self._bytes.ctypes.data
        self._used = 0
        runtime.register(self)

    @classmethod
    def holding(cls, floats: Sequence[Shape], ints: Sequence[Shape] = ()) -> tuple[KernelMemory, list[Any], list[Any]]:
        """Allocate a memory for arrays of these shapes; returns it, the float64 arrays and the int32 arrays."""
        kinds = [(shape, np.float64) for shape in floats], [(shape, np.int32) for shape in ints]
        memory = cls(sum(cls.room(shape, kind) for part in kinds for shape, kind in part))
        found = [[memory.array(shape, kind) for shape, kind in part] for part in kinds]
        return memory, found[0], found[1]

    @staticmethod
    def room(shape: Shape, kind: type[np.generic]) -> int:
        """Return the largest number of bytes that an array takes, with alignment."""
        return int(np.prod(shape)) * np.dtype(kind).itemsize + _ALIGNMENT

    def array(self, shape: Shape, kind: type[A]) -> npt.NDArray[A]:
        """Allocate an array of zeros. Raises MemoryError if there is no room."""
        start = -(-self._used // _ALIGNMENT) * _ALIGNMENT
        end = start + int(np.prod(shape)) * np.dtype(kind).itemsize
        if end > len(self._bytes):
            raise MemoryError(
                f"an array of {shape}: found {len(self._bytes) - start} free bytes, expected {end - start}"
            )
        self._used = end
        return self._bytes[start:end].view(kind).reshape(shape)

    def bind(self, module: ModuleType, kernel: Kernel, *arguments: npt.NDArray[Any] | float) -> Callable[[], object]:
        """Return a function that calls a kernel of a module with these numbers and arrays.

        Arrays are passed as addresses, so they must be of this memory; what is in them may change between calls, as
        numbers may not. Raises KernelError for a wrong number of arguments or an array of another type or memory.
        """
        kinds = parameters(kernel)[0]
        if len(kinds) != len(arguments):
            raise KernelError(f"{kernel.__name__}: found {len(arguments)} arguments, expected {len(kinds)}")
        values = [
            self._place(argument, kind) if isinstance(argument, np.ndarray) else argument
            for argument, kind in zip(arguments, kinds.values(), strict=True)
        ]
        instance = self._instances.get(module)
        if instance is None:
            instance = self._wasmtime.Instance(self._store, _compiled(module), [self._memory]).exports(self._store)
            self._instances[module] = instance
        return make_caller(self._wasmtime, self._store, instance[kernel.__name__], values)

    def close(self) -> None:
        """Free the memory; its arrays and bound kernels must not be used any more."""
        self._store.close()

    def _place(self, array: npt.NDArray[Any], kind: str) -> int:
        place = array.ctypes.data - self._base
        if array.dtype != _TYPES[kind] or not array.flags.c_contiguous or not 0 <= place <= len(self._bytes):
            raise KernelError(
                f"found an array of {array.dtype}, expected a contiguous array of {_TYPES[kind]} in the kernel's memory"
            )
        return place


@cache
def _compiled(module: ModuleType) -> Any:
    """Compile all kernels of a module, once per process."""
    kernels = [module.__dict__[name] for name in module.KERNELS]
    return WasmRuntime.get().compile(translate(kernels))
