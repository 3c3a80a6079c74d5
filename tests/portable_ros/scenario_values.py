"""More of what rclpy and the embedded graph do alike (see scenario.py): rules for names, messages, parameters."""

from __future__ import annotations

import copy
import json
import pickle
import threading
from importlib import import_module
from typing import Any

import rclpy
from geometry_msgs.msg import Transform
from rcl_interfaces.msg import ParameterDescriptor
from rclpy.exceptions import NotInitializedException
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.task import Future
from rclpy.wait_for_message import wait_for_message
from scenario import attempt, seen
from std_msgs.msg import String
from std_srvs.srv import SetBool


def names_of_topics(node: Node) -> None:
    """Rules for topics or services only, and wrong names where a program asks for full ones."""
    rules = ["-r", "rostopic://beep:=horn", "-r", "rosservice://call:=shout", "-r", "both:=all"]
    other = rclpy.create_node("ruled", cli_args=["--ros-args", *rules])
    seen["rules"] = [
        (other.resolve_topic_name(one), other.resolve_service_name(one)) for one in ("beep", "call", "both")
    ]
    wrong = ("", "a b", "{zz}", "1a", "a/", "/a//b")
    seen["resolved"] = [attempt(node.resolve_topic_name, one) for one in wrong]
    seen["waited"] = attempt(wait_for_message, String, node, "t t", time_to_wait=0.1).partition("\n")[0]
    other.destroy_node()


def copies() -> None:
    """Messages that are copied, pickled and imported from the module of one message."""
    message = Transform()
    message.translation.x = 2.0
    copied = copy.deepcopy(message)
    copied.translation.x = 3.0
    seen["copies"] = message.translation.x, pickle.loads(pickle.dumps(message)) == message
    request = SetBool.Request(data=True)
    seen["pickled"] = repr(pickle.loads(pickle.dumps(request)))
    seen["own modules"] = (
        import_module("std_msgs.msg._string").String is String,
        attempt(import_module, "std_msgs.msg._nothing"),
    )


def parameters(node: Node) -> None:
    """Callbacks that cannot be called, read-only parameters with any type, lists from other nodes."""
    seen["callbacks"] = [
        attempt(add, None) for add in (node.add_on_set_parameters_callback, node.add_post_set_parameters_callback)
    ]
    node.declare_parameter("fixed", 1, ParameterDescriptor(dynamic_typing=True, read_only=True))
    seen["fixed"] = repr(node.set_parameters([Parameter("fixed", value="a")])), node.describe_parameter("fixed").type
    lists = [Parameter("l", value=value).to_parameter_msg() for value in ([1], [1.5], [True], ["a"], [b"a"])]
    seen["lists"] = [repr(Parameter.from_parameter_msg(one).value) for one in lists]
    seen["not initialized"] = str(NotInitializedException("why")), str(NotInitializedException())
    seen["log of a number"] = attempt(node.get_logger().info, 5).partition(":")[0]


def shutdowns() -> None:
    """A program that shuts down while it spins: the functions of rclpy return."""
    calls: Any = (rclpy.spin, lambda node: rclpy.spin_until_future_complete(node, Future()))
    ended = []
    for call in calls:
        rclpy.init(args=[])
        node = rclpy.create_node("ending")
        threading.Timer(0.3, rclpy.shutdown).start()
        ended.append((attempt(call, node), rclpy.ok()))
    seen["ended by another thread"] = ended


def main() -> None:
    """Run all parts and print what was seen."""
    rclpy.init(args=[])
    node = rclpy.create_node("own")
    names_of_topics(node)
    copies()
    parameters(node)
    rclpy.shutdown()
    shutdowns()
    print(json.dumps(seen, indent=1))


if __name__ == "__main__":
    main()
