"""Collects plug-ins: exports of the modules of a folder of this project, and entry points of other packages.

A package of plug-ins is its own registry (docs/plugins.md): a file in the folder is a plug-in. Another package adds
plug-ins by entry points of the groups `thymio_sim_ros.sensors`, `.actuators`, `.stimuli` and `.shapes`, and whole
folders by `.behaviours` and `.playgrounds`. A broken module of this package raises RegistryError; a broken plug-in of
another package is logged and skipped. Plug-ins are in order of name, so that every loop over them is repeatable.
"""

from __future__ import annotations

import functools
import importlib
import importlib.metadata
import logging
import pkgutil
import re
from collections.abc import Callable
from pathlib import Path
from types import ModuleType
from typing import Protocol, TypeVar

from thymio_sim_ros.errors import ThymioSimError

__all__ = ["RegistryError", "clear_cache", "collect", "folders", "own_names"]

PREFIX = "thymio_sim_ros"
NAME = re.compile(r"[a-z](_?[a-z0-9])*")
"""Valid names of plug-ins, which become parts of topics, keys and events."""


class Named(Protocol):
    """The attribute that every plug-in has."""

    @property
    def name(self) -> str:
        """Its name, unique in the registry."""
        ...


T = TypeVar("T", bound=Named)


class RegistryError(ThymioSimError):
    """A module of a plug-in folder exports nothing, or something of the wrong kind."""

    def __init__(self, module: str, export: str, found: str) -> None:
        super().__init__(f"{module}: expected {export}, found {found}")
        self.module = module
        self.export = export
        self.found = found


def collect(
    package: ModuleType,
    export: str,
    kind: type[T],
    *,
    check: Callable[[T], object] = id,
    guard: Callable[[T], T] = lambda plugin: plugin,
) -> tuple[T, ...]:
    """Collect the `export` (such as "SENSOR") of each module of `package` and of other packages, in order of name.

    Modules whose name begins with an underscore are helpers. Plug-ins of other packages are skipped if `check` raises,
    and passed through `guard`, which should isolate their errors. Raises RegistryError for a module of this package
    without the export, or with one of another type.
    """
    found: dict[str, T] = {}
    for name in own_names(package):
        module = importlib.import_module(f"{package.__name__}.{name}")
        plugin = getattr(module, export, None)
        if not isinstance(plugin, kind):
            raise RegistryError(module.__name__, f"{export} of type {kind.__name__}", type(plugin).__name__)
        found[plugin.name] = plugin
    for plugin in _external(f"{PREFIX}.{package.__name__.rpartition('.')[2]}", export, kind, tuple(found), check):
        found[plugin.name] = guard(plugin)
    return tuple(found[name] for name in sorted(found))


def own_names(package: ModuleType) -> tuple[str, ...]:
    """Names of the modules in a folder of plug-ins, in order."""
    names = (info.name for info in pkgutil.iter_modules(package.__path__))
    return tuple(sorted(name for name in names if not name.startswith("_")))


@functools.cache
def folders(group: str) -> tuple[Path, ...]:
    """Folders that other packages offer in the group `thymio_sim_ros.<group>`, in order of name."""
    found: list[Path] = []
    for entry in _entries(f"{PREFIX}.{group}"):
        try:
            module = entry.load()
            found.extend(Path(folder) for folder in module.__path__)
        except Exception as error:
            _log_skipped(entry, error)
    return tuple(found)


def clear_cache() -> None:
    """Clear the caches, so that plug-ins of other packages are searched again."""
    _installed.cache_clear()
    folders.cache_clear()
    _external.cache_clear()


@functools.cache
def _external(
    group: str, export: str, kind: type[T], taken: tuple[str, ...], check: Callable[[T], object]
) -> tuple[T, ...]:
    """Valid plug-ins of other packages in a group, without those whose names are in use."""
    found: dict[str, T] = {}
    for entry in _entries(group):
        try:
            loaded = entry.load()
            plugin = getattr(loaded, export, None) if isinstance(loaded, ModuleType) else loaded
            if not isinstance(plugin, kind):
                raise RegistryError(entry.value, f"{export} of type {kind.__name__}", type(plugin).__name__)
            if not NAME.fullmatch(plugin.name):
                raise RegistryError(entry.value, "a name of small letters, digits and single underscores", plugin.name)
            if plugin.name in taken or plugin.name in found:
                raise RegistryError(entry.value, "a name of its own", f"'{plugin.name}', which exists")
            check(plugin)
        except Exception as error:
            _log_skipped(entry, error)
        else:
            found[plugin.name] = plugin
    return tuple(found.values())


@functools.cache
def _installed() -> importlib.metadata.SelectableGroups | importlib.metadata.EntryPoints:
    """The entry points of all packages, which takes a file of each to read."""
    return importlib.metadata.entry_points()


def _entries(group: str) -> list[importlib.metadata.EntryPoint]:
    return sorted(_installed().select(group=group), key=lambda entry: (entry.name, entry.value))


def _log_skipped(entry: importlib.metadata.EntryPoint, error: Exception) -> None:
    """Log that a plug-in is skipped; errors of its code do not affect the others."""
    package = entry.dist.name if entry.dist is not None else "?"
    logging.getLogger(__name__).warning(
        "plug-in '%s' of the package %s (%s) is left out: %s: %s",
        entry.name, package, entry.group, type(error).__name__, error,
    )  # fmt: skip
