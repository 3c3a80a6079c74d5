"""Targets of the compiler: the layout of the robot or of the reference playground, extended by plug-ins.

A layout is the order of variables, events and native functions (docs/spec/thymio-robot.md sections 4 and 6.1). Programs
refer to them by name, bytecode by position: it runs only on the layout for which it was compiled. A robot behind a
network has the layout that it describes (`described`).
"""

from __future__ import annotations

import logging
import zlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache

from aseba_vm import LocalEvent, NativeFunction, Parameter, TargetDescription, Variable
from aseba_vm.targets import THYMIO_II
from thymio_sim_ros.files import registry
from thymio_sim_ros.sim import actuators, sensors
from thymio_sim_ros.sim.actuators import Actuator, all_actuators
from thymio_sim_ros.sim.sensors import Sensor, all_sensors

__all__ = ["LAYOUTS", "PLAYGROUND", "THYMIO", "Layout", "compatible_plugins", "described", "extend", "target"]

THYMIO, PLAYGROUND = "thymio", "playground"

PRODUCT_ID = 8
"""Value of `_productId` (section 4)."""

_PLAYGROUND_VARIABLES = """
    _id event.source event.args _productId _fwversion button.backward button.left button.center button.forward
    button.right prox.horizontal prox.comm.rx prox.comm.tx prox.ground.ambiant prox.ground.reflected
    prox.ground.delta motor.left.target motor.right.target motor.left.speed motor.right.speed motor.left.pwm
    motor.right.pwm acc temperature rc5.address rc5.command mic.intensity mic.threshold timer.period sd.present
"""
_PLAYGROUND_NATIVES = """
    sound.record sound.play sound.replay sound.system leds.circle leds.top leds.bottom.right leds.bottom.left
    sound.freq leds.buttons leds.prox.h leds.prox.v leds.rc leds.sound leds.temperature sound.wave
    prox.comm.enable sd.open sd.write sd.read sd.seek sound.duration
"""
_FREE_WORDS = 512
"""Words for the variables of programs, in every layout."""
_STANDARD = ("math.", "deque.")


def _playground() -> TargetDescription:
    variables = {variable.name: variable for variable in THYMIO_II.variables}
    natives = {native.name: native for native in THYMIO_II.natives}
    standard = [name for name in natives if name.startswith(_STANDARD)]
    chosen = tuple(variables[name] for name in _PLAYGROUND_VARIABLES.split())
    return replace(
        THYMIO_II,
        variables=chosen,
        natives=tuple(natives[name] for name in [*standard, *_PLAYGROUND_NATIVES.split()]),
        variables_size=sum(variable.size for variable in chosen) + _FREE_WORDS,
    )


@dataclass(frozen=True, slots=True)
class Layout:
    """A target without plug-ins, and the values of its variables after a reset, if they are not 0."""

    base: TargetDescription
    initial_values: Mapping[str, tuple[int, ...]]


_DESCRIBED: dict[str, TargetDescription] = {}
"""Descriptions of robots behind a network by the name of their layout, which depends on nothing but the content."""


LAYOUTS: Mapping[str, Layout] = {
    THYMIO: Layout(THYMIO_II, {"_productId": (PRODUCT_ID,), "_fwversion": (14, 1)}),
    PLAYGROUND: Layout(_playground(), {"_productId": (PRODUCT_ID,), "_fwversion": (11, 0), "temperature": (220,)}),
}
"""The robot with firmware 14, and the reference playground."""


def described(description: TargetDescription) -> str:
    """Return the layout of a robot that has described itself: the same name for the same description."""
    name = f"{description.name}/{zlib.crc32(repr(description).encode()):08x}"
    _DESCRIBED[name] = description
    return name


@cache
def target(layout: str = THYMIO) -> TargetDescription:
    """Return the target with this layout and all compatible plug-ins, or exactly what a robot has described.

    Raises KeyError for an unknown layout.
    """
    if layout in _DESCRIBED:
        return _DESCRIBED[layout]
    return extend(LAYOUTS[layout].base, *compatible_plugins())


@cache
def compatible_plugins() -> tuple[tuple[Sensor, ...], tuple[Actuator, ...]]:
    """Return all sensors and actuators, except incompatible ones of other packages, which are logged.

    A plug-in is incompatible if it declares an existing variable or native function with another size. Its sensor or
    actuator works, but programs do not see it.
    """
    try:
        extend(THYMIO_II, all_sensors(), all_actuators())
    except ValueError:
        return _compatible_one_by_one()
    return all_sensors(), all_actuators()


def _compatible_one_by_one() -> tuple[tuple[Sensor, ...], tuple[Actuator, ...]]:
    """Add one plug-in after another, those of this package first; skip those that are incompatible."""
    all_of_them: tuple[Sensor | Actuator, ...] = (*all_sensors(), *all_actuators())
    ours = {*registry.own_names(sensors), *registry.own_names(actuators)}
    kept: list[Sensor | Actuator] = []
    for plugin in sorted(all_of_them, key=lambda plugin: plugin.name not in ours):
        try:
            extend(THYMIO_II, *_partitioned([*kept, plugin]))
        except ValueError as error:
            if plugin.name in ours:
                raise
            logging.getLogger(__name__).warning("programs see nothing of the plug-in '%s': %s", plugin.name, error)
        else:
            kept.append(plugin)
    return _partitioned([plugin for plugin in all_of_them if plugin in kept])


def _partitioned(plugins: Sequence[Sensor | Actuator]) -> tuple[tuple[Sensor, ...], tuple[Actuator, ...]]:
    return (
        tuple(plugin for plugin in plugins if isinstance(plugin, Sensor)),
        tuple(plugin for plugin in plugins if isinstance(plugin, Actuator)),
    )


def extend(base: TargetDescription, sensing: Sequence[Sensor], acting: Sequence[Actuator]) -> TargetDescription:
    """Return the base with the variables, events and native functions of plug-ins appended.

    The memory grows by the appended variables, so that programs keep their free words. Names that the robot has but the
    base lacks are not added. Raises ValueError if a plug-in declares an existing name with another size.
    """
    variables = {variable.name: variable for variable in (*THYMIO_II.variables, *base.variables)}
    events = {event.name: event for event in base.local_events}
    natives = {native.name: native for native in (*THYMIO_II.natives, *base.natives)}
    bindings = [sensor.aseba for sensor in sensing]
    declared = [variable for binding in bindings for variable in binding.variables]
    declared += [pair for actuator in acting for output in actuator.aseba.outputs for pair in output.variables]
    for name, size in declared:
        if variables.setdefault(name, Variable(name, size)).size != size:
            raise ValueError(f"variable {name}: a plug-in declares {size} words, expected {variables[name].size}")
    for binding in bindings:
        edges = [name for name, _ in binding.variables] if binding.edge_events else []
        for name in [*edges, *([binding.event] if binding.event else [])]:
            events.setdefault(name, LocalEvent(name))
    for native in (native for actuator in acting for native in actuator.aseba.natives):
        parameters = tuple(Parameter(name, size) for name, size in native.signature)
        known = natives.setdefault(native.name, NativeFunction(native.name, parameters, native.description))
        sizes, expected = ([parameter.size for parameter in both] for both in (parameters, known.parameters))
        if sizes != expected:
            raise ValueError(
                f"native {native.name}: a plug-in declares parameters of {sizes} words, expected {expected}"
            )
    old_variables = {variable.name for known in (THYMIO_II, base) for variable in known.variables}
    old_natives = {native.name for known in (THYMIO_II, base) for native in known.natives}
    extended = replace(
        base,
        variables=(*base.variables, *(new for name, new in variables.items() if name not in old_variables)),
        local_events=tuple(events.values()),
        natives=(*base.natives, *(new for name, new in natives.items() if name not in old_natives)),
    )
    return replace(extended, variables_size=base.variables_size + extended.variables_end - base.variables_end)
