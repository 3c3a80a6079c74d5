"""Tokens and the roles that they give."""

from __future__ import annotations

import pytest

from thymio_sim_ros.access.hosts import is_loopback
from thymio_sim_ros.access.tokens import TOKEN, Role, Tokens, is_random, new_token

TOKENS = Tokens("fulltoken", "looktoken")


@pytest.mark.parametrize(
    ("given", "role"),
    [
        ("fulltoken", Role.FULL),
        ("looktoken", Role.READ_ONLY),
        ("fulltoke", None),
        ("FULLTOKEN", None),
        ("tökén", None),
        ("\ud800", None),
        ("", None),
        (None, None),
    ],
)
def test_a_token_gives_its_role_and_no_other(given: str | None, role: Role | None) -> None:
    assert TOKENS.role(given) is role


@pytest.mark.parametrize(
    ("given", "role"), [(None, Role.FULL), ("", Role.FULL), ("any", Role.FULL), ("looktoken", Role.READ_ONLY)]
)
def test_without_a_token_all_clients_have_all_rights(given: str | None, role: Role) -> None:
    assert Tokens("", "looktoken").role(given) is role


def test_tokens_are_not_part_of_their_representation() -> None:
    assert "token" not in repr(TOKENS)


@pytest.mark.parametrize("address", ["localhost", "127.0.0.1", "127.9.9.9", "::1"])
def test_no_token_is_created_for_loopback(address: str) -> None:
    assert is_loopback(address)
    assert Tokens.for_address(address) == Tokens()
    assert Tokens.for_address(address, "fulltoken").is_required


@pytest.mark.parametrize("address", ["0.0.0.0", "::", "192.168.1.2", "class-pc", ""])
def test_two_tokens_are_created_for_the_network(address: str) -> None:
    assert not is_loopback(address)
    made = Tokens.for_address(address)
    assert TOKEN.fullmatch(made.full)
    assert TOKEN.fullmatch(made.read_only)
    assert len({made.full, made.read_only, new_token()}) == 3
    assert Tokens.for_address(address, "fulltoken", "looktoken") == TOKENS


@pytest.mark.parametrize(
    ("token", "expected"),
    [
        ("pQ4vX0a9_Zk-LrT2mBcD1A", True),
        ("classroom-2026", False),
        ("aaaaaaaaaaaaaaaaaaaaaA", False),
        ("pQ4vX0a9_Zk-LrT2mBcD1B", False),  # not canonical
        ("pQ4vX0a9~Zk-LrT2mBcD1A", False),
        ("a", False),
    ],
)
def test_a_random_token_is_recognized(token: str, expected: bool) -> None:
    assert is_random(token) is expected
