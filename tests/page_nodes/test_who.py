"""Which visitors may run Python of a page on this computer."""

from __future__ import annotations

from dataclasses import replace

import pytest

from thymio_sim_ros.access import RefusedError, Role, Visitor
from thymio_sim_ros.page_nodes.who import Right, Who, check_page, right_of

HERE = Visitor("127.0.0.1", "localhost:8080", origin="http://localhost:8080")
ELSEWHERE = Visitor("192.0.2.7", "10.0.0.1:8080", origin="http://10.0.0.1:8080")


def right(visitor: Visitor, who: Who = Who.LOCAL, *, role: Role = Role.FULL, is_same_user: bool = True) -> Right:
    return right_of(visitor, role, who, is_same_user=is_same_user)


def test_the_user_of_this_computer_may_run_nodes() -> None:
    assert right(HERE) is Right.LOCAL
    assert right(replace(HERE, address="::1", host="[::1]:8080")) is Right.LOCAL
    assert right(HERE, Who.ALL) is Right.LOCAL


@pytest.mark.parametrize(
    "visitor",
    [
        ELSEWHERE,
        replace(HERE, address="192.0.2.7"),
        replace(HERE, host="10.0.0.1:8080"),  # this computer by its address in the network
        replace(HERE, host="evil.example:8080", origin="http://evil.example:8080"),  # a name that was rebound
        replace(HERE, host=""),
        replace(HERE, host=None),
        replace(HERE, is_proxied=True),
        replace(HERE, is_forwarded=True),  # by a proxy that the suite does not know
        replace(HERE, address=""),
    ],
)
def test_no_other_visitor_does_unless_nodes_are_for_all_and_then_in_isolation(visitor: Visitor) -> None:
    assert right(visitor) is Right.ELSEWHERE
    assert right(visitor, Who.ALL) is Right.ISOLATED


def test_another_user_of_this_computer_does_not() -> None:
    assert right(HERE, is_same_user=False) is Right.OTHER_USER
    assert right(HERE, Who.ALL, is_same_user=False) is Right.ISOLATED


@pytest.mark.parametrize("visitor", [HERE, ELSEWHERE])
def test_who_only_watches_does_not_and_without_nodes_no_one_does(visitor: Visitor) -> None:
    assert right(visitor, Who.ALL, role=Role.READ_ONLY) is Right.READ_ONLY
    assert right(visitor, Who.NONE) is Right.OFF


def test_the_page_of_this_server_may_ask() -> None:
    check_page(HERE)
    check_page(replace(HERE, scheme="https", origin="https://localhost:8080"))


@pytest.mark.parametrize(
    "visitor",
    [
        replace(HERE, origin=None),  # a program, or a link
        replace(HERE, origin="http://localhost:3000"),  # another page of this computer
        replace(HERE, origin="http://127.0.0.1:8080"),
        replace(HERE, origin="https://localhost:8080"),
        replace(HERE, origin="https://app.foxglove.dev"),  # may use the bridge
        replace(HERE, origin="file://"),
        replace(HERE, origin="null"),
        replace(HERE, origin="http://", host=""),
    ],
)
def test_no_other_page_may(visitor: Visitor) -> None:
    with pytest.raises(RefusedError, match="expected one of the page of this server"):
        check_page(visitor)
