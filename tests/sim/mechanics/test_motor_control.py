"""The firmware's loop of one wheel: where it settles, its limits, its protection."""

from __future__ import annotations

import pytest

from tests.sim.fake_view import FakeBody
from thymio_sim_ros.sim.mechanics import motor_control
from thymio_sim_ros.sim.model.units import units_to_speed


class WheelControl:
    """The left wheel of a robot, driven by the kernel as Python runs it."""

    def __init__(self) -> None:
        self.wheels = FakeBody().wheels

    def tick(self, target: float, speed: float) -> float:
        return motor_control.control(self.wheels, 0, target, speed)

    @property
    def output(self) -> float:
        return self.wheels.output[0]

    @property
    def integral(self) -> float:
        return self.wheels.integral[0]

    @property
    def current(self) -> float:
        return self.wheels.current[0]


def run(control: WheelControl, target: float, ticks: int, speed: float = 0.0, *, held: bool = False) -> list[float]:
    """Speeds after each tick of a wheel that starts at a speed; a held one does not turn."""
    speeds = []
    for _ in range(ticks):
        reached = control.tick(target, speed)
        speed = 0.0 if held else reached
        speeds.append(speed)
    return speeds


@pytest.mark.parametrize("target", [-400, -50, 50, 300, 490])
def test_a_wheel_settles_at_its_target_with_the_opposite_output(target: float) -> None:
    control = WheelControl()
    assert run(control, target, 300)[-1] == pytest.approx(target, rel=0.01)
    assert control.output == pytest.approx(-1.6 * target, rel=0.01)
    assert control.integral == pytest.approx(3 * control.output, rel=0.02)


def test_a_wheel_needs_about_a_tenth_of_a_second_for_most_of_the_way() -> None:
    speeds = run(WheelControl(), 300, 100)
    reached = next(tick for tick, speed in enumerate(speeds, start=1) if speed > 0.63 * 300)
    assert 4 <= reached <= 12
    assert max(speeds) < 1.05 * 300


def test_the_first_tick_is_the_mean_with_an_output_of_zero() -> None:
    control = WheelControl()
    control.tick(30, 0)
    assert (control.integral, control.output) == (-30, pytest.approx((5 * -30 + -30 / 3) / 2))


def test_an_output_beyond_its_limit_takes_half_of_the_excess_from_the_integral() -> None:
    control = WheelControl()
    control.tick(500, 0)
    excess = (5 * 500 + 500 / 3) / 2 - 801
    assert (control.output, control.integral) == (-801, pytest.approx(-500 + excess / 2))


def test_the_integral_of_a_held_wheel_stays_within_its_limit() -> None:
    control = WheelControl()
    run(control, 40, 1000, held=True)
    assert abs(control.integral) <= 4806


def test_a_wheel_is_let_go_after_ten_ticks_of_target_zero() -> None:
    control = WheelControl()
    speed = run(control, 300, 200)[-1]
    run(control, 0, 9, speed)
    assert (control.output, control.integral) != (0, 0)
    run(control, 0, 1, speed)
    assert (control.output, control.integral) == (0, 0)


def test_a_held_wheel_gets_half_the_voltage_until_it_is_let_go() -> None:
    control = WheelControl()
    run(control, 500, 60, held=True)
    assert control.current < 600
    run(control, 500, 600, held=True)
    assert control.current == pytest.approx(801 / 2, rel=0.05)
    assert run(control, 500, 300)[-1] > 480


def test_after_three_ticks_of_a_high_current_the_voltage_is_half() -> None:
    control = WheelControl()
    given, currents = [], []
    while len([current for current in currents if current > 600]) < 4:
        given.append(control.tick(500.0, 0.0))
        currents.append(control.current)
    assert given[-2] == pytest.approx(given[-4])
    assert given[-1] == pytest.approx(given[-4] / 2)


def test_left_and_right_turns_mirror_each_other() -> None:
    assert run(WheelControl(), -170, 100) == [-speed for speed in run(WheelControl(), 170, 100)]


def test_a_light_load_of_a_motor_that_follows_at_once_shows() -> None:
    wheels = FakeBody().wheels
    for wheel, speed in enumerate((90, 100)):
        wheels.aimed[wheel], wheels.rim[wheel] = units_to_speed(100), units_to_speed(speed)
    for _ in range(1000):
        for wheel in (0, 1):
            motor_control.report_ideal(wheels, wheel)
    assert [round(value, 3) for value in wheels.current] == [16.0, 0.0]
