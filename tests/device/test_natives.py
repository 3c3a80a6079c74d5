"""What natives answer and tell, case by case; test_everything.py calls them all."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from aseba_vm.machine.natives import NATIVES
from tests.sim.builders import make
from thymio_sim_ros.device.device import AsebaDevice
from thymio_sim_ros.device.layout import target
from thymio_sim_ros.device.natives import native_functions
from thymio_sim_ros.device.options import DEFAULTS, DeviceOptions
from thymio_sim_ros.device.programs.load import LoadMeter
from thymio_sim_ros.device.programs.program import load_program
from thymio_sim_ros.sim.audio.synthesis import BLOCK_NS
from thymio_sim_ros.sim.commands import Command, MotorTargets, PlaySamples, PlaySystemSound, SetVolume, StopSound
from thymio_sim_ros.sim.world import World

CLICK = bytes([128, 200]) * 300


@pytest.fixture
def options(tmp_path: Path) -> DeviceOptions:
    return DeviceOptions(card=tmp_path / "card")


def start(source: str, options: DeviceOptions = DEFAULTS, *, sounds: Sequence[str] = ()) -> AsebaDevice:
    """A device with a program that waits for its first instruction; its card holds a click under these names."""
    device = AsebaDevice(options=options)
    for name in sounds:
        assert device.services.card is not None
        device.services.card.write_sound(name, CLICK)
    device.load(load_program(source, "test"))
    device.pop_commands()
    return device


def run(device: AsebaDevice) -> list[Command]:
    """What the device tells until it waits."""
    while device.is_busy:
        device.run(5000)
    return device.pop_commands()


def reported(source: str, options: DeviceOptions = DEFAULTS, *, sounds: Sequence[str] = ()) -> list[Command]:
    return run(start(source, options, sounds=sounds))


def variables(source: str, options: DeviceOptions, *names: str) -> list[tuple[int, ...]]:
    """What these variables hold after the program."""
    device = start(source, options)
    run(device)
    return [device.variables.get(name) for name in names]


def test_without_a_card_files_answer_what_a_robot_without_one_answers() -> None:
    source = (
        "var o = 5\nvar w = 5\nvar r = 5\nvar s = 5\nvar d = 5\nvar data[2] = [1, 2]\n"
        "call sd.open(1, o)\ncall sd.write(data, w)\ncall sd.read(data, r)\ncall sd.seek(0, s)\n"
        "call sound.duration(1, d)"
    )
    found = variables(source, DEFAULTS, "o", "w", "r", "s", "d", "data", "sd.present")
    assert found == [(-1,), (0,), (0,), (-1,), (0,), (1, 2), (0,)]


def test_reading_beyond_the_end_leaves_the_rest_as_it_was(options: DeviceOptions) -> None:
    source = (
        "var s\nvar n\nvar data[4] = [1, 2, 3, 4]\ncall sd.open(1, s)\ncall sd.write(data[0:1], n)\n"
        "call sd.seek(1, s)\ncall sd.read(data, n)"
    )
    assert variables(source, options, "n", "data", "s") == [(1,), (2, 2, 3, 4), (0,)]


def test_a_position_above_32767_is_written_without_sign(options: DeviceOptions) -> None:
    source = "var s\nvar n\ncall sd.open(1, s)\ncall sd.seek(-32768, s)\ncall sd.write([7], n)"
    assert variables(source, options, "s", "n") == [(0,), (1,)]
    assert options.card is not None
    assert (options.card / "u1.dat").stat().st_size == 2 * 32769


def test_a_program_that_begins_anew_finds_no_open_file(options: DeviceOptions) -> None:
    device = start("var s\nvar n\ncall sd.open(1, s)", options)
    run(device)
    device.load(load_program("var n = 9\ncall sd.write([1], n)", "test"))
    run(device)
    assert device.variables.get("n") == (0,)


@pytest.mark.parametrize(
    ("call", "expected"),
    [
        ("sound.play(1)", [PlaySamples(CLICK)]),
        ("sound.play(2)", [StopSound()]),
        ("sound.play(-1)", [StopSound()]),
        ("sound.replay(3)", [PlaySamples(CLICK)]),
        ("sound.replay(-1)", [StopSound()]),
        ("sound.system(-1)", [StopSound()]),
        ("sound.system(0)", [PlaySystemSound(0)]),
        ("sound.system(7)", [PlaySystemSound(7)]),
        ("sound.system(8)", [PlaySystemSound(8)]),
        ("sound.system(12)", [PlaySamples(CLICK)]),
        ("sound.freq(440, -1)", [StopSound()]),
    ],
)
def test_sounds_come_from_the_robot_or_from_the_card(
    options: DeviceOptions, call: str, expected: list[Command]
) -> None:
    assert reported(f"call {call}", options, sounds=("p1", "r3", "s12", "s0")) == expected


def test_a_missing_sound_is_reported(options: DeviceOptions) -> None:
    device = start("call sound.play(2)", options)
    run(device)
    assert device.notices.pop() == ["there is no p2.wav on the card"]


def test_a_wave_out_of_range_is_a_fault_of_the_program() -> None:
    device = start("var w[142]\nw[3] = 200\ncall sound.wave(w)")
    run(device)
    assert (device.status.state, device.status.line) == ("fault", 3)
    assert device.status.fault == "sound.wave: sample 200 found, expected -128 to 127"


@pytest.mark.parametrize("call", ["_system.settings.read(92, x)", "_system.settings.write(-1, x)"])
def test_an_address_out_of_settings_is_a_fault_of_the_program(call: str) -> None:
    device = start(f"var x\ncall {call}")
    run(device)
    assert device.status.state == "fault"
    assert device.status.fault.startswith("out of settings")


def test_the_volume_and_the_motors_obey_the_settings_at_once() -> None:
    source = "call _system.settings.write(0, 4)\ncall _system.settings.write(8, 300)\nmotor.left.target = 256"
    assert reported(source) == [SetVolume(4), SetVolume(4), MotorTargets(300, 0)]


def test_a_new_calibration_moves_wheels_that_turn_already() -> None:
    device = start("motor.left.target = 256\nonevent prox\ncall _system.settings.write(8, 300)")
    assert run(device) == [MotorTargets(256, 0)]
    device.feed("proximity", (0,) * 7)
    assert MotorTargets(300, 0) in run(device)


def test_settings_survive_a_new_program_and_set_the_volume() -> None:
    device = start("call _system.settings.write(0, 4)")
    run(device)
    device.load(load_program("", "test"))
    assert SetVolume(4) in device.pop_commands()


def test_a_recording_contains_the_intensity_of_the_microphone(options: DeviceOptions) -> None:
    source = "var t = -1\ncall sound.record(5)\nonevent prox\ncall sound.record(-1)\ncall sound.duration(5, t)"
    device = start(source, options)
    device.advance(0)
    run(device)
    for tick in range(1, 201):
        device.variables.set("mic.intensity", (100,))
        device.advance(tick * 10_000_000)
    device.feed("proximity", (0,) * 7)
    run(device)
    assert device.variables.get("t") == (19,)
    assert device.services.card is not None
    samples, complaint = device.services.card.read_sound("r5") or (b"", "missing")
    assert (len(samples), complaint) == (2_000_000_000 // BLOCK_NS * 128, "")
    assert (min(samples), max(samples)) == (78, 178)


@pytest.mark.parametrize(
    "end", [lambda device: device.load(load_program("", "none")), lambda device: device.run_control.switch_off()]
)
def test_a_record_is_stored_when_the_program_ends(options: DeviceOptions, end: Callable[[AsebaDevice], None]) -> None:
    device = start("call sound.record(1)", options)
    run(device)
    end(device)
    assert device.services.recorded_bytes(1) == 0
    assert device.services.card is not None
    assert device.services.card.read_sound("r1") == (b"", "")


@pytest.mark.parametrize("number", [0, -3])
def test_a_node_has_a_positive_number(number: int) -> None:
    device = start(f"call _rf.nodeid({number})")
    run(device)
    assert device.node_id == 1


def test_a_program_that_uses_sound_gets_the_event_of_its_end() -> None:
    source = "var n = 0\nonevent sound.finished\nn++\nonevent prox\ncall sound.system(1)"
    device = start(source)
    for feeds, heard in (("sound_finished", 0), ("proximity", 0), ("sound_finished", 1)):
        device.feed(feeds, (0,) * 7 if feeds == "proximity" else ())
        run(device)
        assert device.variables.get("n") == (heard,)


def test_a_restart_in_the_middle_of_a_handler_ends_it() -> None:
    device = start("var n\nvar m = 0\nonevent prox\ncall _system.reboot()\nm = 1\nmotor.left.target = 100")
    device.feed("proximity", (0,) * 7)
    run(device)
    assert (device.variables.get("m"), device.variables.get("motor.left.target")) == ((0,), (0,))
    assert device.status.state == "running"


def test_a_program_that_restarts_without_end_leaves_room_for_others() -> None:
    device = start("var n = 0\nn++\ncall _system.reboot()\nn = 100")
    for _ in range(3):
        device.run(1000)
        assert device.is_busy
        assert device.variables.get("n") == (0,)


def test_events_of_the_playground_cut_off_a_long_handler() -> None:
    source = "var n = 0\nvar i\nvar long = 0\nonevent motor\nn++\nonevent prox\nfor i in 1:30000 do\nlong = i\nend"
    device = AsebaDevice(options=DeviceOptions(events="playground"))
    device.load(load_program(source, "test"))
    run(device)
    device.feed("proximity", (0,) * 7)
    device.run(5000)
    assert device.is_busy
    done = device.variables.get("long")[0]
    assert 50 < done < 500
    device.run(5000)
    assert done < device.variables.get("long")[0] < 1000
    device.feed("motor", (0, 0, 0, 0))
    device.feed("motor", (0, 0, 0, 0))
    run(device)
    assert device.variables.get("n") == (2,)
    assert device.variables.get("long")[0] < 1000
    assert device.notices.pop() == ["motor cuts off prox, which takes more than 1000 instructions"]


def test_in_the_playground_a_program_has_its_turn_before_an_event_cuts_it_off() -> None:
    code = "var ready = 0\nvar heard = 0\nready = 1\nonevent hello\nheard = 1"
    source = f'<network><event size="0" name="hello"/><node name="thymio-II">{code}</node></network>'
    device = start(source, DeviceOptions(events="playground"))
    device.receive_event("hello", ())
    run(device)
    assert (device.variables.get("ready"), device.variables.get("heard")) == ((1,), (1,))
    assert device.notices.pop() == []


def test_no_native_of_the_robot_is_left_without_a_function() -> None:
    device = AsebaDevice()
    functions = native_functions(device._outputs.send, device.services, LoadMeter())
    assert sorted({*functions, *NATIVES}) == sorted(native.name for native in target().natives)


WORDS = st.one_of(st.sampled_from([0, 1, -1, 8, 32767, -32768]), st.integers(-32768, 32767))


@settings(max_examples=300, deadline=None)
@given(data=st.data(), name=st.sampled_from([native.name for native in target().natives]))
def test_a_native_takes_any_words_and_the_world_takes_what_comes_of_it(
    tmp_path_factory: pytest.TempPathFactory, data: st.DataObject, name: str
) -> None:
    (native,) = (native for native in target().natives if native.name == name)
    sizes = [parameter.size if parameter.size > 0 else 4 for parameter in native.parameters]
    names = [f"a{index}" for index in range(len(sizes))]
    declared = "".join(f"var {variable}[{size}]\n" for variable, size in zip(names, sizes, strict=True))
    device = AsebaDevice(options=DeviceOptions(card=tmp_path_factory.getbasetemp() / "card"))
    device.load(load_program(f"{declared}onevent prox\ncall {name}({', '.join(names)})", "test"))
    run(device)
    for variable, size in zip(names, sizes, strict=True):
        device.variables.set(variable, data.draw(st.lists(WORDS, min_size=size, max_size=size)))
    device.feed("proximity", (0,) * 7)
    if commands := run(device):
        world = World(make())
        for command in commands:
            world.post("thymio", command)
        world.step()
    assert device.status.state in ("running", "fault", "off")


@pytest.mark.parametrize(("events", "heard"), [("firmware", 50), ("playground", 20)])
def test_the_policy_sets_the_rate_of_button_events(events: str, heard: int) -> None:
    device = AsebaDevice(options=DeviceOptions(events=events))
    device.load(load_program("var n = 0\nonevent buttons\nn++", "test"))
    for tick in range(100):
        if tick % 2 == 0:
            device.feed("buttons", (0,) * 5)
        device.advance(tick * 10_000_000)
        run(device)
    assert device.variables.get("n") == (heard,)
