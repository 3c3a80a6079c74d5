"""A disk that takes no more, and one that fails at a certain operation."""

from __future__ import annotations

import builtins
import errno
import io
import os
import resource
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any
from unittest.mock import patch

FILE_TOO_LARGE = os.strerror(errno.EFBIG)
"""What the system says when a file would become too large."""


@contextmanager
def files_end_at(size: int) -> Iterator[None]:
    """Meanwhile this process can write so many bytes to a file, and no more."""
    limits = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, limits[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)


class FailingDisk:
    """Fails at one operation below a folder, or from it on. Within `with disk.failing()` it counts operations.

    Operations are: open for writing, write (half of the bytes are written, the rest fails), sync, rename, change of
    permissions, new folder. Removing files never fails, as on a full disk. After SQLite's tests: run something again
    and again, each time with a later operation that fails, until it is not reached any more.
    """

    def __init__(self, folder: Path, fails_at: int, code: int, *, stays_broken: bool = False) -> None:
        """`fails_at` counts from 1; `code`: what the system says; `stays_broken`: all later operations fail, too."""
        self._folder = folder.resolve()
        self._fails_at, self._code, self._stays_broken = fails_at, code, stays_broken
        self.count = 0

    @property
    def has_failed(self) -> bool:
        """Whether the operation was reached."""
        return self.count >= self._fails_at

    def check(self, path: object) -> None:
        """Count an operation on a path or a descriptor. Raises OSError if it is the one that fails."""
        is_path = not isinstance(path, int)
        if self.is_due(path if is_path else f"/proc/self/fd/{path}"):
            raise self.error(path if is_path else None)

    def error(self, path: object = None) -> OSError:
        """What the system says; errors of descriptors have no name."""
        return OSError(self._code, os.strerror(self._code), *([] if path is None else [str(path)]))

    def is_due(self, path: object) -> bool:
        """Count an operation on a path, and return whether it fails."""
        if not Path(os.fsdecode(path)).resolve().is_relative_to(self._folder):  # type: ignore[arg-type]
            return False
        self.count += 1
        return self.count == self._fails_at or (self._stays_broken and self.count > self._fails_at)

    @contextmanager
    def failing(self) -> Iterator[None]:
        """The context in which operations are counted and one of them fails."""
        disk, original = self, builtins.open

        def open_(file: Any, mode: str = "r", buffering: int = -1, *args: Any, **options: Any) -> Any:
            if not set(mode) & set("wax+") or not isinstance(file, str | os.PathLike):
                return original(file, mode, buffering, *args, **options)
            opener = options.pop("opener", None)
            disk.check(file)
            raw = _File(disk, os.fspath(file), mode.replace("b", "").replace("t", ""), opener)
            binary = io.BufferedRandom(raw) if "+" in mode else io.BufferedWriter(raw)
            if "b" in mode:
                return binary
            return io.TextIOWrapper(binary, *args, **options)

        def counted(function: Callable[..., Any], which: int = 0) -> Callable[..., Any]:
            def call(*args: Any, **options: Any) -> Any:
                disk.check(args[which])
                return function(*args, **options)

            return call

        with (
            patch.object(builtins, "open", open_),
            patch.object(io, "open", open_),
            patch.object(os, "fsync", counted(os.fsync)),
            patch.object(os, "replace", counted(os.replace, 1)),
            patch.object(os, "chmod", counted(os.chmod)),
            patch.object(os, "mkdir", counted(os.mkdir)),
        ):
            yield


class _File(io.FileIO):
    """A file on the disk."""

    def __init__(self, disk: FailingDisk, path: str, mode: str, opener: Any) -> None:
        super().__init__(path, mode, opener=opener)
        self._disk, self._path = disk, path
        self._is_full = False

    def write(self, data: Any) -> int:
        """Write all or, if the disk fails, half of the bytes; the next call fails, as with write(2)."""
        if self._is_full or self._disk.is_due(self._path):
            if self._is_full or len(data) < 2:
                self._is_full = False
                raise self._disk.error()
            self._is_full = True
            return super().write(bytes(data)[: len(data) // 2])
        return super().write(data)
