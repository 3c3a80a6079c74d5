"""Packages of messages of users: folders with `msg/Name.msg`, `srv/Name.srv` and `action/Name.action`."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from functools import cache
from pathlib import Path

from thymio_sim_ros.portable_ros.messages.definition_text import DefinitionError
from thymio_sim_ros.portable_ros.source_packages import installed_folder, source_folders

__all__ = ["FORMS", "TAUGHT", "check_names", "own_folder", "read"]

FORMS = ("msg", "srv", "action")
TAUGHT: dict[str, Mapping[str, str]] = {}
"""The texts of packages without a folder here; `taught_packages.py` adds them."""
_PACKAGE_NAME = re.compile(r"(?!.*__)(?!.*_$)[a-z][a-z0-9_]*")
_NAME = re.compile(r"[A-Z][A-Za-z0-9]*")


def own_folder(package: str) -> Path | None:
    """The folder of a package of the user with definitions, None if there is none; once found, it stays the same."""
    try:
        return _found(package)
    except LookupError:
        return None


@cache
def _found(package: str) -> Path:
    """The folder of a package. Raises LookupError, which the cache does not keep: another folder may have it later."""
    if _PACKAGE_NAME.fullmatch(package):
        for folder in source_folders(package):
            if _has_definitions(folder):
                return folder
        installed = installed_folder(package)
        if installed is not None and _has_definitions(installed):
            return installed
    raise LookupError(package)


def _has_definitions(folder: Path) -> bool:
    return any(next((folder / form).glob(f"*.{form}"), None) is not None for form in FORMS)


def check_names(package: str, names: Iterable[str]) -> None:
    """Raise DefinitionError unless a package and `msg/Name`, `srv/Name` or `action/Name` are names of interfaces."""
    if not _PACKAGE_NAME.fullmatch(package):
        raise DefinitionError(f"found the package {package!r:.80}, expected lower case letters, digits and underscores")
    for name in names:
        form, _, short = name.partition("/")
        if form not in FORMS or not _NAME.fullmatch(short):
            raise DefinitionError(f"{package}: found the name {name!r:.80}, expected one such as msg/Num")


def read(folder: Path) -> Mapping[str, str]:
    """The texts of a folder by `msg/Name`, `srv/Name` or `action/Name`.

    Raises DefinitionError for a file that cannot be read, or whose name is no name of an interface. Such a file is left
    out where `CMakeLists.txt` does not list it, as a build does.
    """
    found = {}
    build = folder / "CMakeLists.txt"
    built = build.read_text(encoding="utf-8", errors="replace") if build.is_file() else ""
    for form in FORMS:
        for file in sorted((folder / form).glob(f"*.{form}")):
            if not _NAME.fullmatch(file.stem):
                if built and f"{form}/{file.name}" not in built:
                    continue
                raise DefinitionError(f"{file}: found the name {file.stem!r}, expected one such as AddThreeInts")
            try:
                found[f"{form}/{file.stem}"] = file.read_text(encoding="utf-8-sig")
            except (OSError, UnicodeDecodeError) as error:
                raise DefinitionError(f"{file}: cannot be read as UTF-8 text: {error}") from error
    return found
