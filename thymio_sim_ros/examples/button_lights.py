"""Show the buttons on the lights: an arrow lights its part of the circle, the center button changes the color on top.

Taught here: topics that publish only when something changes, the moment at which a button is pressed, messages with
arrays and colors, and a node that keeps a state.
"""

from functools import partial

import rclpy
from rcl_interfaces.msg import FloatingPointRange, ParameterDescriptor
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import Bool, ColorRGBA, Float32MultiArray

CIRCLE = {"forward": 0, "right": 2, "backward": 4, "left": 6}  # eight lights, clockwise from the front
COLORS = [(0.0, 1.0, 0.0), (0.0, 0.0, 1.0), (1.0, 0.0, 0.0), (0.0, 0.0, 0.0)]  # green, blue, red, off


class ButtonLights(Node):
    """Publishes lights whenever a button changes."""

    def __init__(self) -> None:
        super().__init__("button_lights")
        levels = FloatingPointRange(from_value=0.0, to_value=1.0)
        about = ParameterDescriptor(description="Brightness of the lights, 0 to 1", floating_point_range=[levels])
        self.declare_parameter("brightness", 1.0, about)
        self.is_pressed = dict.fromkeys(CIRCLE, False)
        self.presses = 0
        self.circle = self.create_publisher(Float32MultiArray, "led/circle", 10)
        self.top = self.create_publisher(ColorRGBA, "led/body/top", 10)
        for name in CIRCLE:
            self.create_subscription(Bool, f"buttons/{name}", partial(self.on_arrow, name), 10)
        self.create_subscription(Bool, "buttons/center", self.on_center, 10)

    def on_arrow(self, name: str, message: Bool) -> None:
        """Light the circle at all arrows that are pressed now."""
        self.is_pressed[name] = message.data
        levels = [0.0] * 8
        for arrow, light in CIRCLE.items():
            if self.is_pressed[arrow]:
                levels[light] = self.get_parameter("brightness").value
        self.circle.publish(Float32MultiArray(data=levels))

    def on_center(self, message: Bool) -> None:
        """Show the next color when the button goes down; nothing happens when it comes up."""
        if message.data:
            red, green, blue = COLORS[self.presses % len(COLORS)]
            self.presses += 1
            level = self.get_parameter("brightness").value
            self.top.publish(ColorRGBA(r=level * red, g=level * green, b=level * blue, a=1.0))


def main() -> None:
    """Run the node until Ctrl-C."""
    try:
        rclpy.init()
        rclpy.spin(ButtonLights())
    except (KeyboardInterrupt, ExternalShutdownException):
        pass


if __name__ == "__main__":
    main()
