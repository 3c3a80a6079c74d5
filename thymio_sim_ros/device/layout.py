"""The Thymio that programs are compiled for: firmware 14, and what plug-ins add behind it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import cache

from aseba_vm import LocalEvent, NativeFunction, Parameter, TargetDescription, Variable
from aseba_vm.targets import THYMIO_II
from thymio_sim_ros.sim.actuators import Actuator, all_actuators
from thymio_sim_ros.sim.sensors import Sensor, all_sensors

PRODUCT_ID = 8
FIRMWARE = (14, 1)
"""Values of `_productId` and `_fwversion` (thymio-robot.md section 4)."""


@cache
def target() -> TargetDescription:
    """The target of this installation."""
    return extend(THYMIO_II, all_sensors(), all_actuators())


def extend(base: TargetDescription, sensors: Sequence[Sensor], actuators: Sequence[Actuator]) -> TargetDescription:
    """The base in its own order; what only a plug-in knows comes after it, and programs keep their room.

    ValueError when a plug-in gives a name that exists another size.
    """
    variables = {variable.name: variable for variable in base.variables}
    events = {event.name: event for event in base.local_events}
    natives = {native.name: native for native in base.natives}
    faces = [sensor.aseba for sensor in sensors]
    declared = [variable for face in faces for variable in face.variables]
    declared += [pair for actuator in actuators for output in actuator.aseba.outputs for pair in output.variables]
    for name, size in declared:
        if variables.setdefault(name, Variable(name, size)).size != size:
            raise ValueError(f"variable {name}: a plug-in declares {size} words, expected {variables[name].size}")
    for face in faces:
        edges = [name for name, _ in face.variables] if face.edge_events else []
        for name in [*edges, *([face.event] if face.event else [])]:
            events.setdefault(name, LocalEvent(name))
    for native in (native for actuator in actuators for native in actuator.aseba.natives):
        parameters = tuple(Parameter(name, size) for name, size in native.signature)
        known = natives.setdefault(native.name, NativeFunction(native.name, parameters, native.description))
        sizes, expected = ([one.size for one in both] for both in (parameters, known.parameters))
        if sizes != expected:
            raise ValueError(
                f"native {native.name}: a plug-in declares parameters of {sizes} words, expected {expected}"
            )
    extended = replace(
        base,
        variables=tuple(variables.values()),
        local_events=tuple(events.values()),
        natives=tuple(natives.values()),
    )
    return replace(extended, variables_size=base.variables_size + extended.variables_end - base.variables_end)
