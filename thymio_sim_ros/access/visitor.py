"""The visitor behind a request: address and URL, as reverse proxies report them, and what it shows to be let in.

A proxy in front of a server hides who asks and under which address: it says so in the headers `X-Forwarded-For`,
`-Proto`, `-Host` and `-Prefix`. Any client can send these headers, therefore they count only from proxies that are
named at the start. Without I/O.
"""

from __future__ import annotations

import ipaddress
import re
import urllib.parse
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

from thymio_sim_ros.access.hosts import HOST
from thymio_sim_ros.errors import ThymioSimError

if TYPE_CHECKING:
    from aiohttp.web import BaseRequest

__all__ = ["FORWARDED", "NO_PROXIES", "ProxyError", "TrustedProxies", "Visitor"]

FORWARDED = "x-forwarded-"
"""Beginning of the headers' names in lower case."""

_PREFIX = re.compile(r"(?:/(?!\.{1,2}(?:/|$))[A-Za-z0-9._~-]{1,100}){1,20}/?")
_SCHEMES = ("http", "https")
_OF_PROXIES = ("Forwarded", "Via", "X-Forwarded-For", "X-Forwarded-Host", "X-Forwarded-Proto", "X-Real-IP")

Network = ipaddress.IPv4Network | ipaddress.IPv6Network
Address = ipaddress.IPv4Address | ipaddress.IPv6Address


class ProxyError(ThymioSimError, ValueError):
    """A value that names no proxy; the text says what was found and expected."""


@dataclass(frozen=True, slots=True)
class Visitor:
    """Where a request comes from, and the URL under which the visitor sees this server."""

    address: str
    """Numeric address, "" if it is unknown."""
    host: str | None
    """Name and port as in a Host header; None if there was none, "" for one that is invalid."""
    scheme: str = "http"
    prefix: str = ""
    """Path of the server: "" or such as `/lab/thymio`."""
    is_proxied: bool = False
    """Whether a trusted proxy has passed the request on."""
    is_forwarded: bool = False
    """Whether a header says that a proxy has passed the request on, be it a trusted one or not."""
    origin: str | None = None
    """That of the web page which makes the request; None for a program, and for links and pictures."""
    is_from_link: bool = False
    """Whether the browser says that a page of another site has caused the request."""
    page_token: str | None = field(default=None, repr=False)
    """The token that also pages can send which may set no header: in `?token=` of the address or, of a WebSocket, in a
    sub-protocol `token.…`. Proxies log addresses, and no sub-protocols."""
    bearer_token: str | None = field(default=None, repr=False)
    """The token in `Authorization: Bearer`, a header that no foreign page can send."""

    @property
    def url(self) -> str | None:
        """URL of the server with a slash at its end, None without a host."""
        return f"{self.scheme}://{self.host}{self.prefix}/" if self.host else None


class TrustedProxies:
    """The proxies whose headers are believed."""

    def __init__(self, networks: Iterable[str] = ()) -> None:
        """`networks` are addresses and networks, such as `127.0.0.1` and `10.0.0.0/8`. Raises ProxyError."""
        self._networks = tuple(map(_network, networks))

    def __bool__(self) -> bool:
        """Whether there is one."""
        return bool(self._networks)

    def visitor_of(self, request: BaseRequest) -> Visitor:
        """The visitor behind a request to a server of aiohttp."""
        headers = request.headers
        return self.visitor(
            request.remote or "",
            lambda name: headers.getall(name, []),
            scheme=request.scheme,
            target=request.raw_path,
        )

    def visitor(
        self, peer: str, values: Callable[[str], Sequence[str]], *, scheme: str = "http", target: str = ""
    ) -> Visitor:
        """The visitor of a request that has arrived from the address `peer` by `scheme`.

        `values` returns the values of a header by its name, none if it was not sent. `target`: path and query.
        """
        hosts, origins = values("Host"), values("Origin")
        visitor = Visitor(
            peer,
            (_matching(HOST, _last(hosts)) or "") if hosts else None,
            scheme,
            origin=_readable(origins[-1]) if origins else None,
            is_forwarded=any(map(values, _OF_PROXIES)),
            is_from_link=_last(values("Sec-Fetch-Site")).lower() == "cross-site",
            page_token=_page_token(target.partition("?")[2], values("Sec-WebSocket-Protocol")),
            bearer_token=_bearer_token(values("Authorization")),
        )
        if not self._is_trusted(_address(peer)):
            return visitor
        given = _last(values("X-Forwarded-Proto")).lower()
        return replace(
            visitor,
            address=self._origin(peer, ",".join(values("X-Forwarded-For"))),
            host=_matching(HOST, _last(values("X-Forwarded-Host"))) or visitor.host,
            scheme=given if given in _SCHEMES else scheme,
            prefix=(_matching(_PREFIX, _last(values("X-Forwarded-Prefix"))) or "").rstrip("/"),
            is_proxied=True,
        )

    def _origin(self, peer: str, chain: str) -> str:
        """The nearest address that is no trusted proxy: those before it are claims of that client."""
        nearest = peer
        for part in reversed(chain.split(",")):
            address = _address(part.strip())
            if address is None:
                break
            nearest = str(address)
            if not self._is_trusted(address):
                break
        return nearest

    def _is_trusted(self, address: Address | None) -> bool:
        return address is not None and any(address in network for network in self._networks)


def _network(text: str) -> Network:
    try:
        network = ipaddress.ip_network(text)
    except ValueError as error:
        reason = f" ({error})" if "host bits" in str(error) else ""
        raise ProxyError(
            f"'{text}' found{reason}, expected the numeric address or network of a proxy, such as 127.0.0.1 or "
            "10.1.0.0/16"
        ) from error
    if network.prefixlen == 0:
        raise ProxyError(f"'{text}' found, which is every computer; expected the address of the proxy")
    return network


def _address(text: str) -> Address | None:
    """An address, also with a port as some proxies send it; None for anything else."""
    bare = text[1:].partition("]")[0] if text.startswith("[") else text.partition(":")[0] if "." in text else text
    for candidate in (text, bare):
        try:
            address = ipaddress.ip_address(candidate.partition("%")[0])
        except ValueError:
            continue
        return (address.ipv4_mapped or address) if address.version == 6 else address
    return None


def _page_token(query: str, offers: Iterable[str]) -> str | None:
    names = (name.strip() for offer in offers for name in offer.split(","))
    # A sub-protocol has the form of the query with a dot in place of `=`, which none may contain.
    for text in (query, *(name.replace(".", "=", 1) for name in names if name.startswith("token."))):
        found = urllib.parse.parse_qs(text, errors="replace").get("token")
        if found:
            return found[-1]
    return None


def _bearer_token(authorizations: Iterable[str]) -> str | None:
    for value in authorizations:
        scheme, _, token = value.partition(" ")
        if scheme.lower() == "bearer":
            return token.strip()
    return None


def _readable(text: str) -> str:
    """A header's value with U+FFFD for bytes that are not UTF-8; aiohttp has lone surrogates, which no file takes."""
    return text.encode("utf-8", "surrogateescape").decode("utf-8", "replace")


def _last(values: Sequence[str]) -> str:
    """The last item of a header's values, which the nearest proxy has written."""
    return values[-1].rpartition(",")[2].strip() if values else ""


def _matching(pattern: re.Pattern[str], text: str) -> str | None:
    return text if pattern.fullmatch(text) else None


NO_PROXIES = TrustedProxies()
