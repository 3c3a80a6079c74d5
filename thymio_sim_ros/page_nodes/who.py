"""Which visitors may run nodes: Python that a page sends and that this computer executes. Without I/O."""

from __future__ import annotations

from enum import StrEnum
from http import HTTPStatus

from thymio_sim_ros.access import RefusedError, Role, Visitor
from thymio_sim_ros.access.hosts import host_name, is_loopback, is_loopback_name

__all__ = ["Right", "Who", "check_page", "right_of"]


class Who(StrEnum):
    """The visitors that may run nodes."""

    LOCAL = "local"
    """The user of this computer, on its loopback address."""
    ALL = "all"
    """All with full access; those of other computers in isolation only."""
    NONE = "none"


class Right(StrEnum):
    """What a visitor may do with nodes; those that are refused have the reason, as a word for the page."""

    LOCAL = "local"
    """Run them, as isolated as this computer can."""
    ISOLATED = "isolated"
    """Run them in isolation, or not at all."""
    OFF = "off"
    READ_ONLY = "readOnly"
    ELSEWHERE = "elsewhere"
    """From another computer, by a proxy or by another name than localhost: needs `Who.ALL`."""
    OTHER_USER = "otherUser"
    """From this computer, but of another user."""

    @property
    def may_run(self) -> bool:
        """Whether the visitor may run nodes."""
        return self in (Right.LOCAL, Right.ISOLATED)


def right_of(visitor: Visitor, role: Role, who: Who, *, is_same_user: bool) -> Right:
    """What a visitor may do.

    It is the user of this computer if nothing speaks against it: its address is loopback, it calls the server by a name
    of loopback (else a foreign page may have rebound its own name), no proxy says that it passes the request on, and
    the connection belongs to a program of the same user.
    """
    if who is Who.NONE:
        return Right.OFF
    if role is not Role.FULL:
        return Right.READ_ONLY
    is_here = is_loopback(visitor.address) and is_loopback_name(host_name(visitor.host or ""))
    is_here = is_here and not visitor.is_proxied and not visitor.is_forwarded
    if is_here and is_same_user:
        return Right.LOCAL
    if who is Who.ALL:
        return Right.ISOLATED
    return Right.OTHER_USER if is_here else Right.ELSEWHERE


def check_page(visitor: Visitor) -> None:
    """Raise RefusedError unless a page of this very server makes the request.

    Other pages of this computer may use the bridge, but not execute programs: they can be of anyone.
    """
    own = f"{visitor.scheme}://{visitor.host}"
    if not visitor.host or visitor.origin is None or visitor.origin.lower() != own.lower():
        raise RefusedError(
            HTTPStatus.FORBIDDEN,
            f"found a request of {visitor.origin!s:.100}, expected one of the page of this server",
        )
