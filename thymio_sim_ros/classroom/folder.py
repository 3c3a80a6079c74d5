"""The folder of a class: tokens and places in `class.json`, and the work of each pupil in `pupils/<name>/`.

`program.aesl` is the last own program that was run, `draft.aesl` and `draft.py` what the editor had last, `work.json`
the rest; `handouts/` has what the teacher has handed out. Tokens are secrets: the folder can be read by its owner only.
"""

from __future__ import annotations

import contextlib
import json
import secrets
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

from aseba_vm.cli.output import write_file
from thymio_sim_ros.access.tokens import TOKEN, new_token
from thymio_sim_ros.classroom.errors import ClassError
from thymio_sim_ros.classroom.pupils import folder_name

__all__ = ["ClassFolder", "Place", "Work", "read_text", "write_text"]

_FILE = "class.json"
_PROGRAM, _DRAFT, _NODE, _WORK, _PARAMETERS = "program.aesl", "draft.aesl", "draft.py", "work.json", "parameters.yaml"
_CODE_LETTERS, _CODE_LENGTH = "abcdefghjkmnpqrstuvwxyz23456789", 6
"""A code that pupils type: no letters that look like others, and 30 bits, since attempts are limited."""
_REST = ("program_name", "playground", "class_playground")
"""The fields of `Work` that are in `work.json`."""


@dataclass(frozen=True, slots=True)
class Place:
    """A place of a pupil, permanent with the folder: `number` from 0 decides the domain, `id` is in files and links."""

    id: str
    name: str
    number: int
    token: str = field(repr=False, default_factory=new_token)
    read_only_token: str = field(repr=False, default_factory=new_token)


@dataclass(frozen=True, slots=True)
class Work:
    """The work of a pupil, with which the suite starts."""

    program: str | None = None
    """The last own program that was run."""
    program_name: str = ""
    draft: str | None = None
    """The last text in the editor of the page."""
    playground: str = ""
    """As `load_playground` takes it."""
    class_playground: str = ""
    """The playground of the class at that time: in a lesson with another one, `playground` does not count."""
    node: str | None = None
    """The last ROS node in Python in the editor of the page."""


class ClassFolder:
    """The folder of a class. Invariant: `class.json` has every place that was ever given, so that links stay valid."""

    def __init__(self, path: Path) -> None:
        """Open or create it. Raises ClassError for a folder or a file that cannot be used."""
        self._path = path
        try:
            path.mkdir(parents=True, exist_ok=True, mode=0o700)
            path.chmod(0o700)
            known = json.loads(self._file.read_text("utf-8")) if self._file.exists() else {}
            self.teacher_token = _token(known.get("teacher_token") or new_token())
            """Opens the teacher's page."""
            self.room_code = _token(known.get("room_code") or _new_code())
            """With it, pupils pick their name."""
            self._places = {place.name: place for place in map(_place, known.get("pupils", []))}
        except OSError as error:
            raise ClassError(
                f"{error.filename or path}: {error.strerror}; expected a folder that can be written"
            ) from error
        except (ValueError, TypeError, KeyError, AttributeError, RecursionError) as error:
            raise ClassError(
                f"{self._file}: {error}; expected the file as this program wrote it: restore or delete it (a new one "
                "has new links)"
            ) from error

    @property
    def _file(self) -> Path:
        return self._path / _FILE

    def places(self, names: Sequence[str]) -> list[Place]:
        """The places of these pupils in their order; new pupils get the lowest free numbers.

        Raises OSError with the name of the file.
        """
        for name in names:
            if name not in self._places:
                ids = [place.id for place in self._places.values()]
                numbers = {place.number for place in self._places.values()}
                number = next(at for at in range(len(numbers) + 1) if at not in numbers)
                self._places[name] = Place(folder_name(name, ids), name, number)
        self._save()
        return [self._places[name] for name in names]

    def pupil(self, place: Place) -> Path:
        """The folder of a pupil, which exists."""
        folder = self._path / "pupils" / place.id
        folder.mkdir(parents=True, exist_ok=True)
        return folder

    @property
    def handouts(self) -> Path:
        """The folder with what the teacher has handed out, which exists."""
        folder = self._path / "handouts"
        folder.mkdir(exist_ok=True)
        return folder

    def work(self, place: Place) -> Work:
        """The work of a pupil. Raises OSError."""
        rest: Any = None
        with contextlib.suppress(ValueError, RecursionError):  # damaged: the programs are files of their own
            rest = json.loads(read_text(self.pupil(place) / _WORK) or "{}")
        known = {name: text for name in _REST if isinstance(rest, dict) and isinstance(text := rest.get(name), str)}
        program, draft, node = (read_text(self.pupil(place) / name) for name in (_PROGRAM, _DRAFT, _NODE))
        return Work(program, draft=draft, node=node, **known)

    def keep(self, place: Place, work: Work) -> None:
        """Write what a pupil has made; a crash in between leaves each file as it was or as it is. Raises OSError."""
        rest = json.dumps({name: getattr(work, name) for name in _REST}, indent=2) + "\n"
        for name, text in ((_PROGRAM, work.program), (_DRAFT, work.draft), (_NODE, work.node), (_WORK, rest)):
            path = self.pupil(place) / name
            if text is not None and text != read_text(path):
                write_text(path, text)

    def write_parameters(self, place: Place, parameters: Mapping[str, Mapping[str, str]]) -> Path:
        """Write a file of ROS parameters, by node and name, and return its path. Raises OSError."""
        path = self.pupil(place) / _PARAMETERS
        nodes = {node: {"ros__parameters": dict(values)} for node, values in parameters.items() if values}
        write_text(path, json.dumps(nodes, ensure_ascii=False))  # YAML has JSON's strings, but no pairs of surrogates
        return path

    def _save(self) -> None:
        pupils = [asdict(place) for place in sorted(self._places.values(), key=lambda place: place.number)]
        known = {"teacher_token": self.teacher_token, "room_code": self.room_code, "pupils": pupils}
        write_text(self._file, json.dumps(known, indent=2) + "\n")


def read_text(path: Path) -> str | None:
    """A file of the class; None if it does not exist. Raises OSError."""
    try:
        return path.read_bytes().decode("utf-8", "replace")
    except FileNotFoundError:
        return None


def write_text(path: Path, text: str) -> None:
    """Write a file as a whole, for the owner only. Raises OSError."""
    write_file(str(path), text.encode("utf-8", "replace"), mode=0o600)


def _place(fields: dict[str, Any]) -> Place:
    place = Place(**fields)
    if folder_name(place.id) != place.id or not isinstance(place.name, str) or not 0 <= place.number < 1000:
        raise ValueError(f"found the pupil {fields.get('name')!r:.60} with an invalid id, name or number")
    _token(place.token)
    _token(place.read_only_token)
    return place


def _new_code() -> str:
    return "".join(secrets.choice(_CODE_LETTERS) for _ in range(_CODE_LENGTH))


def _token(text: str) -> str:
    if not TOKEN.fullmatch(text):
        raise ValueError("found an invalid token")
    return text
