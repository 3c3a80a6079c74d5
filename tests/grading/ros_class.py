"""A class of ROS nodes: what pupils hand in, right and wrong, with the points that each gets on every graph."""

from __future__ import annotations

__all__ = ["ASSIGNMENT", "CLASS", "TEST"]

ASSIGNMENT = """
tests = ["test_node.py"]
files = ["node.py"]

[limits]
cpu_s = 20
"""
TEST = """
import pytest
from geometry_msgs.msg import Twist

pytestmark = pytest.mark.thymio(playground="base")


@pytest.mark.points(2)
def test_the_program_drives(ros, simulation):
    sim = simulation()
    ros.run("node.py", cpu_limit=1)
    sim.until(lambda: sim.thymio.pose.x_m > 0.05, seconds=2)


@pytest.mark.points(1)
def test_the_node_drives_at_its_speed(ros, simulation):
    sim = simulation()
    ros.start("node.py", parameters={"speed": 0.05}, cpu_limit=1)
    commands = ros.collect(Twist, "cmd_vel", qos=10)
    sim.until(lambda: commands.latest.linear.x == 0.05, seconds=1)
"""
_NODE = """
import threading, time
import rclpy
from geometry_msgs.msg import Twist, TwistStamped
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor, SingleThreadedExecutor
from rclpy.node import Node
from std_srvs.srv import Trigger
{imports}


class Driver(Node):
    def __init__(self):
        super().__init__("driver")
        self.speed = self.declare_parameter("speed", 0.1).value
        self.wheels = self.create_publisher({type}, "{topic}", 10)
        self.create_timer(0.1, self.drive)
        {init}

    {define} drive(self):
        {before}
        command = {type}()
        {field} = {speed}
        self.wheels.publish(command)

    def go(self, goal):
        goal.succeed()
        self.may_go = True
        return Fibonacci.Result()


def main():
    rclpy.init()
    try:
        {spin}
    except (KeyboardInterrupt, ExternalShutdownException):
        pass


if __name__ == "__main__":
    main()
"""
_GOOD = {
    "type": "Twist", "topic": "cmd_vel", "init": "pass", "before": "pass", "field": "command.linear.x",
    "speed": "self.speed", "spin": "rclpy.spin(Driver())", "imports": "", "define": "def",
}  # fmt: skip
_MANY = "executor = MultiThreadedExecutor(3); executor.add_node(Driver()); executor.spin()"
_THREAD = (
    "node = Driver(); threading.Thread(target=rclpy.spin, args=(node,), daemon=True).start(); "
    "rate = node.create_rate(10); [rate.sleep() for _ in iter(rclpy.ok, False)]"
)
_CALL = 'self.stop = self.create_client(Trigger, "stop")'
_ONE = _MANY.replace("MultiThreadedExecutor(3)", "SingleThreadedExecutor()")
_ACTION = {
    "imports": "from rclpy.action import ActionClient, ActionServer\nfrom test_msgs.action import Fibonacci",
    "init": 'self.may_go = False; self.server = ActionServer(self, Fibonacci, "go", self.go); '
    'self.client = ActionClient(self, Fibonacci, "go")',
    "before": "if not self.may_go: self.client.send_goal_async(Fibonacci.Goal()); return",
}
_TRANSFORM = {
    "imports": "from tf2_ros import Buffer, TransformListener",
    "init": "self.buffer = Buffer(); self.listener = TransformListener(self.buffer, self)",
    "before": 'if not self.buffer.can_transform("odom", "base_link", rclpy.time.Time()): return',
}
_SCRIPT = """
import time
import rclpy
from geometry_msgs.msg import Twist

rclpy.init()
wheels = rclpy.create_node("driver").create_publisher(Twist, "cmd_vel", 10)
command = Twist()
command.linear.x = 0.1
while rclpy.ok():
    wheels.publish(command)
    time.sleep(0.1)
"""


def _node(**different: str) -> str:
    return _NODE.format(**_GOOD | different)


CLASS: dict[str, tuple[str, int]] = {
    "Good": (_node(), 3),
    "Loops": (_node(spin="node = Driver()\n        while rclpy.ok(): rclpy.spin_once(node, timeout_sec=0.01)"), 3),
    "Polls": (_node(spin="node = Driver()\n        while rclpy.ok(): rclpy.spin_once(node, timeout_sec=0)"), 3),
    "Many threads": (_node(spin=_MANY), 3),
    "Thread and rate": (_node(spin=_THREAD), 3),
    "Fixed speed": (_node(speed="0.1"), 2),
    "Slow": (_node(speed="self.speed / 10"), 0),
    "Misspelt": (_node(topic="cmd_vle"), 0),
    "Wrong type": (_node(type="TwistStamped", field="command.twist.linear.x"), 0),
    "Int": (_node(speed="1"), 0),
    "Raises": (_node(before="self.speed / 0"), 0),
    "Forever": (_node(before="while True: pass"), 0),
    "Sleeps": (_node(before="time.sleep(100)"), 0),
    "Deadlock": (_node(init=_CALL, before="self.stop.call(Trigger.Request())"), 0),
    "Waits": (_node(init='self.create_client(Trigger, "stop").wait_for_service()'), 0),
    "Sleeps a little": (_node(before="time.sleep(0.02)"), 3),
    "No node": ("print('hello')\n", 0),
    "Syntax": ("def (\n", 0),
    "Ends": (_node(spin="Driver()"), 1),
    "Exits": (_node(before="exit(0)"), 0),
    "Interrupts": (_node(before="raise KeyboardInterrupt"), 0),
    "Own executor": (_node(spin=_ONE), 3),
    "Coroutine": (_node(define="async def"), 3),
    "Action": (_node(**_ACTION), 3),
    "Transform": (_node(**_TRANSFORM), 3),
    "Sleeping script": (_SCRIPT, 2),
    "Floods": (_node(before="[self.wheels.publish(Twist()) for _ in range(1000)]"), 1),
    "Not a number": (_node(speed="float('nan')"), 0),
    "Unknown import": (_node(imports="import numpy_ros"), 0),
    "Int parameter": (_node(init='self.declare_parameter("turn", 0.5); self.set_parameters([1])'), 0),
}
"""Source and points of each pupil."""
