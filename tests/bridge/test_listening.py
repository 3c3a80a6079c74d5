"""Listening sockets."""

from __future__ import annotations

import errno
import socket
import threading
from pathlib import Path
from typing import Any

import pytest

from thymio_sim_ros.bridge.listening import listen

pytestmark = pytest.mark.process

HAS_IPV6 = socket.has_ipv6 and Path("/proc/net/if_inet6").exists()


@pytest.mark.skipif(not HAS_IPV6, reason="no IPv6 here")
def test_localhost_is_both_loopbacks_on_one_port() -> None:
    listeners = listen("localhost", 0)
    port = listeners[0].getsockname()[1]
    assert [listener.getsockname()[:2] for listener in listeners] == [("127.0.0.1", port), ("::1", port)]
    for listener in listeners:
        listener.close()


@pytest.mark.skipif(not HAS_IPV6, reason="no IPv6 here")
def test_a_port_taken_on_one_loopback_is_rejected_and_the_other_given_back() -> None:
    with socket.create_server(("::1", 0), family=socket.AF_INET6) as taken:
        port = taken.getsockname()[1]
        with pytest.raises(OSError, match=rf"cannot listen on \[::1\]:{port}: address already in use"):
            listen("localhost", port)
    for listener in listen("localhost", port):
        listener.close()


def test_without_ipv6_the_other_loopback_is_enough(monkeypatch: pytest.MonkeyPatch) -> None:
    class Socket(socket.socket):
        def bind(self, address: Any) -> None:
            if self.family == socket.AF_INET6:
                raise OSError(errno.EADDRNOTAVAIL, "cannot assign")
            super().bind(address)

    monkeypatch.setattr(socket, "socket", Socket)
    (listener,) = listen("localhost", 0)
    listener.close()


def test_an_address_of_another_machine_is_rejected_by_name() -> None:
    with pytest.raises(OSError, match=r"cannot listen on 192\.0\.2\.1:8765"):
        listen("192.0.2.1", 8765)


def test_answers_are_not_held_back_by_nagles_algorithm() -> None:
    (listener,) = listen("127.0.0.1", 0)
    with listener:
        assert listener.proto == socket.IPPROTO_TCP  # what asyncio asks for before it sets TCP_NODELAY


def test_connections_of_a_listening_socket_notice_that_their_peer_has_vanished() -> None:
    for listener in listen("localhost", 0):
        with listener, socket.create_connection(listener.getsockname()[:2]):
            connection, _ = listener.accept()
            with connection:
                assert connection.getsockopt(socket.SOL_SOCKET, socket.SO_KEEPALIVE) == 1
                idle_s, period_s, probes = (
                    connection.getsockopt(socket.IPPROTO_TCP, option)
                    for option in (socket.TCP_KEEPIDLE, socket.TCP_KEEPINTVL, socket.TCP_KEEPCNT)
                )
                assert idle_s + period_s * probes <= 60
                assert 0 < connection.getsockopt(socket.IPPROTO_TCP, socket.TCP_USER_TIMEOUT) <= 60_000


def test_the_system_keeps_little_of_a_connection_that_is_not_read() -> None:
    (listener,) = listen("127.0.0.1", 0)
    with listener, socket.create_connection(listener.getsockname()) as client:
        served, _ = listener.accept()
        sending = threading.Thread(target=client.sendall, args=(bytes(400_000_000),))
        sending.start()
        with served:
            waiting = 400_000_000  # read fast, which makes the system give more room unless it is limited
            while waiting > 0:
                waiting -= len(served.recv(256 * 1024))
            sending.join()
            assert served.getsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF) <= 128 * 1024
