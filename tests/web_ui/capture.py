"""Capture messages as rclpy serializes them, for the tests of the page: writes tests/data/web/messages.json.

Run it where rclpy is installed (`python tests/web_ui/capture.py`) when the page starts to use another type.
"""

from __future__ import annotations

import json
import os
import re
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from diagnostic_msgs.msg import DiagnosticStatus, KeyValue
from geometry_msgs.msg import Point, Twist, Vector3
from nav_msgs.msg import Odometry
from rclpy.serialization import serialize_message
from sensor_msgs.msg import JointState, Range
from std_msgs.msg import Bool, ColorRGBA, Float32MultiArray, Int16MultiArray, MultiArrayDimension, String
from std_srvs.srv import SetBool, Trigger
from visualization_msgs.msg import Marker, MarkerArray

TARGET = Path(__file__).parents[1] / "data" / "web" / "messages.json"


def messages() -> Iterator[Any]:
    """Return one message of every type the page reads or writes, with odd lengths so that padding occurs."""
    yield String(data='{"title": "Bögen"}')
    yield Bool(data=True)
    yield Twist(linear=Vector3(x=0.125), angular=Vector3(z=-2.5))
    odometry = Odometry(child_frame_id="base_link")
    odometry.header.frame_id = "map"
    odometry.header.stamp.sec, odometry.header.stamp.nanosec = 12, 340_000_000
    odometry.pose.pose.position = Point(x=0.25, y=-0.5, z=0.0)
    odometry.pose.pose.orientation.z, odometry.pose.pose.orientation.w = 0.6, 0.8
    yield odometry
    yield JointState(name=["left_wheel_joint", "right_wheel_joint"], position=[1.5, 2.5], velocity=[3.0, 4.0])
    yield Range(radiation_type=Range.INFRARED, field_of_view=0.25, min_range=0.0, max_range=0.125, range=0.0625)
    groups = [MultiArrayDimension(label="top", size=3, stride=3), MultiArrayDimension(label="remote", size=1, stride=1)]
    leds = Float32MultiArray(data=[0.0, 0.5, 1.0, 0.25])
    leds.layout.dim = groups
    yield leds
    yield Int16MultiArray(data=[0, -1, 4505])
    values = [KeyValue(key="state", value="running"), KeyValue(key="program", value="line.aesl")]
    yield DiagnosticStatus(level=DiagnosticStatus.WARN, name="robot/program", message="paused", values=values)
    box = Marker(ns="solid/wall", id=7, type=Marker.CUBE, color=ColorRGBA(r=0.5, g=0.25, b=1.0, a=1.0))
    box.scale = Vector3(x=1.0, y=0.5, z=0.125)
    box.points = [Point(x=1.0), Point(y=2.0)]
    yield MarkerArray(markers=[Marker(action=Marker.DELETEALL), box])
    yield Trigger.Request()
    yield Trigger.Response(success=True, message="done")
    yield SetBool.Request(data=True)


def schema(message_type: type) -> tuple[str, str]:
    """Return name and complete definition text of a type, as a bridge advertises them."""
    package, kind, name = (
        message_type.__module__.split(".")[0],
        message_type.__module__.split(".")[1],
        message_type.__name__,
    )
    share = _share(package)
    if kind == "srv":
        base, _, half = name.rpartition("_")
        parts = re.split(r"^---$", (share / "srv" / f"{base}.srv").read_text(), flags=re.MULTILINE)
        root = parts[half == "Response"]
    else:
        root = (share / "msg" / f"{name}.msg").read_text()
    texts = [root]
    seen: set[str] = set()
    pending = [(package, root)]
    while pending:
        owner, text = pending.pop(0)
        for line in text.splitlines():
            used = re.match(r"\s*([A-Z]\w*|\w+/\w+)[\[\s]", line)
            if used is None:
                continue
            full = used[1] if "/" in used[1] else f"{owner}/{used[1]}"
            if full in seen:
                continue
            seen.add(full)
            part, leaf = full.split("/")
            body = (_share(part) / "msg" / f"{leaf}.msg").read_text()
            texts.append(f"{'=' * 80}\nMSG: {full}\n{body}")
            pending.append((part, body))
    return f"{package}/{kind}/{name}", "\n".join(_without_comments(text) for text in texts)


def value(message: Any) -> Any:
    """Convert a message to plain data."""
    if hasattr(message, "get_fields_and_field_types"):
        return {name: value(getattr(message, name)) for name in message.get_fields_and_field_types()}
    if isinstance(message, bytes):
        return message[0]
    if hasattr(message, "tolist"):
        return message.tolist()
    if isinstance(message, (list, tuple)):
        return [value(item) for item in message]
    return message


def _share(package: str) -> Path:
    """Return the folder of a package's definitions: in a sourced ROS, else beside the Python of the ROS wheels."""
    prefixes = [*os.environ.get("AMENT_PREFIX_PATH", "").split(os.pathsep), sys.prefix]
    return next(path for prefix in prefixes if prefix and (path := Path(prefix) / "share" / package).is_dir())


def _without_comments(text: str) -> str:
    lines = (line.partition("#")[0].rstrip() for line in text.splitlines())
    return "\n".join(line for line in lines if line)


def main() -> None:
    """Write the file."""
    captured = []
    for message in messages():
        name, text = schema(type(message))
        captured.append(
            {"schemaName": name, "schema": text, "hex": serialize_message(message).hex(), "value": value(message)}
        )
    TARGET.parent.mkdir(parents=True, exist_ok=True)
    TARGET.write_text(json.dumps(captured, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
