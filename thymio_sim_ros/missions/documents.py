"""What the server of the page has of the shipped missions: their list and their pictures."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from thymio_sim_ros.missions.shipped import index, shipped

__all__ = ["FOLDER", "LIST", "find", "mission_after"]

LIST = "missions.json"
FOLDER = "missions"


def find(names: Sequence[str]) -> tuple[bytes, str] | None:
    """A document by folder and name, and the ending of its type; None if there is none.

    `missions.json` has steps and missions as `thymio-sim mission --list --json` prints them, but addresses in place of
    paths: `missions/NAME.png` is the picture of a mission. Raises MissionError, OSError.
    """
    if tuple(names) == (LIST,):
        return json.dumps(_listed()).encode(), ".json"
    if len(names) != 2 or names[0] != FOLDER:
        return None
    wanted = Path(names[1])
    for step in shipped():
        for each in step.missions:
            picture = Path(each.mission.picture)
            if each.mission.picture and (each.name, picture.suffix) == (wanted.stem, wanted.suffix):
                return picture.read_bytes(), picture.suffix
    return None


def mission_after(name: str) -> str:
    """The shipped mission after another one; "" if there is none. Raises MissionError, OSError."""
    names = [each.name for step in shipped() for each in step.missions]
    return names[names.index(name) + 1] if name in names[:-1] else ""


def _listed() -> dict[str, Any]:
    listed = index()
    for step in listed["steps"]:
        for mission in step["missions"]:
            del mission["path"]
            picture = mission["picture"]
            mission["picture"] = f"{FOLDER}/{mission['name']}{Path(picture).suffix}" if picture else ""
    return listed
