"""The place of a job: its folders, and the processes in it. Each level of isolation has its own kind of place."""

from __future__ import annotations

import os
import shutil
from collections.abc import Collection, Mapping
from pathlib import Path
from typing import Protocol

from thymio_sim_ros.grading.sandbox.processes import Processes

__all__ = ["FOLDERS", "Place", "empty", "remove", "write_files"]

FOLDERS = ("tmp", "out", "work")
"""Folders of a place in which the submission may write: temporary files, files that explain failures, and its own."""


class Place(Protocol):
    """The place of a job. `folder` has `FOLDERS`, and `assignment` with the data of the assignment."""

    folder: Path
    has_own_disk: bool
    """Whether a file system limits its size."""

    @property
    def processes(self) -> Processes:
        """The processes of the submission."""

    def begin(self) -> None:
        """Prepare this process, which supervises the job."""

    def prepare(self, data: Mapping[str, bytes]) -> None:
        """Empty `FOLDERS`, and write the data of the assignment."""

    def write(self, data: Mapping[str, bytes], submission: Mapping[str, bytes]) -> None:
        """Write data and submission afresh into `work`. Raises LimitError, ForgedError."""


def write_files(folder: Path, files: Mapping[str, bytes]) -> None:
    """Write files below a folder."""
    for name, data in files.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_bytes(data)


def empty(folder: Path, keep: Collection[tuple[str, ...]] = ()) -> None:
    """Remove all that a folder has, but for paths with these parts, where files of the system are mounted."""
    folder.chmod(folder.stat().st_mode | 0o700)
    for path in folder.iterdir():
        if path.parts in keep:
            continue
        if path.is_dir() and not path.is_symlink():
            remove(path)
        else:
            path.unlink()


def remove(folder: Path) -> None:
    """Remove a folder with all that a submission has left in it, also folders that it has closed."""
    if folder.is_symlink():  # a submission has put it there
        folder.unlink()
    elif folder.is_dir():
        for parent, folders, _ in os.walk(folder):
            for name in folders:
                path = os.path.join(parent, name)
                if not os.path.islink(path):
                    os.chmod(path, 0o700)
        folder.chmod(0o700)
        shutil.rmtree(folder)
