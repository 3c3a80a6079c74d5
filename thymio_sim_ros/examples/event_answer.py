"""Answer an event of an Aseba program: the program emits `where`, the node answers `here` with the position in mm.

Taught here: events are the border between the two worlds. The program in the robot has no odometry, but it can ask a
node that has. Events carry 16-bit integers, so the unit is mm, and values are limited.
"""

import rclpy
from geometry_msgs.msg import Point
from nav_msgs.msg import Odometry
from rcl_interfaces.msg import FloatingPointRange, ParameterDescriptor
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import Int16MultiArray

LARGEST = 32767  # of a variable in Aseba


class EventAnswer(Node):
    """Answers each event with the latest position."""

    def __init__(self) -> None:
        super().__init__("event_answer")
        scales = FloatingPointRange(from_value=1.0, to_value=1000.0)
        about = ParameterDescriptor(
            description="Units of the answer in a meter: 1000 is mm", floating_point_range=[scales]
        )
        self.declare_parameter("units_per_meter", 1000.0, about)
        self.position: Point | None = None
        self.create_subscription(Odometry, "odom", self.on_odometry, 10)
        self.create_subscription(Int16MultiArray, "aseba/events/where", self.on_where, 10)
        self.answers = self.create_publisher(Int16MultiArray, "aseba/emit/here", 10)

    def on_odometry(self, message: Odometry) -> None:
        """Keep the latest position."""
        self.position = message.pose.pose.position

    def on_where(self, _question: Int16MultiArray) -> None:
        """Answer, unless no position is known yet: the program asks again."""
        if self.position is None:
            return
        scale = self.get_parameter("units_per_meter").value
        values = [round(scale * value) for value in (self.position.x, self.position.y)]
        self.answers.publish(Int16MultiArray(data=[max(-LARGEST, min(LARGEST, value)) for value in values]))


def main() -> None:
    """Run the node until Ctrl-C."""
    try:
        rclpy.init()
        rclpy.spin(EventAnswer())
    except (KeyboardInterrupt, ExternalShutdownException):
        pass


if __name__ == "__main__":
    main()
