"""Publishes the status of one robot's machine and the description of its program."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cache

from diagnostic_msgs.msg import DiagnosticStatus, KeyValue
from rclpy.node import Node
from std_msgs.msg import String

from thymio_sim_ros.device.editor import language_service
from thymio_sim_ros.device.programs.breakpoints import Breakpoints
from thymio_sim_ros.device.programs.program import ThymioProgram, memory_use
from thymio_sim_ros.device.programs.status import FAULT, RUNNING, DeviceStatus
from thymio_sim_ros.ros.interface import qos
from thymio_sim_ros.ros.interface.names import RobotNames

__all__ = ["LoadedProgram", "StatusEndpoints", "describe_position"]


@dataclass(frozen=True, slots=True)
class LoadedProgram:
    """A loaded program: topic words of its events, notes for the user, breakpoints."""

    program: ThymioProgram
    topics: Mapping[str, str] = field(default_factory=dict)
    notes: tuple[str, ...] = ()
    breakpoints: Breakpoints = field(default_factory=Breakpoints)


class StatusEndpoints:
    """The retained topics `_aseba/status` and `_aseba/target`."""

    def __init__(self, node: Node, names: RobotNames, *, number: int) -> None:
        self._node = node
        self._name = f"{node.get_namespace().strip('/')}/aseba: {names.name or 'robot'}".removeprefix("/")
        self._number = number
        self._last: tuple[DeviceStatus, int | None, str] | None = None
        self._constant: list[KeyValue] = []
        self._program = ""
        self.message = DiagnosticStatus(name=self._name)
        self._status = node.create_publisher(DiagnosticStatus, names.topic("_aseba/status"), qos.TRANSIENT_LOCAL)
        self._target = node.create_publisher(String, names.topic("_aseba/target"), qos.TRANSIENT_LOCAL)

    def set_program(self, loaded: LoadedProgram, spoken: str) -> None:
        """Publish the target of a changed program; help texts are in the language `spoken`. The status follows."""
        self._last = None
        self._constant = _constant(loaded)
        self._program = loaded.program.name
        described = json.dumps(language_service.describe_program(loaded.program, loaded.topics))
        fixed = _target_json(loaded.program.layout, spoken)
        self._target.publish(String(data=f'{fixed[:-1]}, "program": {described}}}'))

    def publish_if_changed(self, status: DeviceStatus, overload: str = "") -> bool:
        """Publish the status if it has changed, and return whether it has. `overload`: a warning text."""
        is_running = status.state == RUNNING
        shown = DeviceStatus(RUNNING) if is_running else status
        overload = overload if is_running else ""
        if self._last == (shown, shown.pc, overload):
            return False
        self._last = (shown, shown.pc, overload)
        level = DiagnosticStatus.WARN if overload else DiagnosticStatus.OK
        self.message = DiagnosticStatus(
            level=DiagnosticStatus.ERROR if shown.state == FAULT else level,
            name=self._name,
            hardware_id=f"node {self._number}",
            message=shown.fault or overload or shown.state,
            values=[
                KeyValue(key="state", value=shown.state),
                *self._constant,
                KeyValue(key="event", value=shown.event),
                KeyValue(key="line", value=_text(shown.line)),
                KeyValue(key="pc", value=_text(shown.pc)),
                KeyValue(key="fault", value=shown.fault),
                KeyValue(key="faults", value=json.dumps(dict(shown.faults))),
                KeyValue(key="overload", value=overload),
            ],
        )
        if shown.state == FAULT:
            self._node.get_logger().error(f"{self._name}: {self._program}: line {shown.line}: {shown.fault}")
        self._status.publish(self.message)
        return True

    def close(self) -> None:
        """Destroy the topics."""
        self._node.destroy_publisher(self._status)
        self._node.destroy_publisher(self._target)


def describe_position(status: DeviceStatus) -> str:
    """Return the state with line and event, for the user."""
    if status.state == RUNNING or status.line is None:
        return status.state
    return f"{status.state} at line {status.line} in {status.event}"


def _constant(loaded: LoadedProgram) -> list[KeyValue]:
    """Return the values that do not change while a program runs."""
    program, points = loaded.program, loaded.breakpoints
    warnings = [
        {key: warning[key] for key in ("line", "column", "message")} for warning in language_service.doubts(program)
    ]
    warnings += [{"line": None, "column": None, "message": note} for note in loaded.notes]
    values = {
        "program": program.name,
        "node": program.node.name,
        "first_line": str(program.lines[0]),
        "breakpoints": json.dumps(points.lines),
        "breakpoints_moved": json.dumps({str(line): new for line, new in points.moved.items()}),
        "warnings": json.dumps(warnings),
    }
    for memory, (used, size) in memory_use(program.program, program.layout).items():
        values |= {f"{memory}_used": str(used), f"{memory}_size": str(size)}
    return _pairs(values)


def _pairs(values: Mapping[str, str]) -> list[KeyValue]:
    return [KeyValue(key=key, value=value) for key, value in values.items()]


def _text(number: int | None) -> str:
    return "" if number is None else str(number)


@cache
def _target_json(layout: str, spoken: str) -> str:
    return json.dumps(language_service.describe_target(layout, spoken))
