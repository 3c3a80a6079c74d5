"""Commands as messages: commands of programs arrive unchanged, invalid messages are rejected."""

from __future__ import annotations

import pytest
from std_msgs.msg import (
    Bool,
    ColorRGBA,
    Empty,
    Float32,
    Float32MultiArray,
    Int8,
    Int8MultiArray,
    Int16MultiArray,
    UInt8MultiArray,
)

from thymio_sim_ros.ros.interface.command_checks import CommandError
from thymio_sim_ros.ros.interface.command_topics import ROWS, topic_of
from thymio_sim_ros.sim.actuators import all_actuators, leds, loudspeaker
from thymio_sim_ros.sim.audio.synthesis import TRIANGLE
from thymio_sim_ros.sim.commands import (
    LED_GROUPS,
    EnableComm,
    MotorTargets,
    PlayGesture,
    PlaySamples,
    PlaySystemSound,
    PlayTone,
    ReleaseLeds,
    SetAlarm,
    SetCommPayload,
    SetLed,
    SetLeds,
    SetPen,
    SetSoundThreshold,
    SetVolume,
    SetWave,
    ShowOnLeds,
    StopGesture,
    StopSound,
)
from thymio_sim_ros.sim.stimuli import all_stimuli

BY_TOPIC = {row.topic: row for row in ROWS}


def decode(topic, message):
    assert isinstance(message, BY_TOPIC[topic].type)
    return BY_TOPIC[topic].decode(message)


@pytest.mark.parametrize(
    "command",
    [
        MotorTargets(500, -500),
        *(SetLeds(group, tuple(range(size))) for group, size in LED_GROUPS.items()),
        *(ShowOnLeds(group, (32,) * size) for group, size in LED_GROUPS.items()),
        SetLed(39, 31),
        PlayTone(440.0, 500_000_000),
        PlayTone(55.5, None),
        StopSound(),
        PlaySystemSound(7),
        PlaySamples(bytes(range(256))),
        SetWave(TRIANGLE),
        SetVolume(8),
        *(SetSoundThreshold(level) for level in (-32768, -1, 0, 1, 128, 255, 256, 32767)),
        *(SetCommPayload(value) for value in (-32768, 0, 2047, 32767)),
        EnableComm(True),
        EnableComm(False),
    ],
    ids=str,
)
def test_what_a_program_commands_arrives_unchanged(command):
    row = BY_TOPIC[topic_of(command)]
    message = row.encode(command)
    assert isinstance(message, row.type)
    assert row.decode(message) == command


@pytest.mark.parametrize("group", LED_GROUPS)
def test_a_released_group_arrives_dark(group):
    command = ReleaseLeds(group)
    row = BY_TOPIC[topic_of(command)]
    arrived = row.decode(row.encode(command))
    assert arrived in (command, SetLeds(group, (0, 0, 0)))


@pytest.mark.parametrize("actuator", [leds.ACTUATOR, loudspeaker.ACTUATOR], ids=lambda actuator: actuator.name)
def test_every_command_of_a_reset_has_a_topic(actuator):
    assert [command for command in actuator.aseba.at_reset if topic_of(command) not in BY_TOPIC] == []


def test_every_row_gives_commands_that_an_actuator_takes():
    accepted = {kind for plugin in (*all_actuators(), *all_stimuli()) for kind in plugin.accepts}
    messages = {
        "pen/down": Bool(data=True),
        "_pen/color": ColorRGBA(r=1.0, a=1.0),
        "_pen/width": Float32(data=0.01),
    }
    for topic, message in messages.items():
        assert type(decode(topic, message)) in accepted


def test_the_pen_is_moved_colored_and_used_as_eraser():
    assert decode("pen/down", Bool(data=True)) == SetPen(down=True)
    assert decode("_pen/color", ColorRGBA(r=1.0, g=0.5, b=2.0, a=1.0)) == SetPen(color=(1.0, 0.5, 1.0), erase=False)
    assert decode("_pen/color", ColorRGBA(a=0.0)).erase
    assert decode("_pen/width", Float32(data=0.03125)) == SetPen(width_m=0.03125)


def test_gestures_have_a_period_whose_sign_is_the_direction():
    assert decode("_led/gesture/kit", Float32(data=-0.5)) == PlayGesture("kit", -0.5)
    assert decode("_led/gesture/alive", Empty()) == PlayGesture("alive", 4.0)
    assert decode("_led/gesture/off", Empty()) == StopGesture()


def test_an_alarm_is_switched():
    assert decode("_alarm", Bool(data=True)) == SetAlarm(True)


@pytest.mark.parametrize(("number", "reported"), [(-129, -128), (127, 127), (128, 127), (32767, 127)])
def test_an_unknown_sound_number_fits_into_the_message(number, reported):
    message = BY_TOPIC["_sound/system"].encode(PlaySystemSound(number))
    assert decode("_sound/system", message) == PlaySystemSound(reported)


def test_a_sound_is_stopped_by_a_negative_number():
    assert decode("sound/tone", Float32MultiArray(data=[0.0, -1.0])) == StopSound()
    assert decode("_sound/system", Int8(data=-1)) == StopSound()


@pytest.mark.parametrize(
    ("topic", "message", "found"),
    [
        ("sound/tone", Float32MultiArray(data=[440.0]), r"found 1 values, expected \[Hz, s\]"),
        ("sound/tone", Float32MultiArray(data=[float("nan"), 1.0]), "frequency is nan"),
        ("sound/tone", Float32MultiArray(data=[440.0, float("inf")]), "duration is inf"),
        ("_sound/volume", Int8(data=9), "found 9, expected 0"),
        ("_sound/wave", Int8MultiArray(data=[1, 2]), "found 2 values, expected 142 samples"),
        ("_sound/samples", UInt8MultiArray(data=bytes(5_000_000)), "found 5000000 samples"),
        ("_led/single", Int16MultiArray(data=[1]), "found 1 values"),
        ("_led/gesture/blink", Float32(data=0.0), "period 0 s found, expected 0.1 to 60"),
        ("_led/own", Float32MultiArray(data=[1.0]), "group '' found"),
        ("led/circle", Float32MultiArray(data=[1.0]), "found 1 values, expected 8 intensities"),
        ("_sound_threshold", Float32(data=float("nan")), "threshold is nan"),
        ("_pen/width", Float32(data=0.5), "found 0.5 m, expected 0.001 to 0.1"),
        ("_pen/color", ColorRGBA(r=float("inf")), "color is inf"),
    ],
)
def test_invalid_messages_are_rejected(topic, message, found):
    with pytest.raises(CommandError, match=found):
        decode(topic, message)
