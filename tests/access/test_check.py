"""Which requests servers answer: pages from elsewhere drive no robot, neither by scripts nor by links or names."""

from __future__ import annotations

import asyncio
from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import pytest

from thymio_sim_ros.access import NO_PROXIES, AccessCheck, AccessRules, HostNames, RefusedError, Role, Tokens, Visitor
from thymio_sim_ros.access.attempts import TooManyAttemptsError
from thymio_sim_ros.access.origins import FOXGLOVE_APPS

TOKENS = Tokens("fulltoken", "looktoken")
LOOPBACK = AccessRules(host_names=HostNames.LOOPBACK)
NETWORK = AccessRules(host_names=HostNames.UNOWNED)
WEBSOCKETS = AccessRules(allowed_origins=FOXGLOVE_APPS)
WITH_TOKEN = AccessRules(TOKENS, HostNames.UNOWNED)
PROGRAM = Visitor("192.0.2.1", None)


def visitor(headers: Mapping[str, str], target: str = "/") -> Visitor:
    return NO_PROXIES.visitor("192.0.2.1", lambda name: [headers[name]] if name in headers else [], target=target)


def check_of(rules: AccessRules, **options: Any) -> AccessCheck:
    return AccessCheck(rules, lambda about, text: None, **options)


def role_of(check: AccessCheck, asked: Visitor) -> Role | int:
    """The role, or the status of the answer."""
    try:
        return asyncio.run(check.admit(asked))
    except RefusedError as error:
        return error.status


@pytest.mark.parametrize(
    ("rules", "headers"),
    [
        (LOOPBACK, {}),
        (LOOPBACK, {"Host": "localhost:3000"}),
        (LOOPBACK, {"Host": "[::1]:3000"}),
        (LOOPBACK, {"Host": "127.0.0.1:3000", "Origin": "http://127.0.0.1:8899", "Sec-Fetch-Site": "same-site"}),
        (LOOPBACK, {"Host": "127.0.0.1:3000", "Origin": "http://localhost:8080", "Sec-Fetch-Site": "cross-site"}),
        (LOOPBACK, {"Host": "127.0.0.1:3000", "Sec-Fetch-Site": "none"}),
        (replace(LOOPBACK, allowed_hosts=("lab.example",)), {"Host": "LAB.example:3000"}),
        (AccessRules(allowed_origins=("https://vpl.example",)), {"Origin": "https://vpl.example"}),
        (NETWORK, {"Host": "192.168.1.5:3000", "Origin": "http://192.168.1.5:8080"}),
        (NETWORK, {"Host": "robot.local:3000"}),
        (NETWORK, {"Host": "classroom"}),
        (WEBSOCKETS, {"Host": "robots.school.example", "Origin": "https://app.foxglove.dev"}),
    ],
)
def test_programs_and_local_pages_have_all_rights(rules: AccessRules, headers: Mapping[str, str]) -> None:
    assert role_of(check_of(rules), visitor(headers)) is Role.FULL


@pytest.mark.parametrize(
    ("rules", "headers"),
    [
        (LOOPBACK, {"Host": "evil.example"}),
        (LOOPBACK, {"Host": "127.0.0.1.evil.example:3000"}),
        (LOOPBACK, {"Host": "local host"}),
        (LOOPBACK, {"Host": "localhost", "Origin": "https://evil.example"}),
        (LOOPBACK, {"Host": "localhost", "Origin": "http://localhost.evil.example"}),
        (LOOPBACK, {"Host": "localhost", "Origin": "null"}),
        (LOOPBACK, {"Host": "localhost", "Origin": "file://"}),
        (LOOPBACK, {"Host": "localhost", "Origin": "http://[::1"}),
        (LOOPBACK, {"Host": "localhost", "Sec-Fetch-Site": "cross-site"}),
        (LOOPBACK, {"Host": "192.168.1.5:3000"}),
        (NETWORK, {"Host": "evil.example"}),
        (NETWORK, {"Host": "192.168.1.5:3000", "Origin": "http://192.168.1.6"}),
        (WEBSOCKETS, {"Host": "evil.example", "Origin": "http://evil.example"}),
    ],
)
def test_foreign_pages_and_names_are_rejected(rules: AccessRules, headers: Mapping[str, str]) -> None:
    reports: list[tuple[str, str]] = []
    check = AccessCheck(rules, lambda *report: reports.append(report))
    assert role_of(check, visitor(headers)) == 403
    assert len(reports) == 1


def test_a_token_decides_for_pages_and_names_from_anywhere() -> None:
    foreign = {"Host": "robots.school.example", "Origin": "https://school.example", "Sec-Fetch-Site": "cross-site"}
    check = check_of(WITH_TOKEN)
    assert role_of(check, visitor(foreign, "/nodes?token=fulltoken")) is Role.FULL
    assert role_of(check, visitor({**foreign, "Authorization": "Bearer looktoken"})) is Role.READ_ONLY
    assert role_of(check, visitor(foreign)) == 401
    assert check.is_allowed_page(visitor(foreign))


def test_the_token_of_a_page_comes_before_that_of_the_header() -> None:
    given = {"Authorization": "Bearer fulltoken"}
    offered = {"Sec-WebSocket-Protocol": "foxglove.sdk.v1, token.looktoken"}
    assert role_of(check_of(WITH_TOKEN), visitor(offered)) is Role.READ_ONLY
    assert role_of(check_of(WITH_TOKEN), visitor(given, "/?token=looktoken")) is Role.READ_ONLY
    in_header = check_of(replace(WITH_TOKEN, allows_page_token=False))
    assert role_of(in_header, visitor(given, "/?token=looktoken")) is Role.FULL
    assert role_of(in_header, visitor({}, "/?token=fulltoken")) == 401
    assert role_of(in_header, visitor(offered)) == 401


def test_the_reason_says_whether_a_token_is_missing_or_wrong() -> None:
    def reason(check: AccessCheck, target: str) -> str:
        with pytest.raises(RefusedError) as caught:
            asyncio.run(check.role(visitor({}, target)))
        assert caught.value.headers == {"WWW-Authenticate": "Bearer"}
        return str(caught.value)

    assert reason(check_of(WITH_TOKEN), "/").startswith("a token is needed")
    assert reason(check_of(WITH_TOKEN), "/?token=other").startswith("the token is wrong")
    assert reason(check_of(replace(WITH_TOKEN, token_hint="ask the teacher")), "/?token=other") == "ask the teacher"


def results(check: AccessCheck, given: str, times: int, **asked: str) -> list[Role | str | None]:
    async def one() -> Role | str | None:
        try:
            return await check.role_of(given, replace(PROGRAM, **asked))
        except TooManyAttemptsError:
            return "too many"

    async def scenario() -> list[Role | str | None]:
        return [await one() for _ in range(times)]

    return asyncio.run(scenario())


def test_wrong_tokens_do_not_lock_out_a_random_one() -> None:
    random = "pQ4vX0a9_Zk-LrT2mBcD1A"
    check = check_of(AccessRules(Tokens(random)), now_s=lambda: 0.0)
    assert results(check, "wrong", 1000) == [None] * 1000
    assert results(check, random, 1) == [Role.FULL]


def test_wrong_tokens_do_not_lock_out_a_chosen_one() -> None:
    check = check_of(WITH_TOKEN)
    assert results(check, "wrong", 31) == [None] * 31
    assert results(check, "fulltoken", 1) == [Role.FULL]


def test_a_chosen_token_cannot_be_guessed() -> None:
    async def found() -> list[object]:
        check = check_of(WITH_TOKEN, now_s=lambda: 0.0)
        return await asyncio.gather(*(check.role_of("wrong", PROGRAM) for _ in range(40)), return_exceptions=True)

    assert [getattr(one, "status", one) for one in asyncio.run(found())] == [None] * 35 + [429] * 5


def test_a_foreign_page_does_not_use_up_the_attempts_of_the_owner() -> None:
    check = check_of(WITH_TOKEN, now_s=lambda: 0.0)
    foreign = {"origin": "https://evil.example", "host": "192.0.2.9:8765"}
    assert results(check, "wrong", 30, **foreign) == [None] * 30
    check._pages._set_remaining(PROGRAM.address, -5.0)
    assert results(check, "fulltoken", 1, **foreign) == ["too many"]
    for own in ({}, {"origin": "http://lab.local:8080", "host": "lab.local:8765"}, {"origin": "http://localhost:8080"}):
        assert results(check, "fulltoken", 1, **own) == [Role.FULL]
    assert results(check, "wrong", 1, origin="http://lab.example", host="lab.example") == ["too many"]


def test_a_request_without_a_token_is_no_attempt() -> None:
    check = check_of(WITH_TOKEN, now_s=lambda: 0.0)
    assert [role_of(check, PROGRAM) for _ in range(100)] == [401] * 100
    assert results(check, "fulltoken", 1) == [Role.FULL]
