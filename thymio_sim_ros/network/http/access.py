"""The requests that the HTTP interface answers: a web page from elsewhere must not drive a robot. Without I/O.

Any page in a browser can make requests to this computer, also by images and links, for which browsers send no Origin.
Therefore a request is rejected

- if it addresses the server by a name that a foreign page may own (DNS rebinding),
- if the browser says that a foreign page makes it, unless the user has allowed that page.

Where the server has a token, a request needs that token instead.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from thymio_sim_ros.bridge.access import TokenCheck, Tokens, TooManyAttemptsError, given_token, is_loopback
from thymio_sim_ros.bridge.origin_policy import is_local, is_numeric
from thymio_sim_ros.bridge.protocol.constants import Role
from thymio_sim_ros.network.http.requests import RequestError
from thymio_sim_ros.web.hosts import host_name, is_loopback_name

__all__ = ["AccessPolicy", "check_origin", "check_token", "cors_headers"]

_ALLOWED_METHODS = "GET, POST, PUT, OPTIONS"


@dataclass(frozen=True, slots=True)
class AccessPolicy:
    """The clients that may make requests to a server that listens on `address`.

    Without `tokens`: programs, local pages, and pages of `allowed_origins`. With them: all that give one.
    """

    address: str = "localhost"
    tokens: Tokens = field(default=Tokens())
    allowed_origins: tuple[str, ...] = ()


def check_origin(headers: Mapping[str, str], policy: AccessPolicy) -> None:
    """Raise RequestError for a request that a foreign web page makes."""
    host = headers.get("Host")
    if policy.tokens.is_required:
        return
    if host is not None and not _is_own_name(host_name(host), policy):
        raise RequestError(403, "this address is not one of this server's; use localhost, or a numeric address")
    origin = headers.get("Origin")
    if origin is None and headers.get("Sec-Fetch-Site", "").lower() == "cross-site":
        raise RequestError(403, "links and images of other pages are not answered; open the address itself")
    if origin is not None and not _is_allowed(origin, host, policy):
        raise RequestError(403, f"pages from {origin[:100]!r} may not make requests; see allowed_origins")


async def check_token(
    target: str, authorizations: Sequence[str], address: str, headers: Mapping[str, str], check: TokenCheck
) -> Role:
    """The role of a client. Raises RequestError without the token, or after too many wrong ones."""
    token = given_token(target, authorizations)
    try:
        role = await check.role(token, address, origin=headers.get("Origin"), host=headers.get("Host"))
    except TooManyAttemptsError as error:
        raise RequestError(429, str(error)) from error
    if role is None:
        raise RequestError(401, "expected the token of this server: ?token=… or the header Authorization: Bearer …")
    return role


def cors_headers(headers: Mapping[str, str], policy: AccessPolicy) -> dict[str, str]:
    """Headers by which a browser gives the answer to the page that made the request, if that page is allowed."""
    origin = headers.get("Origin")
    found = {"Vary": "Origin"}
    if origin is None:
        return found
    if not policy.tokens.is_required and not _is_allowed(origin, headers.get("Host"), policy):
        return found
    found["Access-Control-Allow-Origin"] = origin
    if "Access-Control-Request-Method" in headers:
        found["Access-Control-Allow-Methods"] = _ALLOWED_METHODS
        found["Access-Control-Allow-Headers"] = "Authorization, Content-Type"
        found["Access-Control-Max-Age"] = "600"
    if "Access-Control-Request-Private-Network" in headers:
        found["Access-Control-Allow-Private-Network"] = "true"
    return found


def _is_allowed(origin: str, host: str | None, policy: AccessPolicy) -> bool:
    return "*" in policy.allowed_origins or origin in policy.allowed_origins or is_local(origin, host)


def _is_own_name(name: str | None, policy: AccessPolicy) -> bool:
    """Whether no foreign page can have this name."""
    if is_loopback_name(name):
        return True
    if name is None or is_loopback(policy.address):
        return False
    return is_numeric(name) or "." not in name or name.endswith(".local")
