"""Additional topics of a robot: those of the Thymio's ROS driver, or of a profile."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from thymio_sim_ros.ros.interface.robot_inputs import RobotInput
from thymio_sim_ros.ros.interface.sensor_topics import Row

__all__ = ["ExtraTopics"]


@dataclass(frozen=True, slots=True)
class ExtraTopics:
    """Published rows by sensor, and inputs."""

    rows: Mapping[str, Sequence[Row]] = field(default_factory=dict)
    inputs: Sequence[RobotInput] = ()

    def with_all(self, other: ExtraTopics) -> ExtraTopics:
        """Return the topics of both."""
        sensors = self.rows.keys() | other.rows.keys()
        rows = {name: (*self.rows.get(name, ()), *other.rows.get(name, ())) for name in sorted(sensors)}
        return ExtraTopics(rows, (*self.inputs, *other.inputs))
