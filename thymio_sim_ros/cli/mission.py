"""The command `thymio-sim mission`: a program in a mission, judged without ROS, as fast as possible."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from aseba_vm.languages import LANGUAGES
from thymio_sim_ros.cli.errors import UsageError
from thymio_sim_ros.cli.options import check_files
from thymio_sim_ros.cli.output import print_json, print_text
from thymio_sim_ros.device.layout import THYMIO
from thymio_sim_ros.engine.engine import Engine
from thymio_sim_ros.files.loading import NO_PROGRAM
from thymio_sim_ros.files.resources import ResourceError
from thymio_sim_ros.missions import Judge, Mission, MissionError, Verdict, load_mission
from thymio_sim_ros.missions.shipped import Step, find_mission, index, shipped
from thymio_sim_ros.sim.model.fields import FieldError

__all__ = ["run"]

NOT_PASSED = 1
_DONE, _OPEN = "[x]", "[ ]"
_STAR, _NO_STAR = "★", "☆"


def run(argv: Sequence[str]) -> int:
    """Judge the program; return the exit code. Raises UsageError for rejected input."""
    options = _parser().parse_args(argv)
    if options.list:
        print_json(_index()) if options.json else print_text(_list(options.language))
        return 0
    if options.mission is None:
        raise UsageError("mission: found no mission, expected the name of one (--list) or a file (docs/missions.md)")
    path = _found(options.mission)
    mission = _mission(path)
    try:
        judge = _judge(mission, options.program, options.seed)
    except FieldError as error:
        raise UsageError(str(MissionError(str(path), error))) from error
    print_json(_result(mission, judge)) if options.json else print_text(
        _report(mission, judge.verdict, options.language)
    )
    return 0 if judge.verdict.is_passed else NOT_PASSED


def _shipped() -> tuple[Step, ...]:
    try:
        return shipped()
    except (MissionError, OSError, ValueError) as error:
        raise UsageError(f"the installed missions: {error}; install the package again") from error


def _index() -> dict[str, Any]:
    _shipped()
    return index()


def _list(language: str) -> str:
    """The shipped missions in steps: name, number of stars, languages of programs, title."""
    lines = []
    for number, step in enumerate(_shipped(), start=1):
        lines.append(f"{number} {step.titles.get(language, step.titles['en'])}")
        for each in step.missions:
            stars = _NO_STAR * (1 + len(each.mission.stars))
            titles = each.mission.titles
            lines.append(
                f"  {each.name:<12} {stars:<3} {titles.get(language, titles['en'])}"
                f" ({', '.join(each.mission.languages)})"
            )
    return "\n".join(lines)


def _found(name: str) -> Path:
    try:
        _shipped()
        return find_mission(name)
    except ResourceError as error:
        raise UsageError(str(error)) from error


def _mission(path: Path) -> Mission:
    try:
        return load_mission(path)
    except MissionError as error:
        raise UsageError(str(error)) from error
    except OSError as error:
        raise UsageError(f"{path}: {error.strerror}; expected a mission file (docs/missions.md)") from error


def _judge(mission: Mission, program: str, seed: int) -> Judge:
    """The judge of a whole run."""
    playground, assignments = check_files(mission.playground, program, "", THYMIO)
    robot = mission.robot or next((start.name for start in playground.robots), "")
    programs = {name: found.program for name, found in assignments.items() if found.program is not None}
    engine = Engine(playground, {name: one for name, one in programs.items() if name == robot}, seed=seed)
    judge = Judge(mission, engine)
    while not judge.is_over:
        engine.step(())
        judge.tick()
    return judge


def _report(mission: Mission, verdict: Verdict, language: str) -> str:
    title = mission.translations[language].title if language in mission.translations else ""
    lines = [title or mission.title]
    for item in verdict.checklist:
        texts = ", ".join(mission.text_of(fact, language) for fact in item.facts)
        lines.append(f"{_DONE if item.is_done else _OPEN} {texts}")
    stars = "".join(_STAR if has else _NO_STAR for has in verdict.stars)
    if verdict.is_passed:
        lines.append(f"{stars} passed after {verdict.at_s:.2f} s")
    else:
        broken = ", ".join(mission.text_of(fact, language) for fact in verdict.broken)
        lines.append(f"{stars} not passed: {broken or 'time is over'}, after {verdict.at_s:.2f} s")
        if hint := mission.hint(0, language):
            lines.append(f"Hint: {hint}")
    return "\n".join(lines)


def _result(mission: Mission, judge: Judge) -> dict[str, object]:
    verdict = judge.verdict
    return {
        "mission": mission.title,
        "state": verdict.state.value,
        "seconds": verdict.at_s,
        "stars": sum(verdict.stars),
        "checklist": [{"facts": list(item.facts), "done": item.is_done} for item in verdict.checklist],
        "broken": list(verdict.broken),
        "trace": [[round(x, 4), round(y, 4)] for x, y in judge.trace],
    }


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="thymio-sim mission",
        description="Run a program in a mission without ROS, as fast as possible, and say which stars it gets. "
        "The same program gets the same stars on each computer.",
        epilog="exit code: 0 passed; 1 not passed; 2 rejected input",
        allow_abbrev=False,
    )
    about = "a shipped mission, or a file (docs/missions.md)"
    parser.add_argument("mission", nargs="?", metavar="MISSION", help=about)
    parser.add_argument("--list", action="store_true", help="list the shipped missions, with --json as JSON")
    parser.add_argument("--program", default=NO_PROGRAM, metavar="FILE", help="program of the robot (default: none)")
    parser.add_argument("--seed", type=int, default=0, help="seed of the noise (default: %(default)s)")
    parser.add_argument("--language", choices=LANGUAGES, default="en", help="of the mission's texts (default: en)")
    parser.add_argument("--json", action="store_true", help="print the result as JSON, with the way of the robot")
    return parser
