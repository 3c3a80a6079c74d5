"""The mission that is open: starts it in the live world, judges its tries, and publishes what they reach."""

from __future__ import annotations

import base64
import binascii
import contextlib
import hashlib
import json
import re
import tempfile
import time
import urllib.parse
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from rclpy.node import Node
from std_msgs.msg import String

from thymio_sim_ros.device.programs.program import ProgramError, ThymioProgram
from thymio_sim_ros.engine.inputs import Controlled
from thymio_sim_ros.files.loading import load_playground
from thymio_sim_ros.files.resources import ResourceError
from thymio_sim_ros.missions import Mission, MissionError, load_mission
from thymio_sim_ros.missions.check import is_node, program_runs
from thymio_sim_ros.missions.description import described, progress
from thymio_sim_ros.missions.documents import mission_after
from thymio_sim_ros.missions.live import LiveMission, check_fits
from thymio_sim_ros.missions.shipped import find_mission, shipped
from thymio_sim_ros.missions.trial import judged_run, programs_of_others
from thymio_sim_ros.ros.rclpy_ext.local_node import LocalNode
from thymio_sim_ros.ros.simulator.parameter_callbacks import ParameterCallbacks
from thymio_sim_ros.ros.simulator.robot_endpoint_set import RobotEndpointSet
from thymio_sim_ros.ros.simulator.world_runner import WorldRunner
from thymio_sim_ros.ros.simulator.world_topics import TOPICS
from thymio_sim_ros.sim.model.fields import FieldError
from thymio_sim_ros.sim.playground import writer
from thymio_sim_ros.sim.playground.reader import Playground, PlaygroundError

__all__ = ["MissionEndpoints"]

_UPLOAD = re.compile(r"data:[^;,]*(?:;name=(?P<name>[^;,]*))?;base64,(?P<content>.*)", re.DOTALL)
_MISSION, _TRY = "~/_mission", "~/_mission/try"
MEASURED_GAP_NS = 250_000_000
"""Shortest wall time between two messages about quantities, such as the way that the robot has driven."""
_FILE = "the file of a mission as data:;name=my.json;base64,..."


@dataclass(frozen=True, slots=True)
class _Opened:
    """A mission, the name of its file, what pages get of it, and the programs of its other robots."""

    file: str
    mission: Mission
    content: dict[str, Any]
    programs: Mapping[str, ThymioProgram]


class MissionEndpoints:
    """One mission at a time, or none. Only for the thread of the simulator's executor."""

    def __init__(
        self,
        node: Node | LocalNode,
        runner: WorldRunner,
        robots: RobotEndpointSet,
        parameters: ParameterCallbacks,
    ) -> None:
        self._runner, self._robots, self._parameters = runner, robots, parameters
        self._publishers = {
            name: node.create_publisher(TOPICS[name].type, name, TOPICS[name].profile) for name in (_MISSION, _TRY)
        }
        self.live: LiveMission | None = None
        self._name = self._digest = ""
        self._shown: tuple[Any, ...] = ()
        """What the last message about the try was made of."""
        self._published_ns = 0
        """Wall time of that message."""
        runner.before_tick.append(self._begin_tick)
        runner.on_tick.append(self._judge_tick)
        runner.on_engine.append(self._judge_other_engine)
        self._publish_mission(None)
        self._publish_try()

    def start(self, name: str, value: str) -> None:
        """Load a mission: the shipped one of this name, or a file that a client has sent.

        The programs of all robots stop; a try begins when one runs. Raises MissionError, ValueError with a sentence;
        the mission before then goes on.
        """
        if self._runner.is_replaying:
            raise ValueError("a run is replayed: load a playground first")
        try:
            opened = self._runner.run_beside(lambda: _open(name, value))
        except (ResourceError, PlaygroundError, ProgramError, OSError) as error:
            raise ValueError(str(error)) from error
        mission = opened.mission
        if problem := self._parameters.load_playground(mission.playground):
            raise ValueError(problem)
        self.end()
        try:
            self.live = LiveMission(mission, self._runner.engine, self._runner.reset)
        except FieldError as error:
            raise MissionError(opened.file, error) from error
        self._name, self._digest = _names(opened.file, name, value)
        self._load_programs(opened.programs)
        robot = self._robots.names[self.live.robot].name
        following = Path(mission.next).stem if mission.next else mission_after(self._name)
        self._publish_mission(opened.content | {"name": self._name, "robot": robot, "next": following})
        self._publish_try()

    def check(self, name: str, value: str) -> str:
        """Run the solutions of a file that a client has sent, but no ROS nodes. The world goes on meanwhile.

        Returns those that do not get all stars as JSON: language → which stars. Raises MissionError, ValueError.
        """
        try:
            return self._runner.run_beside(lambda: _failing(name, value))
        except (ResourceError, PlaygroundError, ProgramError, OSError) as error:
            raise ValueError(str(error)) from error

    def end(self) -> None:
        """Judge no more."""
        if self.live is None:
            return
        self.live.close()
        self.live = None
        self._publish_mission(None)
        self._publish_try()

    def _begin_tick(self) -> None:
        """Begin a try if one is due."""
        if self.live is not None:
            self.live.before_tick()

    def _judge_tick(self) -> None:
        """Judge the tick, and publish what has changed."""
        if self.live is not None:
            self.live.after_tick()
            self._publish_if_changed()

    def _judge_other_engine(self) -> None:
        """Judge in the new world if it is that of the mission, as with another seed; else the mission has ended."""
        live, engine = self.live, self._runner.engine
        if live is None:
            return
        if live.engine.world.playground != engine.world.playground:
            self.end()
            return
        live.close()
        self.live = LiveMission(live.mission, engine, self._runner.reset)
        self._publish_try()

    def _load_programs(self, programs: Mapping[str, ThymioProgram]) -> None:
        """Load the programs of other robots, which begin with a try; those that ran before must not drive here."""
        engine = self._runner.engine
        for robot in engine.hosts:
            if robot in programs:
                engine.load(robot, programs[robot])
            engine.apply(Controlled(robot, "stop"))
        self._runner.on_reset()

    def _publish_if_changed(self) -> None:
        if self.live is None:
            return
        wall_ns = time.monotonic_ns()
        is_due = self.live.is_running and wall_ns - self._published_ns >= MEASURED_GAP_NS
        if _seen(self.live) != self._shown or (is_due and self._publishers[_TRY].get_subscription_count()):
            self._publish_try()

    def _publish_try(self) -> None:
        shown = None
        if self.live is not None:
            self._shown, self._published_ns = _seen(self.live), time.monotonic_ns()
            shown = progress(self.live) | {"mission": self._name, "file": self._digest}
        self._publishers[_TRY].publish(String(data=json.dumps(shown)))

    def _publish_mission(self, content: dict[str, Any] | None) -> None:
        self._publishers[_MISSION].publish(String(data=json.dumps(content)))


def _names(file: str, name: str, value: str) -> tuple[str, str]:
    """The name of a mission, and the SHA-256 of the file that a client has sent, which is "" for others.

    A file with the name of a shipped mission keeps its ending: the stars of one are not those of the other.
    """
    upload = _UPLOAD.fullmatch(value)
    if upload is None:
        return name, ""
    stem = Path(file).stem
    is_taken = any(each.name == stem for step in shipped() for each in step.missions)
    return file if is_taken else stem, hashlib.sha256(base64.b64decode(upload["content"])).hexdigest()


def _seen(live: LiveMission) -> tuple[Any, ...]:
    """What a message about a try is made of, but for time and quantities."""
    judge = live.judge
    reached = () if judge is None else (judge.is_over, judge.done)
    return (live.tries, live.trouble, live.is_helped, *reached)


def _open(name: str, value: str) -> _Opened:
    if not value:
        path = find_mission(name)
        mission = load_mission(path)
        return _opened(path, mission, load_playground(mission.playground)[1])
    with _uploaded(name, value) as (path, mission):
        _, playground = load_playground(mission.playground)
        if Path(mission.playground).suffix:  # a file of this folder, which the simulator's parameter shall not name
            mission = replace(mission, playground=writer.dumps(playground))
        return _opened(path, mission, playground)


@contextlib.contextmanager
def _uploaded(name: str, value: str) -> Iterator[tuple[Path, Mission]]:
    """The mission of a client's file, in a folder that is there meanwhile."""
    with tempfile.TemporaryDirectory(prefix="mission-") as temporary:
        folder = Path(temporary)
        path = _unpacked(name, value, folder)
        try:
            mission = load_mission(path, folder=folder)
        except MissionError as error:
            raise MissionError(path.name, FieldError(error.key, error.found, error.expected)) from error
        yield path, mission


def _failing(name: str, value: str) -> str:
    """The solutions of a client's mission that do not get all stars, as JSON."""
    with _uploaded(name, value) as (path, mission):
        try:
            runs = program_runs(
                mission, lambda program: None if is_node(program) else judged_run(mission, program), ("solutions",)
            )
            return json.dumps(
                {run.language: list(run.verdict.stars) for run in runs if run.verdict is not None and run.mistake}
            )
        except FieldError as error:
            raise MissionError(path.name, error) from error


def _opened(path: Path, mission: Mission, playground: Playground) -> _Opened:
    """What is needed to start it. All that the world would refuse is refused here: the mission before goes on."""
    try:
        programs = programs_of_others(mission, playground)
        check_fits(mission, playground)
        return _Opened(path.name, mission, described(mission), programs)
    except FieldError as error:
        raise MissionError(path.name, error) from error


def _unpacked(name: str, value: str, folder: Path) -> Path:
    upload = _UPLOAD.fullmatch(value)
    if upload is None:
        raise ValueError(f"{name}: found {value[:40]!r}, expected {_FILE}")
    try:
        data = base64.b64decode(upload["content"], validate=True)
    except (binascii.Error, ValueError) as error:
        raise ValueError(f"{name}: found characters that are not base64, expected {_FILE}") from error
    path = folder / (Path(urllib.parse.unquote(upload["name"] or "")).name or "mission.json")
    path.write_bytes(data)
    return path
