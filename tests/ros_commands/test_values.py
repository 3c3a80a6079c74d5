"""Values as YAML, and rates."""

from __future__ import annotations

import math

import pytest
from geometry_msgs.msg import PoseWithCovariance
from sensor_msgs.msg import Image, LaserScan
from std_msgs.msg import Empty, String

from thymio_sim_ros.ros_commands import rates
from thymio_sim_ros.ros_commands.values import to_yaml


def test_numbers_texts_and_lists_are_yaml() -> None:
    assert to_yaml(LaserScan(ranges=[0.5, math.inf])).splitlines()[-4:] == [
        "ranges:",
        "- 0.5",
        "- .inf",
        "intensities: []",
    ]
    assert to_yaml(String(data="ä")) == "data: ä\n"
    assert to_yaml(1.5) == "1.5\n"
    assert to_yaml(PoseWithCovariance().covariance).splitlines() == ["- 0.0"] * 36
    assert to_yaml(Empty()) == "{}\n"


def test_long_values_are_cut_unless_all_is_wanted() -> None:
    image = Image(encoding="x" * 200, data=[1] * 200)
    lines = to_yaml(image).splitlines()
    assert lines.count("- 1") == 128
    assert lines[-1] == "- '...'"
    assert f"encoding: {'x' * 128}..." in lines
    assert to_yaml(image, longest=None).count("- 1") == 200
    assert "data: <array type, 200 elements>" in to_yaml(image, lists=False)


@pytest.fixture
def window() -> rates.Window:
    """Four messages of 2 kB, 0.1, 0.1 and 0.2 s apart."""
    times = iter((1.0, 1.1, 1.2, 1.4, 1.4))
    made = rates.Window(10, lambda: next(times))
    assert not made.is_new
    for _ in range(4):
        made.add(2000)
    return made


def test_rates_are_those_of_the_window(window: rates.Window) -> None:
    assert window.is_new
    assert not window.is_new
    assert rates.rate(window) == "average rate: 7.500\n\tmin: 0.100s max: 0.200s std dev: 0.04714s window: 4"
    assert rates.bandwidth(window) == (
        "20.00 KB/s from 4 messages\n\tMessage size mean: 2.00 KB min: 2.00 KB max: 2.00 KB"
    )


@pytest.mark.parametrize(("size", "text"), [(12, "12 B"), (720, "0.72 KB"), (2_500_000, "2.50 MB")])
def test_bytes_have_the_unit_that_fits(size: int, text: str) -> None:
    assert rates._bytes(size) == text
