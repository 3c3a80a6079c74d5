"""The folder of a class: tokens and places in `class.json`, programs in `pupils/<name>/program.aesl`.

Tokens are secrets: the folder can be read by its owner only.
"""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

from aseba_vm.cli.output import write_file
from thymio_sim_ros.bridge.access import TOKEN, new_token
from thymio_sim_ros.classroom.errors import ClassError
from thymio_sim_ros.classroom.pupils import folder_name

__all__ = ["ClassFolder", "Place"]

_FILE = "class.json"


@dataclass(frozen=True, slots=True)
class Place:
    """What a pupil keeps while the folder is kept: `number` from 0 decides ports and domain, `id` names the files."""

    id: str
    name: str
    number: int
    token: str = field(repr=False, default_factory=new_token)
    read_only_token: str = field(repr=False, default_factory=new_token)


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
        """Return the places of these pupils in their order; new pupils get the lowest free numbers.

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
        """Return the folder of a pupil, which exists."""
        folder = self._path / "pupils" / place.id
        folder.mkdir(parents=True, exist_ok=True)
        return folder

    def program(self, place: Place) -> str | None:
        """Return the text of a pupil's last own program, None without one."""
        try:
            return self.program_file(place).read_text("utf-8")
        except FileNotFoundError:
            return None

    def program_file(self, place: Place) -> Path:
        """Return the path of a pupil's program, which may not exist."""
        return self.pupil(place) / "program.aesl"

    def keep_program(self, place: Place, text: str) -> None:
        """Write a pupil's program; a crash in between leaves the one before. Raises OSError."""
        _write(self.program_file(place), text)

    def _save(self) -> None:
        pupils = [asdict(place) for place in sorted(self._places.values(), key=lambda place: place.number)]
        _write(self._file, json.dumps({"teacher_token": self.teacher_token, "pupils": pupils}, indent=2) + "\n")


def _write(path: Path, text: str) -> None:
    write_file(str(path), text.encode("utf-8", "replace"), mode=0o600)


def _place(fields: dict[str, Any]) -> Place:
    place = Place(**fields)
    if folder_name(place.id) != place.id or not isinstance(place.name, str) or not 0 <= place.number < 1000:
        raise ValueError(f"found the pupil {fields.get('name')!r:.60} with an invalid id, name or number")
    _token(place.token)
    _token(place.read_only_token)
    return place


def _token(text: str) -> str:
    if not TOKEN.fullmatch(text):
        raise ValueError("found an invalid token")
    return text
