"""State of robots and programs as lines of failure messages."""

from __future__ import annotations

import math
from collections.abc import Iterable

from thymio_sim_ros.device.programs.status import FAULT
from thymio_sim_ros.testing.failure_messages import pluralized
from thymio_sim_ros.testing.thymio import Thymio

__all__ = ["robot_lines"]

_LAST_EVENTS = 3


def robot_lines(robots: Iterable[Thymio]) -> list[str]:
    """Two or three lines for each robot: its pose, the state of its program, its last events."""
    lines: list[str] = []
    for thymio in robots:
        if thymio.name in thymio.stage.world.robots:
            lines += [_place(thymio), *_program(thymio)]
        else:
            lines.append(f"{thymio.name}: no longer in the world")
    return lines


def _place(thymio: Thymio) -> str:
    pose, touching = thymio.pose, thymio.touching
    turned = round(math.degrees(pose.yaw_rad)) % 360
    x, y, speed = (round(value, 3) + 0.0 for value in (pose.x_m, pose.y_m, thymio.speed))  # never -0.000
    place = f"at ({x:.3f}, {y:.3f}) m, turned {turned}°, {speed:.3f} m/s"
    return f"{thymio.name}: {place}" + (f", touches {', '.join(touching)}" if touching else "")


def _program(thymio: Thymio) -> list[str]:
    machine = thymio.stage.machine(thymio.name)
    if machine is None:
        return []
    status = machine.device.status
    state = status.state
    if state == FAULT:
        state = f"fault in {status.event}, line {status.line}: {status.fault}"
    lines = [f"  program {machine.program.name}: {state}"]
    last = thymio.events[-_LAST_EVENTS:]
    if last:
        emitted = ", ".join(f"{event.name} {list(event.args)} at {event.at_s:.2f} s" for event in last)
        lines.append(f"  emitted {pluralized(len(thymio.events), 'event')}, last {emitted}")
    return lines
