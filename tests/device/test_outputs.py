"""Commands from native functions and variables; unchanged values cause none."""

from __future__ import annotations

import pytest

from aseba_vm import VirtualMachine
from thymio_sim_ros.device.firmware.indicators import Indicators
from thymio_sim_ros.device.firmware.settings import Settings
from thymio_sim_ros.device.layout import THYMIO, target
from thymio_sim_ros.device.outputs import LIGHT_REPEAT_NS, Outputs
from thymio_sim_ros.sim.commands import MotorTargets, PlaySystemSound, PlayTone, SetLed, SetLeds, SetVolume, ShowOnLeds

RED, GREEN = SetLeds("top", (32, 0, 0)), SetLeds("top", (0, 32, 0))


class OutputsUnderTest(Outputs):
    """Outputs of a machine whose variables a test writes."""

    def __init__(self) -> None:
        self.settings = Settings()
        self.indicators = Indicators(target().addresses)
        super().__init__(THYMIO, self.settings, self.indicators)
        self.machine = VirtualMachine(target())
        self.reset(self.machine)
        self.pop()

    def write(self, name: str, *words: int) -> None:
        self.machine.write_variables(target().addresses[name][0], words)


def always_measured(_address: int) -> bool:
    return True


@pytest.fixture
def outputs() -> OutputsUnderTest:
    return OutputsUnderTest()


def test_a_changed_variable_causes_a_command(outputs: OutputsUnderTest) -> None:
    outputs.write("motor.left.target", 100)
    assert outputs.pop_changes() == [MotorTargets(100, 0)]
    assert outputs.pop_changes() == []


def test_a_variable_set_by_a_native_function_causes_no_second_command(outputs: OutputsUnderTest) -> None:
    outputs.send(RED, {"leds.top": (32, 0, 0)})
    assert (outputs.pop(), outputs.pop_changes()) == ([RED], [])
    outputs.write("leds.top", 0, 32, 0)
    assert outputs.pop_changes() == [GREEN]


def test_lights_set_to_their_levels_cause_one_command(outputs: OutputsUnderTest) -> None:
    for command in (RED, RED, GREEN, GREEN, RED):
        outputs.send(command)
    assert outputs.pop() == [RED, GREEN, RED]


def test_repeated_lights_are_sent_again_after_a_while(outputs: OutputsUnderTest) -> None:
    commands = []
    for tick in range(100):
        outputs.advance(tick * LIGHT_REPEAT_NS // 10)
        outputs.send(RED)
        commands += outputs.pop()
    assert commands == [RED] * 10
    outputs.send(RED)
    outputs.advance(0)  # time went back
    outputs.send(RED)
    assert outputs.pop() == [RED]


def test_what_was_set_before_a_reset_is_news_after_it(outputs: OutputsUnderTest) -> None:
    outputs.send(RED)
    outputs.reset(outputs.machine)
    outputs.pop()
    outputs.send(RED)
    assert outputs.pop() == [RED]


def test_a_group_that_a_rule_had_lit_is_dark_for_the_robot_from_then_on(outputs: OutputsUnderTest) -> None:
    memory = outputs.machine.variables.words
    outputs.write("temperature", 200)
    outputs.queue(*outputs.indicators.update(memory, always_measured))
    outputs.pop()
    outputs.send(SetLeds("temperature", (1, 2)))
    assert outputs.pop() == [ShowOnLeds("temperature", (0, 0)), SetLeds("temperature", (1, 2))]
    outputs.send(SetLeds("temperature", (1, 3)))
    assert outputs.pop() == [SetLeds("temperature", (1, 3))]


def test_a_single_light_makes_its_group_news_again(outputs: OutputsUnderTest) -> None:
    for command in (RED, SetLed(3, 7), RED):
        outputs.send(command)
    assert outputs.pop() == [RED, SetLed(3, 7), RED]


def test_a_new_calibration_sends_the_same_targets_again(outputs: OutputsUnderTest) -> None:
    outputs.write("motor.left.target", 256)
    outputs.pop_changes()
    outputs.settings[8] = 300
    outputs.resend_motor_targets()
    assert outputs.pop_changes() == [MotorTargets(300, 0)]


def test_sound_is_used_from_its_first_command_on(outputs: OutputsUnderTest) -> None:
    touched = PlaySystemSound(2)
    outputs.send(SetVolume(3))
    assert not outputs.has_used_sound
    outputs.write("button.left", 1)
    assert touched in outputs.indicators.update(outputs.machine.variables.words, always_measured)
    outputs.send(PlayTone(440, None))
    assert outputs.has_used_sound
    outputs.write("button.right", 1)
    assert touched not in outputs.indicators.update(outputs.machine.variables.words, always_measured)
    outputs.reset(outputs.machine)
    assert not outputs.has_used_sound


def test_a_reset_sends_commands_to_every_actuator(outputs: OutputsUnderTest) -> None:
    outputs.reset(outputs.machine)
    commands = outputs.pop()
    assert len(commands) == len(set(commands))
    kinds = {type(command).__name__ for command in commands}
    assert {"MotorTargets", "ReleaseLeds", "StopSound", "SetWave", "EnableComm", "SetSoundThreshold"} <= kinds
