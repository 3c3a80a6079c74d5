"""A bridge without ROS in the process of a worker, made by the classes of its checkout: publishes on demand.

`bridge` imports only what all compared checkouts have; those before 83af4efb have a `ServerThread` in their bridge.
"""

from __future__ import annotations

import importlib
import time
from collections.abc import Callable
from typing import Any

CHANNEL = 1
"""Number of the only channel."""


class Sink:
    """Ignores the requests of clients."""

    def is_full(self, client: int) -> bool:
        """Never."""
        return False

    def post(self, event: Any) -> None:
        """Ignore it."""


def bridge() -> Callable[..., Any]:
    """Start a bridge; return a function of its commands: "port", and "publish" with `publish`'s arguments."""
    messages = importlib.import_module("thymio_sim_ros.bridge.protocol.messages")
    events = importlib.import_module("thymio_sim_ros.bridge.switchboard.events")
    channel = messages.Channel(CHANNEL, "/t", "cdr", "std_msgs/msg/String", "string data", "ros2msg")
    server = importlib.import_module("thymio_sim_ros.bridge")
    port, execute, publish = (_by_itself if hasattr(server, "ServerThread") else _on_page)(server)
    execute(events.AddChannels((channel,)))

    def run(command: str, *arguments: Any) -> Any:
        return port if command == "port" else _publish(publish, *arguments)

    return run


def _on_page(server: Any) -> tuple[int, Callable[[Any], object], Callable[[int, int, bytes], object]]:
    web = importlib.import_module("thymio_sim_ros.web.thread")
    board = importlib.import_module("thymio_sim_ros.bridge.switchboard.switchboard")
    thread = web.ServerThread(warn=print)
    made = server.BridgeServer(board.Switchboard(server.ServerInfo("benchmark", ())), Sink(), thread.loop)
    thread.mount_bridge(made)
    return thread.listen("127.0.0.1", 0)[1], made.execute, made.publish


def _by_itself(server: Any) -> tuple[int, Callable[[Any], object], Callable[[int, int, bytes], object]]:
    thread = server.ServerThread(server.ServerInfo("benchmark", ()), Sink(), address="127.0.0.1", port=0)
    return thread.port, thread.post, thread.publish


def _publish(publish: Callable[[int, int, bytes], object], bursts: int, of: int, period_s: float, size: int) -> float:
    """Publish so many bursts of messages, one per period; return the CPU time of the process, s.

    Each payload begins with the time of its publication, in ns by the monotonic clock.
    """
    rest, began_s = bytes(size - 8), time.process_time()
    next_s = time.monotonic()
    for _ in range(bursts):
        for _ in range(of):
            publish(CHANNEL, 0, time.monotonic_ns().to_bytes(8, "little") + rest)
        next_s += period_s
        time.sleep(max(0.0, next_s - time.monotonic()))
    return time.process_time() - began_s
