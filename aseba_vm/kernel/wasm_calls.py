"""Calls into and out of WebAssembly by the fastest interface of the installed `wasmtime`.

The documented interface checks and converts every value, which costs more than a short event. The ctypes bindings
inside the package make the same calls without that. They are private: where they differ from what this module expects,
the documented interface is used.
"""

from __future__ import annotations

import ctypes
from collections.abc import Callable, Sequence
from functools import cache, partial
from typing import Any


def make_caller(wasmtime: Any, store: Any, function: Any, arguments: Sequence[float] = ()) -> Callable[[], object]:
    """A function that calls an exported function with fixed arguments: an int is an i32, a float an f64.

    The call holds the GIL, so the exported function must be bounded in time.
    """
    try:
        bindings = wasmtime._bindings
        raw = _library(bindings.dll._name).wasmtime_func_call_unchecked
        values = (bindings.wasmtime_val_raw_t * max(1, len(arguments)))()
        for value, argument in zip(values, arguments, strict=False):
            setattr(value, "i32" if isinstance(argument, int) else "f64", argument)
        trap = ctypes.POINTER(bindings.wasm_trap_t)()
        context = ctypes.c_void_p(ctypes.cast(store._context(), ctypes.c_void_p).value)
        places = [ctypes.c_void_p(ctypes.addressof(part)) for part in (function._func, values, trap)]
    except AttributeError:
        return partial(function, store, *arguments)
    call = partial(raw, context, places[0], places[1], ctypes.c_size_t(len(values)), places[2])
    call.kept = (store, function, values, trap)  # type: ignore[attr-defined]  # keeps them alive as long as the call
    return call


def make_import(wasmtime: Any, store: Any, function: Callable[[], None]) -> Any:
    """A host function without parameters for modules to import. It must not raise."""
    kind = wasmtime.FuncType([], [])
    try:
        bindings = wasmtime._bindings
        host_function = bindings.wasmtime_func_t()

        def call(_environment: int, _caller: int, _values: int, _count: int) -> int:
            function()
            return 0

        # Numbers in place of the pointers that the bindings declare: ctypes would build objects for them in each call.
        pointer = ctypes.c_size_t
        function_type = ctypes.PYFUNCTYPE(ctypes.c_size_t, pointer, pointer, pointer, ctypes.c_size_t)
        callback = ctypes.cast(function_type(call), bindings.wasmtime_func_unchecked_callback_t)
        bindings.wasmtime_func_new_unchecked(
            store._context(), kind.ptr(), callback, None, type(wasmtime._func.finalize)(), ctypes.byref(host_function)
        )
        imported = wasmtime.Func._from_raw(host_function)
    except (AttributeError, TypeError, ctypes.ArgumentError):
        return wasmtime.Func(store, kind, function)
    imported.kept = callback  # keeps it alive as long as the function
    return imported


@cache
def _library(name: str) -> ctypes.PyDLL:
    """A library whose functions are called with the GIL: to release and take it costs more than a short event.

    It is cached because each one has classes of its own, which only the collector frees.
    """
    return ctypes.PyDLL(name)
