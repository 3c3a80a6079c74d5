"""The suite that the browser tests of a worker share: before a test, its world becomes what the test asks for."""

from __future__ import annotations

import base64
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

from tests import patience
from tests.bridge.studio import Studio, set_and_answer
from tests.processes import SUITE, Process, free_port, wait_for_port
from thymio_sim_ros.bridge.protocol import messages as ms
from thymio_sim_ros.bridge.protocol.constants import JSON
from thymio_sim_ros.classroom.cdr import read_diagnostic, read_string

POLL_S = 0.005

SLOW_CLOCK = ("--ros-args", "-p", "clock_rate:=10.0")
"""The page draws with each message of the clock: fewer of them save a quarter of its processor time."""
NODES = {"/simulator", "/aseba_runtime", "/foxglove_bridge", "/web_ui"}
STATE = "/simulator/_state"
STATUS, IMU = "/_aseba/status", "/imu"
"""Ends of topics of a robot, from runtime and simulator; its others come and go with these."""
PLAYGROUND = "/simulator.playground"
PATH, SOURCE, NAME = (f"/aseba_runtime.script.{word}" for word in ("path", "source", "name"))
BEHAVIOUR = "/aseba_runtime.behaviour"
BETWEEN = "# between two tests"
"""A program that no test has, so that the next one starts although it was the last one."""


def until(condition: Callable[[], object], *, what: str) -> None:
    """Poll a condition often: the world is restarted before most tests."""
    patience.until(condition, lambda: what, every_s=POLL_S)


class SharedWorld:
    """A suite that starts with the first call. Each call restarts its world, whatever was done to it before.

    Everything that clients can change is a parameter of a node, or belongs to the world, which a reset creates anew:
    robots, poses, time, noise, buttons, pen, running programs with their variables.
    """

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._process: Process | None = None
        self._ports = (0, 0)
        self._first: dict[str, ms.Parameter] = {}
        """The parameters of all nodes as they were at the start of the suite, by name."""

    def __call__(self, playground: str | Path = "base", program: str | Path = "none", *, behaviour: str = "") -> str:
        """Restart the world with a playground and a program, each a shipped name or a file; the address of the page.

        `behaviour`: a built-in behavior that runs when the robots are switched on, in place of the program.
        """
        if self._process is None or not self._process.is_running:
            self._start()
        try:
            with self.client() as client:
                self._restart(client, playground, program, behaviour)
        except BaseException:
            self.end()  # the next test does not meet what could not be restarted
            raise
        return f"http://127.0.0.1:{self._ports[0]}/"

    def client(self) -> Studio:
        """A client of its bridge."""
        return Studio(self._ports[1], until)

    def rest(self) -> None:
        """Pause the world between two tests, so that it takes no processor time."""
        if self._process is not None and self._process.is_running:
            with self.client() as client:
                _call(client, "/simulator/pause", data=True)

    def end(self) -> None:
        """End the suite if it runs."""
        if self._process is not None:
            self._process.end()
        self._process = None

    def _start(self) -> None:
        self.end()
        self._ports = port, foxglove_port = free_port(), free_port()
        ports = ("--port", str(port), "--foxglove-port", str(foxglove_port))
        world = ("--playground", "base", "--program", "none")
        self._process = Process(self._folder, SUITE, "--portable", *ports, *world, *SLOW_CLOCK)
        for one in self._ports:
            wait_for_port(one)
        with self.client() as client:
            until(lambda: {name.partition(".")[0] for name in _parameters(client)} >= NODES, what="all nodes")
            self._first = _parameters(client)

    def _restart(self, client: Studio, playground: str | Path, program: str | Path, behaviour: str) -> None:
        wanted = {name: one.value for name, one in self._first.items()}
        wanted |= {PLAYGROUND: playground if isinstance(playground, str) else upload(playground)}
        if isinstance(program, Path):
            wanted |= {PATH: "", SOURCE: program.read_text(encoding="utf-8"), NAME: program.name}
        else:
            wanted |= {PATH: program, SOURCE: "", NAME: ""}
        if behaviour:
            wanted |= {BEHAVIOUR: behaviour}
        if _parameters(client)[PLAYGROUND].value == wanted[PLAYGROUND]:
            _call(client, "/simulator/reset")  # before programs start: it discards what they have commanded
        set_and_answer(client, ms.Parameter(SOURCE, BETWEEN))
        set_and_answer(client, *_differing(client, wanted))
        _call(client, "/simulator/pause", data=False)
        left = _differing(client, wanted)
        assert not left, f"parameters that cannot be set: {left}"
        self._wait(client, Path(playground).stem, Path(behaviour or program).stem)

    def _wait(self, client: Studio, playground: str, program: str) -> None:
        """Wait until the world runs and all its robots run the program; names are without the ends of files."""
        topics: dict[int, str] = {}
        state: dict[str, Any] = {}
        programs: dict[str, dict[str, str]] = {}

        def watch(topic: str) -> None:
            if topic in client.channels and (number := client.channels[topic].id) not in topics:
                topics[number] = topic
                client.subscribe(number, topic)

        def is_ready() -> bool:
            client.read()
            watch(STATE)
            for message in client.received:
                if isinstance(message, ms.MessageData):
                    topic = topics[message.subscription_id]
                    if topic == STATE:
                        state.update(json.loads(read_string(message.payload)))
                    else:
                        programs[topic] = read_diagnostic(message.payload)
            client.received.clear()
            if not state or Path(state["playground"]).stem != playground or state["paused"]:
                return False
            robots = {f"/{robot['name']}".rstrip("/") for robot in state["robots"]}
            for end in (STATUS, IMU):
                if robots != {topic.removesuffix(end) for topic in client.channels if topic.endswith(end)}:
                    return False
            for robot in robots:
                watch(robot + STATUS)  # not of a robot that is gone: a subscription keeps its topic
            return all(
                topic in programs
                and programs[topic]["state"] == "running"
                and Path(programs[topic]["program"]).stem == program
                for topic in (robot + STATUS for robot in robots)
            )

        try:
            until(is_ready, what=f"the playground {playground} with {program}")
        except AssertionError as error:
            raise AssertionError(f"{error}; found {state}, {programs}") from None


def upload(path: Path) -> str:
    """A file as a value of the parameter `playground`."""
    return f"data:;name={path.name};base64,{base64.b64encode(path.read_bytes()).decode()}"


def _parameters(client: Studio) -> dict[str, ms.Parameter]:
    client.send(ms.GetParameters((), "all"))
    values = client.next(ms.ParameterValues, lambda answer: answer.id == "all")
    return {one.name: one for one in values.parameters}


def _differing(client: Studio, wanted: dict[str, Any]) -> list[ms.Parameter]:
    """The parameters that have other values, with the wanted ones; those that are not listed have none.

    These came with a robot or a constant. The name of a program comes before its text, as the runtime needs it, and the
    behavior, which new programs end, last.
    """
    changed = []
    for name, one in _parameters(client).items():
        value = wanted[name] if name in wanted else {str: "", tuple: ()}.get(type(one.value))
        if (one.value or None) != (value or None):  # an empty list may have none
            changed.append(ms.Parameter(name, value, one.type))
    return sorted(changed, key=lambda one: (one.name == BEHAVIOUR, not one.name.endswith("script.name")))


def _call(client: Studio, name: str, **request: Any) -> None:
    service = client.service(name).id
    client.send(ms.ServiceRequest(service, 1, JSON, json.dumps(request).encode()))
    answer = client.next(ms.ServiceResponse, lambda answer: answer.service_id == service)
    assert json.loads(answer.payload)["success"], answer
