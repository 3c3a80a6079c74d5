"""Drives the robot of our own simulator in one process, with whatever rclpy there is; prints what it saw as JSON."""

from __future__ import annotations

import json
import sys
from typing import Any

import rclpy
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from rcl_interfaces.msg import Log
from rcl_interfaces.srv import SetParameters
from rclpy.context import Context
from rclpy.executors import SingleThreadedExecutor
from rclpy.parameter import Parameter
from rclpy.qos import DurabilityPolicy, QoSProfile
from rosgraph_msgs.msg import Clock
from std_srvs.srv import SetBool, Trigger
from tf2_msgs.msg import TFMessage

from thymio_sim_ros.ros.rclpy_ext.node_runner import NodeRunner
from thymio_sim_ros.ros.simulator.node import Simulator

FAR_M = 0.05
SPEED = 0.1
PATIENCE = 600
"""Iterations of a tenth of a second."""


def main() -> None:
    """Start the simulator, drive, reset, change a parameter."""
    context = Context()
    rclpy.init(args=sys.argv[1:], context=context)
    runner = NodeRunner(context)
    runner.start(Simulator(context))
    node = rclpy.create_node("driver", context=context)
    executor = SingleThreadedExecutor(context=context)
    executor.add_node(node)
    received: dict[str, list[Any]] = {"odom": [], "clock": [], "tf": [], "log": []}
    node.create_subscription(Odometry, "/odom", received["odom"].append, 10)
    node.create_subscription(Clock, "/clock", received["clock"].append, 10)
    node.create_subscription(TFMessage, "/tf", received["tf"].append, 100)
    retained = QoSProfile(depth=100, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    node.create_subscription(Log, "/rosout", received["log"].append, retained)

    def spin_until(condition: Any) -> None:
        for _ in range(PATIENCE):
            if condition():
                return
            executor.spin_once(timeout_sec=0.1)
        raise AssertionError("the condition did not become true")

    def call(kind: Any, name: str, request: Any) -> Any:
        client = node.create_client(kind, name)
        spin_until(client.service_is_ready)
        future = client.call_async(request)
        spin_until(future.done)
        return future.result()

    def x_m() -> float:
        return float(received["odom"][-1].pose.pose.position.x) if received["odom"] else 0.0

    publisher = node.create_publisher(Twist, "/cmd_vel", 10)
    command = Twist()
    command.linear.x = SPEED
    timer = node.create_timer(0.05, lambda: publisher.publish(command))
    spin_until(lambda: x_m() > FAR_M)
    timer.cancel()
    node.get_logger().info("has driven")
    seen: dict[str, Any] = {"has driven": x_m() > FAR_M}
    seen["reset"] = call(Trigger, "/simulator/reset", Trigger.Request()).success
    spin_until(lambda: x_m() == 0.0)
    seen["paused"] = call(SetBool, "/simulator/pause", SetBool.Request(data=True)).success
    wrong = SetParameters.Request(parameters=[Parameter("seed", value="text").to_parameter_msg()])
    seen["refused"] = call(SetParameters, "/simulator/set_parameters", wrong).results[0].reason
    spin_until(lambda: received["tf"] and received["clock"] and received["log"])
    seen["frames"] = sorted({one.child_frame_id for message in received["tf"] for one in message.transforms})
    seen["logs"] = sorted({one.name for one in received["log"]})
    seen["topics"] = sorted(name for name, _ in node.get_topic_names_and_types())
    executor.shutdown()
    node.destroy_node()
    runner.close()
    context.try_shutdown()
    print(json.dumps(seen))


if __name__ == "__main__":
    main()
