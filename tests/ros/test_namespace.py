"""The suite in a pushed namespace, as `ros2 launch` does it by `-r __ns:=…`: all of it moves, and keeps to itself."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterator

import pytest
from geometry_msgs.msg import Twist, Vector3
from nav_msgs.msg import Odometry
from rosgraph_msgs.msg import Clock
from std_msgs.msg import Int16MultiArray
from std_srvs.srv import SetBool, Trigger

from tests.bridge.studio import Studio
from tests.patience import PATIENCE_S
from tests.processes import Process, free_port
from tests.ros.aseba_tools import Status, get_variables, set_parameters
from thymio_sim_ros.bridge.protocol import messages as ms
from thymio_sim_ros.bridge.protocol.constants import CDR
from thymio_sim_ros.ros.interface.names import GLOBAL

pytestmark = pytest.mark.process

OF_ROS = ("/parameter_events", "/rosout")

PROGRAM = """<!DOCTYPE aesl-source>
<network>
<event size="1" name="ping"/>
<event size="1" name="pong"/>
<node nodeId="1" name="thymio-II">var heard = 0
onevent ping
	heard = heard + 1
	emit pong event.args[0] + 1
</node>
</network>
"""


@pytest.fixture
def suite(ros, tmp_path) -> Iterator[Callable[..., dict[str, int]]]:
    """Start the executable `thymio` in a namespace; the ports of its page and its bridge."""
    started: list[Process] = []
    numbers = itertools.count()

    def start(namespace: str, *arguments: str, playground: str = "borderless") -> dict[str, int]:
        ports = {"port": free_port(), "foxglove_port": free_port()}
        given = ports | {"playground": playground, "script.path": "none"}
        words = [word for name, value in given.items() for word in ("-p", f"{name}:={value}")]
        folder = tmp_path / str(next(numbers))
        folder.mkdir()
        module = "thymio_sim_ros.ros.combined"
        started.append(Process(folder, module, "--ros-args", "-r", f"__ns:={namespace}", *arguments, *words))
        state = f"{namespace}/simulator/_state"
        ros.until(lambda: ros.node.count_publishers(state), PATIENCE_S, what=f"a simulator in {namespace}")
        return ports

    yield start
    for one in started:
        one.end()


def moved(odometry: list[Odometry]) -> float:
    return odometry[-1].pose.pose.position.x if odometry else 0.0


def said(ros, kind: type, topic: str, message: object, until: Callable[[], object], what: str) -> None:
    """Publish again and again until it shows: what is said before the other process knows us is lost."""
    publisher = ros.publisher(kind, topic)

    def again() -> object:
        publisher.publish(message)
        return until()

    ros.until(again, what=what)


FORWARD = Twist(linear=Vector3(x=0.1))


def test_everything_moves_and_works(ros, suite):
    ports = suite("/lab1", "-p", "cmd_vel_timeout:=0.0")
    ros.until(lambda: ros.node.count_publishers("/lab1/_aseba/status"), PATIENCE_S, what="the runtime's robot")
    status = Status(ros, "/lab1")
    outside = [
        name
        for name, _ in ros.node.get_topic_names_and_types()
        if not name.startswith("/lab1/") and name not in (*GLOBAL, *OF_ROS)
    ]
    assert outside == []

    odometry = ros.collect(Odometry, "/lab1/odom")
    said(ros, Twist, "/lab1/cmd_vel", FORWARD, lambda: moved(odometry) > 0.02, "a robot that drives")

    assert set_parameters(ros, {"script.source": PROGRAM}, node="/lab1/aseba_runtime").successful
    ros.until(lambda: status["state"] == "running", what="a program that runs")
    pongs = ros.collect(Int16MultiArray, "/lab1/aseba/events/pong")
    ping = Int16MultiArray(data=[41])
    said(ros, Int16MultiArray, "/lab1/aseba/emit/ping", ping, lambda: pongs, "the answer of the program")
    assert list(pongs[0].data) == [42]
    assert get_variables(ros, "heard", robot="/lab1") != [[0]]

    assert ros.call(SetBool, "/lab1/simulator/pause", SetBool.Request(data=True)).success
    assert ros.call(Trigger, "/lab1/simulator/step").success
    assert ros.call(Trigger, "/lab1/reset_odometry").success
    refusal = set_parameters(ros, {"playground": "nowhere"}, node="/lab1/simulator")
    assert "no playground 'nowhere'" in refusal.reason

    with Studio(ports["foxglove_port"], ros.until) as studio:
        assert studio.next(ms.ServerInfo).metadata == {"namespace": "/lab1"}
        for topic in ("/lab1/simulator/_state", "/lab1/_raw/ground", "/lab1/_press/tap", "/tf"):
            studio.channel(topic)
        assert studio.parameter("/lab1/simulator.playground") == "borderless"
        studio.subscribe(1, "/lab1/_led/state")
        studio.next(ms.MessageData)
        studio.advertise(1, "/lab1/cmd_vel", "geometry_msgs/msg/Twist", CDR)


def test_two_suites_in_one_domain_do_not_meet(ros, suite):
    suite("/lab1", "-p", "cmd_vel_timeout:=0.0")
    suite("/lab2", "-r", "/clock:=/lab2/clock", "-p", "namespaced_tf:=true")
    for lab in ("/lab1", "/lab2"):
        ros.until(
            lambda lab=lab: ros.node.count_publishers(f"{lab}/_aseba/status"), PATIENCE_S, what=f"robots of {lab}"
        )
        assert set_parameters(ros, {"script.source": PROGRAM}, node=f"{lab}/aseba_runtime").successful
    assert ros.node.count_publishers("/clock") == ros.node.count_publishers("/lab2/clock") == 1
    assert ros.node.count_publishers("/tf") == ros.node.count_publishers("/lab2/tf") == 1

    there, here = (ros.collect(Odometry, f"{lab}/odom") for lab in ("/lab1", "/lab2"))
    pongs = [ros.collect(Int16MultiArray, f"{lab}/aseba/events/pong") for lab in ("/lab1", "/lab2")]
    said(ros, Twist, "/lab1/cmd_vel", FORWARD, lambda: moved(there) > 0.02, "the first robot drives")
    ping = Int16MultiArray(data=[1])
    said(ros, Int16MultiArray, "/lab1/aseba/emit/ping", ping, lambda: pongs[0], "the first robot answers")
    ticks = ros.collect(Clock, "/lab2/clock")
    ros.until(lambda: len(ticks) > 10, what="time of the second suite")
    assert moved(here) == 0.0
    assert list(pongs[1]) == []
    assert get_variables(ros, "heard", robot="/lab2") == [[0]]


@pytest.mark.slow
def test_several_robots_move_with_their_simulator(ros, suite):
    suite("/robot1", playground="two_robots")
    ros.until(lambda: ros.node.count_publishers("/robot1/blue/_aseba/status"), PATIENCE_S, what="the runtime's robots")
    odometry = {name: ros.collect(Odometry, f"/robot1/{name}/odom") for name in ("red", "blue")}
    said(ros, Twist, "/robot1/red/cmd_vel", FORWARD, lambda: moved(odometry["red"]) > 0.02, "the red robot drives")
    assert moved(odometry["blue"]) == 0.0
    assert odometry["blue"][-1].header.frame_id == "blue/odom"
