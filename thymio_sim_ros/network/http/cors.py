"""Headers by which browsers give answers to pages of other origins (CORS)."""

from __future__ import annotations

from collections.abc import Mapping

from thymio_sim_ros.access import AccessCheck, Visitor

__all__ = ["cors_headers"]

_ALLOWED_METHODS = "GET, POST, PUT, OPTIONS"


def cors_headers(asked: Mapping[str, str], visitor: Visitor, access: AccessCheck) -> dict[str, str]:
    """The headers of an answer, by those of the request: the page gets the answer if `access` allows it."""
    found = {"Vary": "Origin"}
    if visitor.origin is None or not access.is_allowed_page(visitor):
        return found
    found["Access-Control-Allow-Origin"] = visitor.origin
    if "Access-Control-Request-Method" in asked:
        found["Access-Control-Allow-Methods"] = _ALLOWED_METHODS
        found["Access-Control-Allow-Headers"] = "Authorization, Content-Type"
        found["Access-Control-Max-Age"] = "600"
    if "Access-Control-Request-Private-Network" in asked:
        found["Access-Control-Allow-Private-Network"] = "true"
    return found
