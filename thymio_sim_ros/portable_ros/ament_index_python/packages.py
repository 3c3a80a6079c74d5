"""The folders of packages. A package need not be installed: its source folder has the same files."""

from __future__ import annotations

import re
from pathlib import Path

from thymio_sim_ros.errors import ThymioSimError
from thymio_sim_ros.portable_ros.ament_index_python.resources import get_resources, has_resource
from thymio_sim_ros.portable_ros.ament_index_python.search_paths import get_search_paths
from thymio_sim_ros.portable_ros.source_packages import MANIFEST, source_folders

__all__ = [
    "PackageNotFoundError",
    "get_package_prefix",
    "get_package_share_directory",
    "get_package_share_path",
    "get_packages_with_prefixes",
]

_NAME = re.compile(r"[a-zA-Z0-9][a-zA-Z0-9_-]+", re.ASCII)


class PackageNotFoundError(ThymioSimError, KeyError):
    """There is no such package."""


def get_packages_with_prefixes() -> dict[str, str]:
    """The folders of all installed packages by their names."""
    return get_resources("packages")


def get_package_prefix(package_name: str) -> str:
    """The folder into which a package is installed, or else its source folder.

    Raises PackageNotFoundError, and ValueError for what is no name of a package.
    """
    source = _source(package_name)
    if source is not None and has_resource("packages", package_name) is False:
        return str(source)
    return str(_installed(package_name))


def get_package_share_path(package_name: str, print_warning: bool = True) -> Path:
    """The folder of the files of a package, such as `launch` and `config`: as installed, or its source folder.

    Raises the errors of `get_package_prefix`.
    """
    return _source(package_name) or _installed(package_name) / "share" / package_name


def get_package_share_directory(package_name: str, print_warning: bool = True) -> str:
    """The folder of the files of a package as a text; see `get_package_share_path`."""
    return str(get_package_share_path(package_name))


def _source(name: str) -> Path | None:
    """The source folder of a package, None without one. Raises ValueError."""
    if not _NAME.fullmatch(name):
        raise ValueError(f"'{name}' is not a valid package name")
    return next((folder for folder in source_folders(name) if (folder / MANIFEST).is_file()), None)


def _installed(name: str) -> Path:
    prefix = has_resource("packages", name)
    if prefix is False:
        raise PackageNotFoundError(
            f"package '{name}' not found, searching: {get_search_paths()}, and for a folder '{name}' with {MANIFEST}"
            " beside the program or beside a folder above it"
        )
    return Path(prefix)
