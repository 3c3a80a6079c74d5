"""The device manager is found by mDNS on the loopback interface."""

from __future__ import annotations

import socket

import pytest

zeroconf = pytest.importorskip("zeroconf", reason="needs zeroconf (pip install zeroconf)")

from tests.patience import until
from thymio_sim_ros.network.servers import NetworkServers
from thymio_sim_ros.network.settings import OFF, NetworkSettings

pytestmark = pytest.mark.process

KIND = "_mobsya._tcp.local."


def test_a_program_of_this_computer_finds_the_device_manager() -> None:
    warnings: list[str] = []
    settings = NetworkSettings(tdm_port=0, tdm_ws_port=0)
    thread = NetworkServers(settings, warn=warnings.append, info=warnings.append)
    name = f"Thymio Device Manager on {socket.gethostname()}".replace(".", "-").encode()[:63].decode(errors="ignore")
    try:
        with zeroconf.Zeroconf(interfaces=["127.0.0.1"]) as listener:
            found = until(lambda: warnings or listener.get_service_info(KIND, f"{name}.{KIND}", timeout=1000))
        if warnings:
            pytest.skip(warnings[0])
        tcp_port, ws_port = thread.tdm_ports
        assert OFF not in (tcp_port, ws_port)
        assert (found.port, found.parsed_addresses()) == (tcp_port, ["127.0.0.1"])
        assert int(found.properties[b"ws-port"]) == ws_port
        assert len(found.properties[b"uuid"]) == 36
    finally:
        thread.close()
