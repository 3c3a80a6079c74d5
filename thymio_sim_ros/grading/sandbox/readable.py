"""The files of the system that a test process needs: interpreter, libraries, this package, ROS."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from pathlib import Path

import thymio_sim_ros

__all__ = ["DEVICES", "PACKAGE_FOLDER", "package_folders", "python_path", "readable_paths"]

PACKAGE_FOLDER = Path(thymio_sim_ros.__file__).resolve().parents[1]
"""The folder that has this package."""

_SYSTEM = (
    "/usr", "/bin", "/sbin", "/lib", "/lib32", "/lib64", "/libx32", "/etc/alternatives", "/etc/group", "/etc/hosts",
    "/etc/ld.so.cache", "/etc/ld.so.conf", "/etc/ld.so.conf.d", "/etc/localtime", "/etc/nsswitch.conf", "/etc/passwd",
    "/nix/store",
)  # fmt: skip
_PARTS = ("aseba_vm", "thymio_sim_ros", "playgrounds", "share")
"""What is read of it. A source tree has other files, perhaps an assignment."""

DEVICES = ("null", "full", "random", "urandom")
"""Without `zero`: a mapping of it is shared memory that no limit counts."""


def readable_paths() -> list[str]:
    """Existing files and folders that a test process may read, none of them below another."""
    prefixes = os.environ.get("AMENT_PREFIX_PATH", "").split(os.pathsep)
    wanted = [*_SYSTEM, sys.prefix, sys.base_prefix, sys.exec_prefix, *package_folders(), *filter(None, prefixes)]
    wanted += [str(PACKAGE_FOLDER / part) for part in _PARTS]
    found = sorted({path for path in wanted if os.path.lexists(path)}, key=len)
    return [path for path in found if not any(path.startswith(f"{other}/") for other in found)]


def python_path() -> str:
    """The value of PYTHONPATH with which a test process finds what this process finds."""
    return os.pathsep.join(dict.fromkeys([str(PACKAGE_FOLDER), *package_folders()]))


def package_folders() -> Iterator[str]:
    """Folders of installed packages."""
    for path in sys.path:
        if os.path.basename(path) in ("site-packages", "dist-packages") and os.path.isdir(path):
            yield path
