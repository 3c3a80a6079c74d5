"""Addresses of robots."""

from __future__ import annotations

import pytest

from thymio_sim_ros.network.robot_target import SerialTarget, TargetError, TcpTarget, parse_target


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("tcp:robot:33334", TcpTarget("robot", 33334)),
        ("tcp:robot", TcpTarget("robot", 33333)),
        ("tcp:[::1]:33334", TcpTarget("::1", 33334)),
        ("tcp:[::1]", TcpTarget("::1", 33333)),
        ("tcp:127.0.0.1;33334", TcpTarget("127.0.0.1", 33334)),
        ("tcp:robot;port=33334", TcpTarget("robot", 33334)),
        ("tcp:host=robot;port=33334", TcpTarget("robot", 33334)),
        ("tcp:port=33334", TcpTarget("localhost", 33334)),
        ("ser:/dev/ttyACM0", SerialTarget("/dev/ttyACM0")),
        ("ser:device=/dev/ttyACM0", SerialTarget("/dev/ttyACM0")),
        ("ser", SerialTarget()),
        ("ser:", SerialTarget()),
    ],
)
def test_addresses_are_parsed(text: str, expected: TcpTarget | SerialTarget) -> None:
    assert parse_target(text) == expected
    assert parse_target(str(expected)) == expected


@pytest.mark.parametrize("text", ["", "robot:33333", "udp:robot:1", "tcp", "tcp:robot:99999"])
def test_other_texts_are_rejected(text: str) -> None:
    with pytest.raises(TargetError, match="expected"):
        parse_target(text)
