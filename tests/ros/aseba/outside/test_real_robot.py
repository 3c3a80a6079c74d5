"""A real robot in place of a simulator: one of ours behind the Aseba server, on the topics of a simulated one."""

from __future__ import annotations

import contextlib
import math
import os
import pty
import socket
import subprocess
import sys
import threading
from concurrent.futures import ThreadPoolExecutor
from functools import partial

import pytest
from diagnostic_msgs.msg import DiagnosticStatus
from geometry_msgs.msg import Twist, Vector3
from nav_msgs.msg import Odometry
from rcl_interfaces.msg import Log
from sensor_msgs.msg import BatteryState, Imu, JointState, Range
from std_msgs.msg import Bool, ColorRGBA, Empty, Float32MultiArray, Int16MultiArray, String
from std_srvs.srv import Trigger

from aseba_vm.protocol import (
    GetNodeDescription,
    ListNodes,
    NamedVariable,
    NodePresent,
    Run,
    SetBytecode,
    UserMessage,
)
from tests.network.aseba_client import AsebaClient
from tests.network.served_robot import ServedRobot
from tests.patience import PATIENCE_S
from tests.processes import free_port
from tests.ros.aseba.conftest import wait_until_it_runs
from tests.ros.aseba_tools import Status, event, get_variables, set_parameters
from thymio_sim_ros.device.programs.foreign import FOREIGN
from thymio_sim_ros.ros.aseba.node import AsebaRuntime, RuntimeParams
from thymio_sim_ros.ros.aseba.parameters import NetworkParams
from thymio_sim_ros.ros.rclpy_ext.node_runner import StartError
from thymio_sim_ros.sim.commands import PlayTone, SetLeds, StopSound

TALK = """<network><event size="2" name="pong"/><event size="1" name="ping"/><node name="thymio-II">
var n = 0
onevent ping
n = event.args[0]
emit pong [n * 3, 7]
onevent prox
call leds.circle(1, 2, 3, 4, 5, 6, 7, 8)
</node></network>"""


def wheel_targets(robot):
    return robot.variable("motor.left.target") + robot.variable("motor.right.target")


def test_sensors_are_published_in_si_units(ros, remote_runtime, served_robot):
    remote_runtime("var a")
    ranges = ros.collect(Range, "/proximity/center")
    nothing = ros.collect(Range, "/proximity/left")
    accelerations = ros.collect(Imu, "/imu")
    batteries = ros.collect(BatteryState, "/_battery")
    presses = ros.collect(Bool, "/buttons/center")
    taps = ros.collect(Empty, "/_tap")
    served_robot.feed("proximity", 0, 0, 2000, 0, 0, 0, 0)
    served_robot.feed("accelerometer", 0, 0, 23)
    served_robot.feed("battery", 796, 796, 0)
    served_robot.feed("buttons", 0, 0, 1, 0, 0)
    ros.until(lambda: ranges and math.isclose(ranges[-1].range, 0.0957, abs_tol=0.001))
    ros.until(lambda: nothing and nothing[-1].range == math.inf)
    ros.until(lambda: accelerations and math.isclose(accelerations[-1].linear_acceleration.z, 9.81, abs_tol=0.01))
    ros.until(lambda: batteries and math.isclose(batteries[-1].voltage, 4.0, abs_tol=0.01))
    ros.until(lambda: presses and presses[-1].data)

    def is_tapped():
        served_robot.feed("tap", 1 - served_robot.variable("acc._tap")[0])
        return taps

    ros.until(is_tapped)
    assert ranges[-1].header.frame_id == "proximity_center_link"


def test_a_velocity_drives_the_wheels_and_ends(ros, remote_runtime, served_robot):
    remote_runtime("motor.left.target = 30", cmd_vel_timeout=0.3)
    drive = ros.publisher(Twist, "/cmd_vel")
    drive.publish(Twist(linear=Vector3(x=0.083)))
    ros.until(lambda: wheel_targets(served_robot) == (250, 250))
    ros.until(lambda: wheel_targets(served_robot) == (30, 0))


def test_odometry_is_integrated_and_can_be_reset(ros, remote_runtime, served_robot):
    remote_runtime("var a")
    poses = ros.collect(Odometry, "/odom")
    wheels = ros.collect(JointState, "/joint_states")
    served_robot.feed("motor", 250, 250, 0, 0)
    ros.until(lambda: poses and poses[-1].pose.pose.position.x > 0.05)
    assert math.isclose(poses[-1].twist.twist.linear.x, 0.083, abs_tol=0.001)
    assert poses[-1].pose.pose.position.y == 0.0
    ros.until(lambda: wheels and wheels[-1].position[0] > 1.0)
    served_robot.feed("motor", 0, 0, 0, 0)
    ros.until(lambda: poses[-1].twist.twist.linear.x == 0.0)
    assert ros.call(Trigger, "/reset_odometry").success
    ros.until(lambda: poses[-1].pose.pose.position.x == 0.0)


def test_lights_and_sounds_are_those_of_the_robot(ros, remote_runtime, served_robot):
    remote_runtime(TALK)
    ros.publisher(ColorRGBA, "/led/body/top").publish(ColorRGBA(r=1.0, g=0.5, b=0.0, a=1.0))
    ros.until(lambda: SetLeds("top", (32, 16, 0)) in served_robot.commands)
    ros.publisher(Float32MultiArray, "/led/circle").publish(Float32MultiArray(data=[1.0] * 8))
    ros.until(lambda: SetLeds("circle", (32,) * 8) in served_robot.commands)
    ros.publisher(Float32MultiArray, "/sound/tone").publish(Float32MultiArray(data=[440.0, 0.0]))
    ros.until(lambda: PlayTone(440, None) in served_robot.commands)
    ros.publisher(Empty, "/_led/off").publish(Empty())
    ros.until(lambda: SetLeds("circle", (0,) * 8) in served_robot.commands)


def test_topics_that_a_real_robot_does_not_have_are_absent_and_said_once(ros, served_robot):
    node = ros.live(AsebaRuntime(ros.context, RuntimeParams(robot=f"tcp:127.0.0.1:{served_robot.port}")))
    logs = ros.collect(Log, "/rosout", transient_local=True)
    wait_until_it_runs(ros, node)
    said = "without ground truth, clock and playground"
    ros.until(lambda: any(said in log.msg for log in logs))
    topics = {name for name, _ in ros.node.get_topic_names_and_types()}
    assert not topics & {"/_ground_truth/odom", "/clock", "/initialpose", "/pen/down", "/_alarm", "/_led/state"}
    assert {"/odom", "/tf", "/robot_description", "/_battery", "/_proximity/laser"} <= topics
    served_robot.disconnect()
    ros.until(lambda: any("not connected" in log.msg for log in logs))
    assert sum(said in log.msg for log in logs) == 1


def test_what_the_robot_cannot_do_is_rejected_with_a_warning(ros, remote_runtime):
    remote_runtime("var a")
    logs = ros.collect(Log, "/rosout")
    ros.publisher(Float32MultiArray, "/led/circle").publish(Float32MultiArray(data=[]))
    ros.until(lambda: any("/led/circle rejected: ReleaseLeds: a real robot cannot do this" in log.msg for log in logs))


def test_events_go_both_ways(ros, remote_runtime):
    remote_runtime(TALK)
    pongs = ros.collect(Int16MultiArray, "/aseba/events/pong")
    anything = ros.collect(Int16MultiArray, "/_aseba/events")
    ros.publisher(Int16MultiArray, "/aseba/emit/ping").publish(Int16MultiArray(data=[5]))
    ros.until(lambda: pongs and anything)
    assert list(pongs[0].data) == [15, 7]
    ros.publisher(Int16MultiArray, "/_aseba/emit").publish(event("ping", -2))
    ros.until(lambda: len(pongs) > 1)
    assert list(pongs[1].data) == [-6, 7]
    ros.until(lambda: get_variables(ros, "n") == [[-2]])
    topics = {name for name, _ in ros.node.get_topic_names_and_types()}
    assert not [name for name in topics if "_ros" in name]


def test_a_program_that_does_not_fit_the_robot_is_rejected_with_its_place(ros, remote_runtime):
    remote_runtime("var a = 1")
    answer = set_parameters(ros, {"script.source": "var a\n  motor.left.targt = 5"})
    assert not answer.successful
    assert "line 2, column 3" in answer.reason
    assert set_parameters(ros, {"script.source": "var b = 6", "script.name": "good.aesl"}).successful
    status = Status(ros)
    ros.until(lambda: status["program"] == "good.aesl")
    ros.until(lambda: get_variables(ros, "b") == [[6]])


def test_a_breakpoint_stops_before_its_line(ros, remote_runtime, served_robot):
    remote_runtime("var n = 0\nvar m\n\nonevent prox\n    n = n + 1\n    # a comment\n    m = n\n")
    status = Status(ros)
    assert set_parameters(ros, {"breakpoints": [6, 99]}).successful
    ros.until(lambda: served_robot.do(lambda device: device._vm.breakpoints), what="the breakpoint is set")
    served_robot.feed("proximity", *[0] * 7)
    ros.until(lambda: status.place == ("paused", "prox", "7"))
    assert (status.data("breakpoints"), status.data("breakpoints_moved")) == ([7], {"6": 7, "99": None})
    ros.until(lambda: get_variables(ros, "n", "m") == [[1], [0]])
    assert ros.call(Trigger, "/aseba/run").success
    ros.until(lambda: status.place == ("running", "", ""))
    ros.until(lambda: get_variables(ros, "m") == [[1]])


def test_steps_by_line(ros, remote_runtime, served_robot):
    remote_runtime("var n = 0\nonevent prox\nn = 1\nn = 2\n")
    status = Status(ros)
    ros.call(Trigger, "/aseba/pause")
    ros.until(lambda: served_robot.do(lambda device: device.status.state) == "paused")
    served_robot.feed("proximity", *[0] * 7)
    for place in (("paused", "prox", "3"), ("paused", "prox", "4"), ("paused", "", "")):
        ros.call(Trigger, "/aseba/step_line")
        ros.until(lambda place=place: status.place == place)
    ros.until(lambda: get_variables(ros, "n") == [[2]])


def test_a_fault_is_reported_and_stops_the_wheels(ros, remote_runtime, served_robot):
    remote_runtime("var i = 9\nvar t[3]\nmotor.left.target = 100\nonevent button.center\n t[i] = 1")
    status = Status(ros)
    served_robot.feed("buttons", 0, 0, 1, 0, 0)
    ros.until(lambda: status.place == ("fault", "button.center", "5"))
    assert status["fault"] == "index 9 is outside an array of 3"
    assert status.messages[-1].level == DiagnosticStatus.ERROR
    ros.until(lambda: wheel_targets(served_robot) == (0, 0))


def test_a_robot_is_switched_off_and_on_again(ros, remote_runtime, served_robot):
    remote_runtime("motor.left.target = 100")
    status = Status(ros)
    ros.publisher(Empty, "/shutdown").publish(Empty())
    ros.until(lambda: status["state"] == "off")
    ros.until(lambda: wheel_targets(served_robot) == (0, 0))
    ros.until(lambda: StopSound() in served_robot.commands)
    assert ros.call(Trigger, "/aseba/run").success
    ros.until(lambda: wheel_targets(served_robot) == (100, 0))
    assert status["state"] == "running"


def test_the_target_of_the_editor_is_what_the_robot_describes(ros, remote_runtime):
    node = remote_runtime("var a")
    targets = ros.collect(String, "/_aseba/target", transient_local=True)
    ros.until(lambda: targets and node.robots[0].device.layout in targets[-1].data)


def test_the_wheels_stop_when_the_runtime_ends(ros, remote_runtime, served_robot):
    node = remote_runtime("motor.left.target = 100")
    ros.until(lambda: wheel_targets(served_robot) == (100, 0))
    ros.end(node)
    ros.until(lambda: wheel_targets(served_robot) == (0, 0))


def test_a_robot_that_returns_gets_its_program_again(ros):
    port = free_port()
    ros.live(AsebaRuntime(ros.context, RuntimeParams(source=TALK, robot=f"tcp:127.0.0.1:{port}")))
    status = Status(ros)
    ros.until(lambda: status["state"] == "off" and "refused" in status["fault"])
    for _ in range(2):
        robot = ServedRobot(port=port)
        ros.until(lambda: status["state"] == "running", what="the robot is found")
        ros.publisher(Int16MultiArray, "/aseba/emit/ping").publish(Int16MultiArray(data=[5]))
        ros.until(lambda: get_variables(ros, "n") == [[5]])
        robot.close()
        ros.until(lambda: status["state"] == "off", what="its end is noticed")


def test_a_program_that_the_robot_cannot_run_is_not_loaded_and_said(ros):
    robot = ServedRobot("playground")
    address = f"tcp:127.0.0.1:{robot.port}"
    ros.live(AsebaRuntime(ros.context, RuntimeParams(source="call _leds.set(3, 32)", robot=address)))
    logs = ros.collect(Log, "/rosout", transient_local=True)
    status = Status(ros)
    ros.until(lambda: status["state"] == "running" and "_leds.set" in status["warnings"])
    ros.until(lambda: any("not loaded: program: line 1, column 1" in log.msg for log in logs))
    ros.until(lambda: ros.node.count_publishers("/odom"))
    topics = {name for name, _ in ros.node.get_topic_names_and_types()}
    assert not topics & {"/_battery", "/_tap", "/_led/single"}
    robot.close()


def relay(connection, terminal):
    """Copy bytes between a TCP connection and a terminal, in both directions, until one of them ends."""

    def copy(read, write):
        with contextlib.suppress(OSError):
            while data := read():
                write(data)

    outward = partial(copy, partial(os.read, terminal, 4096), connection.sendall)
    inward = partial(copy, partial(connection.recv, 4096), partial(os.write, terminal))
    for direction in (outward, inward):
        threading.Thread(target=direction, daemon=True).start()


def test_a_robot_on_a_serial_port(ros, served_robot):
    pytest.importorskip("serial", reason="pyserial is not installed")
    robot_end, port = pty.openpty()
    with socket.create_connection(("127.0.0.1", served_robot.port)) as connection:
        relay(connection, robot_end)
        node = ros.live(AsebaRuntime(ros.context, RuntimeParams(source=TALK, robot=f"ser:{os.ttyname(port)}")))
        wait_until_it_runs(ros, node)
        ros.publisher(Int16MultiArray, "/aseba/emit/ping").publish(Int16MultiArray(data=[10]))  # a line feed
        ros.until(lambda: get_variables(ros, "n") == [[10]])
        os.close(port)
        os.close(robot_end)
        status = Status(ros)
        ros.until(lambda: status["state"] == "off", what="the cable was pulled")


@pytest.mark.parametrize("address", ["somewhere", "tcp:robot:99999"])
def test_a_wrong_address_is_rejected_at_the_start(ros, address):
    with pytest.raises(StartError, match=f"robot '{address}'"):
        AsebaRuntime(ros.context, RuntimeParams(robot=address))


def test_one_robot_has_one_name(ros):
    with pytest.raises(StartError, match="found 2 robot_names, expected 1"):
        AsebaRuntime(ros.context, RuntimeParams(robot="tcp:robot", robots=["anna", "bert"]))


@pytest.mark.process
def test_a_simulated_robot_behind_a_network_moves_as_one_in_the_process(ros, tmp_path):
    port = free_port()
    arguments = ("--headless", "--playground", "base", "--program", "none", "--aseba-port", str(port))
    code = f"import os; os.environ['ROS_DOMAIN_ID'] = '{(ros.domain + 1) % 100}'\n"
    command = [sys.executable, "-c", code + "import sys; from thymio_sim_ros.cli.main import main; sys.exit(main())"]
    with (tmp_path / "log").open("w") as log, subprocess.Popen([*command, *arguments], stdout=log, stderr=log) as far:
        try:
            near = AsebaRuntime(ros.context, RuntimeParams(source=TALK, robot=f"tcp:127.0.0.1:{port}", robots=["near"]))
            ros.live(near)
            ros.until(
                lambda: near.robots[0].device.status.state == "running", PATIENCE_S, what="the robot is connected"
            )
            poses = ros.collect(Odometry, "/near/odom")
            drive = ros.publisher(Twist, "/near/cmd_vel")

            def has_moved():
                drive.publish(Twist(linear=Vector3(x=0.1), angular=Vector3(z=0.5)))
                return poses and poses[-1].pose.pose.position.x > 0.03

            ros.until(has_moved, what="the robot has moved")
            assert poses[-1].header.frame_id == "near/odom"
            assert poses[-1].pose.pose.orientation.z > 0.0
            grounds = ros.collect(Range, "/near/ground/left")
            ros.until(lambda: grounds and grounds[-1].range == -math.inf)
            pongs = ros.collect(Int16MultiArray, "/near/aseba/events/pong")
            ros.publisher(Int16MultiArray, "/near/aseba/emit/ping").publish(Int16MultiArray(data=[4]))
            ros.until(lambda: pongs and list(pongs[0].data) == [12, 7])
        finally:
            far.terminate()
            assert far.wait(PATIENCE_S) == 0


def test_a_real_robot_is_a_node_for_other_programs_too(ros, remote_runtime):
    node = remote_runtime(TALK, network=NetworkParams(aseba_port=0, announce=False))
    ros.until(lambda: node.network.servers.ports, what="the port is open")
    pongs = ros.collect(Int16MultiArray, "/aseba/events/pong")
    with ThreadPoolExecutor(1) as pool, contextlib.closing(AsebaClient(node.network.servers.ports[""])) as client:

        def work(function, *arguments):
            future = pool.submit(function, *arguments)
            ros.until(future.done, what="the client has its answer")
            return future.result()

        assert work(client.ask, ListNodes(0, 5), NodePresent) == NodePresent(1, 5)
        assert work(client.ask, GetNodeDescription(0, 1, 5), NamedVariable).name == "_id"
        assert work(client.ask, UserMessage(0, 1, (5,)), UserMessage) == UserMessage(1, 0, (15, 7))
        ros.until(lambda: pongs and list(pongs[0].data) == [15, 7])
        client.send(SetBytecode(0, 1, 0, (3, 0xFFFF, 3, 0)), Run(0, 1))
        status = Status(ros)
        ros.until(lambda: status["program"] == FOREIGN)
