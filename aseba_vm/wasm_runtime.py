"""The compiler of WebAssembly, one for the process."""

from __future__ import annotations

import atexit
import importlib
import weakref
from typing import Any, Protocol


class Closable(Protocol):
    """What holds a store."""

    def close(self) -> None:
        """Let go of it; harmless when done already."""
        ...


class Runtime:
    """The compiler, one for the process."""

    _instance: Runtime | None = None

    def __init__(self) -> None:
        """Load ``wasmtime``."""
        self.wasmtime: Any = importlib.import_module("wasmtime")
        self.engine = self.wasmtime.Engine()
        self._modules: weakref.WeakSet[Any] = weakref.WeakSet()
        self._served: weakref.WeakSet[Closable] = weakref.WeakSet()
        atexit.register(self._close)

    def compile(self, text: str) -> Any:
        """Return a module."""
        module = self.wasmtime.Module(self.engine, text)
        self._modules.add(module)
        return module

    def serve(self, served: Closable) -> None:
        """Note what lives in a store of its own; it is closed before the process takes ``wasmtime`` itself apart."""
        self._served.add(served)

    def _close(self) -> None:
        for made in [*self._served, *self._modules, self.engine]:
            made.close()

    @classmethod
    def get(cls) -> Runtime:
        """Return the compiler, started when first asked for."""
        if cls._instance is None:
            cls._instance = cls()
        return cls._instance
