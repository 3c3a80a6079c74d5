"""`thymio-sim node` beside a suite on an installed ROS 2, whose tools see its node as every other one."""

from __future__ import annotations

from pathlib import Path

import pytest
from geometry_msgs.msg import Twist
from rcl_interfaces.msg import Parameter, ParameterType, ParameterValue
from rcl_interfaces.srv import GetParameters, SetParameters

from tests.patience import PATIENCE_S, until
from tests.processes import Process, free_port, wait_for_port
from thymio_sim_ros import examples

pytestmark = pytest.mark.process

LINE_FOLLOWER = Path(examples.__file__).with_name("line_follower.py")


def test_a_node_without_ros_is_a_node_of_ros(ros, ros_domain, tmp_path):
    port = free_port()
    (tmp_path / "node").mkdir()
    words = ("--ros", "--no-web", "--playground", "line", "--program", "none", "--foxglove-port", str(port))
    suite = Process(tmp_path, "thymio_sim_ros.cli.main", *words)
    try:
        wait_for_port(port)
        url = f"ws://127.0.0.1:{port}"
        program = Process(tmp_path / "node", "thymio_sim_ros.cli.main", "node", str(LINE_FOLLOWER), "--connect", url)
        try:
            commands = []
            ros.node.create_subscription(Twist, "/cmd_vel", commands.append, 10)
            ros.until(lambda: commands, PATIENCE_S, what=f"a command; {program.output} {suite.output}")
            assert "/line_follower" in [f"/{name}" for name in ros.node.get_node_names()]
            topics = dict(ros.node.get_publisher_names_and_types_by_node("line_follower", "/"))
            assert topics["/cmd_vel"] == ["geometry_msgs/msg/Twist"]
            setting = _call(
                ros,
                SetParameters,
                "set_parameters",
                SetParameters.Request(
                    parameters=[
                        Parameter(
                            name="speed",
                            value=ParameterValue(type=ParameterType.PARAMETER_DOUBLE, double_value=0.03),
                        )
                    ]
                ),
            )
            assert setting.results[0].successful
            assert _call(ros, GetParameters, "get_parameters", GetParameters.Request(names=["speed"])).values[
                0
            ].double_value == pytest.approx(0.03)
            program.interrupt()
            assert program.wait() == 0, program.output
            assert "thymio-sim node:" not in program.output
            ros.until(lambda: "line_follower" not in ros.node.get_node_names(), PATIENCE_S, what="the end of the node")
        finally:
            program.end()
    finally:
        suite.end()
    until(lambda: not suite.is_running)


def _call(ros, kind, name, request):
    """The response of a service of the node."""
    client = ros.node.create_client(kind, f"/line_follower/{name}")
    ros.until(client.service_is_ready, PATIENCE_S, what=name)
    future = client.call_async(request)
    ros.until(future.done, PATIENCE_S, what=f"a response of {name}")
    return future.result()
