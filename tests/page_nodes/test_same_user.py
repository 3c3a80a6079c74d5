"""Connections of loopback and their users."""

from __future__ import annotations

import os
import socket
import subprocess
import sys
from collections.abc import Iterator

import pytest

from thymio_sim_ros.page_nodes.same_user import is_same_user

pytestmark = [
    pytest.mark.process,
    pytest.mark.skipif(not sys.platform.startswith("linux"), reason="Linux lists connections with their users"),
]


@pytest.fixture
def listener() -> Iterator[socket.socket]:
    with socket.create_server(("127.0.0.1", 0)) as server:
        yield server


def test_a_connection_of_this_process_is_of_this_user(listener: socket.socket) -> None:
    with socket.create_connection(listener.getsockname()), listener.accept()[0] as accepted:
        assert is_same_user(accepted.getpeername(), accepted.getsockname())


def test_a_connection_that_is_not_listed_is_not(listener: socket.socket) -> None:
    with socket.create_connection(listener.getsockname()), listener.accept()[0] as accepted:
        address, port = accepted.getpeername()
        assert not is_same_user((address, port ^ 1), accepted.getsockname())
        assert not is_same_user(("::1", port), accepted.getsockname())


def test_a_connection_of_another_user_is_not(listener: socket.socket) -> None:
    if os.geteuid() != 0:
        pytest.skip("only root can be another user")
    code = f"import socket; s = socket.create_connection({listener.getsockname()!r}); s.recv(1)"
    other = subprocess.Popen(["/usr/bin/env", "python3", "-c", code], user=65534, group=65534)
    try:
        with listener.accept()[0] as accepted:
            assert not is_same_user(accepted.getpeername(), accepted.getsockname())
    finally:
        other.wait()
