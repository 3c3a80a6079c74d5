"""Tables of the topics for a program's variables, events and native functions, from the declarations of plug-ins."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from thymio_sim_ros.device import bindings
from thymio_sim_ros.device.layout import LAYOUTS, THYMIO
from thymio_sim_ros.ros.interface import command_topics, sensor_topics
from thymio_sim_ros.ros.interface.names import is_hidden
from thymio_sim_ros.sim.actuators import all_actuators
from thymio_sim_ros.sim.commands import Command
from thymio_sim_ros.sim.plugin_api.aseba_binding import Native
from thymio_sim_ros.sim.sensors import Sensor

__all__ = ["mapping_tables"]

STANDARD = ("math.", "deque.")
INSIDE = "internal: `aseba/get_variables`, `aseba/set_variables`"
HEADS = "| {} | | topic |\n| --- | --- | --- |\n"


def mapping_tables(sensing: Sequence[Sensor]) -> str:
    """Return three Markdown tables: variables, local events and native functions of the robot."""
    described = LAYOUTS[THYMIO].base
    parts = ["### Variables\n", "\n", HEADS.format("Aseba")]
    sensors = {name: sensor for sensor in sensing for name, _ in sensor.aseba.variables}
    outputs = dict(_outputs())
    for variable in described.variables:
        size = f"[{variable.size}]" if variable.size > 1 else ""
        parts.append(f"| `{variable.name}{size}` | {_variable(variable.name, sensors, outputs)} |\n")
    parts += ["\n### Local events\n", "\n", HEADS.format("onevent")]
    events = dict(_events(sensing))
    for event in described.local_events:
        sensor = events.get(event.name)
        where = f"out | {_sensed(sensor, event.name)}" if sensor else "| timers of your own node"
        parts.append(f"| `{event.name}` | {where} |\n")
    parts += ["\n### Native functions\n", "\n", HEADS.format("call")]
    natives = bindings.natives()
    for native in described.natives:
        if native.name.startswith(STANDARD):
            continue
        arguments = ", ".join(parameter.name for parameter in native.parameters)
        topic = _topic_of(natives[native.name]) if native.name in natives else None
        where = f"in | `{topic}`" if topic else "| internal"
        parts.append(f"| `{native.name}({arguments})` | {where} |\n")
    parts.append("\nFor `math.*` and `deque.*` use Python.\n")
    return "".join(parts)


def _variable(name: str, sensors: dict[str, Sensor], outputs: dict[str, str]) -> str:
    if name in sensors:
        return f"out | {_sensed(sensors[name], name)}"
    return f"in | `{outputs[name]}`" if name in outputs else f"| {INSIDE}"


def _sensed(sensor: Sensor, name: str) -> str:
    """Return the topics of a variable: in SI units (only the one for the last word of its name, if any), then raw."""
    topics = [row.topic for row in sensor_topics.rows_of(sensor)]
    *units, raw = topics
    units = [topic for topic in units if not is_hidden(topic)] or units
    own = [topic for topic in units if topic.endswith(f"/{name.rpartition('.')[2]}")]
    if own:
        return ", ".join(f"`{topic}`" for topic in (*own, raw))
    places = {topic.rpartition("/")[0] for topic in units if "/" in topic and topic.partition("/")[0] == sensor.name}
    short = [f"{place}/…" for place in sorted(places)] + [
        topic for topic in units if topic.rpartition("/")[0] not in places or topic == sensor.name
    ]
    return ", ".join(f"`{topic}`" for topic in [*dict.fromkeys(short), raw])


def _outputs() -> Iterator[tuple[str, str]]:
    for output in (output for actuator in all_actuators() for output in actuator.aseba.outputs):
        topic = command_topics.topic_of(output.command([0] * sum(size for _, size in output.variables)))
        if topic is not None:
            yield from ((name, topic) for name, _ in output.variables)


def _events(sensing: Sequence[Sensor]) -> Iterator[tuple[str, Sensor]]:
    for sensor in sensing:
        if sensor.aseba.edge_events:
            yield from ((name, sensor) for name, _ in sensor.aseba.variables)
        if sensor.aseba.event:
            yield sensor.aseba.event, sensor


def _topic_of(native: Native) -> str | None:
    return command_topics.topic_of(_sample(native))


def _sample(native: Native) -> Command:
    return native.command([0] * sum(size for _, size in native.signature))
