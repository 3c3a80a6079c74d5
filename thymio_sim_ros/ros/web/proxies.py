"""The parameter `trusted_proxies` of bridge and page."""

from __future__ import annotations

from collections.abc import Iterable

from thymio_sim_ros.access.visitor import ProxyError, TrustedProxies
from thymio_sim_ros.ros.rclpy_ext.node_runner import StartError

__all__ = ["trusted_proxies"]


def trusted_proxies(values: Iterable[str]) -> TrustedProxies:
    """The proxies of a parameter, in which empty texts count as none. Raises StartError for a text that names none."""
    try:
        return TrustedProxies(filter(None, values))
    except ProxyError as error:
        raise StartError(f"parameter trusted_proxies: {error}") from error
