"""Programs without an end on a class of robots: what still answers, and how fast.

    PYTHONPATH=. python benchmarks/aseba_runaway.py [--robots 20] [--only WORD] [--port 9210] [--json FILE]

Every program of `tests/data/runaway` runs on all robots of a `thymio-sim` of its own, with page and bridge. Then, in
this order: `aseba/get_variables`, the program of one robot set by a parameter, a parameter by the bridge, and
`aseba/stop` of five robots are called, each timed; "acts" is the time until `_aseba/status` says that the robot has
stopped. "factor" is the simulated time per second of wall time meanwhile, "status" whether a robot says that its
program is too fast. Last is the time from Ctrl-C to the end of the process. Limits: 1 s for each answer, 5 s for the
end; the exit code tells.
"""

from __future__ import annotations

import argparse
import json
import os
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from dataclasses import asdict, dataclass, field
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

from benchmarks.ros_load import playground
from thymio_sim_ros.ros.interface import qos

PROGRAMS = Path(__file__).resolve().parent.parent / "tests" / "data" / "runaway"
MAIN = "import sys; from thymio_sim_ros.cli.main import main; sys.exit(main())"
START_S, RUN_S, ANSWER_S, END_S = 90.0, 4.0, 30.0, 30.0
MOST_ANSWER_S, MOST_END_S = 1.0, 5.0
STOPPED = 5


@dataclass
class Figures:
    """Seconds; `stop` and `acts` are the longest of `STOPPED` robots."""

    program: str
    start: float = 0.0
    get: float = 0.0
    source: float = 0.0
    bridge: float = 0.0
    stop: float = 0.0
    acts: float = 0.0
    end: float = 0.0
    factor: float = 0.0
    status: str = ""
    code: int | None = None
    errors: list[str] = field(default_factory=list)

    @property
    def is_good(self) -> bool:
        """Whether all limits are kept."""
        answers = (self.get, self.source, self.bridge, self.stop, self.acts)
        return max(answers) <= MOST_ANSWER_S and self.end <= MOST_END_S and self.code == 0 and not self.errors


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


def measure(program: Path, robots: int, port: int, folder: Path) -> Figures:
    """Run one program on all robots, and everything that is asked of them meanwhile."""
    figures = Figures(program.stem)
    world = folder / "class.json"
    world.write_text(playground(robots))
    log = folder / f"{program.stem}.log"
    ports = ["--port", str(port), "--foxglove-port", str(port + 1)]
    folders = ["--card", str(folder / program.stem / "card"), "--settings", str(folder / program.stem / "settings")]
    command = [sys.executable, "-c", MAIN, "--playground", str(world), "--program", str(program), *ports, *folders]
    begin = time.monotonic()
    with log.open("w") as output:
        process = subprocess.Popen(command, stdout=output, stderr=subprocess.STDOUT, start_new_session=True)
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
        figures.factor = -simulated
        waited = pupils.until(lambda: False, RUN_S)
        figures.factor = (pupils.now_s - simulated) / waited
        figures.status = next((text for name in pupils.stops if (text := pupils.state(name, "overload"))), "")
        request = GetParameters.Request(names=["motor.left.target"])
        figures.get = max(pupils.call(pupils.gets[f"r{number}"], request) for number in range(min(robots, STOPPED)))
        source = Parameter("robots.r0.script.source", value="motor.left.target = 7").to_parameter_msg()
        figures.source = pupils.call(pupils.set, SetParametersAtomically.Request(parameters=[source]))
        figures.bridge = ask_bridge(port + 1)
        for number in range(1, min(robots, STOPPED + 1)):
            name = f"r{number}"
            begin = time.monotonic()
            figures.stop = max(figures.stop, pupils.call(pupils.stops[name], Trigger.Request()))
            pupils.until(lambda name=name: pupils.state(name, "state") == "stopped", ANSWER_S)  # type: ignore[misc]
            figures.acts = max(figures.acts, time.monotonic() - begin)
        begin = time.monotonic()
        os.killpg(process.pid, signal.SIGINT)
        try:
            figures.code = process.wait(END_S)
        except subprocess.TimeoutExpired:
            figures.errors.append("Ctrl-C is dead")
        figures.end = time.monotonic() - begin
    finally:
        pupils.close()
        if process.poll() is None:
            os.killpg(process.pid, signal.SIGKILL)
            process.wait()
    figures.errors += [line for line in log.read_text().splitlines() if "Traceback" in line or "fault of ours" in line]
    return figures


def main() -> int:
    """The command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--robots", type=int, default=20)
    parser.add_argument("--only", default="")
    parser.add_argument("--port", type=int, default=9210)
    parser.add_argument("--json", type=Path)
    options = parser.parse_args()
    found = []
    heads = ("get", "source", "bridge", "stop", "acts", "end", "factor", "start")
    print(f"{'program':16s}" + "".join(f"{head:>8s}" for head in heads) + "  status")
    for program in sorted(path for path in PROGRAMS.glob("*.aesl") if options.only in path.stem):
        with tempfile.TemporaryDirectory() as folder:
            figures = measure(program, options.robots, options.port, Path(folder))
        found.append(figures)
        cells = "".join(f"{getattr(figures, head):8.2f}" for head in heads)
        mark = "" if figures.is_good else f"  TOO SLOW {figures.code} {'; '.join(figures.errors[:3])}"
        print(f"{figures.program:16s}{cells}  {'says' if figures.status else '-'}{mark}", flush=True)
    if options.json:
        options.json.write_text(json.dumps([asdict(figures) for figures in found], indent=1))
    return 0 if all(figures.is_good for figures in found) else 1


if __name__ == "__main__":
    sys.exit(main())
