"""Drive a turtle with the keys of a terminal, as the program of this name in turtlesim."""

from __future__ import annotations

import contextlib
import math
import os
import sys
import time
from collections.abc import Callable, Iterator, Mapping
from typing import TYPE_CHECKING, Any

import rclpy
from geometry_msgs.msg import Twist
from rclpy.action import ActionClient
from rclpy.context import Context
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from turtlesim.action import RotateAbsolute

if TYPE_CHECKING:
    from rclpy.action.client import ClientGoalHandle

__all__ = ["HELP", "Teleop", "keys_of", "main"]

HELP = """\
Arrows drive the turtle. The keys around F turn it to a heading, F ends the turn, Q ends the program.

    E R T
    D F G
    C V B
"""
_ARROWS: Mapping[str, tuple[float, float]] = {
    "up": (1.0, 0.0),
    "down": (-1.0, 0.0),
    "left": (0.0, 1.0),
    "right": (0.0, -1.0),
}
"""Factors of linear and angular speed."""
_HEADINGS: Mapping[str, float] = {key: number * math.pi / 4 for number, key in enumerate("cvbgtred", -3)}
"""Headings in rad, counter-clockwise from the right."""
_CANCEL, _QUIT = "f", "q"
_ESCAPED = {"A": "up", "B": "down", "C": "right", "D": "left"}
"""Letters at the end of what a terminal sends for an arrow: escape, `[` or `O`, letter."""
_ESCAPE = "\x1b"
_LONGEST_KEY = 3
"""Characters of an arrow."""
_ON_WINDOWS = {"H": "up", "P": "down", "M": "right", "K": "left"}
"""Characters after the one that announces an arrow."""
_WAIT_S = 0.05
_USAGE = 2


class Teleop(Node):
    """Publishes a velocity for each arrow, and sends goals for headings."""

    def __init__(self, context: Context | None = None) -> None:
        """`context`: the default one if None."""
        super().__init__("teleop_turtle", context=context)
        self.declare_parameter("scale_linear", 2.0)
        self.declare_parameter("scale_angular", 2.0)
        self._velocity = self.create_publisher(Twist, "turtle1/cmd_vel", 1)
        self._turn: ActionClient[Any, Any, Any] = ActionClient(self, RotateAbsolute, "turtle1/rotate_absolute")
        self._goal: ClientGoalHandle[Any, Any, Any] | None = None

    def press(self, key: str) -> bool:
        """Act on a key; return whether the program goes on."""
        key = key.lower()
        if key in _ARROWS:
            linear, angular = _ARROWS[key]
            twist = Twist()
            twist.linear.x = linear * self.get_parameter("scale_linear").value
            twist.angular.z = angular * self.get_parameter("scale_angular").value
            self._velocity.publish(twist)
        elif key in _HEADINGS:
            if not self._turn.server_is_ready():
                self.get_logger().warning(
                    "found no action turtle1/rotate_absolute: start `thymio-sim --like turtlesim`"
                )
                return True
            sent = self._turn.send_goal_async(RotateAbsolute.Goal(theta=_HEADINGS[key]))
            sent.add_done_callback(lambda answered: self._keep(answered.result()))
        elif key == _CANCEL and self._goal is not None:
            self._goal.cancel_goal_async()
            self._goal = None
        return key != _QUIT

    def _keep(self, goal: ClientGoalHandle[Any, Any, Any] | None) -> None:
        if goal is not None and goal.accepted:
            self._goal = goal
        else:
            self.get_logger().warning("the turn was rejected: the log of the turtle has the reason")


def keys_of(read: Callable[[], str]) -> Iterator[str]:
    """Yield the keys of the characters that a terminal sends; empty while there are none.

    `read` returns the characters that have arrived. An arrow is `up`, `down`, `left` or `right`.
    """
    waiting = ""
    while True:
        arrived = "" if len(waiting) >= _LONGEST_KEY else read()
        waiting += arrived
        if not waiting or (waiting[0] == _ESCAPE and len(waiting) < _LONGEST_KEY and arrived):
            yield ""  # the rest of the key may come
        elif waiting[0] == _ESCAPE and waiting[1:2] in ("[", "O"):
            yield _ESCAPED.get(waiting[2:3], "")
            waiting = waiting[_LONGEST_KEY:]
        else:
            yield waiting[0].strip(_ESCAPE)
            waiting = waiting[1:]


@contextlib.contextmanager
def _terminal() -> Iterator[Callable[[], str]]:
    """Yield a function that returns the characters that have arrived within `_WAIT_S`; lines need no end meanwhile."""
    if sys.platform == "win32":
        import msvcrt

        def read() -> str:
            if not msvcrt.kbhit():
                time.sleep(_WAIT_S)
                return ""
            first = msvcrt.getwch()
            return _ARROW_TEXT[_ON_WINDOWS.get(msvcrt.getwch(), "")] if first in "\0\xe0" else first

        yield read
        return
    import select
    import termios
    import tty

    terminal = sys.stdin.fileno()
    before = termios.tcgetattr(terminal)
    try:
        tty.setcbreak(terminal)
        yield (
            lambda: (
                os.read(terminal, 64).decode(errors="ignore") if select.select([terminal], [], [], _WAIT_S)[0] else ""
            )
        )
    finally:
        termios.tcsetattr(terminal, termios.TCSADRAIN, before)


_ARROW_TEXT = {"": "", **{arrow: f"\x1b[{letter}" for letter, arrow in _ESCAPED.items()}}


def main() -> int:
    """Run the program until Q or Ctrl-C; return the exit code."""
    if not sys.stdin.isatty():
        print("turtle_teleop_key: found no terminal, expected one with a keyboard", file=sys.stderr)
        return _USAGE
    try:
        rclpy.init()
        node = Teleop()
        print(HELP, flush=True)
        with _terminal() as read:
            for key in keys_of(read):
                if key and not node.press(key):
                    break
                rclpy.spin_once(node, timeout_sec=0.0)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
