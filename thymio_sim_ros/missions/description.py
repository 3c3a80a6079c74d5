"""A mission and its present try as JSON values, for pages and other clients."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from thymio_sim_ros.missions.live import LiveMission
from thymio_sim_ros.missions.mission import Mission
from thymio_sim_ros.missions.zones import ZONES
from thymio_sim_ros.sim.model import fields
from thymio_sim_ros.sim.model.fields import FieldError

__all__ = ["described", "progress"]

MAX_PROGRAM_BYTES = 1_000_000
"""Of a program that is sent to pages."""
WAITING = "waiting"
"""State before the first try, and after the program was stopped."""

_NOTHING: Mapping[str, Any] = {"broken": [], "missing": [], "measured": {}, "trace": []}
_KINDS = {kind: word for word, kind in ZONES.items()}


def described(mission: Mission) -> dict[str, Any]:
    """What a pupil needs of a mission: texts in all languages, zones, start programs, solutions for the next step.

    Raises FieldError for a program that cannot be read.
    """
    return {
        "title": mission.title,
        "story": mission.story,
        "languages": list(mission.languages),
        "time_s": mission.time_s,
        "hints": list(mission.hints),
        "facts": {name: mission.text_of(name) for name in mission.facts},
        "missing": {name: mission.missing_text(name) for name in mission.facts},
        "stars": [{"text": star.text, "within_s": star.within_s, "length": star.length} for star in mission.stars],
        "zones": {name: {"kind": _KINDS[type(zone)]} | fields.write(zone) for name, zone in mission.zones.items()},
        "programs": _texts("programs", mission.programs),
        "solutions": _texts("solutions", mission.solutions),
        "toolbox": {"hide": list(mission.toolbox.hide), "modes": mission.toolbox.modes},
        "translations": {
            language: {
                "title": texts.title,
                "story": texts.story,
                "hints": list(texts.hints),
                "facts": dict(texts.facts),
                "missing": dict(texts.missing),
                "stars": list(texts.stars),
            }
            for language, texts in mission.translations.items()
        },
    }


def progress(live: LiveMission) -> dict[str, Any]:
    """What the present try has reached.

    `checklist` has the facts of each line, `done` whether it is done. `state` is waiting, running, passed or failed;
    `reason` says why it has failed: facts (those of `broken`), time, or hand. `trouble`: see `Trouble`. Times are
    simulated seconds; the way is in m. `measured` has value, goal and unit of the facts that are quantities.
    """
    verdict, judge = live.verdict, live.judge
    checklist = live.checklist if verdict is None else verdict.checklist
    shown: dict[str, Any] = {
        "tries": live.tries,
        "trouble": live.trouble.value,
        "checklist": [list(item.facts) for item in checklist],
        "done": [item.is_done for item in checklist],
    }
    if verdict is None or judge is None:
        return shown | {"state": WAITING, "reason": "", "at_s": 0.0, "stars": [], **_NOTHING}
    is_failed = live.is_helped or verdict.state.value == "failed"
    reason = "hand" if live.is_helped else "time" if verdict.is_late else "facts" if is_failed else ""
    return shown | {
        "state": "failed" if is_failed else verdict.state.value,
        "reason": reason,
        "at_s": verdict.at_s,
        "stars": [False] * len(verdict.stars) if live.is_helped else list(verdict.stars),
        "broken": list(verdict.broken),
        "missing": list(judge.missing()) if verdict.is_late else [],
        "measured": {
            name: [round(one.value, 3), round(one.goal, 3), one.unit] for name, one in judge.measured().items()
        },
        "trace": [] if live.is_running else [[round(x, 3), round(y, 3)] for x, y in judge.trace],
    }


def _texts(key: str, programs: Mapping[str, str]) -> dict[str, str]:
    """The texts of programs by language."""
    return {language: _text(f"{key}.{language}", Path(path)) for language, path in programs.items()}


def _text(key: str, path: Path) -> str:
    try:
        data = path.read_bytes()
        if len(data) > MAX_PROGRAM_BYTES:
            raise FieldError(key, f"{len(data)} bytes in '{path.name}'", f"at most {MAX_PROGRAM_BYTES}")
        return data.decode()
    except UnicodeDecodeError as error:
        raise FieldError(key, f"an invalid byte in '{path.name}'", "UTF-8 text") from error
    except (OSError, ValueError) as error:
        raise FieldError(key, f"no file '{path.name}'", "a program beside the mission") from error
