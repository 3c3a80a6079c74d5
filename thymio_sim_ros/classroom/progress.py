"""How far a pupil is with each hand-out, in `handouts.json` of the pupil's folder, and the pupil's program for it."""

from __future__ import annotations

import contextlib
import json
from dataclasses import asdict, dataclass, fields, replace
from pathlib import Path
from typing import Any

from thymio_sim_ros.classroom.folder import read_text, write_text
from thymio_sim_ros.classroom.handouts import Handout, now
from thymio_sim_ros.classroom.suite_state import MissionTry

__all__ = ["Progress", "ProgressLog"]

_FILE = "handouts.json"


@dataclass(frozen=True, slots=True)
class Progress:
    """What a pupil has reached. Times are those of ISO 8601, "": not yet."""

    opened: str = ""
    changed: str = ""
    """The last run or try, or change of a ROS node."""
    tries: int = 0
    """Programs that were run since it was opened, or tries of a mission."""
    stars: int = 0
    """The most stars of a try."""
    passed: str = ""
    best_s: float = 0.0
    """Simulated time of the first try with the most stars."""


class ProgressLog:
    """The progress of one pupil. Invariant: the files have it. Methods raise OSError."""

    def __init__(self, folder: Path) -> None:
        """`folder` is that of the pupil. What another program has written there counts as nothing."""
        self._folder = folder
        known: Any = None
        with contextlib.suppress(ValueError, RecursionError):
            known = json.loads(read_text(folder / _FILE) or "{}")
        known = known if isinstance(known, dict) else {}
        handouts = known.get("handouts")
        self._of = {number: _progress(one) for number, one in (handouts if isinstance(handouts, dict) else {}).items()}
        current = known.get("current")
        self.current = current if isinstance(current, str) else ""
        """Id of the hand-out that programs are for."""
        self._seen = ("", 0)
        """Mission and number of its last try."""

    def of(self, handout: Handout) -> Progress:
        """That of a hand-out."""
        return self._of.get(handout.id, Progress())

    def program(self, handout: Handout) -> str | None:
        """The program that was run last for a hand-out; None: none yet."""
        return read_text(self._program(handout))

    def node(self, handout: Handout) -> str | None:
        """The ROS node that was written last for a hand-out; None: none yet."""
        return read_text(self._program(handout, ".py"))

    def open(self, handout: Handout) -> None:
        """The pupil has opened it: programs that run from now on are for it, unless it is a playground for them."""
        if handout.kind != "playground":
            self.current = handout.id
        progress = self.of(handout)
        self._keep(handout.id, progress if progress.opened else replace(progress, opened=now()))

    def run(self, handout: Handout, text: str) -> None:
        """The pupil has run a program while a hand-out was open; tries of a mission are counted by themselves."""
        self._write(self._program(handout), text)
        progress = self.of(handout)
        runs = progress.tries if handout.kind == "mission" else progress.tries + 1
        self._keep(handout.id, replace(progress, changed=now(), tries=runs))

    def write_node(self, handout: Handout, text: str) -> None:
        """The pupil has written a ROS node while a hand-out was open; it need not run, as in a class without nodes."""
        self._write(self._program(handout, ".py"), text)
        self._keep(handout.id, replace(self.of(handout), changed=now()))

    def tried(self, handout: Handout, attempt: MissionTry) -> None:
        """A try of a mission that was handed out has changed. A new number is another try."""
        progress = self.of(handout)
        self.current = handout.id
        if attempt.tries > 0 and (attempt.mission, attempt.tries) != self._seen:
            progress = replace(progress, tries=progress.tries + 1, changed=now(), opened=progress.opened or now())
        self._seen = (attempt.mission, attempt.tries)
        if attempt.has_passed and attempt.stars > progress.stars:
            progress = replace(
                progress, stars=attempt.stars, passed=progress.passed or now(), best_s=attempt.at_s, changed=now()
            )
        if progress != self.of(handout):
            self._keep(handout.id, progress)

    def _program(self, handout: Handout, ending: str = ".aesl") -> Path:
        return self._folder / "handouts" / f"{handout.id}{ending}"

    def _write(self, path: Path, text: str) -> None:
        path.parent.mkdir(exist_ok=True)
        write_text(path, text)

    def _keep(self, number: str, progress: Progress) -> None:
        self._of[number] = progress
        known = {"current": self.current, "handouts": {one: asdict(each) for one, each in self._of.items()}}
        write_text(self._folder / _FILE, json.dumps(known, indent=2) + "\n")


def _progress(given: Any) -> Progress:
    known = given if isinstance(given, dict) else {}
    right: dict[str, Any] = {
        one.name: value for one in fields(Progress) if type(value := known.get(one.name)) is type(one.default)
    }
    return Progress(**right)
