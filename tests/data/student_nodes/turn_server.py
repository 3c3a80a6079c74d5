"""An action server that turns the robot to a heading, and publishes what remains."""

import math
import time

import rclpy
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from rclpy.action import ActionServer, CancelResponse, GoalResponse
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import MultiThreadedExecutor
from rclpy.node import Node
from turtlesim.action import RotateAbsolute


class TurnServer(Node):
    def __init__(self):
        super().__init__("turn_server")
        group = ReentrantCallbackGroup()
        self.yaw = None
        self.wheels = self.create_publisher(Twist, "cmd_vel", 10)
        self.create_subscription(Odometry, "odom", self.on_odom, 10, callback_group=group)
        self._action_server = ActionServer(
            self,
            RotateAbsolute,
            "turn",
            execute_callback=self.execute,
            goal_callback=lambda goal: GoalResponse.ACCEPT if abs(goal.theta) <= math.pi else GoalResponse.REJECT,
            cancel_callback=lambda goal_handle: CancelResponse.ACCEPT,
            callback_group=group,
        )

    def on_odom(self, msg):
        q = msg.pose.pose.orientation
        self.yaw = math.atan2(2.0 * q.w * q.z, 1.0 - 2.0 * q.z * q.z)

    def execute(self, goal_handle):
        while self.yaw is None:
            time.sleep(0.05)
        start = self.yaw
        while True:
            error = goal_handle.request.theta - self.yaw
            error = math.atan2(math.sin(error), math.cos(error))
            if abs(error) < 0.05:
                break
            if goal_handle.is_cancel_requested:
                goal_handle.canceled()
                return RotateAbsolute.Result()
            command = Twist()
            command.angular.z = max(-1.0, min(1.0, 2.0 * error))
            self.wheels.publish(command)
            goal_handle.publish_feedback(RotateAbsolute.Feedback(remaining=error))
            time.sleep(0.05)
        self.wheels.publish(Twist())
        goal_handle.succeed()
        return RotateAbsolute.Result(delta=self.yaw - start)


def main(args=None):
    rclpy.init(args=args)
    node = TurnServer()
    executor = MultiThreadedExecutor()
    rclpy.spin(node, executor=executor)


if __name__ == "__main__":
    main()
