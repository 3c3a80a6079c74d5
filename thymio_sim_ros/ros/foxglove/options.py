"""Parameters of the Foxglove bridge, and the checks of their values before it starts."""

from __future__ import annotations

import re
from dataclasses import dataclass, fields

from thymio_sim_ros.bridge import Capability
from thymio_sim_ros.network.settings import OFF
from thymio_sim_ros.ros.foxglove.assets import ASSETS
from thymio_sim_ros.ros.rclpy_ext.node_runner import StartError
from thymio_sim_ros.ros.rclpy_ext.parameters import param
from thymio_sim_ros.ros.web.tls import CERTFILE, KEYFILE, TLS

__all__ = ["READ_ONLY_SERVICES", "FoxgloveParams", "check", "server_capabilities"]

READ_ONLY_SERVICES = (
    r"/(.+/)?aseba/(get|list|describe)_variables",
    r"/(.+/)?aseba_runtime/check",
    r"/(.+/)?simulator/get_\w+",
    r"/(.+/)?is_ready",
)
"""Services of this project that change nothing."""


@dataclass(frozen=True)
class FoxgloveParams:
    """Parameters of the bridge; names as in the vendor's bridge if it has the same parameter."""

    port: int = param(
        8765,
        "TCP port; 0 selects a free one, -1 none beside that of a page in the same process",
        low=OFF,
        high=65535,
        fixed=True,
    )
    address: str = param(
        "localhost",
        "Address to listen on: localhost (this computer), 0.0.0.0 (all IPv4 interfaces), :: (also IPv6)",
        fixed=True,
    )
    tls: bool = TLS
    certfile: str = CERTFILE
    keyfile: str = KEYFILE
    allowed_origins: tuple[str, ...] = param(
        ("",),
        "Origins of additional web pages that may connect, as https://host:port; * allows all",
        fixed=True,
    )
    trusted_proxies: tuple[str, ...] = param(
        ("",),
        "Addresses and networks of reverse proxies whose headers X-Forwarded-* are believed, also those of the page",
        fixed=True,
    )
    require_token: bool = param(
        True, "Whether clients need a token if the address is reachable from the network (SECURITY.md)", fixed=True
    )
    read_only_services: tuple[str, ...] = param(
        READ_ONLY_SERVICES, "Regular expressions of services that clients with the read-only token may call", fixed=True
    )
    topic_whitelist: tuple[str, ...] = param((".*",), "Regular expressions of topics to offer", fixed=True)
    service_whitelist: tuple[str, ...] = param((".*",), "Regular expressions of services to offer", fixed=True)
    param_whitelist: tuple[str, ...] = param(
        (".*",), "Regular expressions of parameters (/node.name) to offer", fixed=True
    )
    client_topic_whitelist: tuple[str, ...] = param(
        (".*",), "Regular expressions of topics on which clients may publish", fixed=True
    )
    include_hidden: bool = param(
        False, "Offer hidden services and topics of actions; other hidden topics are always offered", fixed=True
    )
    capabilities: tuple[str, ...] = param(
        tuple(item.value for item in Capability if item is not Capability.TIME),
        "Capabilities to offer: clientPublish, parameters, parametersSubscribe, services, connectionGraph, assets; "
        "time is added with use_sim_time",
        fixed=True,
    )
    asset_uri_allowlist: tuple[str, ...] = param(
        (ASSETS,), "Regular expressions of package:// files that clients may fetch", fixed=True
    )
    best_effort_qos_topic_whitelist: tuple[str, ...] = param(
        ("(?!)",), "Regular expressions of topics that are always subscribed to as best effort", fixed=True
    )
    min_qos_depth: int = param(10, "Smallest history depth of a subscription", low=1, high=1000, fixed=True)
    max_qos_depth: int = param(25, "Largest history depth of a subscription", low=1, high=1000, fixed=True)
    send_buffer_limit: int = param(
        1 << 20,
        "Bytes that may be buffered for a client; above, only the newest message of each topic is sent",
        low=1 << 12,
        high=1 << 30,
        fixed=True,
    )
    publish_client_count: bool = param(
        False, "Publish the number of connected clients on ~/client_count (std_msgs/UInt32)", fixed=True
    )
    max_message_size: int = param(
        4 << 20, "Longest frame accepted from a client, bytes", low=1 << 10, high=1 << 28, fixed=True
    )


def server_capabilities(values: FoxgloveParams, *, uses_sim_time: bool) -> tuple[Capability, ...]:
    """The capabilities for serverInfo. Raises StartError for an unknown name."""
    known = {item.value: item for item in Capability}
    for name in filter(None, values.capabilities):
        if name not in known:
            raise StartError(f"parameter capabilities: found '{name}', expected some of {', '.join(known)}")
    wanted = {known[name] for name in values.capabilities if name}
    wanted.discard(Capability.TIME)
    return tuple(item for item in Capability if item in wanted or (item is Capability.TIME and uses_sim_time))


def check(values: FoxgloveParams) -> None:
    """Raise StartError for an invalid regular expression."""
    for item in fields(values):
        if item.name.endswith(("_whitelist", "_allowlist", "_services")):
            for pattern in getattr(values, item.name):
                try:
                    re.compile(pattern)
                except re.error as error:
                    raise StartError(
                        f"parameter {item.name}: '{pattern}' is not a regular expression: {error}"
                    ) from error
