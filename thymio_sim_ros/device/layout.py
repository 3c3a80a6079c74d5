"""The Thymio that programs are compiled for: firmware 14, and what plug-ins add behind it."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

from aseba_vm import NativeFunction, Parameter, TargetDescription, Variable
from aseba_vm.targets import THYMIO_II
from thymio_sim_ros.sim.actuators import all_actuators
from thymio_sim_ros.sim.sensors import all_sensors

PRODUCT_ID = 8
FIRMWARE = (14, 1)
"""Values of `_productId` and `_fwversion` (thymio-robot.md section 4)."""


@cache
def target() -> TargetDescription:
    """Firmware 14 in its own order; variables and natives that only a plug-in knows come after it."""
    variables = {variable.name: variable for variable in THYMIO_II.variables}
    natives = {native.name: native for native in THYMIO_II.natives}
    faces = [sensor.aseba.variables for sensor in all_sensors()]
    for actuator in all_actuators():
        faces += [output.variables for output in actuator.aseba.outputs]
        for native in actuator.aseba.natives:
            parameters = tuple(Parameter(name, 1) for name in native.parameters)
            natives.setdefault(native.name, NativeFunction(native.name, parameters, native.description))
    for face in faces:
        for name, size in face:
            variables.setdefault(name, Variable(name, size))
    return replace(THYMIO_II, variables=tuple(variables.values()), natives=tuple(natives.values()))
