"""The URDF of the robot, built from primitives for RViz and Foxglove, and its fixed frames.

Source: docs/spec/ros-interface.md section 8.
"""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass

from thymio_sim_ros.ros.interface.names import PROXIMITY, SCAN_FRAME, SIDES, RobotNames
from thymio_sim_ros.sim.model import robot_constants
from thymio_sim_ros.sim.model.lidar import LIDAR_HEIGHT_M, LIDAR_PLACE

LASER_HEIGHT_M = 0.035
GROUND_SENSOR_HEIGHT_M = 0.009
GROUND_CLEARANCE_M = 0.008
BUTTONS_X_M = 0.048
LIDAR_HEAD_M = (0.02, 0.016)
"""Radius and height of the head of the lidar, only drawn."""
FRONT_STEPS = 6
WHEEL_SIDE = {"left": 1.0, "right": -1.0}


@dataclass(frozen=True, slots=True)
class FixedFrame:
    """A frame fixed to `base_link`: position in m, roll pitch yaw in rad."""

    name: str
    position: tuple[float, float, float]
    rotation: tuple[float, float, float]

    @property
    def quaternion(self) -> tuple[float, float, float, float]:
        """The rotation as x, y, z, w."""
        roll, pitch, yaw = (angle / 2 for angle in self.rotation)
        cr, sr, cp, sp, cy, sy = (f(a) for a in (roll, pitch, yaw) for f in (math.cos, math.sin))
        return (
            sr * cp * cy - cr * sp * sy,
            cr * sp * cy + sr * cp * sy,
            cr * cp * sy - sr * sp * cy,
            cr * cp * cy + sr * sp * sy,
        )


def fixed_frames(*, has_lidar: bool = False, base: str = "base_link") -> tuple[FixedFrame, ...]:
    """Return the frames of the simulated sensors, x along the viewing direction; `base` is that of the robot."""
    # A robot whose frame is called base_footprint has a base_link at the same place.
    other = "base_link" if base == "base_footprint" else "base_footprint"
    frames = [FixedFrame(other, (0.0, 0.0, 0.0), (0.0, 0.0, 0.0))]
    for name, (x_m, y_m, yaw_rad) in zip(PROXIMITY, robot_constants.PROXIMITY_POSES, strict=True):
        frames.append(
            FixedFrame(f"proximity_{name}_link", (x_m, y_m, robot_constants.PROXIMITY_HEIGHT_M), (0.0, 0.0, yaw_rad))
        )
    for side, (x_m, y_m) in zip(SIDES, robot_constants.GROUND_SENSORS, strict=True):
        frames.append(FixedFrame(f"ground_{side}_link", (x_m, y_m, GROUND_SENSOR_HEIGHT_M), (0.0, math.pi / 2, 0.0)))
    frames.append(FixedFrame("laser_link", (0.0, 0.0, LASER_HEIGHT_M), (0.0, 0.0, 0.0)))
    if has_lidar:
        frames.append(FixedFrame(SCAN_FRAME, (*LIDAR_PLACE, LIDAR_HEIGHT_M), (0.0, 0.0, 0.0)))
    return tuple(frames)


def wheel_position(side: str) -> tuple[float, float, float]:
    """Return the center of a wheel in `base_link`, m."""
    return (0.0, WHEEL_SIDE[side] * robot_constants.WHEEL_TRACK_M / 2, robot_constants.WHEEL_RADIUS_M)


def urdf(names: RobotNames, *, has_lidar: bool = False) -> str:
    """Return the URDF of one robot, with its prefix on link and joint names; `has_lidar`: with one on its back."""
    height = robot_constants.BODY_HEIGHT_M
    parts = [
        '<?xml version="1.0"?>',
        f'<robot name="{names.name or "thymio"}">',
        '<material name="white"><color rgba="0.95 0.95 0.95 1"/></material>',
        '<material name="gray"><color rgba="0.25 0.25 0.27 1"/></material>',
        f'<link name="{names.frame("base_link")}">',
        *(
            _visual(
                ((rear + front) / 2, 0, (height + GROUND_CLEARANCE_M) / 2),
                _box(front - rear, width, height - GROUND_CLEARANCE_M),
            )
            for rear, front, width in _slabs()
        ),
        _visual((BUTTONS_X_M, 0, height), _box(0.045, 0.045, 0.004), "gray"),
        *([_visual((*LIDAR_PLACE, height + LIDAR_HEAD_M[1] / 2), _cylinder(*LIDAR_HEAD_M), "gray")] * has_lidar),
        "</link>",
    ]
    for side in SIDES:
        x, y, z = wheel_position(side)
        link, joint = names.frame(f"{side}_wheel_link"), names.frame(f"{side}_wheel_joint")
        radius, thickness = robot_constants.WHEEL_RADIUS_M, robot_constants.WHEEL_WIDTH_M
        parts += [
            f'<link name="{link}">',
            _visual((0, 0, 0), _cylinder(radius, thickness), "gray", roll=math.pi / 2),
            _visual((0, 0, 0), _box(radius * 1.7, thickness * 1.05, radius * 0.3)),
            "</link>",
            f'<joint name="{joint}" type="continuous"><parent link="{names.frame("base_link")}"/>',
            f'<child link="{link}"/><origin xyz="{x} {y} {z}"/><axis xyz="0 1 0"/></joint>',
        ]
    for frame in fixed_frames(has_lidar=has_lidar, base=names.frames.base_link):
        xyz, rpy = (" ".join(f"{v:.6g}" for v in vector) for vector in (frame.position, frame.rotation))
        link = names.fixed_frame(frame.name)
        parts.append(f'<link name="{link}"/>')
        parts.append(
            f'<joint name="{link}_joint" type="fixed"><parent link="{names.frame("base_link")}"/>'
            f'<child link="{link}"/><origin xyz="{xyz}" rpy="{rpy}"/></joint>'
        )
    parts.append("</robot>")
    return "\n".join(parts)


def _box(x: float, y: float, z: float) -> str:
    return f'<box size="{x:.4f} {y:.4f} {z:.4f}"/>'


def _cylinder(radius: float, length: float) -> str:
    return f'<cylinder radius="{radius}" length="{length}"/>'


def _slabs() -> list[tuple[float, float, float]]:
    """Return the hull as boxes (rear x, front x, width in m); the round front is approximated in steps."""
    radius, half_width = robot_constants.HULL_RADIUS_M, robot_constants.HULL_WIDTH_M / 2
    corner = math.sqrt(radius**2 - half_width**2)
    edges = [corner + (radius - corner) * step / FRONT_STEPS for step in range(FRONT_STEPS + 1)]
    round_part = [
        (rear, front, 2 * math.sqrt(radius**2 - ((rear + front) / 2) ** 2)) for rear, front in itertools.pairwise(edges)
    ]
    return [(robot_constants.HULL_REAR_X_M, corner, 2 * half_width), *round_part]


def _visual(xyz: tuple[float, float, float], geometry: str, material: str = "white", *, roll: float = 0.0) -> str:
    x, y, z = xyz
    return (
        f'<visual><origin xyz="{x:.4f} {y:.4f} {z:.4f}" rpy="{roll:.6g} 0 0"/>'
        f'<geometry>{geometry}</geometry><material name="{material}"/></visual>'
    )
