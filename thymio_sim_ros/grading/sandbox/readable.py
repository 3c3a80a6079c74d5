"""The files of the system that a test process needs: interpreter, libraries, this package, ROS."""

from __future__ import annotations

import contextlib
import importlib.util
import os
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path

import thymio_sim_ros

__all__ = [
    "DEVICES",
    "PACKAGE_FOLDER",
    "UNPRIVILEGED_ID",
    "closed_path",
    "needed_paths",
    "package_folders",
    "python_path",
    "readable_paths",
]  # fmt: skip

PACKAGE_FOLDER = Path(thymio_sim_ros.__file__).resolve().parents[1]
"""The folder that has this package."""

_SYSTEM = (
    "/usr", "/bin", "/sbin", "/lib", "/lib32", "/lib64", "/libx32", "/etc/alternatives", "/etc/group", "/etc/hosts",
    "/etc/ld.so.cache", "/etc/ld.so.conf", "/etc/ld.so.conf.d", "/etc/localtime", "/etc/nsswitch.conf", "/etc/passwd",
    "/nix/store",
)  # fmt: skip
_PARTS = ("aseba_vm", "thymio_sim_ros", "playgrounds", "share")
"""Readable parts of an installation. A source tree has other files, perhaps an assignment."""

UNPRIVILEGED_ID = 65534
"""A user and group without rights."""

DEVICES = ("null", "full", "random", "urandom")
"""Without `zero`: a mapping of it is shared memory that no limit counts."""


def readable_paths() -> list[str]:
    """Existing files and folders that a test process may read, none of them below another."""
    prefixes = os.environ.get("AMENT_PREFIX_PATH", "").split(os.pathsep)
    wanted = [*_SYSTEM, sys.prefix, sys.base_prefix, sys.exec_prefix, *package_folders(), *filter(None, prefixes)]
    wanted += [str(PACKAGE_FOLDER / part) for part in _PARTS]
    found = sorted({path for path in wanted if os.path.lexists(path)}, key=len)
    return [path for path in found if not any(path.startswith(f"{other}/") for other in found)]


def needed_paths() -> list[str]:
    """Paths without which no test process starts: the interpreter, this package, pytest."""
    pytest = importlib.util.find_spec("pytest")
    found = [str(PACKAGE_FOLDER / "aseba_vm"), str(PACKAGE_FOLDER / "thymio_sim_ros")]
    found += [os.path.dirname(pytest.origin)] if pytest is not None and pytest.origin else []
    return [sys.executable, sys.prefix, sys.base_prefix, *found]


def closed_path(paths: Sequence[str], user: int | None) -> tuple[str, str] | None:
    """The first of these folders and programs that a user cannot use, and the part of its path that is closed, or None.

    A process that has become the user tries it, because the rights of a path also depend on access control lists.
    None as user stands for the present one. A user that cannot be tried has no closed path.
    """
    reader, writer = os.pipe()
    child = os.fork()
    if child == 0:
        with contextlib.suppress(BaseException):
            if user is not None:
                os.setgroups([])
                os.setresgid(user, user, user)
                os.setresuid(user, user, user)
            for path in paths:
                if closed := _closed_part(path):
                    os.write(writer, f"{path}\0{closed}".encode())
                    break
        os._exit(0)
    os.close(writer)
    with os.fdopen(reader, encoding="utf-8") as answer:
        path, _, closed = answer.read().partition("\0")
    os.waitpid(child, 0)
    return (path, closed) if closed else None


def _closed_part(path: str) -> str:
    """The outermost folder on the way to a folder or program, or itself, that this process may not use; or empty."""
    if os.access(path, os.X_OK):
        return ""
    real = os.path.realpath(path)
    folders = [folder for way in (path, real) for folder in reversed(Path(way).parents)]
    return next((str(folder) for folder in folders if not os.access(folder, os.X_OK)), real)


def python_path() -> str:
    """The value of PYTHONPATH with which a test process finds what this process finds."""
    return os.pathsep.join(dict.fromkeys([str(PACKAGE_FOLDER), *package_folders()]))


def package_folders() -> Iterator[str]:
    """Folders of installed packages."""
    for path in sys.path:
        if os.path.basename(path) in ("site-packages", "dist-packages") and os.path.isdir(path):
            yield path
