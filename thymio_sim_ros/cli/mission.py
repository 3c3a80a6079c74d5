"""The command `thymio-sim mission`: a program in a mission, judged without ROS, as fast as possible."""

from __future__ import annotations

import argparse
import os
import tempfile
import warnings
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

from aseba_vm.languages import LANGUAGES
from thymio_sim_ros import course_packages
from thymio_sim_ros.cli.errors import UsageError
from thymio_sim_ros.cli.output import print_json, print_text
from thymio_sim_ros.course_packages import field_checks
from thymio_sim_ros.errors import ThymioSimError
from thymio_sim_ros.files.loading import NO_PROGRAM
from thymio_sim_ros.files.resources import ResourceError
from thymio_sim_ros.grading import assignment as assignments
from thymio_sim_ros.grading.errors import GradingError
from thymio_sim_ros.missions import Judge, Mission, MissionError, Verdict, load_mission
from thymio_sim_ros.missions.check import is_node, program_runs
from thymio_sim_ros.missions.facts import Measured
from thymio_sim_ros.missions.shipped import Step, find_mission, index, shipped
from thymio_sim_ros.missions.trial import judged_run
from thymio_sim_ros.portable_ros import import_hook
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
    if options.check:
        return _check(path, options)
    mission = _mission(path)
    judge = _judge(mission, path, options.program, options.seed)
    print_json(_result(mission, judge)) if options.json else print_text(_report(mission, judge, options.language))
    return 0 if judge.verdict.is_passed else NOT_PASSED


def _check(path: Path, options: argparse.Namespace) -> int:
    """Run solutions and start programs, and print what they get: a solution has all stars, a start does not pass."""
    with tempfile.TemporaryDirectory(prefix="thymio_mission_") as folder:
        inside = f"{folder}{os.sep}"
        try:
            mission = _mission(path, folder=Path(folder) if options.untrusted else None)
            runs, mistakes = _checked(mission, path, options.seed, may_run_nodes=not options.untrusted)
        except UsageError as error:
            raise UsageError(str(error).replace(inside, "")) from error
    mistakes = [mistake.replace(inside, "") for mistake in mistakes]
    print_json({"runs": runs, "mistakes": mistakes}) if options.json else print_text("\n".join([*runs, *mistakes]))
    return NOT_PASSED if mistakes else 0


def _checked(mission: Mission, path: Path, seed: int, *, may_run_nodes: bool) -> tuple[list[str], list[str]]:
    """What the programs of a mission get, and the mistakes of it."""
    named = {"playground": mission.playground, "picture": mission.picture, "next": mission.next}
    files = {key: name for key, name in named.items() if Path(name).suffix}
    mistakes = [f"{path}: {key}: found no file {name}" for key, name in files.items() if not Path(name).is_file()]
    mistakes += _circles(mission, path)

    def judge(program: str) -> Judge | None:
        return _judge(mission, path, program, seed) if may_run_nodes or not is_node(program) else None

    runs = list(program_runs(mission, judge))
    if all(run.verdict is None for run in runs):
        _judge(mission, path, NO_PROGRAM, seed)  # refuses wrong names and zones
    lines = [f"{run.key}: {_ended(run.verdict)}" for run in runs]
    if not mission.solutions:
        lines.append("no solutions: whether it can be passed is not checked")
    return lines, mistakes + [f"{path}: {run.key}: {run.mistake}" for run in runs if run.mistake]


def _circles(mission: Mission, path: Path) -> list[str]:
    """What is wrong with the missions after this one: they lead back to one of them, or cannot be read."""
    chain = [path.resolve()]
    while Path(mission.next).suffix and (following := Path(mission.next).resolve()).is_file():
        if following in chain:
            names = " → ".join(each.name for each in [*chain[chain.index(following) :], following])
            return [f"{path}: next: found the circle {names}, expected a last mission"]
        chain.append(following)
        try:
            mission = load_mission(following)
        except (MissionError, OSError) as error:
            return [f"{path}: next: {error}"]
    return []


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
                f"  {each.name:<14} {stars:<3} {titles.get(language, titles['en'])}"
                f" ({', '.join(each.mission.languages)})"
            )
    return "\n".join(lines)


def _found(name: str) -> Path:
    """The file of a shipped mission, of a path, or of the mission that an assignment names."""
    try:
        _shipped()
        path = find_mission(name)
        if path.suffix != ".toml":
            return path
        mission = assignments.load(path).mission
    except (ResourceError, GradingError) as error:
        raise UsageError(str(error)) from error
    if mission is None:
        raise UsageError(f"{name}: mission: found none, expected the file of a mission (docs/missions.md)")
    return mission


def _mission(path: Path, folder: Path | None = None) -> Mission:
    try:
        return load_mission(path, folder=folder)
    except MissionError as error:
        raise UsageError(str(error)) from error
    except OSError as error:
        raise UsageError(f"{path}: {error.strerror}; expected a mission file (docs/missions.md)") from error


def _judge(mission: Mission, path: Path, program: str, seed: int) -> Judge:
    """The judge of a whole run of an Aseba program, or of a ROS node in Python."""
    try:
        if is_node(program):
            return _judged_node(mission, Path(program), seed)
        return judged_run(mission, program, seed=seed)
    except FieldError as error:
        raise UsageError(str(MissionError(str(path), error))) from error
    except UsageError:
        raise
    except (ThymioSimError, OSError) as error:
        raise UsageError(str(error)) from error


def _judged_node(mission: Mission, program: Path, seed: int) -> Judge:
    """The judge of a node on the embedded graph, also where a ROS is installed."""
    if not program.is_file():
        raise UsageError(f"{program}: found no such file, expected a ROS node in Python")
    field_checks.switch_on()
    import_hook.install(is_forced=True)
    course_packages.add_to_path()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", DeprecationWarning)  # lark, imported with the first messages
        try:
            from thymio_sim_ros.testing.ros.mission import judged_node
        except ModuleNotFoundError as error:
            if error.name != "pytest":
                raise
            raise UsageError(f"{program}: nodes are judged with pytest; install it: pip install pytest") from error
    return judged_node(mission, program, seed=seed)


def _stars(verdict: Verdict) -> str:
    return "".join(_STAR if has else _NO_STAR for has in verdict.stars)


def _ended(verdict: Verdict | None) -> str:
    return "not run" if verdict is None else f"{_stars(verdict)} {verdict.state.value} after {verdict.at_s:.2f} s"


def _report(mission: Mission, judge: Judge, language: str) -> str:
    verdict, measured = judge.verdict, judge.measured()
    lines = [mission.titles.get(language, mission.title)]
    for item in verdict.checklist:
        texts = ", ".join(mission.text_of(fact, language) for fact in item.facts)
        lines.append(f"{_DONE if item.is_done else _OPEN} {texts}")
    lines += [
        f"{_STAR if has else _NO_STAR} {mission.star_text(number, language)}"
        for number, has in enumerate(verdict.stars[1:])
    ]
    if verdict.is_passed:
        lines.append(f"{_stars(verdict)} passed after {verdict.at_s:.2f} s")
    else:
        broken = ", ".join(mission.missing_text(fact, language) for fact in verdict.broken)
        lines.append(f"{_stars(verdict)} not passed: {broken or 'time is over'}, after {verdict.at_s:.2f} s")
        lines += [
            f"Missing: {mission.missing_text(fact, language)}{_amount(measured.get(fact))}" for fact in judge.missing()
        ]
        if hint := mission.hint(0, language):
            lines.append(f"Hint: {hint}")
    return "\n".join(lines)


def _amount(found: Measured | None) -> str:
    return "" if found is None else f" ({found.value:.3g} of {found.goal:g} {found.unit}".rstrip() + ")"


def _result(mission: Mission, judge: Judge) -> dict[str, object]:
    verdict = judge.verdict
    return {
        "mission": mission.title,
        "state": verdict.state.value,
        "seconds": verdict.at_s,
        "stars": sum(verdict.stars),
        "checklist": [{"facts": list(item.facts), "done": item.is_done} for item in verdict.checklist],
        "broken": list(verdict.broken),
        "missing": [] if verdict.is_passed else list(judge.missing()),
        "measured": {name: asdict(found) for name, found in judge.measured().items()},
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
    about = "a shipped mission, a file (docs/missions.md), or an assignment (*.toml) that names one"
    parser.add_argument("mission", nargs="?", metavar="MISSION", help=about)
    parser.add_argument("--list", action="store_true", help="list the shipped missions, with --json as JSON")
    parser.add_argument(
        "--program", default=NO_PROGRAM, metavar="FILE", help="program of the robot, or a ROS node (.py); default: none"
    )
    about = "run the solutions and start programs of the mission: solutions get all stars, a start does not pass"
    parser.add_argument("--check", action="store_true", help=about)
    about = "with --check: the file of someone else, which names files of its own only and whose ROS nodes are not run"
    parser.add_argument("--untrusted", action="store_true", help=about)
    parser.add_argument("--seed", type=int, default=0, help="seed of the noise (default: %(default)s)")
    parser.add_argument("--language", choices=LANGUAGES, default="en", help="of the mission's texts (default: en)")
    parser.add_argument(
        "--json", action="store_true", help="print the result as JSON, with the way of the robot, or what --check finds"
    )
    return parser
