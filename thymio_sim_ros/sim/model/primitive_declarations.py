"""Primitives as JSON, as the page draws them (`web_ui/playground/primitives.js`).

- `solid`: `pose`, `height`, `color` and its outline: `size` of a box, `radius` of a disc, or `vertices` of a convex
  polygon in the frame of the pose
- `floor` and `paint`: `vertices`, `color`
- `print`: `pose`, `sizeX`, `sizeY`
- `trigger`: `vertices`, `door`

Lengths are in m, poses have `x`, `y` and `yaw` in rad, colors are `#rrggbb`.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from thymio_sim_ros.sim.model.geometry import Pose
from thymio_sim_ros.sim.model.primitives import Box, Disc, Floor, Outline, Paint, Primitive, Print, Solid, Trigger

__all__ = ["primitive_declarations"]


def primitive_declarations(primitives: Iterable[Primitive]) -> list[dict[str, Any]]:
    """Each primitive as an object, prints without their pixels."""
    found: list[dict[str, Any]] = []
    for primitive in primitives:
        match primitive:
            case Solid(_, pose, outline, height_m, color):
                outlined = {"pose": _pose(pose), **_outline(outline)}
                found.append({"type": "solid", **outlined, "height": height_m, "color": _hex(color)})
            case Floor(_, vertices, color):
                found.append({"type": "floor", "vertices": vertices, "color": _hex(color)})
            case Paint(_, vertices, color):
                found.append({"type": "paint", "vertices": vertices, "color": _hex(color)})
            case Print(_, pose, size_x_m, size_y_m):
                found.append({"type": "print", "pose": _pose(pose), "sizeX": size_x_m, "sizeY": size_y_m})
            case Trigger(_, vertices, door):
                found.append({"type": "trigger", "vertices": vertices, "door": door})
    return found


def _outline(outline: Outline) -> dict[str, Any]:
    match outline:
        case Box(size_x_m, size_y_m):
            return {"size": (size_x_m, size_y_m)}
        case Disc(radius_m):
            return {"radius": radius_m}
        case _:
            return {"vertices": outline.vertices}


def _pose(pose: Pose) -> dict[str, float]:
    return {"x": pose.x_m, "y": pose.y_m, "yaw": pose.yaw_rad}


def _hex(color: tuple[float, ...]) -> str:
    return "#" + "".join(f"{round(255 * part):02x}" for part in color)
