"""A serial port as a socket; the port is a loop, which every system has."""

from __future__ import annotations

from typing import Any

import pytest

from tests.patience import PATIENCE_S
from thymio_sim_ros.network.serial_stream import SerialStream

serial = pytest.importorskip("serial", reason="pyserial is not installed")

pytestmark = pytest.mark.process


class Ports:
    """The ports that have been opened."""

    def __init__(self) -> None:
        self.opened: list[Any] = []

    def open(self, _device: str, *arguments: Any, **options: Any) -> Any:
        """A port that receives what it sends."""
        self.opened.append(serial.serial_for_url("loop://", *arguments, **options))
        return self.opened[-1]


@pytest.fixture
def ports(monkeypatch: pytest.MonkeyPatch) -> Ports:
    """Replaces the ports of the system."""
    found = Ports()
    monkeypatch.setattr(serial, "Serial", found.open)
    return found


def test_bytes_go_to_the_port_and_come_from_it(ports: Ports) -> None:
    stream = SerialStream("COM3", 115200)
    with stream.socket as end:
        end.settimeout(PATIENCE_S)
        end.sendall(b"\r\n\x11\x13")
        received = b""
        while len(received) < 4:
            received += end.recv(4)
    assert received == b"\r\n\x11\x13"
    stream.join(PATIENCE_S)
    assert not ports.opened[0].is_open


def test_what_was_sent_before_the_end_reaches_the_port(ports: Ports, monkeypatch: pytest.MonkeyPatch) -> None:
    written: list[bytes] = []
    stream = SerialStream("COM3", 115200)
    monkeypatch.setattr(ports.opened[0], "write", written.append)
    with stream.socket as end:
        end.sendall(b"last")
    stream.join(PATIENCE_S)
    assert b"".join(written) == b"last"


@pytest.mark.parametrize("part", ["read", "write"])
def test_a_port_that_fails_ends_the_stream(ports: Ports, monkeypatch: pytest.MonkeyPatch, part: str) -> None:
    def fail(_argument: object) -> bytes:
        raise serial.SerialException("the cable was pulled")

    stream = SerialStream("COM3", 115200)
    monkeypatch.setattr(ports.opened[0], part, fail)
    with stream.socket as end:
        end.settimeout(PATIENCE_S)
        end.sendall(b"x")
        while end.recv(1):
            pass
    stream.join(PATIENCE_S)
    assert not ports.opened[0].is_open
