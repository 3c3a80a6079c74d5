"""docs/ros.md from the declarations of the nodes: `python -m thymio_sim_ros.ros.generate_ros_docs > docs/ros.md`.

Plug-ins of other packages are left out: the page describes this package only.
"""

from __future__ import annotations

import itertools
import math
import sys
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import TypeVar

from thymio_sim_ros.files import registry
from thymio_sim_ros.names.type_names import type_name
from thymio_sim_ros.ros import combined_parameters
from thymio_sim_ros.ros.aseba.aseba_ros_mapping import mapping_tables
from thymio_sim_ros.ros.aseba.node import RuntimeParams
from thymio_sim_ros.ros.compat import tf2_messages
from thymio_sim_ros.ros.interface import driver_topics, qos, sensor_topics
from thymio_sim_ros.ros.interface.names import SIDES, is_hidden
from thymio_sim_ros.ros.interface.robot_inputs import robot_inputs
from thymio_sim_ros.ros.profiles._actions import OWN_ACTIONS
from thymio_sim_ros.ros.rclpy_ext import parameters
from thymio_sim_ros.ros.ros_docs_text import (
    ACTIONS,
    AFTER,
    ALL_IN_ONE,
    BEFORE,
    DRIVER,
    HIDDEN,
    INTERFACES,
    QUALITY,
    RVIZ,
)
from thymio_sim_ros.ros.simulator import robot_endpoints, world_services, world_topics
from thymio_sim_ros.ros.simulator.parameters import SimulatorParams
from thymio_sim_ros.ros.simulator.simulation_interfaces.services import OFFERS, PACKAGE, STEPS
from thymio_sim_ros.ros.simulator.visualization.urdf import fixed_frames, wheel_position
from thymio_sim_ros.sim import sensors
from thymio_sim_ros.sim.sensors import Sensor, all_sensors
from thymio_sim_ros.suite_config import SuiteConfig

__all__ = ["own_sensors", "published", "table", "text", "type_name"]

T = TypeVar("T")


@dataclass(frozen=True, slots=True)
class _Line:
    """A row for a topic; adjacent topics that differ only in the last part of their name are merged."""

    topic: str
    type: str
    rate: str
    frame: str
    profile: str
    about: str

    @property
    def place(self) -> str:
        """The name without its last part."""
        return self.topic.rpartition("/")[0]

    @property
    def sort(self) -> tuple[str, ...]:
        """Properties that merged topics have in common."""
        word = self.topic.rpartition("/")[2]
        frame = self.frame.replace(f"_{word}_", "_…_")
        return (self.place, self.type, self.rate, frame, self.profile, self.about)


def text() -> str:
    """The text of the page."""
    parts = [
        BEFORE,
        "## Published topics of a robot\n",
        _topics(line for line in _published() if not is_hidden(line.topic)),
        "## Subscribed topics of a robot\n",
        _topics(line for line in _listened() if not is_hidden(line.topic)),
        HIDDEN,
        "### Published hidden topics of a robot\n",
        _topics(line for line in _published() if is_hidden(line.topic)),
        "### Subscribed hidden topics of a robot\n",
        _topics(line for line in _listened() if is_hidden(line.topic)),
        DRIVER,
        table(("topic", "", "type", ""), _of_driver()),
        "## Topics of the world\n",
        _topics(_of_world()),
        "## Services\n",
        table(("service", "type", "description"), _services()),
        ACTIONS,
        table(
            ("action", "type", "description"), ((f"`{row.name}`", f"`{row.type}`", row.about) for row in OWN_ACTIONS)
        ),
        INTERFACES,
        table(("service", "type", "description"), _interfaces()),
        "## Quality of service\n",
        QUALITY,
        table(("kind", "depth", "for"), ((kind, str(one.depth), about) for kind, (one, about) in qos.KINDS.items())),
        "## Frames\n",
        _frames(),
        RVIZ,
        "## Parameters of the simulator\n",
        table(("parameter", "default", "values", "at run time", ""), _parameters(SimulatorParams())),
        "## Parameters of the Aseba runtime\n",
        "For details see [aseba_ros.md](aseba_ros.md).\n",
        table(("parameter", "default", "values", "at run time", ""), _parameters(RuntimeParams())),
        ALL_IN_ONE,
        table(("parameter", "node", "default"), _of_all_nodes()),
        AFTER,
        mapping_tables(own_sensors()),
    ]
    return "\n".join(parts)


def published() -> dict[str, tuple[str, str]]:
    """Type and kind of QoS of every topic of the simulator; names are absolute or relative to a robot's namespace."""
    return {line.topic: (line.type, line.profile) for line in (*_published(), *_of_world())}


def own_sensors() -> tuple[Sensor, ...]:
    """The shipped sensors, without plug-ins."""
    ours = registry.own_names(sensors)
    return tuple(sensor for sensor in all_sensors() if sensor.name in ours)


CELL_BAR = "\\|"
"""A vertical bar inside a cell of a Markdown table."""


def table(heads: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """A Markdown table, followed by an empty line."""
    lines = [heads, ["---"] * len(heads), *rows]
    return "".join(f"| {' | '.join(cell.replace('|', CELL_BAR) for cell in line)} |\n" for line in lines)


def _published() -> Iterator[_Line]:
    for sensor in own_sensors():
        for row in sensor_topics.rows_of(sensor):
            rate = sensor_topics.rate(sensor, row)
            profile = qos.kind_of(row.profile)
            yield _Line(row.topic, type_name(row.type), rate, row.frame, profile, row.about)
    kind, about = robot_endpoints.DESCRIPTION_TOPIC
    yield _Line(robot_endpoints.DESCRIPTION, type_name(kind), "once", "", "transient local", about)


def _listened() -> Iterator[_Line]:
    for robot_input in robot_inputs():
        yield _Line(
            robot_input.topic, type_name(robot_input.type), "", "", qos.kind_of(robot_input.profile), robot_input.about
        )


def _of_driver() -> Iterator[tuple[str, str, str, str]]:
    for topic, (direction, kind, about) in driver_topics.TOPICS.items():
        yield f"`{topic}`", direction, f"`{driver_topics.PACKAGE}/msg/{kind}`", about


def _of_world() -> Iterator[_Line]:
    for topic, world_topic in world_topics.TOPICS.items():
        yield _Line(
            _in_no_namespace(topic),
            type_name(world_topic.type),
            world_topic.rate,
            world_topic.frame,
            qos.kind_of(world_topic.profile),
            world_topic.about,
        )
    moving = "`map -> odom -> base_link` and the wheels; `map -> odom` compensates the drift of the odometry"
    yield _Line("/tf", tf2_messages.TF_TYPE_NAME, "20", "", "transforms", moving)
    yield _Line("/tf_static", tf2_messages.TF_TYPE_NAME, "once", "", "transient local", "the fixed frames below")
    yield _Line(
        _in_no_namespace(world_services.PLACE_TOPIC),
        "geometry_msgs/msg/TransformStamped",
        "in",
        "map",
        "command",
        world_services.PLACE_MEANING,
    )


def _in_no_namespace(name: str) -> str:
    """The absolute name of a topic or service of the simulator without a namespace."""
    return name if name.startswith("/") else f"/{name.replace('~', 'simulator')}"


def _topics(lines: Iterable[_Line]) -> str:
    """Topics grouped by their place, in the order of the first topic of each place."""
    listed = list(lines)
    places = {line.place: None for line in listed}
    ordered = [line for place in places for line in listed if line.place == place]
    has_rates, has_frames = any(line.rate for line in listed), any(line.frame for line in listed)
    rows = []
    for group in _runs(ordered, lambda line: line.sort):
        first = group[0]
        words = [line.topic.rpartition("/")[2] for line in group]
        word = words[0] if len(words) == 1 else f"{{{','.join(words)}}}"
        frame = first.frame if len(words) == 1 else first.frame.replace(f"_{words[0]}_", "_…_")
        name = f"{first.place}/{word}" if first.place or first.topic.startswith("/") else word
        cells = [f"`{name}`", f"`{first.type}`", first.rate, f"`{frame}`" if frame else "", first.profile, first.about]
        wanted = (True, True, has_rates, has_frames, True, True)
        rows.append([cell for cell, is_wanted in zip(cells, wanted, strict=True) if is_wanted])
    heads = [
        head for head, is_wanted in zip(("topic", "type", "Hz", "frame", "QoS", ""), wanted, strict=True) if is_wanted
    ]
    return table(heads, rows)


def _runs(items: Iterable[T], key: Callable[[T], object]) -> Iterator[list[T]]:
    for _, group in itertools.groupby(items, key=key):
        yield list(group)


def _services() -> Iterator[tuple[str, str, str]]:
    for name, (kind, about) in robot_endpoints.SERVICES.items():
        yield f"`{name}`", f"`{type_name(kind)}`", about
    for name, service in world_services.SERVICES.items():
        yield f"`{_in_no_namespace(name)}`", f"`{type_name(service.type)}`", service.about


def _interfaces() -> Iterator[tuple[str, str, str]]:
    for offer in (*OFFERS, STEPS):
        form = "action" if offer is STEPS else "srv"
        yield f"`/simulator/{offer.name}`", f"`{PACKAGE}/{form}/{offer.type}`", offer.about


def _frames() -> str:
    rows = [("`odom`", "`map`", "origin of the odometry in the world", ""), ("`base_link`", "`odom`", "odometry", "")]
    rows += [
        (f"`{side}_wheel_link`", "`base_link`", _vector(wheel_position(side)), "rotates about y") for side in SIDES
    ]
    for frame in fixed_frames():
        degrees = ", ".join(f"{math.degrees(angle):.4g}" for angle in frame.rotation)
        turn = "" if not any(frame.rotation) else f"roll, pitch, yaw {degrees}°"
        rows.append((f"`{frame.name}`", "`base_link`", _vector(frame.position), turn))
    return table(("frame", "parent", "position, m", ""), rows)


def _vector(values: Iterable[float]) -> str:
    return ", ".join(f"{value:.4g}" for value in values)


def _parameters(values: object) -> Iterator[tuple[str, str, str, str, str]]:
    """Rows of parameters; those that differ only in the middle of their names share a row."""
    for first, name in _grouped(values):
        yield (
            f"`{name}`",
            _value(first.default),
            _limits(first),
            "" if first.options.fixed else "yes",
            _cell(first.options.text),
        )


def _grouped(values: object) -> Iterator[tuple[parameters.Declared, str]]:
    """The first parameter of each group, and the name of its row."""
    groups: dict[tuple[str, str], list[parameters.Declared]] = {}
    for parameter in parameters.declared(values):
        groups.setdefault((_outer(parameter.name), parameter.options.text), []).append(parameter)
    for group in groups.values():
        first = group[0]
        several = f"{first.name.split('.')[0]}.<sensor>.{first.name.rpartition('.')[2]}"
        yield first, first.name if len(group) == 1 else several


def _of_all_nodes() -> Iterator[tuple[str, str, str]]:
    """Parameters of the combined process with their nodes and defaults; those of a group share a row."""
    values = combined_parameters.defaults(SuiteConfig())
    suite = ["port", "foxglove_port", "address"]
    for name in suite:
        nodes = combined_parameters.targets(name)
        node, own_name = nodes[-1]
        called = [f"`{target}`" if own == name else f"`{target}` (its `{own}`)" for target, own in nodes]
        yield f"`{name}`", ", ".join(called), _value(parameters.by_name(values[node])[own_name])
    for node, own in values.items():
        for first, line_name in _grouped(own):
            if first.name not in suite and combined_parameters.targets(first.name):
                yield f"`{line_name}`", f"`{node}`", _value(first.default)


def _outer(name: str) -> str:
    """The first and the last part of a dotted name."""
    words = name.split(".")
    return f"{words[0]}.{words[-1]}"


def _value(value: object) -> str:
    return f"`{str(value).lower() if isinstance(value, bool) else repr(value) if isinstance(value, str) else value}`"


def _limits(parameter: parameters.Declared) -> str:
    descriptor = parameter.descriptor
    for floats in descriptor.floating_point_range:
        return f"{floats.from_value:g}…{floats.to_value:g}"
    for integers in descriptor.integer_range:
        return f"{integers.from_value}…{integers.to_value}"
    return _cell(descriptor.additional_constraints)


def _cell(content: str) -> str:
    return content.replace("|", "\\|")


if __name__ == "__main__":
    sys.stdout.write(text())
