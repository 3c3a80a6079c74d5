"""Programs without an end on a class of robots: what still answers, and how fast.

Every program of `tests/data/runaway` runs on all robots of a `thymio-sim` of its own, with page and bridge. Then, in
this order: `aseba/get_variables`, the program of one robot set by a parameter, a parameter by the bridge, and
`aseba/stop` of five robots are called, each timed; "acts" is the time until `_aseba/status` says that the robot has
stopped. "factor" is the simulated time per second of wall time meanwhile, "reported" whether a robot reports that its
program is too fast. "end" is the time from Ctrl-C to the end of the process. Needs ROS and the built page.
"""

from __future__ import annotations

import argparse
import json
import signal
import subprocess
import tempfile
import time
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import rclpy
from diagnostic_msgs.msg import DiagnosticStatus
from rcl_interfaces.srv import GetParameters, SetParametersAtomically
from rclpy.context import Context
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.parameter import Parameter
from rosgraph_msgs.msg import Clock
from std_srvs.srv import Trigger
from websockets.sync.client import connect

from benchmarks.lib.processes import suite
from benchmarks.lib.report import ROOT, Goal, Report, Table
from benchmarks.lib.scenes import grid
from thymio_sim_ros.ros.interface import qos

QUICK = {"robots": 2, "only": "deques", "seconds": 0.5}
PROGRAMS = ROOT / "tests" / "data" / "runaway"
START_S, ANSWER_S = 90.0, 30.0
MOST_ANSWER_S, MOST_END_S, LEAST_FACTOR = 1.0, 5.0, 0.95
GAP_M = 0.4
STOPPED = 5


@dataclass
class Figures:
    """Figures of one program, in s; `stop` and `acts` are the longest of `STOPPED` robots."""

    program: str
    start: float = 0.0
    get: float = 0.0
    source: float = 0.0
    bridge: float = 0.0
    stop: float = 0.0
    acts: float = 0.0
    end: float = 0.0
    factor: float = 0.0
    reported: bool = False


class Class:
    """A client in ROS of the robots r0, r1, …"""

    def __init__(self, robots: int) -> None:
        self._context = Context()
        rclpy.init(context=self._context)
        self.node = Node("teacher", context=self._context, enable_rosout=False)
        self._executor = SingleThreadedExecutor(context=self._context)
        self._executor.add_node(self.node)
        self.states: dict[str, DiagnosticStatus] = {}
        self.now_s = 0.0
        self.node.create_subscription(Clock, "/clock", self._on_clock, qos.CLOCK)
        names = [f"r{number}" for number in range(robots)]
        self.stops = {name: self.node.create_client(Trigger, f"/{name}/aseba/stop") for name in names}
        self.gets = {name: self.node.create_client(GetParameters, f"/{name}/aseba/get_variables") for name in names}
        self.set = self.node.create_client(SetParametersAtomically, "/aseba_runtime/set_parameters_atomically")
        for name in names:
            self.node.create_subscription(
                DiagnosticStatus, f"/{name}/_aseba/status", self._keeper(name), qos.TRANSIENT_LOCAL
            )

    def until(self, condition: Callable[[], bool], seconds: float) -> float:
        """Spin until a condition holds; how long it took, `seconds` if it did not hold by then."""
        begin = time.monotonic()
        while not condition() and time.monotonic() - begin < seconds:
            self._executor.spin_once(timeout_sec=0.05)
        return time.monotonic() - begin

    def call(self, client: Any, request: Any) -> float:
        """Call a service; the seconds until its answer."""
        future = client.call_async(request)
        return self.until(future.done, ANSWER_S)

    def state(self, name: str, key: str) -> str:
        """A value of a robot's status."""
        status = self.states.get(name)
        return "" if status is None else {item.key: item.value for item in status.values}.get(key, "")

    def is_stopped(self, name: str) -> bool:
        """Whether the program of a robot is stopped."""
        return self.state(name, "state") == "stopped"

    def close(self) -> None:
        """Leave ROS."""
        self._executor.shutdown()
        self.node.destroy_node()
        self._context.try_shutdown()

    def _on_clock(self, message: Clock) -> None:
        self.now_s = message.clock.sec + message.clock.nanosec / 1e9

    def _keeper(self, name: str) -> Callable[[DiagnosticStatus], None]:
        return lambda message: self.states.update({name: message})


def ask_bridge(port: int) -> float:
    """Seconds until the bridge has answered a new client that asks for a parameter."""
    begin = time.monotonic()
    with connect(f"ws://localhost:{port}", subprotocols=["foxglove.websocket.v1"], max_size=None) as client:  # type: ignore[list-item]
        client.send(json.dumps({"op": "getParameters", "parameterNames": ["/simulator.seed"], "id": "1"}))
        while time.monotonic() - begin < ANSWER_S:
            message = client.recv(timeout=ANSWER_S)
            if isinstance(message, str) and json.loads(message).get("op") == "parameterValues":
                break
    return time.monotonic() - begin


def run(program: Path, options: argparse.Namespace, folder: Path) -> Figures:
    """Run one program on all robots, and everything that is requested meanwhile. Raises RuntimeError for a fault."""
    figures = Figures(program.stem)
    robots = options.robots
    world = folder / "class.json"
    world.write_text(grid(robots, GAP_M))
    folders = ["--card", str(folder / "card"), "--settings", str(folder / "settings")]
    begin = time.monotonic()
    with suite("--playground", str(world), "--program", str(program), *folders) as running:
        pupils = Class(robots)
        try:
            pupils.until(
                lambda: (
                    len(pupils.states) == robots
                    and pupils.now_s > 0.0
                    and all(client.service_is_ready() for client in (*pupils.stops.values(), *pupils.gets.values()))
                ),
                START_S,
            )
            figures.start = time.monotonic() - begin
            simulated = pupils.now_s
            waited = pupils.until(lambda: False, options.seconds)
            figures.factor = (pupils.now_s - simulated) / waited
            figures.reported = any(pupils.state(name, "overload") for name in pupils.stops)
            request = GetParameters.Request(names=["motor.left.target"])
            figures.get = max(pupils.call(pupils.gets[f"r{number}"], request) for number in range(min(robots, STOPPED)))
            source = Parameter("robots.r0.script.source", value="motor.left.target = 7").to_parameter_msg()
            figures.source = pupils.call(pupils.set, SetParametersAtomically.Request(parameters=[source]))
            figures.bridge = ask_bridge(running.bridge_port)
            for number in range(1, min(robots, STOPPED + 1)):
                name = f"r{number}"
                begin = time.monotonic()
                figures.stop = max(figures.stop, pupils.call(pupils.stops[name], Trigger.Request()))
                pupils.until(partial(pupils.is_stopped, name), ANSWER_S)
                figures.acts = max(figures.acts, time.monotonic() - begin)
            begin = time.monotonic()
            running.process.signal(signal.SIGINT)
            try:
                code = running.process.wait()
            except subprocess.TimeoutExpired:
                raise RuntimeError(f"{program.stem}: Ctrl-C has no effect") from None
            figures.end = time.monotonic() - begin
        finally:
            pupils.close()
        faults = [
            line for line in running.process.output.splitlines() if "Traceback" in line or "internal error" in line
        ]
    if code or faults:
        raise RuntimeError(f"{program.stem}: exit code {code} {'; '.join(faults)}")
    return figures


def add_options(parser: argparse.ArgumentParser) -> None:
    """Add options."""
    parser.add_argument("--robots", type=int, default=20, help="robots that run each program")
    parser.add_argument("--only", default="", metavar="WORD", help="programs with this in their names")
    parser.add_argument("--seconds", type=float, default=4.0, help="for which the programs run before the requests")


def measure(options: argparse.Namespace) -> Report:
    """Measure all programs."""
    found = []
    for program in sorted(path for path in PROGRAMS.glob("*.aesl") if options.only in path.stem):
        with tempfile.TemporaryDirectory() as folder:
            found.append(run(program, options, Path(folder)))
    heads = ("get", "source", "bridge", "stop", "acts", "end", "start", "factor")
    rows = [
        [f"`{one.program}`", *(getattr(one, head) for head in heads), "yes" if one.reported else "no"] for one in found
    ]
    answers = [max(one.get, one.source, one.bridge, one.stop, one.acts) for one in found]
    goals = [
        Goal("slowest answer", MOST_ANSWER_S, max(answers), "s"),
        Goal("slowest end after Ctrl-C", MOST_END_S, max(one.end for one in found), "s"),
        Goal("slowest world", LEAST_FACTOR, min(one.factor for one in found), "of real time", is_least=True),
    ]
    return Report([Table(["seconds", *heads, "reported"], rows)], goals)
