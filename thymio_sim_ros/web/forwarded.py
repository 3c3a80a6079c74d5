"""Requests that trusted proxies have passed on, as their visitors have sent them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from thymio_sim_ros.bridge.visitor import TrustedProxies, Visitor

if TYPE_CHECKING:
    from aiohttp import web

__all__ = ["as_sent", "visitor_of"]


def visitor_of(request: web.BaseRequest, proxies: TrustedProxies) -> Visitor:
    """The visitor behind a request."""
    headers = request.headers
    return proxies.visitor(request.remote or "", lambda name: headers.getall(name, []), scheme=request.scheme)


def as_sent(request: web.BaseRequest, visitor: Visitor) -> web.BaseRequest:
    """The request with address, host and scheme of its visitor: all checks of access are then those of the visitor."""
    if not visitor.is_proxied:
        return request
    headers = request.headers.copy()
    if visitor.host is not None:
        headers["Host"] = visitor.host
    return request.clone(remote=visitor.address, scheme=visitor.scheme, headers=headers)
