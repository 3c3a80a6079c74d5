"""The link to a robot: TCP and serial ports, lost connections, what arrives when it is closed."""

from __future__ import annotations

import asyncio
import contextlib
import os
import queue
import socket
from collections.abc import Iterator
from contextlib import contextmanager
from random import Random
from types import SimpleNamespace

import pytest

from aseba_vm.protocol import ListNodes, NodePresent, Run, UserMessage, encode
from tests.patience import PATIENCE_S, until
from tests.systems import posix
from thymio_sim_ros.device.remote.remote_robot import RemoteRobot
from thymio_sim_ros.network import robot_link
from thymio_sim_ros.network.robot_link import LinkEvent, LinkLost, LinkOpened, LinkReceived, RobotLink
from thymio_sim_ros.network.robot_target import SerialTarget, Target, TcpTarget

pytestmark = pytest.mark.process


class Events:
    """The events of a link, from its thread."""

    def __init__(self) -> None:
        self.queue: queue.Queue[LinkEvent] = queue.Queue()
        self.is_full = False

    def next(self) -> LinkEvent:
        return self.queue.get(timeout=PATIENCE_S)


@contextmanager
def linked(target: Target) -> Iterator[tuple[RobotLink, Events]]:
    events = Events()
    link = RobotLink(target, events.queue.put, lambda: events.is_full)
    try:
        yield link, events
    finally:
        link.close()


@pytest.fixture
def listener() -> Iterator[socket.socket]:
    with socket.create_server(("127.0.0.1", 0)) as server:
        server.settimeout(PATIENCE_S)
        yield server


def port_of(listener: socket.socket) -> TcpTarget:
    return TcpTarget("127.0.0.1", listener.getsockname()[1])


def received(connection: socket.socket, size: int) -> bytes:
    connection.settimeout(PATIENCE_S)
    data = b""
    while len(data) < size:
        data += connection.recv(size - len(data))
    return data


def accepts(connection: socket.socket, data: bytes, *, times: int) -> bool:
    """Whether a peer reads data that is sent so many times."""
    try:
        for _ in range(times):
            connection.sendall(data)
    except TimeoutError:
        return False
    return True


def test_messages_go_both_ways(listener: socket.socket) -> None:
    with linked(port_of(listener)) as (link, events):
        connection, _ = listener.accept()
        with connection:
            assert events.next() == LinkOpened()
            link.send(encode(ListNodes(0, 9)))
            assert received(connection, 8) == encode(ListNodes(0, 9))
            frame = encode(NodePresent(1, 5))
            connection.sendall(frame[:3])
            connection.sendall(frame[3:])
            assert events.next() == LinkReceived((NodePresent(1, 5),))


def test_a_lost_connection_is_opened_again(listener: socket.socket) -> None:
    with linked(port_of(listener)) as (_, events):
        for _ in range(3):
            connection, _ = listener.accept()
            assert events.next() == LinkOpened()
            connection.sendall(encode(NodePresent(1, 5))[:4])
            connection.close()
            assert events.next() == LinkLost("the connection was closed")


def test_only_a_robot_that_has_described_itself_is_tried_again_soon(
    listener: socket.socket, monkeypatch: pytest.MonkeyPatch
) -> None:
    pauses: list[float] = []

    async def pause(delay_s: float) -> None:
        pauses.append(delay_s)

    monkeypatch.setattr(robot_link, "asyncio", SimpleNamespace(**{**vars(asyncio), "sleep": pause}))
    with linked(port_of(listener)) as (link, events):
        for number in range(7):
            connection, _ = listener.accept()
            with connection:
                assert events.next() == LinkOpened()
                if number == 5:
                    link.confirm()
                connection.sendall(bytes([0xFF]) * 100)
                assert isinstance(events.next(), LinkLost)
        until(lambda: len(pauses) >= 7)
    assert pauses[:7] == [0.25, 0.5, 1.0, 2.0, 4.0, 0.25, 0.5]


def test_a_robot_that_is_not_there_is_reported_and_found_later() -> None:
    with socket.create_server(("127.0.0.1", 0)) as probe:
        target = port_of(probe)
    with linked(target) as (_, events):
        lost = events.next()
        assert isinstance(lost, LinkLost)
        assert lost.reason
        with socket.create_server(("127.0.0.1", target.port)) as server:
            server.settimeout(PATIENCE_S)
            server.accept()[0].close()
            while isinstance(event := events.next(), LinkLost):
                pass
            assert event == LinkOpened()


def test_a_silent_robot_is_given_up(listener: socket.socket, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(robot_link, "SILENCE_S", 0.05)
    with linked(port_of(listener)) as (_, events):
        connection, _ = listener.accept()
        with connection:
            assert events.next() == LinkOpened()
            assert events.next() == LinkLost("no data for 0.05 s")


def test_a_frame_that_is_too_long_ends_the_connection(listener: socket.socket) -> None:
    with linked(port_of(listener)) as (_, events):
        connection, _ = listener.accept()
        with connection:
            assert events.next() == LinkOpened()
            connection.sendall(b"\xff\xff\x01\x00\x05\x90")
            assert events.next() == LinkLost("frame: payload of 65535 bytes, expected at most 4096")


def test_a_frame_that_is_no_message_is_skipped(listener: socket.socket) -> None:
    with linked(port_of(listener)) as (_, events):
        connection, _ = listener.accept()
        with connection:
            assert events.next() == LinkOpened()
            connection.sendall(b"\x00\x00\x01\x00\x0a\x90" + encode(UserMessage(1, 0, (4,))))
            assert events.next() == LinkReceived((UserMessage(1, 0, (4,)),))


def test_a_robot_that_does_not_read_is_given_up(listener: socket.socket, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(robot_link, "MAX_WAITING", 1000)
    with linked(port_of(listener)) as (link, events):
        connection, _ = listener.accept()
        with connection:
            assert events.next() == LinkOpened()
            until(lambda: link.send(bytes(60_000)) or not events.queue.empty())
            assert isinstance(events.next(), LinkLost)


def test_nothing_is_read_while_the_receiver_is_full(listener: socket.socket) -> None:
    with linked(port_of(listener)) as (_, events):
        connection, _ = listener.accept()
        with connection:
            assert events.next() == LinkOpened()
            events.is_full = True
            connection.sendall(encode(NodePresent(1, 5)))
            assert events.next() == LinkReceived((NodePresent(1, 5),))
            connection.settimeout(0.5)
            flood = encode(UserMessage(1, 0, (0,) * 200)) * 1000
            assert not accepts(connection, flood, times=100)
            assert events.queue.empty()
            events.is_full = False
            assert isinstance(events.next(), LinkReceived)


def test_damaged_streams_do_no_harm(listener: socket.socket, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(robot_link, "FIRST_PAUSE_S", 0.0)
    random = Random(24)
    good = b"".join(map(encode, (NodePresent(1, 5), UserMessage(1, 2, (3,) * 40), ListNodes(1, 9))))
    robot = RemoteRobot()
    with linked(port_of(listener)) as (_, events):
        for _ in range(300):
            connection, _ = listener.accept()
            with connection, contextlib.suppress(OSError):
                data = bytearray(good * 20)
                for _ in range(random.randrange(40)):
                    data[random.randrange(len(data))] = random.randrange(256)
                connection.sendall(data[: random.randrange(len(data))])
            assert events.next() == LinkOpened()
            robot.start(0)
            while isinstance(event := events.next(), LinkReceived):
                for message in event.messages:
                    robot.receive(message)
                robot.pop_messages()
            assert isinstance(event, LinkLost)
            robot.end(event.reason)
        connection, _ = listener.accept()
        with connection:
            assert events.next() == LinkOpened()
            connection.sendall(encode(NodePresent(1, 5)))
            assert events.next() == LinkReceived((NodePresent(1, 5),))


def test_the_last_message_arrives_when_the_link_is_closed(listener: socket.socket) -> None:
    with linked(port_of(listener)) as (link, events):
        connection, _ = listener.accept()
        with connection:
            assert events.next() == LinkOpened()
            link.close(encode(Run(0, 1)))
            assert received(connection, 8) == encode(Run(0, 1))
            assert connection.recv(1) == b""


@posix
def test_a_serial_port_is_a_stream_too() -> None:
    pytest.importorskip("serial", reason="pyserial is not installed")
    robot, port = os.openpty()
    with linked(SerialTarget(os.ttyname(port))) as (link, events):
        assert events.next() == LinkOpened()
        link.send(encode(ListNodes(0, 9)))
        data = b""
        while len(data) < 8:
            data += os.read(robot, 8 - len(data))
        assert data == encode(ListNodes(0, 9))
        frame = encode(UserMessage(1, 0, (10, 13, 17, 19, 3)))  # bytes that a terminal would treat in its own way
        os.write(robot, frame)
        assert events.next() == LinkReceived((UserMessage(1, 0, (10, 13, 17, 19, 3)),))
        os.close(port)
        os.close(robot)  # the cable is pulled
        assert isinstance(events.next(), LinkLost)
        lost = events.next()
        assert isinstance(lost, LinkLost)
        assert "no such file" in lost.reason.lower()


def test_a_missing_thymio_is_an_error_that_names_the_ports(monkeypatch: pytest.MonkeyPatch) -> None:
    list_ports = pytest.importorskip("serial.tools.list_ports", reason="pyserial is not installed")
    monkeypatch.setattr(list_ports, "comports", list)
    with linked(SerialTarget()) as (_, events):
        expected = "no Thymio found, but no serial ports; name the port, as in ser:/dev/ttyACM0"
        assert events.next() == LinkLost(expected)
