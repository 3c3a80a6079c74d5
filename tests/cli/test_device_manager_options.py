"""Which servers for other programs run, and what the banner says."""

from __future__ import annotations

import argparse
import socket
from collections.abc import Sequence

import pytest

from tests.processes import free_port
from thymio_sim_ros.access.tokens import Tokens
from thymio_sim_ros.cli.errors import UsageError
from thymio_sim_ros.cli.servers import Servers, add_server_options, select_servers
from thymio_sim_ros.network.settings import OFF, TDM

pytestmark = pytest.mark.process


def _select(
    arguments: Sequence[str],
    *,
    address: str = "localhost",
    headless: bool = False,
    no_web: bool = True,
    token: str = "",
) -> Servers:
    parser = argparse.ArgumentParser()
    add_server_options(parser)
    options = parser.parse_args([*arguments, "--no-aseba"])
    options.address, options.headless = address, headless
    options.certificate = ""
    options.no_web, options.port = no_web, 8080
    return select_servers(options, 1, Tokens(token))


def test_the_banner_names_both_ports_of_the_device_manager() -> None:
    tcp, websocket = free_port(), free_port()
    found = _select(["--tdm-port", str(tcp), "--tdm-ws-port", str(websocket)])
    assert (found.settings.tdm_port, found.settings.tdm_ws_port) == (tcp, websocket)
    assert found.lines == (f"TDM       localhost port {tcp}, WebSocket {websocket} (tdmclient, Scratch, VPL 3)",)


def test_clients_of_the_network_are_told_the_password() -> None:
    tcp, websocket = free_port(), free_port()
    chosen = ["--tdm-port", str(tcp), "--tdm-ws-port", str(websocket)]
    (line,) = _select(chosen, address="0.0.0.0", token="secret").lines
    assert line.endswith("(tdmclient, Scratch, VPL 3), password secret")
    (line,) = _select(chosen, token="secret").lines
    assert "secret" not in line


@pytest.mark.parametrize("option", ["--tdm-port", "--tdm-ws-port"])
def test_a_chosen_port_that_is_taken_ends_the_command(option: str) -> None:
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
        other = {"--tdm-port": "--tdm-ws-port", "--tdm-ws-port": "--tdm-port"}[option]
        with pytest.raises(UsageError, match=f"{port}: address already in use; choose another with {option}"):
            _select([option, str(port), other, str(free_port())])


def test_a_usual_port_that_is_taken_turns_the_device_manager_off(monkeypatch: pytest.MonkeyPatch) -> None:
    with socket.create_server(("127.0.0.1", 0)) as taken:
        monkeypatch.setattr("thymio_sim_ros.cli.servers.TDM_PORT", taken.getsockname()[1])
        found = _select([])
        assert found.settings.tdm_port == OFF
        (line,) = found.lines
        assert line.startswith("TDM       none: cannot listen on 127.0.0.1:")
        assert line.endswith("address already in use; Thymio Suite may be running; another port: --tdm-port")


def test_it_is_off_on_request_and_without_the_page() -> None:
    for found in (_select(["--no-tdm"]), _select([], headless=True)):
        assert found.settings.tdm_port == OFF
        assert found.lines == ()
    tcp, websocket = free_port(), free_port()
    assert _select(["--tdm-port", str(tcp), "--tdm-ws-port", str(websocket)], headless=True).settings.tdm_port == tcp


def test_it_is_on_the_port_of_a_page_too() -> None:
    ports = ["--tdm-port", str(free_port()), "--tdm-ws-port", str(free_port())]
    assert _select(ports, no_web=False).settings.on_page == (TDM,)
    assert _select(ports).settings.on_page == ()


def test_it_may_be_on_the_port_of_the_page_only() -> None:
    found = _select(["--no-tdm-ports"], no_web=False)
    assert (found.settings.tdm_port, found.settings.on_page, found.settings.is_off) == (OFF, (TDM,), False)
    assert found.lines == ("TDM       ws://localhost:8080/tdm",)


@pytest.mark.parametrize(("words", "no_web"), [([], True), (["--tdm-port", "1234"], False)])
def test_without_ports_it_needs_a_page(words: list[str], no_web: bool) -> None:
    with pytest.raises(UsageError, match="--no-tdm-ports: expected a page"):
        _select(["--no-tdm-ports", *words], no_web=no_web)


def test_usual_ports_that_are_taken_leave_it_on_the_port_of_the_page(monkeypatch: pytest.MonkeyPatch) -> None:
    with socket.create_server(("127.0.0.1", 0)) as taken:
        monkeypatch.setattr("thymio_sim_ros.cli.servers.TDM_PORT", taken.getsockname()[1])
        found = _select([], no_web=False)
    assert (found.settings.tdm_port, found.settings.on_page) == (OFF, (TDM,))
    assert found.lines[0].startswith("TDM       ws://localhost:8080/tdm only: cannot listen on 127.0.0.1:")
