"""A pupil with the page, for `soak.py`: what the page of a visitor requests, without drawing it."""

from __future__ import annotations

import json
import random
import re
import time
import urllib.request
from collections.abc import Callable

from benchmarks.lib.soak_visits import ANSWER_S, PROGRAM, RUDE, Lesson, leave_rudely
from tests.bridge.studio import Studio
from thymio_sim_ros.bridge.protocol import messages as ms
from thymio_sim_ros.bridge.protocol.constants import JSON

__all__ = ["WORLD", "Pupil", "visit_page"]

WORLD, FIRST_PROGRAM = "two_robots", "line_follower"
"""Playground and program at rest."""
PLAYGROUNDS = (WORLD, WORLD, "line", "obstacle", "maze", "arena", "desk")
PROGRAMS = (FIRST_PROGRAM, "explorer", "friendly", "menu", "welcome", "none")
ASSET = re.compile(r'(?:src|href)="\.?/?([\w./-]+)"')
WATCHED = ("/simulator/_state", "/_markers", "/_markers/objects", "/tf", "/tf_static", "/diagnostics")
OF_A_ROBOT = ("_aseba/status", "_aseba/variables", "_aseba/target", "_led/state", "_raw/proximity", "_pen/trail")


class Pupil:
    """A connection to the bridge; its requests wait for their answers."""

    def __init__(self, studio: Studio) -> None:
        self.studio = studio
        self._calls = 0

    def call(self, name: str, **fields: object) -> bool:
        """Call a service; return False if it is not there, or is gone before it answers."""
        service = self.studio.read().services.get(name)
        if service is None:
            return False
        self._calls += 1
        self.studio.send(ms.ServiceRequest(service.id, self._calls, JSON, json.dumps(fields).encode()))
        kinds = (ms.ServiceResponse, ms.ServiceCallFailure)
        answer = self._wait(lambda one: isinstance(one, kinds) and one.call_id == self._calls, name)  # type: ignore[attr-defined]
        return isinstance(answer, ms.ServiceResponse)

    def set(self, name: str, value: ms.ParameterValue) -> None:
        """Set a parameter; a rejected value is answered by a status beside the current one."""
        self._calls += 1
        label = f"set {self._calls}"
        self.studio.send(ms.SetParameters((ms.Parameter(name, value),), label))
        self._wait(lambda one: isinstance(one, ms.ParameterValues) and one.id == label, name)

    def robots(self) -> list[str]:
        """Prefixes of the robots' topics: "/" for a single one, else such as "/red/"."""
        ends = "_aseba/status"
        return sorted(topic.removesuffix(ends) for topic in self.studio.read().channels if topic.endswith(ends))

    def _wait(self, accept: Callable[[ms.ServerMessage], bool], what: str) -> ms.ServerMessage:
        deadline = time.monotonic() + ANSWER_S
        while time.monotonic() < deadline:
            for message in self.studio.read().received:
                if accept(message):
                    self.studio.received.clear()
                    return message
            self.studio.received.clear()
            time.sleep(0.02)
        raise TimeoutError(f"no answer to {what} within {ANSWER_S} s")


def until(condition: Callable[[], object], what: str = "") -> None:
    """Poll a condition; raises TimeoutError after `ANSWER_S`."""
    deadline = time.monotonic() + ANSWER_S
    while not condition():
        if time.monotonic() > deadline:
            raise TimeoutError(f"no {what} within {ANSWER_S} s")
        time.sleep(0.02)


def visit_page(lesson: Lesson, dice: random.Random) -> None:
    """Load the page with its files, connect, do some of `ACTIONS`, and leave."""
    base = f"http://127.0.0.1:{lesson.doors.page}/"
    for path in ["", *ASSET.findall(fetch(base)), "shapes.json"]:
        fetch(base + path)
    studio = Studio(lesson.doors.bridge, until)
    with studio:
        pupil = Pupil(studio)
        until(pupil.robots, "robots")
        topics = [*WATCHED, *(robot + topic for robot in pupil.robots() for topic in OF_A_ROBOT)]
        channels = [studio.channels[topic].id for topic in topics if topic in studio.channels]
        studio.send(ms.Subscribe(tuple(ms.Subscription(number, number) for number in channels)))
        studio.send(ms.SubscribeParameterUpdates(("/aseba_runtime.script.source", "/simulator.playground")))
        for _ in range(dice.randint(4, 12)):
            if lesson.is_over.wait(dice.uniform(0.3, 1.5)):
                break
            action = dice.choice(ACTIONS)
            action(pupil, dice)
            lesson.did(f"page: {action.__name__}")
        if dice.random() < RUDE:
            leave_rudely(studio._connection.socket)
            lesson.did("page: leave rudely")


def fetch(address: str) -> str:
    """Read a file of the page's server."""
    with urllib.request.urlopen(address, timeout=ANSWER_S) as answer:
        body: bytes = answer.read()
        return body.decode("utf-8", "replace")


def load(pupil: Pupil, dice: random.Random) -> None:
    """Start one of the built-in programs."""
    pupil.set("/aseba_runtime.script.path", dice.choice(PROGRAMS))


def edit(pupil: Pupil, dice: random.Random) -> None:
    """Change the text of a program as if line by line; one of three does not compile at first."""
    text = PROGRAM.format(dice.randint(2, 300))
    if dice.random() < 0.3:
        pupil.set("/aseba_runtime.script.source", text + "motor.left.targt = 1\n")
    pupil.set("/aseba_runtime.script.source", text)


def run_and_stop(pupil: Pupil, dice: random.Random) -> None:
    """Press the buttons of the editor."""
    for verb in dice.sample(["run", "stop", "reset", "run"], 3):
        pupil.call(f"{robot_of(pupil, dice)}aseba/{verb}")


def debug(pupil: Pupil, dice: random.Random) -> None:
    """Stop at a breakpoint, step by lines and instructions, continue."""
    robot = robot_of(pupil, dice)
    pupil.set("/aseba_runtime.breakpoints", [4])
    for verb in ("pause", "step_line", "step", "step_line", "run"):
        pupil.call(f"{robot}aseba/{verb}")
    pupil.set("/aseba_runtime.breakpoints", [])
    pupil.call(f"{robot}aseba/run")


def change_playground(pupil: Pupil, dice: random.Random) -> None:
    """Choose another playground."""
    pupil.set("/simulator.playground", dice.choice(PLAYGROUNDS))


def reset(pupil: Pupil, _dice: random.Random) -> None:
    """Restart the world."""
    pupil.call("/simulator/reset")


def pause(pupil: Pupil, _dice: random.Random) -> None:
    """Pause, step, and resume."""
    pupil.call("/simulator/pause", data=True)
    pupil.call("/simulator/step")
    pupil.call("/simulator/pause", data=False)


def spawn_and_remove(pupil: Pupil, dice: random.Random) -> None:
    """Add a robot, move it, and remove it."""
    name = f"guest_{dice.randrange(4)}"
    value = {"type": 8, "double_array_value": [dice.uniform(-0.3, 0.3), dice.uniform(-0.3, 0.3), 0.0]}
    for verb in ("spawn", "set_poses", "remove"):
        pupil.call(f"/simulator/{verb}", parameters=[{"name": name, "value": value}])


def drive(pupil: Pupil, dice: random.Random) -> None:
    """Drive with the keys of the page."""
    topic = f"{robot_of(pupil, dice)}cmd_vel"
    number = dice.randrange(1_000_000)
    pupil.studio.send(ms.ClientAdvertise((ms.ClientChannel(number, topic, JSON, "geometry_msgs/msg/Twist"),)))
    for _ in range(5):
        twist = {"linear": {"x": dice.uniform(-0.1, 0.1)}, "angular": {"z": dice.uniform(-1.0, 1.0)}}
        pupil.studio.send(ms.ClientMessageData(number, json.dumps(twist).encode()))
        time.sleep(0.05)
    pupil.studio.send(ms.ClientUnadvertise((number,)))


def robot_of(pupil: Pupil, dice: random.Random) -> str:
    """Choose a robot."""
    return dice.choice(pupil.robots() or ["/"])


ACTIONS = (
    *(load, edit, edit, edit, run_and_stop, run_and_stop, debug, debug, drive, drive),
    *(change_playground, reset, pause, spawn_and_remove),
)
