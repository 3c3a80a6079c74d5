"""The compiler of WebAssembly, one for the process."""

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
"""Bytes of address space that must be left for the memories and modules that are made later."""
_SAMPLE = '(module (import "" "memory" (memory 1)) (func (export "run") (i32.store (i32.const 0) (i32.const 42))))'


@cache
def is_usable() -> bool:
    """Whether WebAssembly can be compiled and run here; if ``wasmtime`` is there but fails, the reason is logged once.

    The package may be broken (a missing system library, another machine's binary), or a memory limit may be too low.
    """
    try:
        _try()
    except ModuleNotFoundError as error:
        if error.name == "wasmtime":
            return False
        _log(error)
        return False
    except Exception as error:  # whatever a broken package raises: everything works without it
        _log(error)
        return False
    return True


def _try() -> None:
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


def _log(error: Exception) -> None:
    reason = " ".join(str(error).split()) or type(error).__name__
    logging.getLogger(__name__).warning("wasmtime cannot be used, programs and crowds run slower: %s", reason)


class StoreOwner(Protocol):
    """What holds a store."""

    def close(self) -> None:
        """Let go of it; harmless when done already."""
        ...


class WasmRuntime:
    """The compiler, one for the process."""

    _instance: WasmRuntime | None = None

    def __init__(self) -> None:
        """Load ``wasmtime``."""
        self.wasmtime: Any = importlib.import_module("wasmtime")
        self.engine = self.wasmtime.Engine(self._config())
        self._modules: weakref.WeakSet[Any] = weakref.WeakSet()
        self._store_owners: weakref.WeakSet[StoreOwner] = weakref.WeakSet()
        atexit.register(self._close)

    def _config(self) -> Any:
        """Memories take the address space of their size.

        The default of 4 GB each makes them fail where address space is limited (`ulimit -v`, batch systems). They never
        grow, so that they need no room behind them either; bounds are checked instead (measured: no slower).
        """
        config = self.wasmtime.Config()
        for name, value in (
            ("memory_reservation", _PAGE),
            ("memory_reservation_for_growth", 0),
            ("memory_guard_size", _PAGE),
        ):
            if hasattr(type(config), name):  # older versions reserve what they choose
                setattr(config, name, value)
        return config

    def compile(self, text: str) -> Any:
        """Return a module."""
        module = self.wasmtime.Module(self.engine, text)
        self._modules.add(module)
        return module

    def register(self, owner: StoreOwner) -> None:
        """Note what lives in a store of its own; it is closed before the process takes ``wasmtime`` itself apart."""
        self._store_owners.add(owner)

    def _close(self) -> None:
        for made in [*self._store_owners, *self._modules, self.engine]:
            made.close()

    @classmethod
    def get(cls) -> WasmRuntime:
        """Return the compiler, started when first asked for."""
        if cls._instance is None:
            cls._instance = cls()
        return cls._instance
