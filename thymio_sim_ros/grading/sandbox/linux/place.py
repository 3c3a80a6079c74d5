"""The place of a job on Linux, whose processes have fewer rights than the supervisor."""

from __future__ import annotations

import contextlib
import errno
import os
import signal
from collections.abc import Mapping
from pathlib import Path

from thymio_sim_ros.grading.sandbox.linux import namespaces, syscalls
from thymio_sim_ros.grading.sandbox.linux.confined_processes import ConfinedProcesses
from thymio_sim_ros.grading.sandbox.linux.confinement import Confinement, confine
from thymio_sim_ros.grading.sandbox.place import FOLDERS, empty, remove, write_files
from thymio_sim_ros.grading.sandbox.readable import readable_paths
from thymio_sim_ros.grading.sandbox.report_protocol import ForgedError
from thymio_sim_ros.grading.sandbox.watched_process import LimitError

__all__ = ["LinuxPlace"]

_FULL, _NOT_WRITTEN = 3, 4
"""Exit codes of the process that writes the files of a test."""


class LinuxPlace:
    """See `place.Place`."""

    def __init__(self, folder: Path, confinement: Confinement, *, is_namespace: bool) -> None:
        """`is_namespace`: kernel namespaces have its processes and its file system."""
        self.folder, self._confinement, self.has_own_disk = folder, confinement, is_namespace
        self.processes = ConfinedProcesses(confinement, are_alone=is_namespace)
        self._bound: list[Path] = []
        """Files of the assignment that are mounted read-only beside those of the submission."""

    def begin(self) -> None:
        """Hide this process, and make it the parent of orphans."""
        if self.has_own_disk:
            signal.signal(signal.SIGINT, signal.SIG_DFL)  # the first one of a namespace ignores what it does not handle
        syscalls.hide_memory()
        syscalls.reap_orphans()

    def prepare(self, data: Mapping[str, bytes]) -> None:
        """Empty the folders, and write the data of the assignment."""
        self._unbind()
        user = self._confinement.user
        for name in FOLDERS:
            path = self.folder / name
            remove(path)
            path.mkdir()
            if user is not None:
                os.chown(path, user, user)
        if self.has_own_disk:
            empty(Path("/dev/shm"))
            empty(Path("/tmp"), keep={Path(path).parts[:3] for path in readable_paths()})
        self._write_assignment(data)

    def write(self, data: Mapping[str, bytes], submission: Mapping[str, bytes]) -> None:
        """Write data and submission afresh. Raises LimitError, ForgedError.

        Processes of the submission may run and change paths meanwhile. Therefore the process that writes has no more
        rights than they have, so that they cannot make it write to places that are closed to them.
        """
        self._unbind()
        if not self.has_own_disk:
            self._write_assignment(data)
        work = self.folder / "work"
        code = self._write_confined(work, {**data, **submission})
        if code == _FULL:
            raise LimitError(
                "disk limit", "the files of the program leave no room for the next test: write less, or delete files"
            )
        try:
            if code:
                raise OSError(f"exit code {code}")
            for name in data if self.has_own_disk else ():
                namespaces.bind_read_only(self.folder / "assignment" / name, work / name)
                self._bound.append(work / name)
        except OSError as error:
            raise ForgedError("files of the assignment that could not be written") from error

    def _write_confined(self, work: Path, files: Mapping[str, bytes]) -> int:
        writer = os.fork()
        if writer == 0:
            try:
                confine(self._confinement)
                empty(work)
                write_files(work, files)
                os._exit(0)
            except OSError as error:
                os._exit(_FULL if error.errno in (errno.ENOSPC, errno.EDQUOT) else _NOT_WRITTEN)
            except BaseException:
                os._exit(_NOT_WRITTEN)
        return os.waitstatus_to_exitcode(os.waitpid(writer, 0)[1])

    def _write_assignment(self, data: Mapping[str, bytes]) -> None:
        """Write the data of the assignment where no submission can change them, if the level gives such a place."""
        folder = self.folder / "assignment"
        has_landlock = self._confinement.writable is not None
        if (self.has_own_disk or has_landlock) and folder.exists():  # a rule of Landlock holds for this folder
            return
        remove(folder)
        folder.mkdir()
        write_files(folder, data)
        if self.has_own_disk:
            namespaces.bind_read_only(folder, folder)

    def _unbind(self) -> None:
        while self._bound:
            with contextlib.suppress(OSError):
                syscalls.umount(str(self._bound.pop()))
