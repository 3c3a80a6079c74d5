"""Tokens: what they allow, where they are found, and how often a wrong one may be tried."""

from __future__ import annotations

import pytest

from thymio_sim_ros.bridge.access import TOKEN, AttemptLimiter, Tokens, given_token, is_loopback, new_token
from thymio_sim_ros.bridge.protocol.constants import Role

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
    ("target", "authorizations", "token"),
    [
        ("/?token=abcd", [], "abcd"),
        ("/?x=1&token=abcd", ["Bearer other"], "abcd"),
        ("/", ["Bearer abcd"], "abcd"),
        ("/", ["Basic xyz", "bearer  abcd "], "abcd"),
        ("/?token=", [], None),
        ("/token=abcd", ["Basic abcd"], None),
        ("/?token=%ff", [], "\ufffd"),
    ],
)
def test_a_token_is_found_in_the_address_or_in_a_header(
    target: str, authorizations: list[str], token: str | None
) -> None:
    assert given_token(target, authorizations) == token


def test_wrong_tokens_may_be_tried_some_times_and_then_slowly() -> None:
    now_s = 0.0
    attempts = AttemptLimiter(lambda: now_s)
    tried = 0
    while attempts.is_allowed_to_try("10.0.0.1"):
        attempts.record_failure("10.0.0.1")
        tried += 1
    assert tried == 30
    assert attempts.is_allowed_to_try("10.0.0.2")
    now_s = 2.5
    for _ in range(2):
        assert attempts.is_allowed_to_try("10.0.0.1")
        attempts.record_failure("10.0.0.1")
    assert not attempts.is_allowed_to_try("10.0.0.1")


def test_one_computer_does_not_get_more_attempts_by_several_ipv6_addresses() -> None:
    attempts = AttemptLimiter(lambda: 0.0)
    for number in range(30):
        attempts.record_failure(f"fd00::{number:x}")
    assert not attempts.is_allowed_to_try("fd00::ffff")
    assert attempts.is_allowed_to_try("fd01::1")


def test_the_number_of_remembered_addresses_is_limited() -> None:
    attempts = AttemptLimiter(lambda: 0.0)
    for number in range(2000):
        attempts.record_failure(f"10.0.{number // 250}.{number % 250}")
    assert len(attempts._remaining_by_network) == 1000
