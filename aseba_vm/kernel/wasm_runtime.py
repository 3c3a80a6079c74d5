"""The WebAssembly compiler, shared by the whole process."""

from __future__ import annotations

import atexit
import importlib
import logging
import mmap
import weakref
from functools import cache
from typing import Any, Protocol

_PAGE = 0x10000
_HEADROOM = 256 << 20
"""Bytes of address space that must remain free for later memories and modules."""
_SAMPLE = '(module (import "" "memory" (memory 1)) (func (export "run") (i32.store (i32.const 0) (i32.const 42))))'


@cache
def is_usable() -> bool:
    """Whether WebAssembly can be compiled and run here. Never raises.

    If not, the reason is logged once: `wasmtime` may be missing (it has no wheel for every platform) or broken (a
    missing system library, a binary for another platform), or a memory limit too low.
    """
    try:
        _try()
    except Exception as error:  # a broken package can raise anything, and everything works without it
        reason = " ".join(str(error).split()) or type(error).__name__
        logging.getLogger(__name__).warning("wasmtime cannot be used, programs and robots run slower: %s", reason)
        return False
    return True


def _try() -> None:
    """Compile and run a sample. Raises any exception that a broken `wasmtime` can raise."""
    runtime = WasmRuntime.get()
    wasmtime = runtime.wasmtime
    with mmap.mmap(-1, _HEADROOM):
        store = wasmtime.Store(runtime.engine)
        memory = wasmtime.Memory(store, wasmtime.MemoryType(wasmtime.Limits(1, 1)))
        wasmtime.Instance(store, runtime.compile(_SAMPLE), [memory]).exports(store)["run"](store)
        found = memory.data_ptr(store)[0]
        store.close()
    if found != 42:
        raise RuntimeError(f"a sample gave {found}, expected 42")


class StoreOwner(Protocol):
    """An object that owns a wasmtime store."""

    def close(self) -> None:
        """Free the store; harmless if it is already closed."""
        ...


class WasmRuntime:
    """The compiler, one instance per process."""

    _instance: WasmRuntime | None = None

    def __init__(self) -> None:
        """Import `wasmtime` and create the compiler."""
        self.wasmtime: Any = importlib.import_module("wasmtime")
        self.engine = self.wasmtime.Engine(self._config())
        self._modules: weakref.WeakSet[Any] = weakref.WeakSet()
        self._store_owners: weakref.WeakSet[StoreOwner] = weakref.WeakSet()
        atexit.register(self._close)

    def _config(self) -> Any:
        """A configuration in which memories reserve only the address space of their size, and no thread compiles.

        The default of 4 GB each fails where address space is limited (`ulimit -v`, batch systems). The memories never
        grow, so no space behind them is needed either; bounds are checked explicitly, which measured no slower. The
        threads that would compile large modules do not survive a fork, and modules are small.
        """
        config = self.wasmtime.Config()
        for name, value in (
            ("parallel_compilation", False),
            ("memory_reservation", _PAGE),
            ("memory_reservation_for_growth", 0),
            ("memory_guard_size", _PAGE),
        ):
            if hasattr(type(config), name):  # absent in older versions
                setattr(config, name, value)
        return config

    def compile(self, text: str) -> Any:
        """The module of a WebAssembly text."""
        module = self.wasmtime.Module(self.engine, text)
        self._modules.add(module)
        return module

    def register(self, owner: StoreOwner) -> None:
        """Register an owner of a store, to be closed at exit before `wasmtime` itself is unloaded."""
        self._store_owners.add(owner)

    def _close(self) -> None:
        for made in [*self._store_owners, *self._modules, self.engine]:
            made.close()

    @classmethod
    def get(cls) -> WasmRuntime:
        """The instance, created on first use."""
        if cls._instance is None:
            cls._instance = cls()
        return cls._instance
