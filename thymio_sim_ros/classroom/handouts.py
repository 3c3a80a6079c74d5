"""The hand-outs of a class: programs, playgrounds and missions that the teacher gives to pupils.

`handouts.json` in the folder of the class lists them, `<id>.bin` beside it is the content of each. Ids cannot be
guessed: a link with one is enough for every pupil of the class.
"""

from __future__ import annotations

import base64
import contextlib
import hashlib
import json
import re
import secrets
import unicodedata
from collections.abc import Iterable, Mapping
from dataclasses import asdict, dataclass, replace
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from aseba_vm.aesl.reader import read as read_aesl
from aseba_vm.aesl.text_decoding import decode
from aseba_vm.cli.output import write_file
from aseba_vm.errors import AsebaError
from thymio_sim_ros.classroom.check_mission import check_mission
from thymio_sim_ros.classroom.errors import ClassError
from thymio_sim_ros.classroom.folder import read_text, write_text
from thymio_sim_ros.classroom.suite_state import MissionTry
from thymio_sim_ros.errors import ThymioSimError
from thymio_sim_ros.files.loading import load_playground
from thymio_sim_ros.files.resources import missions_folder

__all__ = ["KINDS", "MAX_CONTENT", "MAX_HANDOUTS", "Handout", "Handouts", "check_time", "checked_content", "now"]

KINDS = ("program", "playground", "mission")
MAX_HANDOUTS = 60
"""Hand-outs of a class: more than one for each week of a school year."""
MAX_CONTENT = 4_000_000
"""Bytes of one of them."""
MAX_NAME, MAX_ENDING = 80, 12
"""Characters of the name of a file, and of its ending."""
MAX_TITLE = 200
_FILE = "handouts.json"
_ENDINGS = {"program": "aesl", "playground": "json", "mission": "json"}
_RESERVED = frozenset({"program", "draft"})
"""Names of files that the zip with the work of the class has beside those of hand-outs."""
_ID = re.compile(r"[\w-]{8,20}")


@dataclass(frozen=True, slots=True)
class Handout:
    """One of them; `name` is that of its file, unlike that of any other. Times are those of ISO 8601, "": none."""

    id: str
    kind: str
    name: str
    pupils: tuple[str, ...]
    """Ids of the pupils who have it."""
    given: str
    due: str = ""
    solution_of: str = ""
    """Id of the hand-out whose solution this is."""
    title: str = ""
    """Of a shipped mission, in the language of the teacher."""

    @property
    def stem(self) -> str:
        """Its name without the ending: the name of the pupil's program for it."""
        return self.name.rpartition(".")[0] or self.name

    def is_shipped_as(self, name: str) -> bool:
        """Whether it is the shipped mission of this name: files have an ending."""
        return self.kind == "mission" and self.name == name and "." not in name

    def is_late(self, at: str) -> bool:
        """Whether something at this time was after the date by which it is due."""
        return self.due != "" and at != "" and datetime.fromisoformat(at) > datetime.fromisoformat(self.due)


class Handouts:
    """All hand-outs of a class, in the order in which they were given. Invariant: the file has them."""

    def __init__(self, path: Path) -> None:
        """Read those of a folder. Raises ClassError for a file that this program has not written, and OSError."""
        self._path = path
        self._digests: dict[str, str] = {}
        try:
            listed = json.loads(read_text(path / _FILE) or "[]")
            self._all = {handout.id: handout for handout in map(_handout, listed)}
        except (ValueError, TypeError, KeyError, AttributeError, RecursionError) as error:
            raise ClassError(
                f"{path / _FILE}: {error}; expected the file as this program wrote it: restore or delete it"
            ) from error

    def all(self) -> list[Handout]:
        """All of them."""
        return list(self._all.values())

    def of(self, pupil: str) -> list[Handout]:
        """Those that a pupil has."""
        return [handout for handout in self._all.values() if pupil in handout.pupils]

    def find(self, number: str) -> Handout | None:
        """The one with this id."""
        return self._all.get(number)

    def content(self, handout: Handout) -> bytes:
        """The file that was handed out. Raises OSError."""
        return (self._path / f"{handout.id}.bin").read_bytes()

    def is_tried(self, handout: Handout, attempt: MissionTry) -> bool:
        """Whether a try is one of this mission. A file is recognized by its content, not its name. Raises OSError."""
        if handout.kind != "mission" or attempt.file == "":
            return handout.is_shipped_as(attempt.mission)
        if handout.id not in self._digests:
            self._digests[handout.id] = hashlib.sha256(self.content(handout)).hexdigest()
        return self._digests[handout.id] == attempt.file

    def add(
        self,
        kind: str,
        name: str,
        content: bytes,
        pupils: Iterable[str],
        *,
        due: str = "",
        solution_of: str = "",
        title: str = "",
    ) -> Handout:
        """Hand out a file whose content was checked. Raises ClassError where there are too many, and OSError.

        Without content it is a shipped mission of that name; one that some pupils have already is given to others, too.
        """
        if content == b"" and (given := next((one for one in self._all.values() if one.is_shipped_as(name)), None)):
            wider = replace(given, pupils=tuple(dict.fromkeys((*given.pupils, *pupils))), due=due)
            self._keep({**self._all, wider.id: wider})
            return wider
        if len(self._all) >= MAX_HANDOUTS:
            raise ClassError(f"found {MAX_HANDOUTS} hand-outs, expected fewer: remove one that is no longer needed")
        unused = name if content == b"" else self._free_name(kind, name)
        number = secrets.token_urlsafe(9)
        handout = Handout(number, kind, unused, tuple(pupils), now(), due, solution_of, title[:MAX_TITLE])
        write_file(str(self._path / f"{number}.bin"), content, mode=0o600)
        self._keep({**self._all, number: handout})
        return handout

    def give(self, handout: Handout, pupil: str) -> Handout:
        """Add a pupil to those who have it. Raises OSError."""
        if pupil in handout.pupils:
            return handout
        given = replace(handout, pupils=(*handout.pupils, pupil))
        self._keep({**self._all, handout.id: given})
        return given

    def remove(self, handout: Handout) -> None:
        """Take it back: what pupils have made of it stays. Raises OSError."""
        self._keep({number: one for number, one in self._all.items() if number != handout.id})
        with contextlib.suppress(FileNotFoundError):
            (self._path / f"{handout.id}.bin").unlink()

    def _keep(self, handouts: Mapping[str, Handout]) -> None:
        write_text(self._path / _FILE, json.dumps([asdict(one) for one in handouts.values()], indent=2) + "\n")
        self._all = dict(handouts)

    def _free_name(self, kind: str, name: str) -> str:
        plain = _file_name(kind, name)
        stem, dot, ending = plain.rpartition(".")
        taken = {one.stem.casefold() for one in self._all.values()} | _RESERVED
        unused, number = stem, 1
        while unused.casefold() in taken:
            number += 1
            unused = f"{stem} {number}"
        return f"{unused}{dot}{ending}"


def now() -> str:
    """The time, in the time zone of this computer."""
    return datetime.now(UTC).astimezone().isoformat(timespec="seconds")


def check_time(text: str) -> None:
    """Raise ValueError for a time that is not one of ISO 8601 with a time zone."""
    if datetime.fromisoformat(text).tzinfo is None:
        raise ValueError(f"found {text!r}, expected a time with its zone, such as 2026-12-01T09:00:00+01:00")


def checked_content(kind: str, name: str, encoded: str) -> bytes:
    """The content of a file in base64, if it is what its kind says. Takes a while. Raises ClassError.

    "" is the content of a shipped mission.
    """
    if kind == "mission" and encoded == "" and name in _shipped():
        return b""
    try:
        content = base64.b64decode(encoded, validate=True)
    except ValueError as error:
        raise ClassError(f"content: {error}; expected a file in base64") from error
    if not 0 < len(content) <= MAX_CONTENT:
        raise ClassError(f"{name}: found {len(content)} bytes, expected 1 to {MAX_CONTENT}")
    try:
        if kind == "program":
            text = decode(content).text
            if text.lstrip().startswith("<"):
                read_aesl(text, is_strict=False)
        elif kind == "playground":
            load_playground(f"data:;name={_file_name(kind, name).replace(';', '_')};base64,{encoded}")
        else:
            check_mission(_file_name(kind, name), content)
    except (AsebaError, ThymioSimError, OSError, ValueError, RecursionError) as error:
        text = str(error)
        raise ClassError(text if text.startswith(f"{name}: ") else f"{name}: {text}") from error
    return content


def _shipped() -> set[str]:
    """The names of the shipped missions. Raises ClassError."""
    folder = missions_folder()
    try:
        listed = json.loads((folder / "index.json").read_text("utf-8")) if folder else {"steps": []}
        return {name for step in listed["steps"] for name in step["missions"]}
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise ClassError(f"{folder}/index.json: {error}; expected the list of missions: install again") from error


def _file_name(kind: str, name: str) -> str:
    """The name of a file without folders and characters that some system does not allow, with an ending."""
    plain = unicodedata.normalize("NFC", name).replace("\\", "/").rpartition("/")[2]
    plain = re.sub(r'[<>:"|?*\x00-\x1f\x7f]', "_", plain).strip(" .")
    stem, dot, ending = plain.rpartition(".")
    if stem and len(ending) < MAX_ENDING:
        return f"{stem[: MAX_NAME - len(ending) - 1]}{dot}{ending}"
    return f"{plain[:MAX_NAME] or 'file'}.{_ENDINGS[kind]}"


def _handout(fields: dict[str, Any]) -> Handout:
    handout = Handout(**{**fields, "pupils": tuple(fields["pupils"])})
    texts = (handout.id, handout.kind, handout.name, handout.given, handout.due, handout.solution_of, handout.title)
    if handout.due != "":
        check_time(handout.due)
    if (
        not all(isinstance(text, str) for text in (*texts, *handout.pupils))
        or not _ID.fullmatch(handout.id)
        or handout.kind not in KINDS
    ):
        raise ValueError(f"found the hand-out {str(fields.get('name'))!r:.60} with invalid fields")
    return handout
