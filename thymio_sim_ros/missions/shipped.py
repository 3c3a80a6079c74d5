"""The missions that are installed with the code, in the order in which a class plays them.

`missions/index.json` lists them in steps; everything else is in their own files.
"""

from __future__ import annotations

import difflib
import functools
import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from thymio_sim_ros.files import resources
from thymio_sim_ros.files.resources import ResourceError
from thymio_sim_ros.missions.mission import Mission
from thymio_sim_ros.missions.reader import load_mission

__all__ = ["ShippedMission", "Step", "find_mission", "index", "shipped"]

_INDEX = "index.json"


@dataclass(frozen=True, slots=True)
class ShippedMission:
    """A shipped mission: `name` is that of its file without the ending, `mission` is its content."""

    name: str
    path: Path
    mission: Mission


@dataclass(frozen=True, slots=True)
class Step:
    """A step of the course: its title by language, and its missions in order."""

    name: str
    titles: Mapping[str, str]
    missions: tuple[ShippedMission, ...]


def shipped() -> tuple[Step, ...]:
    """The steps with their missions; none if no missions are installed. Raises MissionError, OSError."""
    folder = resources.missions_folder()
    if folder is None:
        return ()
    return _shipped(folder, max(path.stat().st_mtime_ns for path in folder.rglob("*.json")))


@functools.lru_cache(maxsize=1)
def _shipped(folder: Path, _changed_ns: int) -> tuple[Step, ...]:
    found = json.loads((folder / _INDEX).read_text(encoding="utf-8"))
    return tuple(_step(folder / step["name"], step) for step in found["steps"])


def _step(folder: Path, step: Mapping[str, Any]) -> Step:
    paths = [folder / f"{name}.json" for name in step["missions"]]
    missions = tuple(ShippedMission(path.stem, path, load_mission(path)) for path in paths)
    return Step(step["name"], step["titles"], missions)


def find_mission(name: str) -> Path:
    """The file of a shipped mission, or else of a path. Raises ResourceError for a name that is neither."""
    found = {each.name: each.path for step in shipped() for each in step.missions}
    if name in found or not name.isidentifier():
        return found.get(name, resources.expanded(name))
    path = resources.expanded(name)
    if path.is_file():
        return path
    near = difflib.get_close_matches(name, found, 1)
    hint = f"; did you mean '{near[0]}'?" if near else ""
    raise ResourceError(f"no mission '{name}': neither a file nor one of {', '.join(found)}{hint}")


def index() -> dict[str, Any]:
    """All steps and missions as JSON for pages: titles by language, languages of programs, number of stars, path.

    `picture` is the path of a file, "" if there is none.
    """
    return {
        "steps": [
            {
                "name": step.name,
                "titles": dict(step.titles),
                "missions": [
                    {
                        "name": each.name,
                        "path": str(each.path),
                        "titles": each.mission.titles,
                        "picture": each.mission.picture,
                        "stars": 1 + len(each.mission.stars),
                        "languages": list(each.mission.languages),
                    }
                    for each in step.missions
                ],
            }
            for step in shipped()
        ]
    }
