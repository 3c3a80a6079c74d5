"""Node tests need ROS; without it this folder is left out."""

from __future__ import annotations

import importlib.util

import pytest

collect_ignore_glob = [] if importlib.util.find_spec("rclpy") else ["test_*.py"]


@pytest.fixture(autouse=True)
def _alone(ros_domain):
    """Tests with contexts or processes of their own, too, run in a domain of their own."""


@pytest.fixture
def bridge(ros):
    """Make a Foxglove bridge on a free port."""
    from thymio_sim_ros.ros.foxglove.node import FoxgloveBridge
    from thymio_sim_ros.ros.foxglove.options import FoxgloveParams

    def make(use_sim_time=False, **parameters):
        defaults = FoxgloveParams(port=0, **parameters)
        return ros.live(FoxgloveBridge(context=ros.context, use_sim_time=use_sim_time, defaults=defaults))

    return make


@pytest.fixture
def studio(ros, bridge):
    """A client of a bridge with default parameters."""
    from tests.bridge.studio import Studio

    with Studio(bridge().port, ros.until) as client:
        yield client


@pytest.fixture
def peer(ros):
    """A node with parameters, one of which has opinions."""
    from rcl_interfaces.msg import ParameterDescriptor, SetParametersResult
    from rclpy.node import Node

    node = ros.add(Node("peer", context=ros.context, enable_rosout=False))
    node.declare_parameter("speed", 1.5)
    node.declare_parameter("count", 3)
    node.declare_parameter("program", "good")
    node.declare_parameter("fixed", 1, ParameterDescriptor(read_only=True))

    def check(parameters):
        is_bad = any(item.name == "program" and item.value == "bad" for item in parameters)
        return SetParametersResult(successful=not is_bad, reason="line 3, column 5: bad" if is_bad else "")

    node.add_on_set_parameters_callback(check)
    return node


@pytest.fixture
def simulator_with(ros):
    """Make a simulator with arguments of ROS, in a context of its own."""
    import rclpy
    from rclpy.context import Context

    from thymio_sim_ros.ros.simulator.node import Simulator, SimulatorParams

    context, made = Context(), []

    def make(*arguments, profile=None, **parameters):
        rclpy.init(args=["--ros-args", *arguments], context=context, domain_id=ros.domain)
        made.append(Simulator(context, SimulatorParams(**parameters), profile=profile))
        return made[0]

    yield make
    for simulator in made:
        simulator.close()
    context.try_shutdown()


@pytest.fixture
def strange_node(ros):
    """Make a node in another participant, as another process has it."""
    import rclpy
    from rclpy.context import Context
    from rclpy.node import Node

    contexts, nodes = [], []

    def make(name="teleop", namespace=""):
        context = Context()
        rclpy.init(context=context, domain_id=ros.domain)
        contexts.append(context)
        node = Node(name, context=context, namespace=namespace, enable_rosout=False, start_parameter_services=False)
        nodes.append(node)
        return node

    yield make
    for context in contexts:
        context.try_shutdown()


@pytest.fixture
def roslib(ros, bridge):
    """A client of rosbridge, of a bridge with default parameters."""
    from tests.bridge.ros_client import RosClient

    with RosClient(bridge().port, ros.until) as client:
        yield client
