"""Serves the room under the names that programs import: `rclpy`, `std_msgs` and the others, and messages of users.

The hook never serves a part of what is installed: it serves all names, or, where there is an rclpy, none unless it is
asked to. An installation with packages of messages but without rclpy is refused, because a program would mix both.
"""

from __future__ import annotations

import importlib
import importlib.util
import sys
from collections.abc import Iterable, Sequence
from importlib.abc import Loader, MetaPathFinder
from importlib.machinery import ModuleSpec
from pathlib import Path
from types import ModuleType

from thymio_sim_ros.errors import ThymioSimError

__all__ = ["APIS", "MODULES", "MixedInstallationError", "install", "is_served"]

_ROOM = __package__
APIS = ("rclpy", "rosidl_parser", "ament_index_python")
MODULES = ("test_msgs.message_fixtures",)
"""What packages of messages have beside their messages."""


class MixedInstallationError(ThymioSimError, ImportError):
    """There are packages of messages without an rclpy, or parts of the other kind are imported already."""


class _RoomLoader(Loader):
    """Loads a module of the room; the import system gets the same object under both names."""

    def __init__(self, name: str) -> None:
        self._name = name

    def create_module(self, spec: ModuleSpec) -> ModuleType:
        """Import the module of the room."""
        module = importlib.import_module(f"{_ROOM}.{self._name}")
        self._own_spec = module.__spec__
        return module

    def exec_module(self, module: ModuleType) -> None:
        """Restore what the import system has changed: the module was executed under its own name.

        Modules of rclpy get the names that they have from others.
        """
        from thymio_sim_ros.portable_ros.rclpy_parts.borrowed_names import BORROWED, lookup

        module.__spec__ = self._own_spec
        if self._name in BORROWED:
            module.__dict__["__getattr__"] = lookup(self._name, module.__dict__.get("__getattr__"))


class _MessagesLoader(Loader):
    """Makes a package of messages, such as `std_msgs`, or a module of it, such as `std_msgs.msg`."""

    def create_module(self, spec: ModuleSpec) -> ModuleType | None:
        """Let the import system make an empty module."""
        return None

    def exec_module(self, module: ModuleType) -> None:
        """Fill a module with its classes, each of which is made when it is first used."""
        from thymio_sim_ros.portable_ros.messages.packages import fill

        fill(module)


class _Finder(MetaPathFinder):
    """Finds the modules that the room serves."""

    def find_spec(
        self, fullname: str, path: Sequence[str] | None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        """The spec of a module, None for others."""
        top, _, rest = fullname.partition(".")
        if top in APIS or fullname in MODULES:
            own = importlib.util.find_spec(f"{_ROOM}.{fullname}")
            if own is None:
                return None
            has_modules = own.submodule_search_locations is not None
            return ModuleSpec(fullname, _RoomLoader(fullname), origin=own.origin, is_package=has_modules)
        from thymio_sim_ros.portable_ros.messages.interface_files import FORMS, PACKAGES, is_module, is_package

        if top in PACKAGES and (not rest or is_module(fullname)):
            return _messages_spec(fullname)
        name = fullname.rpartition(".")[2]
        if rest.partition(".")[0] not in FORMS:  # before folders are searched for the package, which takes long
            return None
        if is_package(top) and is_module(fullname) and not _is_regular(name, path or ()):
            return _messages_spec(fullname)
        return None


class _LastFinder(MetaPathFinder):
    """Finds packages of messages of users, if nothing else has their names."""

    def find_spec(
        self, fullname: str, path: Sequence[str] | None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        """The spec of a package, None for others."""
        from thymio_sim_ros.portable_ros.messages.interface_files import is_package

        return _messages_spec(fullname) if path is None and is_package(fullname) else None


def _messages_spec(fullname: str) -> ModuleSpec:
    return ModuleSpec(fullname, _MessagesLoader(), origin=__file__, is_package=fullname.count(".") < 2)


def _is_regular(name: str, folders: Iterable[str]) -> bool:
    """Whether a module of folders has a file; a folder without `__init__.py` is importable, too.

    PathFinder would need the package of the module to be imported already.
    """
    files = (Path(folder, file) for folder in folders for file in (f"{name}.py", f"{name}/__init__.py"))
    return any(file.is_file() for file in files)


def install(*, is_forced: bool = False) -> bool:
    """Serve the room from now on, if there is no rclpy or if it is forced; return whether it is served.

    Raises MixedInstallationError.
    """
    if any(isinstance(one, _Finder) for one in sys.meta_path):
        return True
    is_there = importlib.util.find_spec("rclpy") is not None
    if is_there and not is_forced:
        return False
    from thymio_sim_ros.portable_ros.messages.interface_files import PACKAGES

    imported = sorted(name for name in (*APIS, *PACKAGES) if name in sys.modules)
    if imported:
        raise MixedInstallationError(
            f"found {imported[0]} of another ROS imported already, expected none: install the embedded graph first"
        )
    found = None if is_there else next((one for one in sorted(PACKAGES) if importlib.util.find_spec(one)), None)
    if found is not None and not is_forced:
        raise MixedInstallationError(
            f"found {found} without rclpy, expected both or neither: complete the installation of ROS, or use"
            " `python -m thymio_sim_ros.portable_ros` to ignore it"
        )
    sys.meta_path.insert(0, _Finder())
    sys.meta_path.append(_LastFinder())
    return True


def is_served(name: str) -> bool:
    """Whether the import of a package gets the one of the room."""
    top = name.partition(".")[0]
    finder = next((one for one in sys.meta_path if isinstance(one, _Finder)), None)
    return finder is not None and finder.find_spec(top, None) is not None
