"""Primitives as JSON, as the page draws them (`web_ui/playground/primitives.js`).

- `solid`: `pose`, `size` of a box or null for a disc with `radius`, `height`, `color`
- `floor` and `paint`: `vertices`, `color`
- `trigger`: `vertices`, `door`

Lengths are in m, poses have `x`, `y` and `yaw` in rad, colors are `#rrggbb`.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from thymio_sim_ros.sim.model.geometry import Pose
from thymio_sim_ros.sim.model.primitives import Box, Color, Disc, Floor, Outline, Paint, Primitive, Solid, Trigger

__all__ = ["primitive_declarations"]


def primitive_declarations(primitives: Iterable[Primitive]) -> list[dict[str, Any]]:
    """Each primitive as an object; images on the ground are left out, since the page has them as files."""
    found: list[dict[str, Any]] = []
    for primitive in primitives:
        match primitive:
            case Solid(_, pose, outline, height_m, color):
                found.append({"type": "solid", **_solid(pose, outline), "height": height_m, "color": _hex(color)})
            case Floor(_, vertices, color):
                found.append({"type": "floor", "vertices": vertices, "color": _hex(color)})
            case Paint(_, vertices, color):
                found.append({"type": "paint", "vertices": vertices, "color": _hex(color)})
            case Trigger(_, vertices, door):
                found.append({"type": "trigger", "vertices": vertices, "door": door})
    return found


def _solid(pose: Pose, outline: Outline) -> dict[str, Any]:
    """Pose, size and radius; of a polygon those of its bounding box, since the page draws boxes and discs only."""
    match outline:
        case Disc(radius_m):
            size, radius = None, radius_m
        case Box(size_x_m, size_y_m):
            size, radius = [size_x_m, size_y_m], 0.0
        case _:
            xs, ys = zip(*outline.vertices, strict=True)
            size, radius = [max(xs) - min(xs), max(ys) - min(ys)], 0.0
            pose = Pose(*pose.place(((max(xs) + min(xs)) / 2, (max(ys) + min(ys)) / 2)), pose.yaw_rad)
    return {"pose": {"x": pose.x_m, "y": pose.y_m, "yaw": pose.yaw_rad}, "size": size, "radius": radius}


def _hex(color: Color) -> str:
    return "#" + "".join(f"{round(255 * part):02x}" for part in color)
