"""All nodes in one process: what a start of the suite chooses reaches the node that it is meant for."""

from __future__ import annotations

import json
import urllib.error
import urllib.request

import pytest
from builtin_interfaces.msg import Time
from diagnostic_msgs.msg import DiagnosticArray
from websockets.exceptions import ConnectionClosed, InvalidMessage, InvalidStatus
from websockets.sync.client import connect

from tests.bridge.certificates import make_certificate, trusting
from tests.patience import PATIENCE_S
from tests.processes import free_port
from thymio_sim_ros.access.tokens import TOKEN_VARIABLE
from thymio_sim_ros.bridge import SUBPROTOCOLS, Tokens
from thymio_sim_ros.device.options import DeviceOptions
from thymio_sim_ros.network.settings import HTTP, OFF, TDM, TDM_PATH, NetworkSettings
from thymio_sim_ros.network.tdm.protocol.codec import decode, encode
from thymio_sim_ros.network.tdm.protocol.messages import ConnectionHandshake
from thymio_sim_ros.ros import combined
from thymio_sim_ros.ros.foxglove.node import FoxgloveBridge
from thymio_sim_ros.ros.rclpy_ext.node_runner import StartError
from thymio_sim_ros.suite_config import SuiteConfig


def test_the_choices_of_a_start_reach_their_nodes(ros, tmp_path):
    device = DeviceOptions("playground", "playground", tmp_path / "card", tmp_path / "flash")
    models = {"motor_model": "firmware", "proximity_model": "cone"}
    suite = SuiteConfig(playground="base", program="none", device=device, **models, web=False, foxglove=False)
    (simulator,) = (ros.live(life) for life in combined.suite_nodes(ros.context, suite))
    (runtime,) = simulator.attached
    assert simulator.params.values.motor_model == "firmware"
    assert simulator.params.values.proximity_model == "cone"
    assert runtime.values.params.options == device
    (robot,) = runtime.robots
    assert robot.device.layout == "playground"
    assert robot.device.variables.get("sd.present") == (1,)


def test_the_diagnostics_of_programs_have_the_time_of_the_world(ros):
    suite = SuiteConfig(playground="base", program="welcome", web=False, foxglove=False)
    (simulator,) = (ros.live(life) for life in combined.suite_nodes(ros.context, suite))
    simulator.runner.advance(150)
    received = ros.collect(DiagnosticArray, "/diagnostics")
    ros.until(lambda: received)
    assert received[0].status[0].name == "aseba: robot"
    assert received[0].header.stamp == Time(sec=1, nanosec=500_000_000)


@pytest.mark.parametrize(("words", "shown"), [([], True), (["--headless"], False)])
def test_the_executable_can_leave_out_bridge_and_page(monkeypatch, words, shown):
    started = []
    monkeypatch.setattr(combined, "_run", lambda suite, args, wrap: started.append((suite, args)))
    combined.main([*words, "--ros-args", "-p", "seed:=3"])
    ((suite, args),) = started
    assert (suite.foxglove, suite.web) == (shown, shown)
    assert args == ["--ros-args", "-p", "seed:=3"]


def test_a_page_opened_from_elsewhere_reaches_the_bridge_if_its_origin_is_allowed(ros):
    here, elsewhere = "127.0.0.1", "127.0.0.2"
    for address, hosts in (("localhost", [here]), ("0.0.0.0", [here, elsewhere])):
        ports = {"port": 0, "foxglove_port": free_port()}
        suite = SuiteConfig(playground="base", program="none", address=address, tokens=Tokens(), **ports)
        _, bridge, page = (ros.live(life) for life in combined.suite_nodes(ros.context, suite))
        for host in (here, elsewhere):
            opening = {"subprotocols": SUBPROTOCOLS, "origin": f"http://{host}:{page.port}"}
            if host in hosts:
                urllib.request.urlopen(f"http://{host}:{page.port}/config.json", timeout=PATIENCE_S).close()
                with connect(f"ws://{host}:{bridge.port}", **opening) as connection:
                    assert connection.subprotocol == SUBPROTOCOLS[0]
                continue
            with pytest.raises(OSError, match="refused"):
                urllib.request.urlopen(f"http://{host}:{page.port}/config.json", timeout=PATIENCE_S)
            with pytest.raises(ConnectionRefusedError), connect(f"ws://{host}:{bridge.port}", **opening):
                pass


@pytest.mark.parametrize("has_port", [True, False])
def test_the_bridge_is_on_the_port_of_the_page_and_on_its_own_if_it_has_one(ros, has_port):
    suite = SuiteConfig(playground="base", program="none", port=0, foxglove_port=free_port() if has_port else OFF)
    _, bridge, page = (ros.live(life) for life in combined.suite_nodes(ros.context, suite))
    with urllib.request.urlopen(f"http://localhost:{page.port}/config.json", timeout=PATIENCE_S) as config:
        assert "foxglove_port" not in json.load(config)
    for port in (page.port, bridge.port) if has_port else (page.port,):
        with connect(f"ws://localhost:{port}", subprotocols=SUBPROTOCOLS) as connection:
            assert connection.subprotocol == SUBPROTOCOLS[0]
        with connect(f"ws://localhost:{port}") as connection:
            assert connection.subprotocol is None
    with pytest.raises(InvalidStatus, match="404"), connect(f"ws://localhost:{page.port}/elsewhere"):
        pass
    assert bridge.port == suite.foxglove_port


def test_other_servers_are_on_the_port_of_the_page(ros):
    network = NetworkSettings(on_page=(TDM, HTTP), is_announced=False)
    suite = SuiteConfig(playground="base", program="none", port=0, foxglove_port=OFF, network=network)
    _, _, page = (ros.live(life) for life in combined.suite_nodes(ros.context, suite))
    with connect(f"ws://localhost:{page.port}{TDM_PATH}") as manager:
        manager.send(encode(ConnectionHandshake()))
        assert isinstance(decode(manager.recv(PATIENCE_S)), ConnectionHandshake)
    with urllib.request.urlopen(f"http://localhost:{page.port}/nodes", timeout=PATIENCE_S) as nodes:
        assert isinstance(json.load(nodes), list)
    with urllib.request.urlopen(f"http://localhost:{page.port}/config.json", timeout=PATIENCE_S) as config:
        assert "version" in json.load(config)


def test_page_and_bridge_speak_tls_with_a_certificate(ros, tmp_path):
    cert, key = make_certificate(tmp_path)
    suite = SuiteConfig(
        playground="base", program="none", port=0, foxglove_port=free_port(), certificate=str(cert), key=str(key)
    )
    _, bridge, page = (ros.live(life) for life in combined.suite_nodes(ros.context, suite))
    assert f"https://localhost:{page.port}/" in page.startup_message
    assert f"wss://localhost:{bridge.port}" in bridge.startup_message
    config = urllib.request.urlopen(
        f"https://localhost:{page.port}/config.json", timeout=PATIENCE_S, context=trusting(cert)
    )
    with config:
        assert "version" in json.load(config)
    for port in (page.port, bridge.port):
        with connect(f"wss://localhost:{port}", subprotocols=SUBPROTOCOLS, ssl=trusting(cert)) as connection:
            assert connection.subprotocol == SUBPROTOCOLS[0]
        with pytest.raises(InvalidMessage), connect(f"ws://localhost:{port}"):
            pass


@pytest.mark.parametrize("password", ["", "wrongtoken", "fulltoken"])
def test_clients_on_the_port_of_the_page_need_the_token_also_on_this_computer(ros, password):
    network = NetworkSettings(on_page=(TDM, HTTP), is_announced=False)
    suite = SuiteConfig(
        playground="base", program="none", port=0, foxglove_port=OFF, network=network, tokens=Tokens("fulltoken", "")
    )
    _, _, page = (ros.live(life) for life in combined.suite_nodes(ros.context, suite))
    with connect(f"ws://localhost:{page.port}{TDM_PATH}") as manager:
        manager.send(encode(ConnectionHandshake(password=password)))
        if password == "fulltoken":
            assert isinstance(decode(manager.recv(PATIENCE_S)), ConnectionHandshake)
        else:
            with pytest.raises(ConnectionClosed):
                manager.recv(PATIENCE_S)
    url = f"http://localhost:{page.port}/nodes?token={password}"
    if password == "fulltoken":
        urllib.request.urlopen(url, timeout=PATIENCE_S).close()
    else:
        with pytest.raises(urllib.error.HTTPError, match="401"):
            urllib.request.urlopen(url, timeout=PATIENCE_S)


@pytest.mark.parametrize(("header", "origin"), [({}, "https://evil.example"), ({"Host": "evil.example"}, None)])
def test_foreign_pages_reach_no_server_on_the_port_of_the_page(ros, header, origin):
    network = NetworkSettings(on_page=(TDM, HTTP), is_announced=False)
    suite = SuiteConfig(playground="base", program="none", port=0, foxglove_port=OFF, network=network)
    _, _, page = (ros.live(life) for life in combined.suite_nodes(ros.context, suite))
    headers = header if origin is None else {"Origin": origin}
    for path in ("/", TDM_PATH) if origin else ():
        with pytest.raises(InvalidStatus, match="403"), connect(f"ws://localhost:{page.port}{path}", origin=origin):
            pass
    request = urllib.request.Request(f"http://localhost:{page.port}/nodes", headers=headers)
    with pytest.raises(urllib.error.HTTPError, match="403"):
        urllib.request.urlopen(request, timeout=PATIENCE_S)


def test_a_bridge_without_a_port_needs_a_page(ros):
    with pytest.raises(StartError, match="expected a port, because no page"):
        FoxgloveBridge(context=ros.context, port=OFF)


def test_in_the_network_the_bridge_creates_tokens_that_the_page_gets(ros, monkeypatch):
    monkeypatch.delenv(TOKEN_VARIABLE, raising=False)
    suite = SuiteConfig(playground="base", program="none", address="0.0.0.0", port=0, foxglove_port=free_port())
    _, bridge, page = (ros.live(life) for life in combined.suite_nodes(ros.context, suite))
    assert bridge.tokens.is_required
    assert page.tokens == bridge.tokens
    assert f"/#token={bridge.tokens.full}" in page.access_urls
    for host in ("127.0.0.1", "127.0.0.2"):
        with pytest.raises(InvalidStatus), connect(f"ws://{host}:{bridge.port}", subprotocols=SUBPROTOCOLS):
            pass
        with connect(f"ws://{host}:{bridge.port}/?token={bridge.tokens.full}", subprotocols=SUBPROTOCOLS) as connection:
            assert connection.subprotocol == SUBPROTOCOLS[0]
