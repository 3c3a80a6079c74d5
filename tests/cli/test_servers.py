"""The servers for other programs: which ones run, and what the banner says."""

from __future__ import annotations

import argparse
import socket

import pytest

from thymio_sim_ros.access.tokens import Tokens
from thymio_sim_ros.cli import servers
from thymio_sim_ros.cli.errors import UsageError
from thymio_sim_ros.network.settings import OFF

pytestmark = pytest.mark.process


def selected(*words, robots=1, headless=False):
    parser = argparse.ArgumentParser()
    servers.add_server_options(parser)
    options = parser.parse_args([*words, "--no-tdm"])
    options.headless, options.address = headless, "localhost"
    options.certificate = ""
    options.no_web, options.port = True, 8080
    return servers.select_servers(options, robots, Tokens())


@pytest.fixture
def taken(monkeypatch):
    """A port that is in use, as the default of the first robot."""
    with socket.create_server(("127.0.0.1", 0)) as server:
        port = server.getsockname()[1]
        monkeypatch.setattr(servers, "ASEBA_PORT", port)
        yield port


@pytest.fixture
def free(monkeypatch):
    with socket.create_server(("127.0.0.1", 0)) as server:
        port = server.getsockname()[1]
    monkeypatch.setattr(servers, "ASEBA_PORT", port)
    return port


def test_the_default_port_is_used_if_it_is_free(free):
    found = selected()
    assert found.settings.aseba_port == free
    assert found.lines == (f"Aseba     localhost port {free} (Studio: tcp:host=localhost;port={free})",)


def test_a_default_port_that_is_taken_is_said_and_all_goes_on(taken):
    found = selected()
    assert found.settings.aseba_port == OFF
    assert f"127.0.0.1:{taken}: address already in use; Thymio Suite or Aseba Playground" in found.lines[0]


def test_each_robot_needs_a_port(taken, monkeypatch):
    monkeypatch.setattr(servers, "ASEBA_PORT", taken - 1)
    assert selected(robots=2).settings.aseba_port == OFF
    assert selected("--aseba-shared", robots=2).settings.aseba_port in (taken - 1, OFF)


def test_a_chosen_port_must_be_free(taken):
    with pytest.raises(UsageError, match=f"Aseba port {taken}: .*choose another with --aseba-port"):
        selected("--aseba-port", str(taken))
    with pytest.raises(UsageError, match="Aseba port 65536: expected at most 65535, for robot 2"):
        selected("--aseba-port", "65535", robots=2)


def test_no_servers(free):
    assert selected("--no-aseba").settings.is_off
    assert selected(headless=True).settings.is_off
    assert selected("--aseba-port", str(free), headless=True).settings.aseba_port == free


def test_another_interface_is_said(free):
    found = selected("--aseba-address", "0.0.0.0", "--no-announcement")
    assert "open to everyone in your network" in found.lines[0]
    assert not found.settings.is_announced
