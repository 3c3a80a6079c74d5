"""The place of a job on any system: a temporary folder. A submission has the rights of the user who grades."""

from __future__ import annotations

import sys
from collections.abc import Mapping
from pathlib import Path

from thymio_sim_ros.grading.assignment import Limits
from thymio_sim_ros.grading.sandbox.place import FOLDERS, empty, remove, write_files
from thymio_sim_ros.grading.sandbox.processes import Processes
from thymio_sim_ros.grading.sandbox.watched_process import LimitError

__all__ = ["PortablePlace"]


class PortablePlace:
    """See `place.Place`."""

    has_own_disk = False

    def __init__(self, folder: Path, limits: Limits) -> None:
        self.folder = folder
        self.processes = _processes(limits)

    def begin(self) -> None:
        """Prepare nothing."""

    def prepare(self, data: Mapping[str, bytes]) -> None:
        """Empty the folders, and write the data of the assignment."""
        for name in (*FOLDERS, "assignment"):
            remove(self.folder / name)
            (self.folder / name).mkdir()
        write_files(self.folder / "assignment", data)

    def write(self, data: Mapping[str, bytes], submission: Mapping[str, bytes]) -> None:
        """Write data and submission afresh. Raises LimitError: Windows keeps files that are open."""
        try:
            for name in ("assignment", "work"):
                empty(self.folder / name)
            write_files(self.folder / "assignment", data)
            write_files(self.folder / "work", {**data, **submission})
        except OSError as error:
            text = "files of the former test could not be replaced: close each file after use"
            raise LimitError("crashed", f"{text} ({error.strerror})") from error


def _processes(limits: Limits) -> Processes:
    if sys.platform == "win32":
        from thymio_sim_ros.grading.sandbox.job_object import JobObject

        return JobObject(limits)
    from thymio_sim_ros.grading.sandbox.tracked_processes import TrackedProcesses

    return TrackedProcesses(limits)
