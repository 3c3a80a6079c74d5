"""Loads playgrounds and programs by name, path or text."""

from __future__ import annotations

import base64
import binascii
import functools
import itertools
import logging
import re
import urllib.parse
from collections.abc import Mapping, Sequence
from pathlib import Path

from aseba_vm import AeslError
from aseba_vm.aesl import text_decoding
from aseba_vm.aesl.foreign_files import looks_like_network, refuse_foreign
from aseba_vm.errors import TextError
from thymio_sim_ros.device.layout import THYMIO
from thymio_sim_ros.device.programs.program import (
    NO_CONSTANTS,
    ProgramError,
    ThymioProgram,
    load_file,
    load_program,
    parse,
)
from thymio_sim_ros.device.programs.program_assignment import Assignment, RobotId, assign_programs
from thymio_sim_ros.files import resources
from thymio_sim_ros.files.block_files import BlocksError, Opened, open_program
from thymio_sim_ros.sim.playground import reader as playgrounds
from thymio_sim_ros.sim.playground.format_detection import MAX_BYTES, is_recognized
from thymio_sim_ros.sim.playground.reader import Playground, PlaygroundError

NO_PROGRAM = "none"
"""Name of the empty program."""

_UPLOAD = re.compile(
    r"data:[^;,]*(?:;name=(?P<name>[^;,]*))?(?:;part=(?P<part>[^;,]*))?;base64,(?P<content>.*)", re.DOTALL
)
_PART = "#"
"""Before the name of one of several playgrounds in an archive."""
_MAX_KEPT = 32
"""Number of installed playgrounds that are kept."""
_UNNAMED = "uploaded playground"
_PLAYGROUNDS = 'JSON with "format": 1, XML with <aseba-playground>, or a zip that holds one'
_FOREIGN_PROGRAMS = frozenset(f"foreign-{kind}" for kind in ("blocks", "python", "ros", "scratch", "tdmclient", "vpl3"))
_PROGRAMS = (".aesl", ".aseba", ".txt")
"""Suffixes of program files. Of other files only the kind is said, because error messages quote from the content."""
_PROGRAM_NAME = re.compile(r"\.(?:aesl|aseba|txt)(?![a-z])", re.IGNORECASE)
"""Also in the names that browsers and Windows give: `follower.aesl.txt`, `follower.aesl.download`, `FOLLOWER.AESL`."""
_BEFORE_TEXT = "\ufeff \t\r\n"


def is_playground_text(value: str) -> bool:
    """Whether `load_playground` uses a value as content and opens no file."""
    return _UPLOAD.fullmatch(value) is not None or value.lstrip(_BEFORE_TEXT).startswith(("{", "<"))


def load_playground(value: str) -> tuple[str, Playground]:
    """Load a playground from a shipped name, a path, the text itself, or a file as data:;name=my.json;base64,...

    The name of one of several playgrounds in an archive is behind its path, as in `maps.zip#a.playground`, or in a
    file as data:;name=maps.zip;part=a.playground;base64,...

    Returns its name and the playground. Files and texts may have any known format (sim/playground/format_detection.py).
    Raises PlaygroundError for invalid content, ResourceError for a missing file, OSError for one that cannot be read.
    """
    upload = _UPLOAD.fullmatch(value)
    if upload is not None:
        name, part = (urllib.parse.unquote(upload[each] or "") for each in ("name", "part"))
        return _load_upload(name or _UNNAMED, part, upload["content"])
    if is_playground_text(value):
        loaded = playgrounds.loads(value, _UNNAMED)
        return loaded.title, loaded
    path, part = _archive_and_part(value)
    try:
        if path in resources.playgrounds().values():
            loaded = _load_installed(path, path.stat().st_mtime_ns)
        else:
            loaded = playgrounds.load(path, part)
        return loaded.name, loaded
    except PlaygroundError:
        if _may_be_quoted(path):
            raise
        raise PlaygroundError(str(path), "", "a file that is not a playground", _PLAYGROUNDS + _hint(path)) from None


@functools.lru_cache(maxsize=_MAX_KEPT)
def _load_installed(path: Path, _changed_ns: int) -> Playground:
    """A playground that is installed with the code, read once per process."""
    return playgrounds.load(path)


def _hint(path: Path) -> str:
    """A hint on the kind of a rejected file, and on its use if it is a program; empty for an unknown kind."""
    try:
        text = text_decoding.decode(path.read_bytes()[:MAX_BYTES]).text
        refuse_foreign(text)
    except TextError as error:
        return f"; {error}" if error.kind in _FOREIGN_PROGRAMS else ""
    return "; this is a program, which --program takes" if looks_like_network(text) else ""


def _archive_and_part(value: str) -> tuple[Path, str]:
    """The file of a playground and, behind `#`, the name of one of several in it. Raises ResourceError."""
    file, mark, part = value.partition(_PART)
    try:
        return resources.find_playground(value), ""
    except resources.ResourceError:
        if not mark:
            raise
    return resources.find_playground(file), part


def _may_be_quoted(path: Path) -> bool:
    """Whether an error may quote from a file: only if it looks like a playground, since any path can be given."""
    try:
        with path.open("rb") as file:
            return is_recognized(file.read(MAX_BYTES))
    except OSError:
        return True  # the error has no content


def _load_upload(name: str, part: str, content: str) -> tuple[str, Playground]:
    try:
        data = base64.b64decode(content, validate=True)
    except (binascii.Error, ValueError) as error:
        raise PlaygroundError(name, "", "characters that are not base64", "the file in base64") from error
    loaded = playgrounds.loads(data, name, part)
    return f"{name}{_PART}{part}" if part else name, loaded


def read_program(path: str, layout: str = THYMIO) -> ThymioProgram:
    """Load the program of a built-in behavior or of a file for a layout; "none" is the empty program.

    Raises ProgramError for an error in the program, ResourceError for a file that is missing or cannot be read.
    """
    return load_program(*read_text(path), layout)


def read_assignments(path: str, robots: Sequence[str], layout: str = THYMIO) -> dict[str, Assignment]:
    """Assign the programs of a file to robots, as the Aseba runtime does. Raises the exceptions of `read_program`."""
    return assignments_of(*read_text(path), robots, layout)


def assignments_of(
    text: str,
    name: str,
    robots: Sequence[str],
    layout: str = THYMIO,
    *,
    constants: Mapping[str, int] = NO_CONSTANTS,
) -> dict[str, Assignment]:
    """Assign the programs of a text with this name to robots, as `read_assignments` does for a file.

    `constants` replace those of the text. Raises ProgramError for an error in the text.
    """
    return assigned_to(text, name, robot_ids(robots), layout, constants=constants)


def robot_ids(robots: Sequence[str]) -> dict[str, RobotId]:
    """The robots of a playground by name, as they are known to a file; one that is alone has no name there."""
    is_alone = len(robots) == 1
    return {robot: RobotId("" if is_alone else robot, number) for number, robot in enumerate(robots, start=1)}


def assigned_to(
    text: str,
    name: str,
    members: Mapping[str, RobotId],
    layout: str = THYMIO,
    *,
    constants: Mapping[str, int] = NO_CONSTANTS,
) -> dict[str, Assignment]:
    """Assign the programs of a text to these robots, which may be some of those of a playground.

    Raises ProgramError for an error in the text.
    """
    names = [member.name for member in members.values() if member.name]
    file = load_file(text, name, layout, constants=constants, robots=names)
    shares = assign_programs(file, list(members.values()))
    return {robot: shares[member.name] for robot, member in members.items()}


def read_text(path: str) -> tuple[str, str]:
    """Text and name of the program that `path` denotes in `read_program`. Raises ResourceError."""
    if path == NO_PROGRAM:
        return "", NO_PROGRAM
    found = resources.find_program(path)
    try:
        opened = open_program(found.read_bytes())
        if not _is_program(found.name, opened.text):
            refuse_foreign(opened.text)
            raise resources.ResourceError(f"{found}: expected a file whose name ends in {', '.join(_PROGRAMS)}")
    except BlocksError as error:
        raise resources.ResourceError(f"{found}: {error}") from error
    except TextError as error:
        place = "" if error.kind.startswith("foreign-") else f" line {error.line}, column {error.column}:"
        if not place or _PROGRAM_NAME.search(found.name):
            raise resources.ResourceError(f"{found}:{place} {error}") from error
        raise resources.ResourceError(f"{found}: expected a file whose name ends in {', '.join(_PROGRAMS)}") from error
    except OSError as error:
        raise resources.ResourceError(f"{found}: {error.strerror}; expected a file that can be read") from error
    return _noted(opened, found.name), found.name


def text_of(source: str, name: str) -> str:
    """The text of a program that is given as text; a workspace of Blockly becomes an .aesl file.

    Raises ProgramError for blocks that cannot be converted.
    """
    try:
        return _noted(open_program(source.encode()), name)
    except (BlocksError, TextError, UnicodeEncodeError) as error:
        raise ProgramError(name, None, None, str(error)) from error


def _noted(opened: Opened, name: str) -> str:
    for note in opened.notes:
        logging.getLogger(__name__).warning("%s: %s", name, note)
    return opened.text


def _is_program(name: str, text: str) -> bool:
    """Whether a file is opened: an .aesl file by its content, a plain program by its name."""
    return _PROGRAM_NAME.search(name) is not None or looks_like_network(text)


def check_behaviour(name: str, layout: str = THYMIO) -> str:
    """The name of a built-in behavior if a robot of this layout can run it; an empty name is valid too.

    Raises ResourceError for an unknown name, ProgramError if the behavior uses what the robot does not have.
    """
    if resources.check_behaviour(name):
        read_program(name, layout)
    return name


def shipped_behaviours() -> dict[str, str]:
    """First comment of each built-in program, as one line, by name. Unreadable programs are logged and skipped."""
    found = {}
    for name, path in resources.behaviours().items():
        try:
            found[name] = _first_comment(path.read_text(encoding="utf-8"))
        except (AeslError, UnicodeDecodeError, OSError) as error:  # of another package
            logging.getLogger(__name__).warning("the behaviour %s is left out: %s", path, error)
    return found


def _first_comment(text: str) -> str:
    code = parse(text).nodes[0].code
    lines = itertools.takewhile(lambda line: line.startswith("#"), code.splitlines())
    return " ".join(" ".join(line.lstrip("#") for line in lines).split())
