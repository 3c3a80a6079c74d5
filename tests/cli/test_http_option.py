"""Options of the HTTP interface, and its line in the banner."""

from __future__ import annotations

import argparse
import socket

import pytest

from thymio_sim_ros.access.tokens import Tokens
from thymio_sim_ros.cli.errors import UsageError
from thymio_sim_ros.cli.servers import add_server_options, select_servers
from thymio_sim_ros.network.settings import HTTP, OFF
from thymio_sim_ros.ros.aseba.parameters import NetworkParams

pytestmark = pytest.mark.process

NO_TOKENS = Tokens()
TOKENS = Tokens("full-token", "watch-token")


def servers(*words, address="localhost", tokens=NO_TOKENS, no_web=True):
    parser = argparse.ArgumentParser()
    add_server_options(parser)
    options = parser.parse_args(["--no-aseba", "--no-tdm", *words])
    options.address, options.headless = address, False
    options.certificate = ""
    options.no_web, options.port = no_web, 8080
    return select_servers(options, 1, tokens)


@pytest.fixture
def port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def test_the_http_interface_is_off_by_default():
    found = servers()
    assert found.settings.http_port == OFF
    assert found.settings.is_off
    assert found.lines == ()


def test_the_banner_has_its_address(port):
    found = servers(f"--http-port={port}")
    assert found.settings.http_port == port
    assert not found.settings.is_off
    assert found.lines == (f"HTTP      http://localhost:{port}/nodes",)


def test_the_address_has_the_token_in_its_query_where_one_is_needed(port):
    [line] = servers(f"--http-port={port}", address="127.0.0.1", tokens=TOKENS).lines
    assert line == f"HTTP      http://localhost:{port}/nodes?token=full-token"


def test_a_port_that_is_taken_is_an_error():
    with socket.create_server(("127.0.0.1", 0)) as taken, pytest.raises(UsageError, match="choose another with --http"):
        servers(f"--http-port={taken.getsockname()[1]}")


def test_origins_are_checked_and_reach_the_runtime(port, capsys):
    found = servers(f"--http-port={port}", "--allow-origin=https://vpl.example", "--allow-origin", "*")
    assert found.settings.allowed_origins == ("https://vpl.example", "*")
    assert NetworkParams.of(found.settings).settings == found.settings
    for wrong in ("vpl.example", "https://vpl.example/page", "https://"):
        with pytest.raises(SystemExit):
            servers("--allow-origin", wrong)
        assert "expected an origin such as https://example.org:8080, or *" in capsys.readouterr().err


def test_it_may_be_on_the_port_of_the_page_only():
    found = servers("--http", no_web=False)
    assert (found.settings.http_port, found.settings.on_page, found.settings.is_off) == (OFF, (HTTP,), False)
    assert found.lines == ("HTTP      http://localhost:8080/nodes",)


def test_a_port_of_its_own_is_beside_that_of_the_page(port):
    assert servers(f"--http-port={port}", no_web=False).settings.on_page == (HTTP,)


def test_without_a_page_it_needs_a_port():
    with pytest.raises(UsageError, match="choose a port with --http-port"):
        servers("--http")
