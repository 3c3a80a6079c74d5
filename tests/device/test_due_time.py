"""When a device has work next, and what brings that forward."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from thymio_sim_ros.device.device import AsebaDevice
from thymio_sim_ros.device.programs.program import load_program
from thymio_sim_ros.sim.model.clock import NEVER_NS

MILLISECOND_NS = 1_000_000


def settled(source: str = "", now_ms: int = 1000) -> AsebaDevice:
    """A device that has done all its work at a time."""
    device = AsebaDevice()
    device.load(load_program(source, "test"))
    device.advance(0)
    tick(device, now_ms)
    return device


def tick(device: AsebaDevice, now_ms: int) -> None:
    """Advance a device and let it work."""
    device.advance(now_ms * MILLISECOND_NS)
    device.run(5000)
    device.pop_commands()


def test_a_device_without_work_is_never_due() -> None:
    assert settled("motor.left.target = 100\nonevent prox\nmotor.left.target = 0").due.ns == NEVER_NS


def firings(device: AsebaDevice, end_ms: int) -> list[int]:
    """The times in ms at which timers fire, if the device is left alone until it is due."""
    found, before = [], device.variables.get("n")
    while device.due.ns <= end_ms * MILLISECOND_NS:
        now_ms = device.due.ns // MILLISECOND_NS
        tick(device, now_ms)
        if device.variables.get("n") != before:
            before = device.variables.get("n")
            found.append(now_ms)
    return found


TIMERS = "var n = 0\ntimer.period = [70, 200]\nonevent timer0\nn++\nonevent timer1\nn++"


def test_a_device_is_due_when_its_next_timer_fires() -> None:
    assert firings(settled(TIMERS, 0), 400) == [70, 140, 200, 210, 280, 350, 400]


def test_a_timer_that_is_set_while_its_device_rests_counts_from_the_last_tick() -> None:
    device = settled(TIMERS.replace("70", "1000"), 0)
    assert firings(device, 150) == []
    device.variables.set("timer.period", (1000, 70))
    tick(device, 160)
    assert firings(device, 300) == [220, 290]


@pytest.mark.parametrize(
    "change",
    [
        lambda device: device.feed("proximity", (4000,) * 7),
        lambda device: device.receive_event("go", ()),
        lambda device: device.variables.set("n", (1,)),
        lambda device: device.load(load_program("", "other")),
        lambda device: device.run_control.stop(),
        lambda device: device.run_control.reset(),
        lambda device: device.run_control.switch_off(),
        lambda device: device.run_control.step(),
    ],
)
def test_what_gives_a_device_work_makes_it_due(change: Callable[[AsebaDevice], None]) -> None:
    source = "var n\nonevent prox\nn++\nonevent go\nn++"
    program = f'<network><event size="0" name="go"/><node name="thymio-II">{source}</node></network>'
    device = settled(program)
    assert not device.is_due
    change(device)
    assert device.is_due


def test_a_reading_that_nothing_handles_is_due_with_the_next_update_of_the_indicators() -> None:
    device = settled(now_ms=1010)
    device.feed("motor", (1, 2, 3, 4))
    assert device.due.ns == NEVER_NS
    device.feed("temperature", (300,))
    assert device.due.ns == 1020 * MILLISECOND_NS
    tick(device, 1020)
    assert device.due.ns == NEVER_NS
    device.feed("temperature", (300,))
    assert device.due.ns == NEVER_NS


def test_a_device_that_rests_while_paused_is_due_again_when_it_continues() -> None:
    device = settled("var n = 0\nonevent prox\nn++")
    device.run_control.pause()
    tick(device, 1010)
    device.feed("proximity", (4000,) * 7)
    tick(device, 1020)
    device.run_control.resume()
    assert device.is_due
    tick(device, 1030)
    assert device.variables.get("n") == (1,)


def test_variables_are_measured_before_a_run_only_if_the_program_refers_to_them() -> None:
    calls = []
    for source in ("var s\nonevent prox\ns = motor.right.pwm", "onevent prox\nmotor.left.target = 5"):
        device = settled(source)
        measured: list[int] = []

        def measure(measured: list[int] = measured) -> list[tuple[str, tuple[int, ...]]]:
            measured.append(1)
            return [("motor", (1, 2, 3, len(measured)))]

        device.measure_on_read(("motor",), measure)
        device.feed("proximity", (0,) * 7)
        tick(device, 1010)
        calls.append(len(measured))
        assert device.variables.get("motor.left.speed") == (1,)
    assert calls == [1, 0]
