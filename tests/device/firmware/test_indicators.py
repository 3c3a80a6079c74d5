"""What the robot shows by itself (docs/spec/thymio-robot.md section 8.4), and what ends it."""

from __future__ import annotations

from collections.abc import Mapping

import pytest

from thymio_sim_ros.device.firmware.indicators import Indicators
from thymio_sim_ros.device.layout import PLAYGROUND, THYMIO, target
from thymio_sim_ros.sim.commands import Command, PlaySystemSound, ShowOnLeds

FORWARD, RIGHT, BACKWARD, LEFT = range(4)


class Robot:
    """A memory and the rules that look at it."""

    def __init__(self, layout: str = THYMIO) -> None:
        self.addresses = target(layout).addresses
        self.memory = [0] * target(layout).variables_size
        self.measured: set[int] = set()
        self.indicators = Indicators(self.addresses)
        self.lights: dict[str, tuple[int, ...]] = {}
        self.sounds: list[int] = []

    def update(self, values: Mapping[str, tuple[int, ...]] | None = None, updates: int = 1) -> list[Command]:
        """The commands of so many updates after these variables changed."""
        for name, words in (values or {}).items():
            address, size = self.addresses[name]
            assert len(words) == size
            self.memory[address : address + size] = words
            self.measured.add(address)
        is_measured = self.measured.__contains__
        commands = [command for _ in range(updates) for command in self.indicators.update(self.memory, is_measured)]
        for command in commands:
            if isinstance(command, ShowOnLeds):
                self.lights[command.group] = command.levels
            elif isinstance(command, PlaySystemSound):
                self.sounds.append(command.number)
        return commands


@pytest.fixture
def robot() -> Robot:
    return Robot()


def test_a_robot_without_readings_shows_nothing(robot: Robot) -> None:
    assert robot.update(updates=100) == []


@pytest.mark.parametrize(
    ("reading", "level"), [(0, 0), (1199, 0), (1200, 0), (1288, 1), (2600, 16), (4000, 32), (4505, 32)]
)
def test_a_proximity_light_shows_the_reading_between_its_limits(robot: Robot, reading: int, level: int) -> None:
    robot.update({"prox.horizontal": (1, 0, 0, 0, 0, 0, 0)})
    robot.update({"prox.horizontal": (0, reading, 0, 0, 0, 0, 0)})
    assert robot.lights.get("proximity", (0,) * 8)[1] == level


def test_each_sensor_has_its_light_and_the_middle_one_has_two(robot: Robot) -> None:
    for sensor, lights in enumerate(((0,), (1,), (2, 3), (4,), (5,), (6,), (7,))):
        robot.update({"prox.horizontal": tuple(4000 if index == sensor else 0 for index in range(7))})
        assert [index for index, level in enumerate(robot.lights["proximity"]) if level] == list(lights)


def test_the_limits_follow_smaller_and_larger_readings(robot: Robot) -> None:
    robot.update({"prox.horizontal": (1000, 0, 0, 0, 0, 0, 0)})
    robot.update({"prox.horizontal": (1100, 0, 0, 0, 0, 0, 0)})
    assert robot.lights["proximity"][0] == 32 * 100 // 3000
    robot.update({"prox.horizontal": (5000, 0, 0, 0, 0, 0, 0)})
    robot.update({"prox.horizontal": (3000, 0, 0, 0, 0, 0, 0)})
    assert robot.lights["proximity"][0] == 16


@pytest.mark.parametrize(("reading", "level"), [(0, 0), (28, 0), (29, 1), (450, 16), (900, 32)])
def test_a_ground_light_shows_the_reading_from_zero(robot: Robot, reading: int, level: int) -> None:
    robot.update({"prox.ground.delta": (reading, 1)})
    assert robot.lights.get("ground", (0, 0))[0] == level


@pytest.mark.parametrize(
    ("acc", "light", "level"),
    [
        ((0, 0, 23), None, 0),
        ((12, 0, 20), 6, 2),
        ((-12, 0, 20), 2, 2),
        ((0, 12, 20), 4, 2),
        ((0, -12, 20), 0, 2),
        ((10, 10, 10), 5, 22),
        ((10, -10, 10), 7, 22),
        ((-10, 10, 10), 3, 22),
        ((-10, -10, 10), 1, 22),
        ((23, 0, 0), 6, 32),
        ((5, 5, 10), None, 0),
        ((0, 11, -20), 4, 2),
    ],
)
def test_the_circle_lights_the_lowest_side_once_the_robot_leans(
    robot: Robot, acc: tuple[int, int, int], light: int | None, level: int
) -> None:
    robot.update({"acc": acc})
    circle = robot.lights.get("circle", (0,) * 8)
    assert circle == tuple(level if index == light else 0 for index in range(8))


def test_a_touched_button_lights_up_step_by_step_and_goes_out_at_once(robot: Robot) -> None:
    robot.update({"button.right": (1,)})
    assert robot.lights["buttons"] == (0, 3, 0, 0)
    robot.update(updates=10)
    assert robot.lights["buttons"] == (0, 32, 0, 0)
    assert robot.update(updates=10) == []
    robot.update({"button.right": (0,)})
    assert robot.lights["buttons"] == (0, 0, 0, 0)


def test_the_centre_lights_all_four(robot: Robot) -> None:
    robot.update({"button.center": (1,)}, updates=2)
    assert robot.lights["buttons"] == (6, 6, 6, 6)


@pytest.mark.parametrize(
    ("button", "sound"), [("forward", 2), ("left", 2), ("right", 2), ("backward", 2), ("center", 3)]
)
def test_a_button_sounds_once_when_it_is_touched(robot: Robot, button: str, sound: int) -> None:
    robot.update({f"button.{button}": (1,)}, updates=20)
    robot.update({f"button.{button}": (0,)}, updates=20)
    assert robot.sounds == [sound]


def test_a_program_that_uses_sound_ends_the_sounds_of_buttons(robot: Robot) -> None:
    robot.indicators.mute_buttons()
    robot.update({"button.center": (1,)})
    assert robot.sounds == []
    robot.indicators.reset()
    robot.update({"button.left": (1,)})
    assert robot.sounds == [2]


@pytest.mark.parametrize(
    ("tenths", "red", "blue"), [(-50, 0, 32), (149, 0, 32), (150, 0, 32), (215, 16, 16), (280, 32, 0), (281, 32, 0)]
)
def test_warm_is_red_and_cold_is_blue(robot: Robot, tenths: int, red: int, blue: int) -> None:
    robot.update({"temperature": (tenths,)})
    assert robot.lights["temperature"] == (red, blue)


def test_zero_is_a_reading_too(robot: Robot) -> None:
    robot.update()
    robot.update({"temperature": (0,), "_vbat": (0, 0)})
    assert robot.lights == {"temperature": (0, 32), "battery": (32, 0, 0)}


def test_the_sound_light_shows_the_peak_and_fades_while_a_program_listens(robot: Robot) -> None:
    robot.update({"mic.intensity": (200,)})
    assert "microphone" not in robot.lights
    robot.update({"mic.threshold": (10,)})
    assert robot.lights["microphone"] == (25,)
    robot.update({"mic.intensity": (0,)}, updates=5)
    assert robot.lights["microphone"] == (20,)
    robot.update(updates=20)
    assert robot.lights["microphone"] == (0,)
    assert robot.update(updates=20) == []


def test_a_remote_control_flashes_its_light(robot: Robot) -> None:
    robot.update()
    robot.indicators.flash_remote()
    robot.update()
    assert robot.lights["remote"] == (32,)
    robot.update(updates=10)
    assert robot.lights["remote"] == (0,)


@pytest.mark.parametrize(("each", "lights"), [(796, 3), (776, 3), (775, 2), (720, 2), (715, 1), (680, 1)])
def test_the_battery_shows_up_to_three_lights(robot: Robot, each: int, lights: int) -> None:
    robot.update({"_vbat": (each, each)})
    assert robot.lights["battery"] == (32,) * lights + (0,) * (3 - lights)


def test_a_battery_that_is_not_empty_does_not_blink_however_its_voltage_changes(robot: Robot) -> None:
    for each in range(780, 880):
        robot.update({"_vbat": (each, each)})
        assert robot.lights["battery"] == (32, 32, 32)


def test_an_empty_battery_blinks(robot: Robot) -> None:
    shown = []
    robot.update({"_vbat": (600, 600)})
    for _ in range(100):
        robot.update()
        shown.append(robot.lights["battery"])
    assert set(shown) == {(32, 0, 0), (0, 0, 0)}
    assert 20 <= shown.count((0, 0, 0)) <= 75


def test_the_lights_of_a_battery_fill_again_and_again_while_it_is_charged(robot: Robot) -> None:
    shown: list[tuple[int, ...]] = []
    robot.update({"_vbat": (600, 600)})
    robot.indicators.set_charging(is_charging=True)
    for _ in range(2 * 100):
        robot.update()
        if shown[-1:] != [robot.lights["battery"]]:
            shown.append(robot.lights["battery"])
    once = [(0, 0, 0), (32, 0, 0), (32, 32, 0), (32, 32, 32)]
    assert shown[:4] in (once, [*once[1:], once[0]])
    assert shown[4:8] == shown[:4]
    robot.update({"_vbat": (720, 720)}, updates=40)
    robot.indicators.set_charging(is_charging=False)
    robot.update()
    assert robot.lights["battery"] == (32, 32, 0)
    assert robot.update(updates=100) == []


def test_a_rule_ends_when_its_lights_are_taken_over(robot: Robot) -> None:
    robot.indicators.claim("temperature")
    commands = robot.update({"temperature": (200,), "prox.ground.delta": (900, 900)})
    assert commands == [ShowOnLeds("ground", (32, 32))]


@pytest.mark.parametrize("group", ["proximity", "ground"])
def test_one_rule_shows_proximity_and_ground_and_ends_for_both(robot: Robot, group: str) -> None:
    robot.update({"prox.horizontal": (4000,) * 7, "prox.ground.delta": (450, 450)})
    assert sorted(robot.indicators.claim(group)) == ["ground", "proximity"]
    assert robot.update({"prox.horizontal": (2000,) * 7, "prox.ground.delta": (100, 100)}) == []


def test_a_clap_between_two_looks_is_shown(robot: Robot) -> None:
    robot.update({"mic.threshold": (50,), "mic.intensity": (9,)})
    robot.update(updates=5)
    robot.indicators.record_intensity(200)
    robot.update()
    assert robot.lights["microphone"] == (25,)
    robot.update(updates=30)
    assert robot.lights["microphone"] == (1,)  # 9 is still there


def test_after_a_reset_all_rules_begin_again(robot: Robot) -> None:
    robot.indicators.claim("ground")
    robot.update({"prox.ground.delta": (900, 900)})
    robot.indicators.reset()
    assert robot.update() == [ShowOnLeds("ground", (32, 32))]


def test_unchanged_levels_cause_no_command(robot: Robot) -> None:
    assert robot.update({"prox.ground.delta": (900, 900)}) != []
    assert robot.update({"prox.ground.delta": (901, 902)}) == []


def test_a_layout_without_a_variable_does_without_its_rule() -> None:
    robot = Robot(PLAYGROUND)
    robot.update({"prox.ground.delta": (900, 900), "temperature": (300,)})
    assert robot.lights == {"ground": (32, 32), "temperature": (32, 0)}
