"""CPU time of the simulator node while robots drive in circles: a process of its own, subscribers in another.

Percentages are CPU seconds of the node's process, with all threads of DDS, for each simulated second, of one core: the
median of the rounds, and the best. The factor is what `/diagnostics` reported as achieved, on average; below 1 time
was lost, by the simulator or by other work. "start" is the CPU time until all robots listen. Other work on the machine
makes everything slower, by its use of caches alone two to three times.

"floor" is what a bare loop takes that sends constant bytes on as many topics at the same rate to the same listener,
right after: the rest is the simulator's own.

"all topics" are all of every robot, /tf and /clock; "13 topics" those of docs/spec/ros-packaging.md section 9: nine
Range, odometry, transforms, joints, Imu. All periodic topics are sent at the scene's rate, the clock too. Needs ROS.
"""

from __future__ import annotations

import argparse
import contextlib
import cProfile
import signal
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import rclpy
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import Twist, Vector3
from rclpy.context import Context
from rclpy.node import Node
from rclpy.serialization import serialize_message
from rclpy.signals import SignalHandlerOptions
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import Range

from benchmarks.lib.processes import child, cpu_s, status_mb
from benchmarks.lib.report import Cell, Goal, Report, Table
from benchmarks.lib.scenes import grid
from thymio_sim_ros.ros import generate_ros_docs
from thymio_sim_ros.ros.compat import dds_profile, tf2_messages
from thymio_sim_ros.ros.interface import qos, sensor_topics
from thymio_sim_ros.ros.rclpy_ext.node_runner import make_executor, run_node
from thymio_sim_ros.ros.simulator.node import Simulator

QUICK = {"seconds": 1.0, "rounds": 1, "warm_up": 0.5, "only": "1 robot, 10 Hz, 13"}
GAP_M = 0.4
SPEED_M_S, TURN_RAD_S = 0.05, 1.0
START_S = 120.0
QUIET = ["--ros-args", "--log-level", "warn"]
NODE = "import sys; from thymio_sim_ros.ros.simulator.node import main; sys.exit(main())"
PROFILED = "import sys; from benchmarks.ros_load import profiled; profiled(sys.argv[1], sys.argv[2:])"
SENDER = "import sys; from benchmarks.ros_load import send; send(*sys.argv[1:])"
LISTENER = "import sys; from benchmarks.ros_load import listen; listen(sys.argv[1:])"


@dataclass(frozen=True)
class Scene:
    """How many robots, how often all that is regular is sent (0: as the robot), what is heard, and what is allowed."""

    robots: int
    rate_hz: float
    heard: str
    most_percent: float | None = None

    @property
    def name(self) -> str:
        """For a table."""
        rate = f"{self.rate_hz:g} Hz" if self.rate_hz else "as on the robot"
        return f"{self.robots} robot{'s' * (self.robots > 1)}, {rate}, {self.heard}"


NOTHING, THIRTEEN, ALL = "no subscriber", "13 topics", "all topics"

SCENES = (
    Scene(1, 10.0, ALL),
    Scene(1, 10.0, THIRTEEN, 1.5),
    Scene(20, 10.0, NOTHING, 6.0),
    Scene(20, 10.0, ALL),
    Scene(20, 10.0, THIRTEEN, 10.0),
    Scene(20, 50.0, ALL),
    Scene(20, 50.0, THIRTEEN, 40.0),
    Scene(100, 10.0, NOTHING, 30.0),
    Scene(100, 10.0, THIRTEEN),
    Scene(1, 0.0, NOTHING),
    Scene(1, 0.0, ALL),
    Scene(20, 0.0, NOTHING),
    Scene(20, 0.0, ALL),
    Scene(100, 0.0, NOTHING),
)


def topics(robots: int, heard: str, *, only_regular: bool = False) -> Iterator[tuple[type, str]]:
    """Every topic that is listened to; or those of them whose messages need no event first."""
    spaces = [""] if robots == 1 else [f"/r{index}" for index in range(robots)]
    for space in spaces:
        for sensor in generate_ros_docs.own_sensors():
            for row in sensor_topics.rows_of(sensor):
                if only_regular and not sensor_topics.is_periodic(sensor, row):
                    continue
                if heard == ALL or row.type is Range or row.topic in ("odom", "joint_states", "imu"):
                    yield row.type, f"{space}/{row.topic}"
    yield tf2_messages.TFMessage, "/tf"
    if heard == ALL:
        yield Clock, "/clock"


def listen(arguments: list[str]) -> None:
    """Subscribe to topics of so many robots, and take what comes."""
    context = Context()
    rclpy.init(args=[], context=context, signal_handler_options=SignalHandlerOptions.NO)
    node = Node("listener", context=context, enable_rosout=False, start_parameter_services=False)
    for kind, topic in topics(int(arguments[0]), arguments[1]):
        node.create_subscription(kind, topic, lambda _data: None, qos.SENSOR, raw=True)
    spin_until_interrupted(node, context)


def spin_until_interrupted(node: Node, context: Context) -> None:
    """Execute callbacks until SIGINT; the context must leave signals alone."""
    ended: list[int] = []
    signal.signal(signal.SIGINT, lambda number, _frame: ended.append(number))
    executor = make_executor(context)
    executor.add_node(node)
    while not ended:
        executor.spin_once(timeout_sec=0.1)


def send(robots: str, heard: str, rate_hz: str, seconds: str) -> None:
    """The bare loop: one message that is ready on each regular topic, again and again; prints its CPU in percent."""
    context = Context()
    rclpy.init(args=[], context=context)
    with dds_profile.used(dds_profile.ALONE):
        node = Node("sender", context=context, enable_rosout=False, start_parameter_services=False)
    ready = []
    for kind, topic in topics(int(robots), heard, only_regular=True):
        data = tf2_messages.encode([]) if kind is tf2_messages.TFMessage else serialize_message(kind())
        ready.append((node.create_publisher(kind, topic, qos.SENSOR), data))
    while not all(publisher.get_subscription_count() for publisher, _ in ready):
        time.sleep(0.1)
    rounds, due, before = round(float(seconds) * float(rate_hz)), time.monotonic(), time.process_time()
    for _ in range(rounds):
        for publisher, data in ready:
            publisher.publish(data)
        due += 1 / float(rate_hz)
        time.sleep(max(0.0, due - time.monotonic()))
    print(100 * (time.process_time() - before) / float(seconds))


def profiled(path: str, arguments: list[str]) -> None:
    """The simulator in the main thread, its profile written at SIGINT."""
    context = Context()
    rclpy.init(args=arguments, context=context, signal_handler_options=SignalHandlerOptions.NO)
    ended: list[int] = []
    signal.signal(signal.SIGINT, lambda number, _frame: ended.append(number))
    with dds_profile.used(dds_profile.ALONE):
        simulator = Simulator(context)
    profile = cProfile.Profile(time.thread_time)
    profile.runcall(run_node, simulator, context, lambda: bool(ended))
    profile.dump_stats(path)
    simulator.close()


class Driver:
    """The node that lets the robots drive and reads what the simulator says about itself."""

    def __init__(self, robots: int) -> None:
        self.context = Context()
        rclpy.init(args=[], context=self.context)
        self.node = Node("driver", context=self.context, enable_rosout=False, start_parameter_services=False)
        self.executor = make_executor(self.context)
        self.executor.add_node(self.node)
        self.factors: list[float] = []
        self.node.create_subscription(DiagnosticArray, "/diagnostics", self._take, qos.SENSOR)
        spaces = [""] if robots == 1 else [f"/r{index}" for index in range(robots)]
        self.publishers = [self.node.create_publisher(Twist, f"{space}/cmd_vel", 1) for space in spaces]

    def _take(self, message: DiagnosticArray) -> None:
        for status in message.status:
            values = {pair.key: pair.value for pair in status.values}
            if "real-time factor achieved" in values:
                self.factors.append(float(values["real-time factor achieved"]))

    def spin(self, seconds: float) -> None:
        """Take what comes for a while."""
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            self.executor.spin_once(timeout_sec=0.1)

    def go(self) -> None:
        """Wait until all robots listen, then let them drive."""
        end = time.monotonic() + START_S
        while not all(publisher.get_subscription_count() for publisher in self.publishers):
            if time.monotonic() > end:
                raise TimeoutError("the simulator does not listen")
            self.spin(0.1)
        for publisher in self.publishers:
            publisher.publish(Twist(linear=Vector3(x=SPEED_M_S), angular=Vector3(z=TURN_RAD_S)))

    def until_heard(self, names: list[str]) -> None:
        """Wait until all of these topics have a subscriber."""
        end = time.monotonic() + START_S
        while missing := [name for name in names if not self.node.count_subscribers(name)]:
            if time.monotonic() > end:
                raise TimeoutError(f"{len(missing)} of {len(names)} topics have no subscriber, such as {missing[0]}")
            self.spin(0.5)

    def close(self) -> None:
        """Leave the graph."""
        self.executor.shutdown()
        self.node.destroy_node()
        self.context.try_shutdown()


@dataclass(frozen=True)
class Figures:
    """Of one round: CPU in percent of a core, that of a bare loop, factor, resident memory, CPU time of the start."""

    cpu_percent: float
    floor_percent: float | None
    factor: float
    memory_mb: float
    start_s: float


def run(scene: Scene, options: argparse.Namespace) -> Figures:
    """One round of a scene."""
    with tempfile.TemporaryDirectory() as folder:
        world = Path(folder) / "load.json"
        world.write_text(grid(scene.robots, GAP_M), encoding="utf-8")
        values = [f"playground:={world}"]
        if scene.rate_hz:
            rates = ("sensor_rate", "odom_max_rate", "clock_rate")
            values += [f"{name}:={scene.rate_hz}" for name in rates]
        arguments = [*QUIET, *(part for value in values for part in ("-p", value))]
        start = [PROFILED, options.profile] if options.profile else [NODE]
        with child(*start, *arguments) as pid:
            driver = Driver(scene.robots)
            driver.go()
            start_s = cpu_s(pid)
            with contextlib.ExitStack() as listening:
                if scene.heard != NOTHING:
                    listening.enter_context(child(LISTENER, str(scene.robots), scene.heard))
                    driver.until_heard([topic for _, topic in topics(scene.robots, scene.heard)])
                figures = _watch(driver, pid, options.seconds, options.warm_up)
            driver.close()
    return Figures(**figures, floor_percent=_floor(scene, options.seconds), start_s=start_s)


def _floor(scene: Scene, seconds: float) -> float | None:
    """CPU percent of the bare loop; None where nothing is heard at a common rate."""
    if scene.heard == NOTHING or not scene.rate_hz:
        return None
    arguments = (str(scene.robots), scene.heard)
    command = [sys.executable, "-c", SENDER, *arguments, str(scene.rate_hz), str(seconds)]
    with child(LISTENER, *arguments):
        return float(subprocess.run(command, capture_output=True, text=True, check=True, timeout=START_S).stdout)


def _watch(driver: Driver, pid: int, seconds: float, warm_up_s: float) -> dict[str, float]:
    driver.spin(warm_up_s)
    driver.factors.clear()
    begin, before = time.monotonic(), cpu_s(pid)
    driver.spin(seconds)
    used, passed = cpu_s(pid) - before, time.monotonic() - begin
    factor = statistics.fmean(driver.factors)
    return {
        "cpu_percent": 100 * used / (passed * factor),
        "factor": factor,
        "memory_mb": status_mb(pid, "VmRSS"),
    }


def summary(rounds: list[Figures]) -> list[Cell]:
    """Return the cells of a scene: CPU, best, floor, factor, memory, CPU time of the start."""
    percents = [one.cpu_percent for one in rounds]
    floors = [one.floor_percent for one in rounds if one.floor_percent is not None]
    return [
        statistics.median(percents),
        min(percents),
        statistics.median(floors) if floors else None,
        statistics.median(one.factor for one in rounds),
        round(max(one.memory_mb for one in rounds)),
        statistics.median(one.start_s for one in rounds),
    ]


def add_options(parser: argparse.ArgumentParser) -> None:
    """Add options."""
    parser.add_argument("--seconds", type=float, default=10.0, help="seconds of each measurement")
    parser.add_argument("--rounds", type=int, default=3, help="rounds; the figures are their medians")
    parser.add_argument("--warm-up", type=float, default=3.0, help="seconds before the measurement")
    parser.add_argument("--only", default="", metavar="WORDS", help="scenes with this in their names")
    parser.add_argument("--profile", metavar="FILE", help="write a profile of the node (its CPU time is then wrong)")


def measure(options: argparse.Namespace) -> Report:
    """Measure all scenes."""
    rows, goals = [], []
    for scene in SCENES:
        if options.only in scene.name:
            cells = summary([run(scene, options) for _ in range(options.rounds)])
            rows.append([scene.name, *cells])
            if scene.most_percent is not None:
                goals.append(Goal(scene.name, scene.most_percent, cells[0], "% CPU"))
    columns = ["", "CPU, %", "best", "floor", "factor", "MB", "start, CPU s"]
    return Report([Table(columns, rows)], goals)
