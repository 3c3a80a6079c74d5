"""Lights: natives, variables, levels."""

from __future__ import annotations

import pytest

from thymio_sim_ros.sim.actuators.leds import ACTUATOR, LED_NUMBERS, LedState
from thymio_sim_ros.sim.commands import LED_GROUPS, ReleaseLeds, SetLed, SetLeds, ShowOnLeds


def test_every_group_has_a_native_of_its_size() -> None:
    sizes = {native.name: len(native.parameters) for native in ACTUATOR.aseba.natives}
    assert sizes == {
        "leds.circle": 8, "leds.top": 3, "leds.bottom.left": 3, "leds.bottom.right": 3, "leds.buttons": 4,
        "leds.prox.h": 8, "leds.prox.v": 2, "leds.rc": 1, "leds.sound": 1, "leds.temperature": 2,
        "_leds.set": 2,
    }  # fmt: skip


def test_natives_set_their_group_and_saturate() -> None:
    commands = {native.name: native.command([-1] * len(native.parameters)) for native in ACTUATOR.aseba.natives}
    groups = {command.group: command.levels for command in commands.values() if isinstance(command, SetLeds)}
    assert groups == {group: (32,) * size for group, size in LED_GROUPS.items() if group not in ("battery", "sd")}


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
    with pytest.raises(ValueError, match="lights: found"):
        ACTUATOR.apply(LedState(), command, 0)


def test_every_light_but_the_refused_one_has_a_number() -> None:
    assert len(LED_NUMBERS) == 40
    assert LED_NUMBERS[15] is None
    assert sorted(filter(None, LED_NUMBERS)) == sorted(
        (group, index) for group, size in LED_GROUPS.items() for index in range(size)
    )


@pytest.mark.parametrize(
    ("number", "group", "index"),
    [
        (0, "proximity", 6), (1, "proximity", 7), (3, "top", 1), (5, "battery", 0), (10, "bottom_left", 2),
        (11, "bottom_right", 0), (14, "sd", 0), (17, "proximity", 1), (18, "proximity", 4), (19, "proximity", 5),
        (20, "proximity", 2), (21, "proximity", 3), (23, "ground", 1), (28, "circle", 4), (29, "remote", 0),
        (30, "microphone", 0), (31, "circle", 7), (32, "buttons", 0), (33, "buttons", 2), (34, "buttons", 3),
        (35, "buttons", 1), (37, "circle", 6), (38, "temperature", 0), (39, "temperature", 1),
    ],
)  # fmt: skip
def test_a_single_light_is_set_by_its_number(number: int, group: str, index: int) -> None:
    state = LedState()
    ACTUATOR.apply(state, SetLed(number, 20), 0)
    assert state.levels[group][index] == 20
    assert sum(sum(levels) for levels in state.levels.values()) == 20
    assert not state.taken


@pytest.mark.parametrize("number", [-1, 15, 40, 32767])
def test_a_number_that_is_no_light_changes_nothing(number: int) -> None:
    state = LedState()
    ACTUATOR.apply(state, SetLed(number, 20), 0)
    assert state == LedState()


def test_the_native_of_single_lights_saturates() -> None:
    (native,) = (native for native in ACTUATOR.aseba.natives if native.name == "_leds.set")
    assert native.command([3, -1]) == SetLed(3, 32)


def test_the_robot_s_own_rules_show_until_somebody_takes_the_group_over() -> None:
    state = LedState()
    ACTUATOR.apply(state, ShowOnLeds("ground", (3, 4)), 0)
    assert state.levels["ground"] == (3, 4)
    ACTUATOR.apply(state, SetLeds("ground", (0, 9)), 0)
    ACTUATOR.apply(state, ShowOnLeds("ground", (5, 6)), 0)
    assert state.levels["ground"] == (0, 9)


def test_a_released_group_is_dark_and_shows_the_rules_again() -> None:
    state = LedState()
    ACTUATOR.apply(state, SetLeds("ground", (0, 9)), 0)
    ACTUATOR.apply(state, ReleaseLeds("ground"), 0)
    assert state == LedState()
    ACTUATOR.apply(state, ShowOnLeds("ground", (5, 6)), 0)
    assert state.levels["ground"] == (5, 6)


def test_a_reset_releases_every_group() -> None:
    assert ACTUATOR.aseba.at_reset == tuple(ReleaseLeds(group) for group in LED_GROUPS)
