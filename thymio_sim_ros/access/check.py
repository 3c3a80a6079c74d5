"""Whether a server answers a request, by one set of rules for page, bridge, network servers and class.

Any page in a browser can make requests to this computer, also by images and links, for which browsers send no Origin.
Where the server needs no token, a request is therefore rejected

- if it addresses the server by a name that a foreign page may own (DNS rebinding),
- if the browser says that a foreign page makes it, unless the user has allowed that page.

Where the server has a token, a request needs that token instead.
"""

from __future__ import annotations

import asyncio
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from enum import Enum, auto
from http import HTTPStatus

from thymio_sim_ros.access.attempts import AttemptLimiter, TooManyAttemptsError
from thymio_sim_ros.access.hosts import host_name, is_loopback_name, is_numeric, is_private_name
from thymio_sim_ros.access.origins import is_allowed, is_same_private_name
from thymio_sim_ros.access.refused import RefusedError
from thymio_sim_ros.access.tokens import Role, Tokens, is_random
from thymio_sim_ros.access.visitor import Visitor

__all__ = ["AccessCheck", "AccessRules", "HostNames", "Report"]

Report = Callable[[str, str], object]
"""Called with a kind of problem, so that repetitions can be limited, and its description."""


_NO_TOKEN = "a token is needed: open the whole address in the simulator's terminal, or append ?token=… to yours"
_WRONG_TOKEN = "the token is wrong or from an earlier start: open the address that the simulator's terminal shows now"


class HostNames(Enum):
    """The names by which a server may be addressed."""

    ANY = auto()
    """All: nothing that it answers is a secret, or its clients are WebSockets, for which browsers always send an
    Origin."""
    LOOPBACK = auto()
    """Those of this computer, and `AccessRules.allowed_hosts`."""
    UNOWNED = auto()
    """Those that no foreign page can have, and `AccessRules.allowed_hosts`."""


@dataclass(frozen=True, slots=True)
class AccessRules:
    """The requests that a server answers."""

    tokens: Tokens = field(default=Tokens())
    host_names: HostNames = HostNames.ANY
    allowed_hosts: tuple[str, ...] = ()
    """Additional host names, in lower case."""
    allowed_origins: tuple[str, ...] = ()
    """Additional origins of web pages; `*` allows all."""
    allows_page_token: bool = True
    """Whether a token counts in the address or in a sub-protocol, and not only in the header Authorization."""
    token_hint: str = ""
    """The text sent to a client without a valid token; empty: that tokens are in the simulator's terminal."""


class AccessCheck:
    """Decides which requests one server answers. Only for the thread of its event loop.

    Random tokens cannot be guessed and need no limit, so that wrong ones never lock out the right one. Chosen ones are
    limited by `AttemptLimiter`. Foreign web pages in a browser share an allowance of their own: otherwise any page that
    the owner visits could use up that of the owner's address.
    """

    def __init__(self, rules: AccessRules, report: Report, *, now_s: Callable[[], float] = time.monotonic) -> None:
        """`report` gets one line for each request that is rejected; `now_s` is a monotonic clock, s."""
        self.rules = rules
        self._report = report
        given = filter(None, (rules.tokens.full, rules.tokens.read_only))
        self._is_limited = not all(map(is_random, given))
        self._programs, self._pages = AttemptLimiter(now_s), AttemptLimiter(now_s)

    async def admit(self, visitor: Visitor) -> Role:
        """The role of a client. Raises RefusedError for a request that is not answered."""
        self.check_page(visitor)
        return await self.role(visitor)

    def check_page(self, visitor: Visitor) -> None:
        """Raise RefusedError for a request that a foreign web page makes, unless a token decides."""
        if self.rules.tokens.is_required:
            return
        self.check_host(visitor)
        if visitor.origin is None and visitor.is_from_link:
            self._report("link", "a link or picture of another page is not answered")
            raise RefusedError(
                HTTPStatus.FORBIDDEN, "links and images of other pages are not answered; open the address itself"
            )
        if not self.is_allowed_page(visitor):
            self._report(
                "origin", f"web page from {visitor.origin:.100} rejected: add it to allowed_origins if it is yours"
            )
            raise RefusedError(
                HTTPStatus.FORBIDDEN, f"Pages from {visitor.origin:.100} may not connect; see allowed_origins."
            )

    def check_host(self, visitor: Visitor) -> None:
        """Raise RefusedError for a request that addresses the server by a name that is not its own."""
        if visitor.host is None or self._is_own_name(host_name(visitor.host)):
            return
        self._report(
            "host", "request with another name of this computer rejected; see parameter allowed_hosts of web_ui"
        )
        raise RefusedError(
            HTTPStatus.FORBIDDEN,
            "This address is not one of this server's. Open it by localhost, or by a numeric address.",
        )

    def is_allowed_page(self, visitor: Visitor) -> bool:
        """Whether the page that makes a request may read the answer; with a token, the token decides."""
        return self.rules.tokens.is_required or is_allowed(visitor.origin, visitor.host, self.rules.allowed_origins)

    async def role(self, visitor: Visitor) -> Role:
        """The role that the token of a request gives. Raises RefusedError without a valid one."""
        given = visitor.bearer_token
        if self.rules.allows_page_token and visitor.page_token is not None:
            given = visitor.page_token
        role = await self.role_of(given, visitor)
        if role is None:
            self._report("token", f"request from {visitor.address} rejected: its token is wrong or missing")
            text = self.rules.token_hint or (_NO_TOKEN if given is None else _WRONG_TOKEN)
            raise RefusedError(HTTPStatus.UNAUTHORIZED, text, {"WWW-Authenticate": "Bearer"})
        return role

    async def role_of(self, given: str | None, visitor: Visitor) -> Role | None:
        """The role that a token gives, after a pause if its address has tried many tokens; None if it is wrong.

        Raises TooManyAttemptsError.
        """
        tokens = self.rules.tokens
        if given is None or not tokens.is_required or not self._is_limited:
            return tokens.role(given)
        origin, host = visitor.origin, visitor.host
        is_own = is_allowed(origin, host, self.rules.allowed_origins) or is_same_private_name(origin, host)
        limiter = self._programs if is_own else self._pages
        try:
            pause_s = limiter.begin(visitor.address)
        except TooManyAttemptsError:
            self._report(
                "attempts", f"requests from {visitor.address} are rejected for some seconds: too many wrong tokens"
            )
            raise
        if pause_s > 0.0:
            await asyncio.sleep(pause_s)
        role = tokens.role(given)
        if role is not None:
            limiter.succeed(visitor.address)
        return role

    def _is_own_name(self, name: str | None) -> bool:
        names = self.rules.host_names
        if names is HostNames.ANY or is_loopback_name(name, self.rules.allowed_hosts):
            return True
        return names is HostNames.UNOWNED and name is not None and (is_numeric(name) or is_private_name(name))
