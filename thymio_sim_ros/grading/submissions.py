"""Finds the submissions of a class: folders, files and archives, as learning platforms export them.

A folder or zip of the whole class has one entry for each pupil: a folder, a file, or a zip. Names of Moodle
(`Name_12345_assignsubmission_file_`) and Canvas (`name_123_456_file.ext`) are recognized. A submission is read into
memory, so that no name in an archive ever becomes a path of this computer.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path, PurePosixPath

from thymio_sim_ros.grading.archives import Content, RejectedError, read_folder, read_zip, unpack
from thymio_sim_ros.grading.errors import GradingError

__all__ = ["Submission", "find", "prepared"]

_MOODLE = re.compile(r"(?P<name>.+)_(?P<id>\d+)_assignsubmission_(?:file|onlinetext)_?")
_CANVAS = re.compile(r"(?P<name>[^_]+)_(?:LATE_)?(?P<id>\d+)_\d+_(?P<file>.+)")
_RESUBMITTED = re.compile(r"-\d+(?=\.\w+$)")
"""Canvas adds -1, -2, … to the name of a file that is handed in again."""


@dataclass(frozen=True, slots=True)
class Submission:
    """What one pupil handed in: relative paths with slashes → content.

    `problem` says why it cannot be graded, else it is empty. `notes` are what the teacher should know.
    """

    name: str
    identifier: str = ""
    """The number of the pupil or submission in the learning platform, if there is one."""
    files: Mapping[str, bytes] = field(default_factory=dict, repr=False)
    problem: str = ""
    notes: tuple[str, ...] = ()


def find(path: Path) -> list[Submission]:
    """Find the submissions in a folder or zip, in order of name.

    A submission that is rejected (a link, a path that leads out of it, too large, damaged) has a `problem`. Raises
    GradingError if the class as a whole cannot be read, or is empty.
    """
    try:
        entries = _class_entries(path)
    except RejectedError as error:
        raise GradingError(f"{path}: {error}") from error
    except OSError as error:
        raise GradingError(f"{error.filename or path}: {error.strerror}; expected a folder or a zip") from error
    merged: dict[tuple[str, str], Submission] = {}
    for entry in entries:
        key = (entry.name, entry.identifier)
        merged[key] = _merged(merged[key], entry) if key in merged else entry
    if not merged:
        raise GradingError(f"{path}: found no submissions, expected a folder, file or zip for each pupil")
    return _with_unique_names(sorted(merged.values(), key=lambda one: (one.name.casefold(), one.name, one.identifier)))


def prepared(submission: Submission, expected: Iterable[str]) -> Submission:
    """Return the submission with the files that an assignment expects under their names.

    A folder around all files is removed. An expected file that is missing is replaced by the only file with the same
    suffix, as pupils rename files. Otherwise the submission gets a `problem`.
    """
    if submission.problem:
        return submission
    files, notes = dict(submission.files), list(submission.notes)
    if not files:
        return replace(submission, problem="no file was handed in")
    expected = tuple(expected)
    while not set(expected) & files.keys() and (folder := _common_folder(files)):
        files = {name.removeprefix(folder): content for name, content in files.items()}
    for wanted in expected:
        if wanted in files:
            continue
        suffix = PurePosixPath(wanted).suffix
        same = [name for name in files if PurePosixPath(name).suffix == suffix and name not in expected]
        if len(same) != 1:
            found = ", ".join(sorted(files)[:5])
            return replace(submission, problem=f"no file {wanted}; found {found}")
        files[wanted] = files.pop(same[0])
        notes.append(f"{same[0]} was graded as {wanted}")
    return replace(submission, files=files, notes=tuple(notes))


def _class_entries(path: Path) -> list[Submission]:
    if path.is_dir():
        return [_from_path(entry) for entry in sorted(path.iterdir()) if not _is_clutter(entry.name)]
    tops = _by_top(read_zip(path.read_bytes(), whole_class=True))
    if len(tops) == 1:
        ((top, only),) = tops.items()
        if "" not in only and not _MOODLE.fullmatch(top):  # the folder of the class itself
            tops = _by_top(only)
    return [_from_files(top, files) for top, files in tops.items()]


def _by_top(files: Content) -> dict[str, dict[str, bytes]]:
    """Files by the first part of their path; a file without a folder has the rest ""."""
    tops: dict[str, dict[str, bytes]] = {}
    for name, data in files.items():
        top, _, rest = name.partition("/")
        if not _is_clutter(top):
            tops.setdefault(top, {})[rest] = data
    return tops


def _from_path(path: Path) -> Submission:
    name, identifier, _ = _owner(path.name, is_folder=path.is_dir() and not path.is_symlink())
    try:
        if path.is_symlink():
            raise RejectedError(f"{path.name} is a symbolic link; expected a file or folder")
        content = read_folder(path) if path.is_dir() else {"": read_folder(path)[path.name]}
    except RejectedError as error:
        return Submission(name, identifier, problem=str(error))
    except OSError as error:
        return Submission(name, identifier, problem=f"{path.name}: {error.strerror}")
    return _from_files(path.name, content)


def _from_files(top: str, files: Content) -> Submission:
    """A submission from an entry of the class: a file has the key "", a folder its relative paths."""
    is_folder = "" not in files
    name, identifier, file = _owner(top, is_folder=is_folder)
    try:
        content = unpack(files if is_folder else {file: files[""]})
    except RejectedError as error:
        return Submission(name, identifier, problem=str(error))
    return Submission(name, identifier, {path: data for path, data in content.items() if not _has_clutter(path)})


def _owner(top: str, *, is_folder: bool) -> tuple[str, str, str]:
    """Name and number of the pupil, and the name of the file as it was handed in."""
    if moodle := _MOODLE.fullmatch(top):
        return moodle["name"], moodle["id"], top
    if is_folder:
        return top, "", top
    if canvas := _CANVAS.fullmatch(top):
        return canvas["name"], canvas["id"], _RESUBMITTED.sub("", canvas["file"])
    return PurePosixPath(top).stem, "", top


def _merged(one: Submission, other: Submission) -> Submission:
    return replace(one, files={**one.files, **other.files}, problem=one.problem or other.problem)


def _with_unique_names(submissions: list[Submission]) -> list[Submission]:
    names = [submission.name for submission in submissions]
    return [
        replace(one, name=f"{one.name} ({one.identifier})") if names.count(one.name) > 1 and one.identifier else one
        for one in submissions
    ]


def _common_folder(files: Mapping[str, bytes]) -> str:
    folders = {name.partition("/")[0] if "/" in name else "" for name in files}
    only = folders.pop() if len(folders) == 1 else ""
    return f"{only}/" if only else ""


def _is_clutter(name: str) -> bool:
    return name.startswith(".") or name in ("__MACOSX", "__pycache__", "desktop.ini", "Thumbs.db")


def _has_clutter(path: str) -> bool:
    return any(_is_clutter(part) for part in path.split("/"))
