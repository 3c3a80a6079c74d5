"""Collects the plug-ins of a folder: the one object that each of its modules exports, in name order.

A package of plug-ins is its own registry (architecture section 9): putting a file into the folder adds
the plug-in, and nothing else has to know. Name order makes every walk over a registry repeatable.
"""

from __future__ import annotations

import importlib
import pkgutil
from types import ModuleType
from typing import TypeVar

__all__ = ["RegistryError", "collect"]

T = TypeVar("T")


class RegistryError(Exception):
    """A module of a plug-in folder exports nothing, or something of the wrong kind."""

    def __init__(self, module: str, export: str, found: str) -> None:
        super().__init__(f"{module}: expected {export}, found {found}")
        self.module = module
        self.export = export
        self.found = found


def collect(package: ModuleType, export: str, kind: type[T]) -> tuple[T, ...]:
    """The `export` (such as "SENSOR") of every module of `package`, in the order of the modules' names.

    Modules whose name begins with an underscore are helpers. Raises RegistryError for a module without
    the export, or with one that is no `kind`.
    """
    found = []
    for name in sorted(info.name for info in pkgutil.iter_modules(package.__path__)):
        if name.startswith("_"):
            continue
        module = importlib.import_module(f"{package.__name__}.{name}")
        plugin = getattr(module, export, None)
        if not isinstance(plugin, kind):
            raise RegistryError(module.__name__, f"{export} of type {kind.__name__}", type(plugin).__name__)
        found.append(plugin)
    return tuple(found)
