"""Sends one goal to the action server that turns, and prints feedback and result."""

import sys

import rclpy
from rclpy.action import ActionClient
from rclpy.node import Node
from turtlesim.action import RotateAbsolute


class TurnClient(Node):
    def __init__(self):
        super().__init__("turn_client")
        self.feedback = 0
        self._action_client = ActionClient(self, RotateAbsolute, "turn")

    def on_feedback(self, message):
        self.feedback += 1

    def send_goal(self, theta):
        self._action_client.wait_for_server()
        goal = RotateAbsolute.Goal()
        goal.theta = theta
        sent = self._action_client.send_goal_async(goal, feedback_callback=self.on_feedback)
        rclpy.spin_until_future_complete(self, sent)
        handle = sent.result()
        if not handle.accepted:
            return "rejected"
        result = handle.get_result_async()
        rclpy.spin_until_future_complete(self, result)
        return f"status {result.result().status}, feedback {self.feedback > 0}"


def main():
    rclpy.init()
    client = TurnClient()
    print(client.send_goal(float(sys.argv[1])), flush=True)
    rclpy.shutdown()


if __name__ == "__main__":
    main()
