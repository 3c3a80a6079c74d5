"""Access to all servers, on values: page, bridge, network servers and class ask the same `AccessCheck`. Without I/O.

tokens      tokens and the roles that they give
attempts    a limit on attempts with wrong tokens
hosts       names by which a server may be addressed
origins     web pages that may connect
visitor     who makes a request, behind proxies that are trusted, and with which token
check       the rules of a server, and whether it answers a request
refused     the answer to a request that is not answered
"""

from __future__ import annotations

from thymio_sim_ros.access.check import AccessCheck, AccessRules, HostNames
from thymio_sim_ros.access.refused import RefusedError
from thymio_sim_ros.access.tokens import Role, Tokens
from thymio_sim_ros.access.visitor import NO_PROXIES, TrustedProxies, Visitor

__all__ = [
    "NO_PROXIES",
    "AccessCheck",
    "AccessRules",
    "HostNames",
    "RefusedError",
    "Role",
    "Tokens",
    "TrustedProxies",
    "Visitor",
]
