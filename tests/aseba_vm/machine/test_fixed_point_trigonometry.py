import math

import pytest

from aseba_vm.machine.fixed_point_trigonometry import arctangent, cosine, sine


@pytest.mark.parametrize(
    ("angle", "value"), [(0, 0), (16384, 32767), (-16384, -32767), (-32768, 0), (8192, 23171), (32767, 3)]
)
def test_the_sine_of_some_angles(angle, value):
    assert sine(angle) == value


def test_sine_and_cosine_follow_the_circle():
    for angle in range(-32768, 32768, 37):
        radians = angle * math.pi / 32768
        assert abs(sine(angle) - 32767 * math.sin(radians)) < 8
        assert abs(cosine(angle) - 32767 * math.cos(radians)) < 8


def test_the_arc_tangent_follows_the_direction():
    for degrees in range(1, 360, 7):
        radians = math.radians(degrees)
        y, x = round(20000 * math.sin(radians)), round(20000 * math.cos(radians))
        wanted = math.atan2(y, x) * 32768 / math.pi
        assert abs(arctangent(y, x) - wanted) < 24


@pytest.mark.parametrize(
    ("y", "x", "value"), [(0, 5, 0), (0, -5, -32768), (5, 0, 16384), (-5, 0, -16384), (1, 1, 8203), (-32768, 1, -16384)]
)
def test_the_arc_tangent_of_some_directions(y, x, value):
    assert arctangent(y, x) == value
