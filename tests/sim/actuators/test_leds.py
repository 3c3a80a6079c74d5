"""Lights: natives, variables, levels."""

from __future__ import annotations

import pytest

from thymio_sim_ros.sim.actuators.leds import ACTUATOR, LedState
from thymio_sim_ros.sim.commands import LED_GROUPS, SetLeds


def test_every_group_has_a_native_of_its_size() -> None:
    sizes = {native.name: len(native.parameters) for native in ACTUATOR.aseba.natives}
    assert sizes == {
        "leds.circle": 8, "leds.top": 3, "leds.bottom.left": 3, "leds.bottom.right": 3, "leds.buttons": 4,
        "leds.prox.h": 8, "leds.prox.v": 2, "leds.rc": 1, "leds.sound": 1, "leds.temperature": 2,
    }  # fmt: skip


def test_natives_set_their_group_and_saturate() -> None:
    commands = {native.name: native.command([-1] * len(native.parameters)) for native in ACTUATOR.aseba.natives}
    groups = {command.group: command.levels for command in commands.values() if isinstance(command, SetLeds)}
    assert groups == {group: (32,) * size for group, size in LED_GROUPS.items()}


def test_colors_and_circle_are_also_variables() -> None:
    names = ["leds.top", "leds.bottom.left", "leds.bottom.right", "leds.circle"]
    assert [output.variables for output in ACTUATOR.aseba.outputs] == [
        ((name, 8 if name == "leds.circle" else 3),) for name in names
    ]
    written = [native.writes([1, 2, 3]) for native in ACTUATOR.aseba.natives]
    assert [list(variables) for variables in written if variables] == [
        ["leds.circle"], ["leds.top"], ["leds.bottom.left"], ["leds.bottom.right"]
    ]  # fmt: skip


def test_writing_a_variable_sets_the_lights_like_the_native() -> None:
    top = ACTUATOR.aseba.outputs[0]
    assert top.command([1, 40, 256]) == SetLeds("top", (1, 32, 0))


def test_levels_are_limited() -> None:
    state = LedState()
    ACTUATOR.apply(state, SetLeds("top", (-5, 10, 99)), 0)
    assert state.levels["top"] == (0, 10, 32)


@pytest.mark.parametrize("command", [SetLeds("tip", (1,)), SetLeds("top", (1, 2))])
def test_an_unknown_group_or_size_is_our_mistake(command: SetLeds) -> None:
    with pytest.raises(ValueError, match="SetLeds"):
        ACTUATOR.apply(LedState(), command, 0)
