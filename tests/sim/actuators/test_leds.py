"""Lights: natives, variables, levels."""

from __future__ import annotations

import math

import pytest

from tests.sim.fake_view import FakeView
from thymio_sim_ros.sim.actuators._led_patterns import GESTURES
from thymio_sim_ros.sim.actuators.leds import ACTUATOR, LED_NUMBERS, LedState
from thymio_sim_ros.sim.commands import (
    LED_GESTURES,
    LED_GROUPS,
    LEDS_GIVEN_BACK,
    Command,
    PlayGesture,
    ReleaseLeds,
    SetLed,
    SetLeds,
    ShowOnLeds,
    StopGesture,
)


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


def test_firmware_indicators_show_until_a_group_is_taken_over() -> None:
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


@pytest.mark.parametrize("end", [ReleaseLeds("circle"), StopGesture()])
def test_a_group_given_back_shows_what_the_rules_have_wanted_all_the_time(end: Command) -> None:
    state, mine = LedState(), (0, 0, 7, 0, 0, 0, 0, 0)
    ACTUATOR.apply(state, ShowOnLeds("circle", (1,) * 8), 0)
    ACTUATOR.apply(state, PlayGesture("circle", 1.0), 0)
    ACTUATOR.apply(state, ShowOnLeds("circle", mine), 0)
    assert state.levels["circle"] != mine
    ACTUATOR.apply(state, end, 0)
    assert state.levels["circle"] == mine
    for command in LEDS_GIVEN_BACK:
        ACTUATOR.apply(state, command, 0)
    assert state.levels["circle"] == (0,) * 8


def test_a_reset_releases_every_group() -> None:
    assert ACTUATOR.aseba.at_reset == LEDS_GIVEN_BACK


def lights(*commands: Command, seconds: float = 1.0) -> list[dict[str, tuple[int, ...]]]:
    """All lights in each tick after commands at time 0."""
    state, shown = LedState(), []
    for command in commands:
        ACTUATOR.apply(state, command, 0)
    assert ACTUATOR.update is not None
    for tick in range(round(seconds * 100)):
        ACTUATOR.update(state, FakeView(now_ns=tick * 10_000_000), 0.01)
        shown.append(dict(state.levels))
    return shown


def test_a_gesture_runs_round_the_circle_in_its_period() -> None:
    brightest = [max(range(8), key=ticks["circle"].__getitem__) for ticks in lights(PlayGesture("circle", 0.8))]
    assert brightest[0:80:10] == [0, 1, 2, 3, 4, 5, 6, 7]


def test_a_negative_period_runs_backwards() -> None:
    brightest = [max(range(8), key=ticks["circle"].__getitem__) for ticks in lights(PlayGesture("circle", -0.8))]
    assert brightest[0:80:10] == [0, 7, 6, 5, 4, 3, 2, 1]


def test_blinking_is_half_on_half_off() -> None:
    shown = [ticks["circle"] for ticks in lights(PlayGesture("blink", 0.5))]
    assert [shown[tick] for tick in (0, 24, 25, 49, 50)] == [(32,) * 8, (32,) * 8, (0,) * 8, (0,) * 8, (32,) * 8]


def test_kit_goes_to_and_fro_at_the_front() -> None:
    shown = [ticks["proximity"] for ticks in lights(PlayGesture("kit", 1.0))]
    assert [shown[tick].index(max(shown[tick])) for tick in (0, 10, 50, 90)] == [0, 1, 5, 1]
    assert all(levels[6:] == (0, 0) for levels in shown)


def test_a_gesture_ends_when_it_is_stopped_replaced_or_its_lights_are_set() -> None:
    dark = (0,) * 8
    assert lights(PlayGesture("blink", 60.0), StopGesture())[0]["circle"] == dark
    replaced = lights(PlayGesture("blink", 60.0), PlayGesture("kit", 1.0))[0]
    assert (replaced["circle"], replaced["proximity"][0]) == (dark, 32)
    assert lights(PlayGesture("blink", 60.0), SetLeds("circle", (1,) * 8))[-1]["circle"] == (1,) * 8
    other = lights(PlayGesture("blink", 1.0), SetLeds("top", (1, 2, 3)))
    assert [other[tick]["circle"] for tick in (49, 50)] == [(32,) * 8, dark]


def test_a_gesture_keeps_the_robot_s_own_rules_away_and_gives_the_lights_back() -> None:
    own = ShowOnLeds("circle", (9,) * 8)
    assert lights(PlayGesture("blink", 60.0), own)[-1]["circle"] == (32,) * 8
    assert lights(PlayGesture("blink", 60.0), StopGesture(), own)[-1]["circle"] == (9,) * 8


@pytest.mark.parametrize(("name", "period_s"), [("dance", 1.0), ("blink", 0.0), ("blink", -0.05), ("kit", math.nan)])
def test_a_gesture_that_cannot_be_is_refused(name: str, period_s: float) -> None:
    with pytest.raises(ValueError, match="PlayGesture"):
        PlayGesture(name, period_s)


def test_every_gesture_has_a_shape() -> None:
    assert set(GESTURES) == set(LED_GESTURES)
