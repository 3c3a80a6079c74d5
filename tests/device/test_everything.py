"""One program that calls every native and reads every variable of the robot.

Source: docs/spec/thymio-robot.md sections 4 and 6.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

from aseba_vm.targets import THYMIO_II
from thymio_sim_ros.device import bindings
from thymio_sim_ros.device.device import AsebaDevice
from thymio_sim_ros.device.layout import target
from thymio_sim_ros.device.options import DeviceOptions
from thymio_sim_ros.device.programs.program import load_program
from thymio_sim_ros.sim.audio.synthesis import BLOCK_NS, TRIANGLE
from thymio_sim_ros.sim.commands import (
    LEDS_GIVEN_BACK,
    Command,
    EnableComm,
    MotorTargets,
    PlaySamples,
    PlaySystemSound,
    PlayTone,
    SetCommPayload,
    SetLed,
    SetLeds,
    SetSoundThreshold,
    SetVolume,
    SetWave,
    StopSound,
)

DATA = Path(__file__).parents[1] / "data" / "device"
SOURCE = (DATA / "everything.aesl").read_text()
TABLE = json.loads((DATA / "variables.json").read_text())

SENSES = {
    "buttons._raw": range(2000, 2005), "button.backward": [0], "button.left": [1], "button.center": [0],
    "button.forward": [1], "button.right": [1], "buttons._mean": range(2100, 2105), "buttons._noise": range(130, 135),
    "prox.horizontal": range(1, 8), "prox.comm.rx._payloads": range(71, 78),
    "prox.comm.rx._intensities": range(81, 88), "prox.comm.rx": [555], "prox.ground.ambiant": [11, 12],
    "prox.ground.reflected": [13, 14], "prox.ground.delta": [15, 16], "_vbat": [796, 797], "_imot": [31, 32],
    "motor.left.speed": [101], "motor.right.speed": [-102], "motor.left.pwm": [-161], "motor.right.pwm": [162],
    "_integrator": [-483, 484], "acc": [-3, 4, 23], "temperature": [234], "rc5.address": [17], "rc5.command": [42],
    "mic.intensity": [60], "mic._mean": [7], "acc._tap": [1],
}  # fmt: skip
"""What each variable of a sensor of the Thymio II is given; the variables of other sensors stay 0."""


def sensed(device: AsebaDevice) -> None:
    """Every sensor tells its words once, proximity last."""
    places = {address: name for name, (address, _) in target().addresses.items()}
    for sensor, binding in sorted(bindings.sensors().items(), key=lambda item: item[0] == "proximity"):
        words = [word for slot in binding.slots for word in SENSES.get(places[slot.address], ())]
        device.feed(sensor, [*words, *[0] * (binding.size - len(words))])


def expectations() -> Iterator[tuple[str, tuple[int, ...]]]:
    for name, words in re.findall(r"^#= (\S+) (.*)$", SOURCE, re.MULTILINE):
        yield name, tuple(map(int, words.split()))


@pytest.fixture
def device(tmp_path: Path) -> AsebaDevice:
    """A robot with a card on which there are two sounds, after the beginning of the program."""
    device = AsebaDevice(options=DeviceOptions(card=tmp_path / "card", settings=tmp_path / "flash"))
    assert device.services.card is not None
    device.services.card.write_sound("p1", b"\x80\x90" * 100)
    device.services.card.write_sound("r1", bytes([128]) * 7812)
    events = "".join(f'<event size="2" name="{name}"/>' for name in ("received", "off", "again"))
    code = SOURCE.replace("&", "&amp;").replace("<", "&lt;")
    device.load(load_program(f'<network>{events}<node name="thymio-II">{code}</node></network>', "everything.aesl"))
    device.pop_commands()
    device.advance(0)
    while device.is_busy:
        device.run(10_000)
    return device


def run(device: AsebaDevice) -> list[Command]:
    while device.is_busy:
        device.run(10_000)
    return device.pop_commands()


def test_the_program_names_every_native_and_every_variable() -> None:
    code = re.sub("#.*", "", SOURCE)
    called = set(re.findall(r"call ([\w.]+)", code))
    assert called == set(TABLE["natives"]["thymio"])
    missing = [
        name for name, _, _ in TABLE["variables"] if not re.search(rf"(?<![\w.]){re.escape(name)}(?![\w.])", code)
    ]
    assert missing == []


def test_every_variable_of_a_sensor_is_given_something() -> None:
    bound = {slot.address for binding in bindings.sensors().values() for slot in binding.slots}
    robot = {address for address in bound if address < THYMIO_II.variables_end}
    assert {target().addresses[name][0] for name in SENSES} == robot


def test_every_native_and_variable_gives_what_the_program_expects(device: AsebaDevice) -> None:
    sensed(device)
    device.receive_event("received", (8, 9), source=3)
    run(device)
    assert device.status.state == "running"
    assert {name: device.variables.get(name) for name, _ in expectations()} == dict(expectations())
    assert device.notices.pop() == []


def test_every_native_function_of_an_actuator_causes_its_command(device: AsebaDevice) -> None:
    assert device.pop_commands() == [
        SetVolume(0),
        SetVolume(2),
        SetLeds("circle", (1, 2, 3, 4, 5, 6, 7, 8)),
        SetLeds("top", (9, 10, 11)),
        SetLeds("bottom_left", (12, 13, 14)),
        SetLeds("bottom_right", (15, 16, 17)),
        SetLeds("buttons", (18, 19, 20, 21)),
        SetLeds("proximity", (22, 23, 24, 25, 26, 27, 28, 29)),
        SetLeds("ground", (30, 31)),
        SetLeds("remote", (32,)),
        SetLeds("microphone", (1,)),
        SetLeds("temperature", (2, 3)),
        SetLed(5, 4),
        EnableComm(True),
        SetWave((127, -128, *[0] * 140)),
        PlayTone(440, 30 * BLOCK_NS),
        PlaySystemSound(7),
        PlaySamples(b"\x80\x90" * 100),
        PlaySamples(bytes([128]) * 7812),
        SetCommPayload(1234),
        SetSoundThreshold(50),
        MotorTargets(101, -100),
    ]


def test_files_of_the_card_and_the_flash_hold_what_was_written(device: AsebaDevice, tmp_path: Path) -> None:
    assert (tmp_path / "card" / "u1.dat").read_bytes() == b"\x01\x00\xfe\xff\x03\x00\x04\x00"
    assert (tmp_path / "card" / "r2.wav").stat().st_size == 44
    assert json.loads((tmp_path / "flash" / "settings.json").read_text())["mot256"] == [260, 256]


def test_the_radio_has_the_number_and_network_it_was_given(device: AsebaDevice) -> None:
    assert (device.node_id, device.services.network) == (9, (1, 77))
    device.run_control.reset()
    assert device.variables.get("_id") == (9,)


def test_switched_off_everything_is_dark_and_still_until_it_is_switched_on(device: AsebaDevice) -> None:
    device.pop_commands()
    device.receive_event("off", (0, 0))
    commands = run(device)
    assert commands[-1] == PlaySystemSound(1)
    assert MotorTargets(0, 0) in commands
    assert commands[-1 - len(LEDS_GIVEN_BACK) : -1] == list(LEDS_GIVEN_BACK)
    assert device.status.state == "off"
    sensed(device)
    device.advance(1_000_000_000)
    device.run_control.pause()
    device.run_control.step()
    assert run(device) == []
    assert device.variables.get("far") == (0,) * 7
    device.run_control.resume()
    assert device.status.state == "running"
    commands = run(device)
    assert StopSound() in commands
    assert MotorTargets(101, -100) in commands


def test_a_restart_begins_anew_and_keeps_what_was_flashed(device: AsebaDevice) -> None:
    sensed(device)
    run(device)
    device.services.settings[0] = 7
    device.receive_event("again", (0, 0))
    commands = run(device)
    assert commands[-1] == MotorTargets(101, -100)
    assert commands[0] != commands[-1]
    assert SetWave(TRIANGLE) in commands
    assert device.services.settings[0] == 2
    assert device.variables.get("far") == (0,) * 7
    assert device.status.state == "running"
