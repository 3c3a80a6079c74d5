"""The suite and each executable as processes of their own: start, readiness, signals, nothing left behind."""

from __future__ import annotations

import http.client
import re
import signal
import socket
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from nav_msgs.msg import Odometry
from std_msgs.msg import Int16MultiArray

from tests.patience import PATIENCE_S
from tests.processes import Process, free_port
from thymio_sim_ros.ros.interface import convert_readings

pytestmark = pytest.mark.process


@pytest.fixture
def process(ros_domain, tmp_path) -> Iterator[Callable[..., Process]]:
    """Start `main()` of a module with arguments, in the test's domain."""
    started: list[Process] = []

    def start(module: str, *arguments: str) -> Process:
        started.append(Process(tmp_path, module, *arguments))
        return started[-1]

    yield start
    for one in started:
        one.end()


def segments(pid: int | str) -> set[str]:
    """Names of the shared memory of ROS that a process uses; none when it is gone or another user's."""
    try:
        maps = Path(f"/proc/{pid}/maps").read_text()
    except OSError:
        return set()
    return set(re.findall(r"/dev/shm/(fastrtps_\w+)", maps))


def left_behind(used: set[str]) -> set[str]:
    """Those of these names that are still there though no process uses them; ports outlive their users."""
    there = {name for name in used if (Path("/dev/shm") / name).exists() and not name.startswith("fastrtps_port")}
    return there - set().union(*(segments(path.name) for path in Path("/proc").glob("[0-9]*")))


def is_free(port: int) -> bool:
    with socket.socket() as probe:
        return probe.connect_ex(("127.0.0.1", port)) != 0


@pytest.mark.parametrize("number", [signal.SIGINT, pytest.param(signal.SIGTERM, marks=pytest.mark.slow)])
def test_the_whole_suite_runs_and_ends(ros, process, number):
    port, foxglove_port = free_port(), free_port()
    ports = ("--port", str(port), "--foxglove-port", str(foxglove_port))
    suite = process("thymio_sim_ros.cli.main", "--program", "line_follower", *ports)
    odometry: list[Odometry] = []
    ros.node.create_subscription(Odometry, "/odom", odometry.append, 10)
    ros.until(lambda: odometry and odometry[-1].pose.pose.position.x > 0.02, PATIENCE_S, what="a moving robot")
    ros.until(lambda: len(suite.output.splitlines()) >= 6, PATIENCE_S)
    graph, page, foxglove, layout, access, stop = suite.output.splitlines()[:6]
    assert graph == f"ROS       ROS 2, ROS_DOMAIN_ID {ros.domain}, this computer only: its nodes see the robots"
    assert str(port) in page
    assert str(foxglove_port) in foxglove
    assert "layout" in layout
    assert "this computer only" in access
    assert "Ctrl-C" in stop
    connection = http.client.HTTPConnection("127.0.0.1", port, timeout=PATIENCE_S)
    connection.request("GET", "/config.json")
    assert b"version" in connection.getresponse().read()
    connection.close()
    used = segments(suite.pid)
    assert used
    suite.signal(number)
    assert suite.wait() == 0, suite.output
    assert is_free(port)
    assert is_free(foxglove_port)
    assert len(suite.output.splitlines()) == 6, suite.output
    assert left_behind(used) == set()


@pytest.mark.slow
def test_two_interrupts_at_once_end_it_cleanly(ros, process):
    suite = process("thymio_sim_ros.cli.main", "--headless")
    odometry: list[Odometry] = []
    ros.node.create_subscription(Odometry, "/odom", odometry.append, 10)
    ros.until(lambda: odometry, PATIENCE_S, what="odometry")
    suite.signal(signal.SIGINT)
    suite.signal(signal.SIGINT)
    assert suite.wait() == 0, suite.output
    assert "Traceback" not in suite.output


def test_a_program_drives_a_robot_of_another_process_by_the_driver_s_topics(ros, process):
    process("thymio_sim_ros.ros.simulator.node", "--ros-args", "-p", "playground:=line")
    process(
        "thymio_sim_ros.ros.aseba.node", "--ros-args", "-p", "script.path:=line_follower", "-p", "use_sim_time:=true"
    )
    odometry: list[Odometry] = []
    ros.node.create_subscription(Odometry, "/odom", odometry.append, 10)
    ros.until(lambda: odometry and odometry[-1].pose.pose.position.x > 0.02, PATIENCE_S, what="a moving robot")


PING = (
    '<network><event name="ping" size="1"/><event name="pong" size="1"/><node name="thymio-II">'
    "onevent ping emit pong event.args[0] + 1</node></network>"
)


def test_robots_of_runtimes_in_different_processes_hear_each_other(ros, process, runtime):
    anna = runtime(PING.replace("onevent ping emit pong", "var got = 0\nonevent pong got ="), robots=["anna"]).robots[0]
    arguments = ["-p", "robots:=[bert]", "-p", "first_id:=2", "-p", f"script.source:={PING}"]
    process("thymio_sim_ros.ros.aseba.node", "--ros-args", "-p", "use_sim_time:=false", *arguments)
    ros.until(lambda: ros.node.count_subscribers("/_aseba/network") == 2, PATIENCE_S, what="the other runtime")
    publisher = ros.publisher(Int16MultiArray, "/anna/_aseba/emit")

    def is_answered():
        publisher.publish(Int16MultiArray(layout=convert_readings.layout([("ping", 1)]), data=[41]))
        return anna.device.variables.get("got") == (42 + 1,)

    ros.until(is_answered, PATIENCE_S, what="the answer of the other process")


@pytest.mark.parametrize(
    ("module", "name"),
    [
        ("simulator.node", "simulator"),
        ("aseba.node", "aseba_runtime"),
        ("foxglove.node", "foxglove_bridge"),
        ("web.node", "web_ui"),
    ],
)
def test_each_executable_ends_with_0(ros, process, module, name):
    port = ["-p", f"port:={free_port()}"] if name in ("foxglove_bridge", "web_ui") else []
    node = process(f"thymio_sim_ros.ros.{module}", "--ros-args", "-p", "use_sim_time:=false", *port)
    ros.until(lambda: name in ros.node.get_node_names(), PATIENCE_S, what=f"node {name}")
    node.signal(signal.SIGINT)
    assert node.wait() == 0, node.output
    assert "Traceback" not in node.output


@pytest.mark.parametrize(
    ("module", "parameter", "reported"),
    [
        ("simulator.node", "playground:=nowhere", "nowhere"),
        pytest.param("simulator.node", "real_time_factor:=5000.0", "real_time_factor", marks=pytest.mark.slow),
        pytest.param("web.node", "port:=99999", "port", marks=pytest.mark.slow),
        ("web.node", "port:=http", "port"),
        pytest.param("foxglove.node", "port:=-1", "port", marks=pytest.mark.slow),
    ],
)
def test_a_bad_parameter_is_one_line_and_exit_code_2(process, module, parameter, reported):
    node = process(f"thymio_sim_ros.ros.{module}", "--ros-args", "-p", parameter)
    assert node.wait() == 2, node.output
    (line,) = node.output.splitlines()
    assert reported in line
