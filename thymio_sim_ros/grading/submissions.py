"""Finds the submissions of a class: folders, files and archives, as learning platforms export them.

A folder or zip of the whole class has one entry for each pupil: a folder, a file, or a zip. Names of Moodle
(`Name_12345_assignsubmission_file_`), Canvas (`name_123_456_file.ext`) and Gradescope (`submission_123`) are
recognized. A submission is read into memory, so that no name in an archive ever becomes a path of this computer.
"""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path, PurePosixPath

from thymio_sim_ros.files.block_files import BlocksError, is_of_blocks, open_program
from thymio_sim_ros.grading import gradescope
from thymio_sim_ros.grading.archives import (
    Content,
    RejectedError,
    check_paths,
    is_clutter,
    is_link,
    is_zip,
    read_class_zip,
    read_folder,
    unpack,
)
from thymio_sim_ros.grading.errors import GradingError
from thymio_sim_ros.grading.other_names import is_copy

__all__ = ["Submission", "find", "prepared", "read_one"]

_MOODLE = re.compile(r"(?P<name>.+)_(?P<id>\d+)_assignsubmission_(?:file|onlinetext)(?:_(?P<file>.*))?")
"""A folder, or a file with its name at the end where the teacher wanted no folders."""
_CANVAS = re.compile(r"(?P<name>[^_]+)_(?:LATE_)?(?P<id>\d+)_\d+_(?P<file>.+)")
_GRADESCOPE = re.compile(r"submission_(?P<id>\d+)")
_DIGITS = re.compile(r"\d+")
_RESUBMITTED = re.compile(r"-\d+(?=\.\w+$)")
"""Canvas adds -1, -2, … to the name of a file that is handed in again."""

_Read = bytes | RejectedError | None
"""A file as it was read: its content, or why it is rejected; None: no file."""


@dataclass(frozen=True, slots=True)
class Submission:
    """Files of one pupil: relative paths with slashes → content.

    `problem`: why it cannot be graded, else empty. `notes`: for the teacher.
    """

    name: str
    identifier: str = ""
    """The number of the pupil or submission in the learning platform, if there is one."""
    key: str = ""
    """Distinguishes the pupil from others of the same name, also after another submission; empty: `identifier` does."""
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
    for entry in entries:  # the last one of several
        key = (entry.name, entry.identifier)
        merged[key] = _merged(merged[key], entry) if key in merged else entry
    if not merged:
        raise GradingError(f"{path}: found no submissions, expected a folder, file or zip for each pupil")
    return _with_unique_names(sorted(merged.values(), key=_place_in_class))


def read_one(path: Path) -> Submission:
    """Read one submission, a folder, a file or a zip; it has a `problem` if it cannot be read."""
    return _from_path(path, {})


def prepared(submission: Submission, expected: Iterable[str]) -> Submission:
    """Return the submission with the files that an assignment expects under their names.

    A folder around all files is removed. An expected file that is missing is replaced by the only one with its name in
    another folder, the only copy of it (`other_names.py`), the only one with its suffix, as pupils rename files, or the
    only program of blocks, which is converted; zips beside other files are opened for it. Otherwise the submission
    gets a `problem`.
    """
    if submission.problem:
        return submission
    expected = tuple(expected)
    if not submission.files:
        return replace(submission, problem=f"no file was handed in: hand in {', '.join(expected) or 'your work'}")
    try:
        result = _with_expected(submission, submission.files, expected)
        if result.problem and any(map(is_zip, submission.files)):
            result = _with_expected(submission, _with_zips_opened(submission.files), expected)
        check_paths(result.files)
    except RejectedError as error:
        return replace(submission, problem=str(error))
    return result


def _with_expected(submission: Submission, files: Content, expected: Collection[str]) -> Submission:
    files, notes = dict(files), list(submission.notes)
    while not set(expected) & files.keys() and (folder := _common_folder(files)):
        files = {name.removeprefix(folder): content for name, content in files.items()}
    for wanted in expected:
        copies = [name for name in files if name not in expected and is_copy(name, wanted)]
        if wanted in files:
            notes += [f"{name} was not graded, but {wanted}" for name in copies if files[name] != files[wanted]]
            continue
        suffix = _suffix(wanted)
        named = [name for name in files if name.endswith(f"/{wanted}")]
        same = [name for name in files if _suffix(name) == suffix and name not in expected]
        blocks = [name for name in files if suffix == ".aesl" and is_of_blocks(files[name])]
        copied_blocks = [name for name in blocks if is_copy(PurePosixPath(name).stem + suffix, wanted)]
        found = next((some[0] for some in (named, copies, copied_blocks, same, blocks) if len(some) == 1), None)
        if found is None:
            listed = ", ".join(sorted(files)[:5])
            return replace(submission, problem=f"no file {wanted}: hand in one file with this name; found {listed}")
        if found in named:  # with what it imports or reads beside it
            folder = found.removesuffix(wanted)
            beside = {name.removeprefix(folder): data for name, data in files.items() if name.startswith(folder)}
            files = {**beside, **files}
            notes.append(f"{found} was graded as {wanted}")
        elif found in blocks:
            try:
                opened = open_program(files[found])
            except BlocksError as error:
                return replace(submission, problem=f"{found}: {error}")
            files[wanted] = opened.text.encode()
            notes += [f"the blocks of {found} were graded as {wanted}", *(f"{found}: {note}" for note in opened.notes)]
        else:
            files[wanted] = files.pop(found)
            notes.append(f"{found} was graded as {wanted}")
    return replace(submission, files=files, notes=tuple(notes))


def _with_zips_opened(files: Content) -> Content:
    """The files, and those of the zips among them; a file outside of the zips has priority."""
    others = {name: data for name, data in files.items() if not is_zip(name)}
    return unpack({**unpack({name: data for name, data in files.items() if is_zip(name)}), **others})


def _suffix(name: str) -> str:
    return PurePosixPath(name).suffix.lower()


def _class_entries(path: Path) -> list[Submission]:
    if path.is_dir():
        paths = [entry for entry in path.iterdir() if not is_clutter(entry.name)]
        paths.sort(key=lambda entry: _with_numbers(entry.name))
        metadata = path / gradescope.METADATA
        pupils = gradescope.pupils(read_folder(metadata).get(gradescope.METADATA)) if metadata in paths else {}
        return [_from_path(entry, pupils) for entry in paths if entry.name != gradescope.METADATA]
    tops = _by_top(read_class_zip(path.read_bytes()))
    if len(tops) == 1:
        ((top, only),) = tops.items()
        if "" not in only and not _MOODLE.fullmatch(top):  # the folder of the class itself
            tops = _by_top(only)
    pupils = gradescope.pupils(tops.pop(gradescope.METADATA, {}).get(""))
    return [_from_files(top, tops[top], pupils) for top in sorted(tops, key=_with_numbers)]


def _with_numbers(name: str) -> list[tuple[str, int, str]]:
    """A key for sorting by which 99 comes before 100: learning platforms number submissions."""
    numbers = [digits.lstrip("0") for digits in _DIGITS.findall(name)]
    return [(text, len(digits), digits) for text, digits in zip(_DIGITS.split(name), [*numbers, ""], strict=True)]


def _by_top(files: Mapping[str, _Read]) -> dict[str, dict[str, _Read]]:
    """Files by the first part of their path; a file without a folder has the rest ""."""
    tops: dict[str, dict[str, _Read]] = {}
    for name, data in files.items():
        top, _, rest = name.partition("/")
        if top != "." and not is_clutter(top):
            tops.setdefault(top, {})[rest] = data
    return tops


def _from_path(path: Path, pupils: Mapping[str, gradescope.Pupil]) -> Submission:
    try:
        if path.is_symlink():
            raise RejectedError(is_link(path.name))
        content = read_folder(path) if path.is_dir() else {"": next(iter(read_folder(path).values()))}
    except (RejectedError, OSError) as error:
        reason = f"{path.name} cannot be read: {error.strerror}" if isinstance(error, OSError) else str(error)
        owner, _ = _owner(path.name, pupils, is_folder=path.is_dir() and not path.is_symlink())
        return replace(owner, problem=reason)
    return _from_files(path.name, content, pupils)


def _from_files(top: str, files: Mapping[str, _Read], pupils: Mapping[str, gradescope.Pupil]) -> Submission:
    """A submission from an entry of the class: a file has the key "", a folder its relative paths."""
    is_folder = "" not in files
    owner, file = _owner(top, pupils, is_folder=is_folder)
    content: dict[str, bytes] = {}
    try:
        for path, data in files.items():
            if isinstance(data, RejectedError):
                raise data
            if data is not None:
                content[path if is_folder else file] = data
        return replace(owner, files=unpack(content))
    except RejectedError as error:
        return replace(owner, problem=str(error))


def _owner(top: str, pupils: Mapping[str, gradescope.Pupil], *, is_folder: bool) -> tuple[Submission, str]:
    """The pupil as a submission without files, and the name of the file as it was handed in."""
    top = unicodedata.normalize("NFC", top)
    if moodle := _MOODLE.fullmatch(top):
        return Submission(moodle["name"], moodle["id"]), moodle["file"] or top
    if is_folder:
        handed_in = _GRADESCOPE.fullmatch(top)
        pupil = pupils.get(top, gradescope.Pupil(top, ""))
        return Submission(pupil.name, handed_in["id"] if handed_in else "", pupil.key), top
    if canvas := _CANVAS.fullmatch(top):
        return Submission(canvas["name"], canvas["id"]), _RESUBMITTED.sub("", canvas["file"])
    return Submission(PurePosixPath(top).stem), top


def _merged(one: Submission, other: Submission) -> Submission:
    """Two entries of one pupil as one submission; of a file that both have, the one of `other`."""
    notes = [
        f"{name} was handed in more than once: the last one was graded"
        for name, data in one.files.items()
        if other.files.get(name, data) != data
    ]
    if not one.identifier:
        notes.append(f"several files or folders have the name {one.name}: they were graded as those of one pupil")
    return replace(
        one,
        files={**one.files, **other.files},
        problem=one.problem or other.problem,
        notes=tuple(dict.fromkeys([*one.notes, *notes])),
    )


def _place_in_class(submission: Submission) -> tuple[str, str, str]:
    return submission.name.casefold(), submission.name, submission.identifier


def _with_unique_names(submissions: list[Submission]) -> list[Submission]:
    names = [submission.name for submission in submissions]
    owners = [(submission.name, submission.key) for submission in submissions]
    return [
        replace(
            one,
            name=f"{one.name} ({one.identifier})" if names.count(one.name) > 1 and one.identifier else one.name,
            key=one.key if owners.count((one.name, one.key)) == 1 else "",
        )
        for one in submissions
    ]


def _common_folder(files: Mapping[str, bytes]) -> str:
    folders = {name.partition("/")[0] if "/" in name else "" for name in files}
    only = folders.pop() if len(folders) == 1 else ""
    return f"{only}/" if only else ""
