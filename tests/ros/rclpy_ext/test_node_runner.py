"""Nodes start and end while others run; late subscribers get retained messages; time may jump back."""

from __future__ import annotations

import json
import signal
import subprocess
import sys

import pytest
from nav_msgs.msg import Odometry
from rcl_interfaces.srv import SetParameters
from rclpy.context import Context
from rclpy.impl.rcutils_logger import RcutilsLogger
from rclpy.node import Node
from rclpy.parameter import Parameter
from rosgraph_msgs.msg import Clock
from std_msgs.msg import Float32MultiArray, Int16MultiArray, String
from std_srvs.srv import Trigger
from visualization_msgs.msg import MarkerArray

from tests.patience import PATIENCE_S
from thymio_sim_ros.ros.aseba.node import AsebaRuntime
from thymio_sim_ros.ros.compat import tf2_messages
from thymio_sim_ros.ros.interface import qos
from thymio_sim_ros.ros.rclpy_ext.node_runner import MAX_CONSECUTIVE_ERRORS, announce, run_main, run_node
from thymio_sim_ros.ros.rclpy_ext.node_runner import STUCK as STUCK_CODE
from thymio_sim_ros.ros.simulator.node import Simulator
from thymio_sim_ros.ros.simulator.world_services import SERVICES
from thymio_sim_ros.ros.web.node import WebPage, WebParams

COUNTS = "var n = 0\nonevent prox\nn = n + 1\ncall leds.top(n, 0, 0)\nmotor.left.target = 200\nmotor.right.target = 200"


def top(state):
    return round(32 * state[-1].data[0]) if state else 0


def test_a_simulator_that_is_started_again_finds_the_program_of_another_process_running(ros, simulation, runtime):
    runtime(COUNTS)
    for _ in range(2):
        sim = simulation(playground="borderless", cmd_vel_timeout=0.0)
        assert sim.world.now_ns == 0
        sim.until(lambda sim=sim: sim.world.robots["thymio"].pose.x_m > 0.05)
        ros.end(sim.simulator)


def test_a_program_starts_again_with_its_node(ros, simulation, runtime):
    sim = simulation(playground="borderless")
    state = ros.collect(Float32MultiArray, "/_led/state")
    node = runtime(COUNTS)
    sim.until(lambda: top(state) > 5)
    ros.end(node)
    runtime(COUNTS)
    sim.until(lambda: top(state) == 1, seconds=2.0)
    sim.until(lambda: top(state) > 2)


@pytest.mark.parametrize(
    ("kind", "topic"),
    [
        (String, "/robot_description"),
        (String, "/simulator/_state"),
        (String, "/simulator/_playgrounds"),
        (String, "/simulator/_sensors"),
        (MarkerArray, "/_markers"),
        (MarkerArray, "/_markers/objects"),
        (Float32MultiArray, "/_led/state"),
    ],
)
def test_a_late_subscriber_gets_retained_messages(ros, simulation, kind, topic):
    sim = simulation()
    sim.step(0.5)
    messages = ros.collect(kind, topic)
    ros.until(lambda: messages)


def test_a_late_subscriber_gets_the_static_frames(ros, simulation):
    sim = simulation()
    sim.step(0.5)
    received = []
    ros.node.create_subscription(tf2_messages.TFMessage, "/tf_static", received.append, qos.TRANSIENT_LOCAL, raw=True)
    ros.until(lambda: received)
    children = {frame.child for frame in tf2_messages.decode(bytes(received[-1]))}
    assert {"base_footprint", "laser_link", "proximity_center_link", "ground_left_link"} <= children


def test_a_subscriber_that_arrives_while_paused_gets_the_clock(ros, simulation):
    sim = simulation()
    sim.step(0.5)
    clocks = ros.collect(Clock, "/clock")
    sim.simulator._publish_heartbeat(0)
    ros.until(lambda: clocks)
    assert clocks[-1].clock.nanosec == 500_000_000


def test_after_a_reset_retained_topics_precede_the_clock_and_the_clock_precedes_readings(ros, simulation):
    sim = simulation()
    sim.step(0.5)
    order = []
    for kind, topic in (
        (String, "/simulator/_state"),
        (MarkerArray, "/_markers"),
        (Clock, "/clock"),
        (Int16MultiArray, "/_raw/motor"),
        (Odometry, "/odom"),
    ):
        ros.node.create_subscription(kind, topic, lambda _message, topic=topic: order.append(topic), 10)
    ros.settle()
    assert ros.call(Trigger, "/simulator/reset").success
    ros.until(lambda: {"/simulator/_state", "/_markers", "/clock"} <= set(order))
    assert not {"/_raw/motor", "/odom"} & set(order)
    sim.until(lambda: {"/_raw/motor", "/odom"} <= set(order))


def test_a_new_playground_goes_back_in_time_and_keeps_the_program(ros, simulation, runtime):
    sim = simulation(playground="borderless")
    state = ros.collect(Float32MultiArray, "/_led/state")
    states = ros.collect(String, "/simulator/_state")
    runtime(COUNTS)
    sim.until(lambda: top(state) > 5)
    request = SetParameters.Request(parameters=[Parameter("playground", value="base").to_parameter_msg()])
    assert ros.call(SetParameters, "/simulator/set_parameters", request).results[0].successful
    ros.until(lambda: json.loads(states[-1].data)["playground"] == "base")
    sim.until(lambda: 0 < top(state) < 3, seconds=3.0)


class Stumbling:
    """A node whose first iterations fail."""

    def __init__(self, node, faults):
        self.node, self.faults, self.turns = node, faults, 0

    def run_once(self, executor):
        self.turns += 1
        executor.spin_once(timeout_sec=0.0)
        if self.turns <= self.faults:
            raise ZeroDivisionError("unexpected")


def test_an_internal_error_does_not_end_a_node(ros, monkeypatch):
    reported = []
    monkeypatch.setattr(RcutilsLogger, "error", lambda self, text, **_: reported.append(text))
    runnable = Stumbling(Node("stumbling", context=ros.context), faults=MAX_CONSECUTIVE_ERRORS - 1)
    run_node(runnable, ros.context, lambda: runnable.turns == MAX_CONSECUTIVE_ERRORS + 1)
    assert len(reported) == MAX_CONSECUTIVE_ERRORS - 1
    assert all("unexpected" in text for text in reported)
    runnable.node.destroy_node()


def test_a_node_that_only_fails_ends(ros):
    runnable = Stumbling(Node("stumbling", context=ros.context), faults=1000)
    with pytest.raises(ZeroDivisionError):
        run_node(runnable, ros.context, lambda: runnable.turns == 1000)
    assert runnable.turns == MAX_CONSECUTIVE_ERRORS
    runnable.node.destroy_node()


def test_nothing_of_a_simulator_is_left_in_the_graph(ros, simulation):
    sim = simulation()
    ros.end(sim.simulator)
    ros.until(lambda: not any(name.startswith("/proximity") for name, _ in ros.node.get_topic_names_and_types()))
    ours = {name.replace("~", "/simulator") for name in SERVICES} | {"/is_ready", "/reset_odometry"}
    ros.until(lambda: not ours & {name for name, _ in ros.node.get_service_names_and_types()})


@pytest.fixture
def logged(monkeypatch):
    """What nodes wrote to the log at these two levels."""
    reported = []
    for level in ("info", "warning"):
        monkeypatch.setattr(RcutilsLogger, level, lambda self, text, **_: reported.append(text))
    return reported


def test_an_executable_logs_what_runs_and_where(ros, logged, simulation, runtime):
    page = ros.live(WebPage(ros.context, WebParams(port=0)))
    hosts = [page, simulation(playground="two_robots").simulator, runtime(COUNTS, robots=["anna"])]
    assert list(announce(hosts)) == hosts
    where, world, programs = logged
    assert where == f"Page: http://localhost:{page.port}/"
    assert world.startswith(f"Playground two_robots, robots in /red, /blue; ROS_DOMAIN_ID {ros.domain}, ")
    assert programs == "Program: program"


@pytest.mark.parametrize(
    ("node", "name", "near", "page"),
    [
        (Simulator, "simulator", " (did you mean playground?)", "ros.md"),
        (AsebaRuntime, "aseba_runtime", "", "ros.md"),
        (WebPage, "web_ui", "", "ros2-tools.md"),
    ],
)
def test_a_misspelled_parameter_is_reported_with_the_nearest_name(ros_domain, logged, node, name, near, page):
    context = Context()
    context.init(args=["--ros-args", "-p", "playgroud:=maze", "-p", "use_sim_time:=false"])
    node(context, *([WebParams(port=0)] if node is WebPage else [])).close()
    context.shutdown()
    assert [text for text in logged if text.startswith("parameter")] == [
        f"parameter playgroud is not a parameter of {name} and has no effect{near}; see docs/{page}"
    ]


def test_a_wrong_file_of_parameters_is_reported_with_its_line(capfd, tmp_path):
    path = tmp_path / "mine.yaml"
    path.write_text("simulator:\n  seed: 1\n")
    for name, found in ((str(path), "at line 2"), ("/nowhere/mine.yaml", "Error opening YAML file")):
        assert run_main(lambda context: pytest.fail("started"), ["--ros-args", "--params-file", name]) == 2
        (line,) = [line for line in capfd.readouterr().err.splitlines() if line.startswith("thymio-sim: ")]
        assert f"'--params-file {name}': " in line
        assert line.endswith(found)


@pytest.mark.parametrize(("argument", "code"), [("--help", 0), ("playground:=maze", 2), ("extra", 2)])
def test_an_argument_outside_ros_args_is_reported_and_nothing_starts(capfd, argument, code):
    assert run_main(lambda context: pytest.fail("started"), [argument, "--ros-args", "-p", "seed:=1"]) == code
    out, err = capfd.readouterr()
    assert "--ros-args -p PARAMETER:=VALUE" in (out if code == 0 else err)
    assert (f"found argument '{argument}'" in err) == bool(code)


@pytest.mark.parametrize(
    ("words", "reported"),
    [
        (["-p", "seed=3"], "ROS cannot be initialized: Couldn't parse parameter override rule: '-p seed=3'"),
        (["--foo"], "not ROS arguments: ['--foo']"),
    ],
)
def test_an_invalid_ros_argument_is_reported_in_one_line(capfd, words, reported):
    assert run_main(lambda context: pytest.fail("started"), ["--ros-args", *words]) == 2
    assert f"thymio-sim: {reported}" in capfd.readouterr().err.splitlines()


SLOW_TO_CLOSE = """
import ctypes, sys, threading
from rclpy.node import Node
from thymio_sim_ros.ros.rclpy_ext import node_runner

class Slow:
    def __init__(self, context):
        self.node = Node("slow", context=context)

    def run_once(self, executor):
        raise RuntimeError("enough")

    def stop(self):
        print("ended")

    def close(self):
        if sys.argv[1] == "python":
            threading.Event().wait()
        ctypes.PyDLL(None).sleep(1000)

node_runner.LEAVE_S = 0.5
sys.exit(node_runner.run_main(lambda context: [Slow(context)], []))
"""


@pytest.mark.parametrize("keeps", ["python", "interpreter"])
def test_a_process_that_dds_does_not_let_go_ends_without_it(ros_domain, keeps):
    """Also where DDS keeps the interpreter meanwhile."""
    ended = subprocess.run(
        [sys.executable, "-u", "-c", SLOW_TO_CLOSE, keeps],
        capture_output=True,
        text=True,
        timeout=PATIENCE_S,
        check=False,
    )
    assert (ended.returncode, ended.stdout) == (1, "ended\n")
    assert "RuntimeError: enough" in ended.stderr


STUCK = """
import sys, threading, time
from rclpy.node import Node
from thymio_sim_ros.ros.rclpy_ext import node_runner

ALL_RUN = threading.Event()

class Turning:
    def __init__(self, context, name):
        self.node = Node(name, context=context)

    def run_once(self, executor):
        executor.spin_once(timeout_sec=0.01)

    def stop(self):
        print(self.node.get_name(), "ended", flush=True)

    def close(self):
        self.node.destroy_node()

class InPython(Turning):
    def run_once(self, executor):
        ALL_RUN.wait()
        print("begun", flush=True)
        here = True
        while here:
            pass

class InC(Turning):
    def run_once(self, executor):
        ALL_RUN.wait()
        print("begun", flush=True)
        threading.Lock().acquire() and time.sleep(1e6)

class UntilInterrupted(Turning):
    interrupted = threading.Event()

    def run_once(self, executor):
        ALL_RUN.wait()
        print("begun", flush=True)
        self.interrupted.wait()

    def interrupt(self):
        self.interrupted.set()

KINDS = {"python": InPython, "c": InC, "long": UntilInterrupted, "": Turning}

def build(context):
    for number, kind in enumerate(sys.argv[1].split(",")):
        if kind == "slow":
            print("begun", flush=True)
            while True:
                pass
        yield KINDS[kind](context, f"{kind or 'well'}_{number}")

node_runner.LEAVE_S = 10.0
def ready():
    ALL_RUN.set()
    if not {"python", "c", "long"} & set(sys.argv[1].split(",")):  # a stuck node says so itself, once it is stuck
        print("begun", flush=True)

sys.exit(node_runner.run_main(build, [], on_ready=ready))
"""


def ended_by_interrupt(kinds: str) -> tuple[int, list[str], str]:
    """Exit code, lines on stdout and text on stderr of a process with lives of these kinds."""
    command = [sys.executable, "-c", STUCK, kinds]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        try:
            assert process.stdout is not None
            while process.stdout.readline() != "begun\n":
                assert process.poll() is None
            process.send_signal(signal.SIGINT)
            out, err = process.communicate(timeout=PATIENCE_S)
        finally:
            process.kill()
    return process.returncode, out.splitlines(), err


@pytest.mark.process
@pytest.mark.parametrize(
    ("kinds", "stuck", "ended"),
    [
        ("python", "python_0", []),
        ("c", "c_0", []),
        pytest.param(",python,", "python_1", ["well_2 ended", "well_0 ended"], marks=pytest.mark.slow),
        pytest.param(",c", "c_1", ["well_0 ended"], marks=pytest.mark.slow),
    ],
)
def test_a_stuck_thread_is_reported_and_does_not_keep_the_process(ros_domain, kinds, stuck, ended):
    code, out, err = ended_by_interrupt(kinds)
    assert code == STUCK_CODE
    assert out == ended
    assert f"{stuck} did not stop within 1.5 s; it is here:" in err
    assert "in run_once" in err


@pytest.mark.slow
@pytest.mark.process
def test_an_interrupt_while_a_node_is_built_ends_those_that_run(ros_domain):
    code, out, err = ended_by_interrupt(",slow")
    assert (code, out, err) == (0, ["well_0 ended"], "")


@pytest.mark.process
@pytest.mark.parametrize("kinds", [",", ",long"])
def test_without_a_stuck_thread_all_ends_in_order(ros_domain, kinds):
    names = [f"{kind or 'well'}_{number} ended" for number, kind in enumerate(kinds.split(","))]
    assert ended_by_interrupt(kinds) == (0, names[::-1], "")
