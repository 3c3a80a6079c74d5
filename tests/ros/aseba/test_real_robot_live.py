"""A runtime in front of Aseba's own robots: Aseba Playground and asebadummynode, where they are installed."""

from __future__ import annotations

import contextlib
import os
import shutil
import signal
import subprocess

import pytest
from geometry_msgs.msg import Twist, Vector3
from nav_msgs.msg import Odometry
from rcl_interfaces.msg import Log
from sensor_msgs.msg import Range
from std_msgs.msg import ColorRGBA, Int16MultiArray
from std_srvs.srv import Trigger

from tests.patience import PATIENCE_S
from tests.processes import free_port
from tests.ros.aseba_tools import Status, get_variables, set_parameters
from thymio_sim_ros.ros.aseba.node import AsebaRuntime, RuntimeParams

pytestmark = pytest.mark.process

WORLD = """<aseba-playground>
<color name="white" r="0.9" g="0.9" b="0.9"/>
<world w="100" h="80" color="white"/>
<wall x="80" y="40" l1="2" l2="60" h="10" color="white"/>
<robot type="thymio2" x="40" y="40" angle="0" port="{port}" name="thymio"/>
</aseba-playground>
"""
PROGRAM = """<network><event size="1" name="ping"/><event size="2" name="pong"/><node name="thymio-II">
var n = 0
onevent ping
n = event.args[0]
emit pong [n + 1, prox.horizontal[2]]
</node></network>"""

HALF = "before its description was complete: 0 of 1 local events, 0 of 30 native functions"


@contextlib.contextmanager
def process(*command):
    for tool in command[:1] if command[0] != "xvfb-run" else ("xvfb-run", command[2]):
        if shutil.which(tool) is None:
            pytest.skip(f"{tool} is not installed")
    with subprocess.Popen(
        command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True
    ) as running:
        try:
            yield running
        finally:
            with contextlib.suppress(ProcessLookupError):
                os.killpg(running.pid, signal.SIGTERM)


def test_a_student_node_drives_the_robot_of_aseba_playground(ros, tmp_path):
    port, world = free_port(), tmp_path / "world.playground"
    world.write_text(WORLD.format(port=port))
    with process("xvfb-run", "-a", "asebaplayground", str(world)):
        address = f"tcp:127.0.0.1:{port}"
        node = ros.live(AsebaRuntime(ros.context, RuntimeParams(source=PROGRAM, robot=address, cmd_vel_timeout=0.5)))
        status = Status(ros)
        ros.until(lambda: status["state"] == "running", PATIENCE_S, what="the playground has started")
        assert node.robots[0].device.layout.startswith("thymio-II/")
        ros.until(lambda: ros.node.count_publishers("/odom"))
        poses, ranges = ros.collect(Odometry, "/odom"), ros.collect(Range, "/proximity/center")
        drive = ros.publisher(Twist, "/cmd_vel")

        def sees_the_wall():
            drive.publish(Twist(linear=Vector3(x=0.15)))
            return ranges and ranges[-1].range < 0.1

        ros.until(sees_the_wall, what="the robot sees the wall")
        # How far depends on the load of the computer: the playground is then slower than real time.
        assert poses[-1].pose.pose.position.x > 0.05
        assert poses[-1].pose.pose.position.y == 0.0
        ros.until(lambda: poses[-1].twist.twist.linear.x == 0.0, what="the velocity has ended")
        ros.publisher(ColorRGBA, "/led/body/top").publish(ColorRGBA(r=1.0, a=1.0))
        pongs = ros.collect(Int16MultiArray, "/aseba/events/pong")
        ros.publisher(Int16MultiArray, "/aseba/emit/ping").publish(Int16MultiArray(data=[41]))
        ros.until(lambda: pongs, what="the answer of the program")
        assert pongs[0].data[0] == 42
        assert pongs[0].data[1] > 1000
        ros.until(lambda: get_variables(ros, "n") == [[41]])
        assert set_parameters(ros, {"breakpoints": [4]}).successful
        ros.publisher(Int16MultiArray, "/aseba/emit/ping").publish(Int16MultiArray(data=[7]))
        ros.until(lambda: status.place == ("paused", "ping", "4"))
        ros.call(Trigger, "/aseba/step_line")
        ros.until(lambda: status.place == ("paused", "ping", "5"))
        ros.call(Trigger, "/aseba/run")
        ros.until(lambda: len(pongs) > 1)
        assert set_parameters(ros, {"breakpoints": [], "script.source": "var t[2]\nvar i = 5\nt[i] = 1"}).successful
        ros.until(lambda: status.place == ("fault", "init", "3"))
        assert status["fault"] == "index 5 is outside an array of 2"
    ros.until(lambda: status["state"] == "off", what="the end of the playground is noticed")


def test_a_robot_that_crashes_while_it_describes_itself_is_reported_and_asked_again(ros):
    port = free_port()
    node = ros.live(AsebaRuntime(ros.context, RuntimeParams(robot=f"tcp:127.0.0.1:{port}")))
    logs = ros.collect(Log, "/rosout", transient_local=True)
    for _ in range(2):
        with process("asebadummynode", "--port", str(port), "0") as running:
            ros.until(lambda: running.poll() is not None or node.robots._real.robot.is_connected)
            if node.robots._real.robot.is_connected:
                pytest.skip("this asebadummynode can describe itself")
            ros.until(lambda: any(HALF in log.msg for log in logs))
    assert sum("cannot be used" in log.msg and HALF in log.msg for log in logs) == 1
    assert not node.robots._real.robot.is_connected
    assert ros.call(Trigger, "/aseba/run").success is False
