"""Tokens: what they allow, where they are found, and how often a wrong one may be tried."""

from __future__ import annotations

import asyncio

import pytest

from thymio_sim_ros.bridge.access import (
    TOKEN,
    AttemptLimiter,
    TokenCheck,
    Tokens,
    TooManyAttemptsError,
    given_token,
    is_loopback,
    is_random,
    new_token,
)
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
    assert [attempts.begin("10.0.0.1") for _ in range(30)] == [0.0] * 30
    assert [attempts.begin("10.0.0.1") for _ in range(5)] == [1.0, 2.0, 3.0, 4.0, 5.0]
    with pytest.raises(TooManyAttemptsError):
        attempts.begin("10.0.0.1")
    assert attempts.begin("10.0.0.2") == 0.0
    now_s = 6.0
    assert [attempts.begin("10.0.0.1") for _ in range(2)] == [0.0, 1.0]


def test_right_tokens_are_not_counted_and_their_address_gets_an_allowance_of_its_own() -> None:
    attempts = AttemptLimiter(lambda: 0.0)
    for _ in range(100):
        assert attempts.begin("fd00::1") == 0.0
        attempts.succeed("fd00::1")
    for _ in range(35):  # another computer of the same network
        attempts.begin("fd00::2")
    with pytest.raises(TooManyAttemptsError):
        attempts.begin("fd00::2")
    assert attempts.begin("fd00::1") == 0.0


def test_one_computer_does_not_get_more_attempts_by_several_ipv6_addresses() -> None:
    attempts = AttemptLimiter(lambda: 0.0)
    for number in range(30):
        attempts.begin(f"fd00::{number:x}")
    assert attempts.begin("fd00::ffff") == 1.0
    assert attempts.begin("fd01::1") == 0.0


def test_the_number_of_remembered_addresses_is_limited() -> None:
    attempts = AttemptLimiter(lambda: 0.0)
    for number in range(2000):
        address = f"10.0.{number // 250}.{number % 250}"
        attempts.begin(address)
        attempts.succeed(address)
    assert len(attempts._remaining_by_key) == len(attempts._known) == 1000


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


def _roles(check: TokenCheck, given: str, times: int, **request: str) -> list[Role | str | None]:
    async def one() -> Role | str | None:
        try:
            return await check.role(given, "192.0.2.1", **request)
        except TooManyAttemptsError:
            return "too many"

    async def scenario() -> list[Role | str | None]:
        return [await one() for _ in range(times)]

    return asyncio.run(scenario())


def test_wrong_tokens_do_not_lock_out_a_random_one() -> None:
    check = TokenCheck(Tokens("pQ4vX0a9_Zk-LrT2mBcD1A"), now_s=lambda: 0.0)
    assert _roles(check, "wrong", 1000) == [None] * 1000
    assert _roles(check, check.tokens.full, 1) == [Role.FULL]


def test_wrong_tokens_do_not_lock_out_a_chosen_one() -> None:
    check = TokenCheck(TOKENS)
    assert _roles(check, "wrong", 31) == [None] * 31
    assert _roles(check, "fulltoken", 1) == [Role.FULL]


def test_a_foreign_page_does_not_use_up_the_attempts_of_the_owner() -> None:
    now_s = 0.0
    check = TokenCheck(TOKENS, now_s=lambda: now_s)
    foreign = {"origin": "https://evil.example", "host": "192.0.2.9:8765"}
    assert _roles(check, "wrong", 30, **foreign) == [None] * 30
    check._pages._set_remaining("192.0.2.1", -5.0)
    assert _roles(check, "fulltoken", 1, **foreign) == ["too many"]
    for own in ({}, {"origin": "http://lab.local:8080", "host": "lab.local:8765"}, {"origin": "http://localhost:8080"}):
        assert _roles(check, "fulltoken", 1, **own) == [Role.FULL]
    assert _roles(check, "wrong", 1, origin="http://lab.example", host="lab.example") == ["too many"]


def test_a_request_without_a_token_is_no_attempt() -> None:
    check = TokenCheck(TOKENS, now_s=lambda: 0.0)

    async def scenario() -> list[Role | None]:
        return [await check.role(None, "192.0.2.1") for _ in range(100)]

    assert asyncio.run(scenario()) == [None] * 100
    assert _roles(check, "fulltoken", 1) == [Role.FULL]
