"""A mission as an assignment of `thymio-sim grade`, or as a part of one: a point for each star."""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path

from thymio_sim_ros.files.loading import load_playground
from thymio_sim_ros.files.resources import ResourceError
from thymio_sim_ros.grading.assignment import Assignment
from thymio_sim_ros.grading.errors import GradingError
from thymio_sim_ros.missions import Mission, MissionError, load_mission
from thymio_sim_ros.missions.files import located
from thymio_sim_ros.missions.shipped import find_mission
from thymio_sim_ros.missions.trial import robot_of
from thymio_sim_ros.sim.model.fields import FieldError
from thymio_sim_ros.sim.playground.reader import Playground, PlaygroundError
from thymio_sim_ros.sim.playground.writer import dumps

__all__ = ["mission_assignment", "with_mission"]

_TEST = "test_mission.py"
_NODE = "ros"
_OF_PROGRAMS = '''"""Made of a mission: a point for each star."""

from pathlib import Path

import pytest

from thymio_sim_ros.testing import check_star

MISSION = Path(__file__).with_name({mission})


@pytest.mark.points({points})
@pytest.mark.parametrize("star", range({points}))
@pytest.mark.thymio(playground={playground}, programs={programs})
def test_star(classroom, star):
    check_star(classroom[{robot}], MISSION, star)
'''
_OF_NODES = '''"""Made of a mission: a point for each star."""

from pathlib import Path

import pytest

from thymio_sim_ros.testing import check_star

MISSION = Path(__file__).with_name({mission})


@pytest.mark.points({points})
@pytest.mark.parametrize("star", range({points}))
@pytest.mark.thymio(playground={playground})
def test_star(ros, simulation, star):
    sim = simulation()
    ros.run({expected})
    check_star(sim[{robot}], MISSION, star)
'''


def with_mission(assignment: Assignment) -> Assignment:
    """The assignment with a test for each star of the mission that it names. Raises GradingError.

    The mission judges the program that the assignment expects, or NAME.aesl or NAME.py if it expects no files.
    """
    if assignment.mission is None:
        return assignment
    of_mission = mission_assignment(str(assignment.mission), assignment.expected)
    for name, data in of_mission.content.items():
        own = assignment.content.get(name)
        if own is not None and (name == _TEST or not _is_same(assignment.mission.parent / name, own, data)):
            raise GradingError(
                f"{assignment.mission}: found another file {name} in the assignment, expected one of a name"
            )
    is_alone = not assignment.tests
    return replace(
        assignment,
        tests=(*of_mission.tests, *assignment.tests),
        content={**assignment.content, **of_mission.content},
        expected=assignment.expected or of_mission.expected,
        solution=assignment.solution or (of_mission.solution if is_alone else None),
    )


def _is_same(path: Path, own: bytes, data: bytes) -> bool:
    """Whether a file of the assignment is that of the mission, which may have its pictures in it."""
    return own == data or (path.is_file() and path.read_bytes() == own)


def mission_assignment(name: str, programs: Sequence[str] = ()) -> Assignment:
    """The assignment of a shipped mission, or of a file.

    A submission is one program: NAME.aesl, or NAME.py if the mission is for ROS nodes alone; or it has `programs`,
    and the first one of that ending is judged. Raises GradingError.
    """
    try:
        given = find_mission(name)
        path = located(given)
        mission = load_mission(path)
        _, playground = load_playground(mission.playground)
    except MissionError as error:
        raise GradingError(str(error)) from error
    except FieldError as error:
        raise GradingError(str(MissionError(name, error))) from error
    except (PlaygroundError, ResourceError) as error:
        raise GradingError(str(error)) from error
    except OSError as error:
        raise GradingError(f"{name}: {error.strerror}; expected tests (*.py, *.toml) or a mission") from error
    is_of_nodes = mission.languages == (_NODE,)
    ending = ".py" if is_of_nodes else ".aesl"
    expected = next((each for each in programs or (f"{given.stem}{ending}",) if each.endswith(ending)), None)
    if expected is None:
        raise GradingError(f"{name}: found the files {', '.join(programs)}, expected a program that ends in {ending}")
    robot = robot_of(mission, playground)
    files = dict(_files(mission, playground, path))
    texts = {
        "mission": path.name,
        "playground": _name(mission.playground, path.parent),
        "programs": {robot: expected}
        | {other: _name(program, path.parent) for other, program in mission.robots.items()},
        "robot": robot,
        "expected": expected,
    }
    source = (_OF_NODES if is_of_nodes else _OF_PROGRAMS).format(
        points=1 + len(mission.stars), **{key: json.dumps(value) for key, value in texts.items()}
    )
    solution = next((Path(each) for each in mission.solutions.values() if Path(each).is_file()), None)
    return Assignment(
        name=given.stem,
        tests=(_TEST,),
        hidden=frozenset(),
        expected=(expected,),
        content={_TEST: source.encode()} | files,
        solution=solution,
    )


def _files(mission: Mission, playground: Playground, path: Path) -> Iterator[tuple[str, bytes]]:
    """The mission and the files that a run needs, by name in its folder; the playground has its pictures in it."""
    yield path.name, path.read_bytes()
    if Path(mission.playground).is_file():
        yield _name(mission.playground, path.parent), dumps(playground).encode()
    for file in mission.robots.values():
        if Path(file).is_file():
            yield _name(file, path.parent), Path(file).read_bytes()


def _name(file: str, folder: Path) -> str:
    """The name of a file in the folder of its mission, or a shipped name. Raises GradingError for one elsewhere."""
    path = Path(file)
    if not path.is_file():
        return file
    if not path.resolve().is_relative_to(folder.resolve()):
        raise GradingError(f"{file}: found a file outside of {folder}, expected the files of a mission below it")
    return path.resolve().relative_to(folder.resolve()).as_posix()
