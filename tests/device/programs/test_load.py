"""What a program asks of its robot is charged; too much is reported and stops it."""

from __future__ import annotations

from pathlib import Path

import pytest

from thymio_sim_ros.device.device import AsebaDevice
from thymio_sim_ros.device.event_queue import MAX_PENDING, PLAYGROUND
from thymio_sim_ros.device.options import DeviceOptions
from thymio_sim_ros.device.programs.load import MIN_CUTS, Load
from thymio_sim_ros.device.programs.program import load_program

BUDGET = 5000
EVENTS = '<network><event size="2" name="e"/><node name="thymio-II">{}</node></network>'
ENDLESS = "var k = 0\nvar i\nwhile k == 0 do\ni = (i + 1) % 30000\n{}\nend"


def running(body: str, options: DeviceOptions | None = None, *, text: str = ENDLESS) -> AsebaDevice:
    device = AsebaDevice(options=options or DeviceOptions())
    source = text.format(body).replace("<", "&lt;")
    device.load(load_program(EVENTS.format(source), "test.aesl", device.layout))
    return device


@pytest.mark.parametrize(
    ("body", "most"),
    [
        ("call leds.top(i % 32, 0, 0)", 5000 // 30),
        ("call sound.freq(440, 1)", 5000 // 30),
        ("emit e [1, 2]", 5000 // 152),
        ("call sd.open(i, k)\nk = 0", 5000 // 200),
        ("call _system.settings.flash()", 2),
    ],
)
@pytest.mark.parametrize("options", [DeviceOptions(), DeviceOptions(events=PLAYGROUND)], ids=["firmware", "playground"])
def test_a_run_makes_as_many_calls_as_the_budget_pays(body: str, most: int, options: DeviceOptions) -> None:
    device = running(body, options)
    for _ in range(MIN_CUTS):
        device.run(BUDGET)
        load = device.load_meter.pop()
        assert 1 <= sum([*load.calls.values(), *load.emitted.values()]) <= max(most, 200)


def test_a_program_that_calls_too_much_is_named_until_it_stops() -> None:
    device = running("call leds.top(i % 32, 0, 0)\nemit e [1, 2]")
    for _ in range(MIN_CUTS):
        device.run(BUDGET)
    said = device.load_meter.pop().warning
    assert "more than the robot can carry out" in said
    assert "emit e" in said
    assert "call leds.top" in said
    device.run_control.stop()
    device.run(BUDGET)
    assert device.load_meter.pop().warning == ""


def test_a_long_computation_is_no_overload() -> None:
    device = running("i = i * 3 % 7")
    for _ in range(10):
        device.run(BUDGET)
    assert device.is_busy
    assert device.load_meter.pop().warning == ""


def test_a_busy_handler_that_ends_is_no_overload() -> None:
    device = running("", text="onevent button.center\ncall leds.top(1, 2, 3)\nemit e [1, 2]{}")
    for pressed in (1, 0) * 5:
        device.feed("buttons", (0, 0, pressed, 0, 0))
        device.run(BUDGET)
    load = device.load_meter.pop()
    assert load.calls == {"leds.top": 10}
    assert load.warning == ""


def test_events_that_cannot_wait_are_counted() -> None:
    device = running("i = 0")
    device.run(BUDGET)
    for _ in range(MAX_PENDING + 7):
        device.receive_event("e", (1, 2))
    load = device.load_meter.pop()
    assert load.lost == {"e": 7}
    assert "events lost" in load.warning


def test_a_program_that_names_ever_new_sounds_is_not_quoted_for_each(tmp_path: Path) -> None:
    device = running("call sound.play(i)", DeviceOptions(card=tmp_path))
    for _ in range(30):
        device.run(BUDGET)
    assert 1 < len(device.notices.pop()) <= 50


def test_a_full_card_fails_as_on_the_robot_and_is_reported(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("thymio_sim_ros.device.firmware.sd_card.MAX_FILES", 4)
    text = "var i\nvar s[8]\nwhile i < 8 do\ncall sd.open(i, s[i])\ni++\nend{}"
    device = running("", DeviceOptions(card=tmp_path), text=text)
    device.run(BUDGET)
    assert device.variables.get("s") == (0, 0, 0, 0, -1, -1, -1, -1)
    assert device.notices.pop() == ["the card is full: it holds 4 files"]


def test_a_long_sound_is_charged_for_its_bytes(tmp_path: Path) -> None:
    (tmp_path / "p1.wav").write_bytes(bytes(44 + 2_000_000))
    device = running("call sound.play(1)", DeviceOptions(card=tmp_path))
    device.run(BUDGET)
    assert device.load_meter.pop().calls == {"sound.play": 1}


def test_a_load_within_the_capacity_has_no_warning() -> None:
    assert Load(MIN_CUTS - 1, 10, {"leds.top": 9}).warning == ""
    assert "leds.top: 9" in Load(1, 1, {"leds.top": 9}).warning
    assert "replaced" in Load(replaced=30).warning
