"""Parameters of the bridge itself: their effects, and rejected values."""

from __future__ import annotations

import pytest
import rclpy
from rclpy.context import Context
from rclpy.impl.rcutils_logger import RcutilsLogger
from rclpy.qos import DurabilityPolicy, QoSProfile
from std_msgs.msg import Bool, UInt32
from websockets.exceptions import ConnectionClosed

from tests.bridge.certificates import make_certificate, trusting
from tests.bridge.studio import Studio
from thymio_sim_ros.access.tokens import READ_ONLY_VARIABLE, TOKEN_VARIABLE
from thymio_sim_ros.bridge import Capability, Tokens
from thymio_sim_ros.bridge.protocol import messages as ms
from thymio_sim_ros.ros.foxglove.graph import allow_list
from thymio_sim_ros.ros.foxglove.node import FoxgloveBridge
from thymio_sim_ros.ros.foxglove.options import FoxgloveParams, server_capabilities
from thymio_sim_ros.ros.rclpy_ext.node_runner import StartError


@pytest.fixture
def certificate(tmp_path):
    """A self-signed certificate for localhost and its key."""
    cert, key = make_certificate(tmp_path)
    return str(cert), str(key)


def test_a_client_connects_with_tls(ros, bridge, certificate):
    cert, key = certificate
    life = bridge(tls=True, certfile=cert, keyfile=key)
    assert f"wss://localhost:{life.port}" in life.startup_message
    ros.node.create_publisher(Bool, "/flag", 1)
    with Studio(life.port, ros.until, tls=trusting(cert)) as studio:
        assert studio.channel("/flag").schema_name == "std_msgs/msg/Bool"


@pytest.mark.parametrize(
    ("parameters", "text"),
    [
        ({"tls": True}, "parameter tls: no certificate given; set certfile and keyfile"),
        ({"tls": True, "certfile": "/no/such.pem"}, "/no/such.pem: No such file"),
        (
            {"topic_whitelist": ("/a", "*")},
            r"parameter topic_whitelist: '\*' is not a regular expression: nothing to rep",
        ),
        ({"asset_uri_allowlist": ("(",)}, r"parameter asset_uri_allowlist: '\(' is not a regular expression"),
        ({"capabilities": ("fly",)}, "parameter capabilities: found 'fly', expected some of clientPublish, "),
    ],
)
def test_an_invalid_parameter_is_rejected_by_name(ros, parameters, text):
    with pytest.raises(StartError, match=text):
        FoxgloveBridge(context=ros.context, defaults=FoxgloveParams(port=0, **parameters))
    assert "foxglove_bridge" not in ros.node.get_node_names()


def test_an_invalid_certificate_is_rejected(ros, tmp_path):
    (tmp_path / "cert.pem").write_text("no certificate")
    values = FoxgloveParams(port=0, tls=True, certfile=str(tmp_path / "cert.pem"))
    with pytest.raises(StartError, match=r"parameters certfile and keyfile: .*cert\.pem: expected a certificate"):
        FoxgloveBridge(context=ros.context, defaults=values)


def test_time_is_announced_exactly_with_simulated_time():
    everything = tuple(Capability)
    assert server_capabilities(FoxgloveParams(), uses_sim_time=True) == everything
    assert set(everything) - set(server_capabilities(FoxgloveParams(), uses_sim_time=False)) == {Capability.TIME}
    only = FoxgloveParams(capabilities=("services", "time"))
    assert server_capabilities(only, uses_sim_time=False) == (Capability.SERVICES,)


def test_a_request_without_its_capability_is_rejected(ros, bridge):
    with Studio(bridge(capabilities=("services",)).port, ros.until) as studio:
        assert studio.next(ms.ServerInfo).capabilities == (Capability.SERVICES,)
        studio.advertise(1, "/cmd_vel", "geometry_msgs/msg/Twist")
        assert studio.next(ms.Status).message == "this server does not offer clientPublish"


def test_a_frame_longer_than_the_user_allows_is_refused(ros, bridge):
    port = bridge(max_message_size=1024).port
    with Studio(port, ros.until) as studio:
        studio.send(ms.GetParameters(("x" * 1024,), "long"))
        assert "expected at most 1024 bytes" in studio.next(ms.Status).message
        studio.send(ms.GetParameters(("x" * 4096,), "longer"))
        with pytest.raises(ConnectionClosed, match="1009"):
            studio.next(ms.ParameterValues)
    with Studio(port, ros.until) as studio:
        assert studio.next(ms.ServerInfo).name == "thymio_sim_ros"


def test_the_number_of_clients_is_published_on_demand(ros, bridge):
    counts = []
    profile = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    ros.node.create_subscription(UInt32, "/foxglove_bridge/client_count", lambda m: counts.append(m.data), profile)
    port = bridge(publish_client_count=True).port
    ros.until(lambda: counts == [0])
    with Studio(port, ros.until):
        ros.until(lambda: counts[-1] == 1)
    ros.until(lambda: counts[-1] == 0)


def test_fetches_follow_the_allow_list(ros, bridge):
    with Studio(bridge(asset_uri_allowlist=(r"package://only/.*",)).port, ros.until) as studio:
        studio.send(ms.FetchAsset("package://std_msgs/a.stl", 3))
        assert "asset_uri_allowlist does not allow it" in studio.next(ms.AssetResponse).error


def test_unknown_parameters_are_logged(monkeypatch):
    warnings = []
    monkeypatch.setattr(RcutilsLogger, "warning", lambda self, text, **_: warnings.append(text))
    context = Context()
    context.init(args=["--ros-args", "-p", "num_threads:=2", "-p", "use_sim_time:=false", "-p", "port:=0"])
    FoxgloveBridge(context=context).close()
    context.shutdown()
    assert warnings == [
        "parameter num_threads is not a parameter of foxglove_bridge and has no effect; see docs/foxglove.md"
    ]


def test_in_the_network_the_bridge_creates_tokens(ros, bridge, monkeypatch):
    monkeypatch.delenv(TOKEN_VARIABLE, raising=False)
    life = bridge(address="0.0.0.0")
    assert life.tokens.is_required
    assert f"?token={life.tokens.full}" in life.access_urls
    assert f"?token={life.tokens.read_only}" in life.access_urls
    for secret in (life.tokens.full, life.tokens.read_only):
        assert secret not in life.startup_message


def test_no_token_is_needed_if_the_user_disables_them(bridge, monkeypatch):
    monkeypatch.setenv(TOKEN_VARIABLE, "fromenv")
    life = bridge(address="0.0.0.0", require_token=False)
    assert not life.tokens.is_required
    assert life.access_urls == ""
    assert "without a token" in life.startup_message


def test_tokens_come_from_the_environment(bridge, monkeypatch):
    monkeypatch.setenv(TOKEN_VARIABLE, "fromenv")
    monkeypatch.setenv(READ_ONLY_VARIABLE, "lookenv")
    assert bridge().tokens == Tokens("fromenv", "lookenv")


@pytest.mark.parametrize(("full", "read_only"), [("a b", ""), ("abc", ""), ("same", "same")])
def test_invalid_tokens_are_rejected(ros, monkeypatch, full, read_only):
    monkeypatch.setenv(TOKEN_VARIABLE, full)
    monkeypatch.setenv(READ_ONLY_VARIABLE, read_only)
    with pytest.raises(StartError, match="token"):
        FoxgloveBridge(context=ros.context, defaults=FoxgloveParams(port=0))


def test_a_token_given_as_a_parameter_cannot_be_read(ros, monkeypatch):
    monkeypatch.delenv(TOKEN_VARIABLE, raising=False)
    warned = []
    monkeypatch.setattr(RcutilsLogger, "warning", lambda self, text, **options: warned.append(text))
    context = Context()
    rclpy.init(args=["--ros-args", "-p", "token:=secret1234"], context=context, domain_id=ros.domain)
    life = FoxgloveBridge(context=context, defaults=FoxgloveParams(port=0))
    try:
        assert life.tokens.full == "secret1234"
        assert not life.node.has_parameter("token")
        assert not any("secret1234" in str(item.value) for item in life.node.get_parameters_by_prefix("").values())
        assert warned == []
    finally:
        life.close()
        context.try_shutdown()


def test_read_only_services_are_those_of_this_project_that_only_read():
    is_read_only_service = allow_list(FoxgloveParams().read_only_services)
    reading = ("/aseba/get_variables", "/a/aseba/list_variables", "/aseba_runtime/check", "/simulator/get_primitives")
    changing = ("/aseba/set_variables", "/aseba/stop", "/simulator/reset", "/simulator/set_poses", "/x/get_coffee")
    assert all(map(is_read_only_service, reading))
    assert not any(map(is_read_only_service, changing))
