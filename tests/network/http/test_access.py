"""Pages from elsewhere cannot drive a robot, neither by scripts nor by links, images or names."""

from __future__ import annotations

import asyncio

import pytest

from thymio_sim_ros.bridge.access import TokenCheck, Tokens
from thymio_sim_ros.bridge.protocol.constants import Role
from thymio_sim_ros.network.http.access import AccessPolicy, check_origin, check_token, cors_headers
from thymio_sim_ros.network.http.requests import RequestError

LOOPBACK = AccessPolicy()
OPEN_NETWORK = AccessPolicy(address="0.0.0.0")
WITH_TOKEN = AccessPolicy(address="0.0.0.0", tokens=Tokens("full-token", "watch-token"))


@pytest.mark.parametrize(
    ("settings", "headers"),
    [
        (LOOPBACK, {}),
        (LOOPBACK, {"Host": "localhost:3000"}),
        (LOOPBACK, {"Host": "[::1]:3000"}),
        (LOOPBACK, {"Host": "127.0.0.1:3000", "Origin": "http://127.0.0.1:8899", "Sec-Fetch-Site": "same-site"}),
        (LOOPBACK, {"Host": "127.0.0.1:3000", "Origin": "http://localhost:8080", "Sec-Fetch-Site": "cross-site"}),
        (LOOPBACK, {"Host": "127.0.0.1:3000", "Sec-Fetch-Site": "none"}),
        (AccessPolicy(allowed_origins=("https://vpl.example",)), {"Origin": "https://vpl.example"}),
        (OPEN_NETWORK, {"Host": "192.168.1.5:3000", "Origin": "http://192.168.1.5:8080"}),
        (OPEN_NETWORK, {"Host": "robot.local:3000"}),
        (OPEN_NETWORK, {"Host": "classroom"}),
        (WITH_TOKEN, {"Host": "robots.school.example", "Origin": "https://school.example"}),
    ],
)
def test_own_programs_and_local_pages_may_make_requests(settings, headers):
    check_origin(headers, settings)


@pytest.mark.parametrize(
    ("settings", "headers"),
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
        (OPEN_NETWORK, {"Host": "evil.example"}),
        (OPEN_NETWORK, {"Host": "192.168.1.5:3000", "Origin": "http://192.168.1.6"}),
    ],
)
def test_foreign_pages_and_names_are_rejected(settings, headers):
    with pytest.raises(RequestError) as caught:
        check_origin(headers, settings)
    assert caught.value.status == 403


def test_only_allowed_pages_get_the_answer():
    local = {"Host": "localhost", "Origin": "http://localhost:8080"}
    assert cors_headers(local, LOOPBACK) == {"Vary": "Origin", "Access-Control-Allow-Origin": "http://localhost:8080"}
    assert cors_headers({"Origin": "https://evil.example"}, LOOPBACK) == {"Vary": "Origin"}
    assert cors_headers({}, LOOPBACK) == {"Vary": "Origin"}
    # with a token, the token decides
    assert (
        cors_headers({"Origin": "https://a.example"}, WITH_TOKEN)["Access-Control-Allow-Origin"] == "https://a.example"
    )


def test_a_preflight_request_names_methods_and_headers():
    asked = {"Origin": "http://localhost", "Access-Control-Request-Method": "PUT"}
    found = cors_headers(asked, LOOPBACK)
    assert found["Access-Control-Allow-Methods"] == "GET, POST, PUT, OPTIONS"
    assert found["Access-Control-Allow-Headers"] == "Authorization, Content-Type"
    private = {**asked, "Access-Control-Request-Private-Network": "true"}
    assert cors_headers(private, LOOPBACK)["Access-Control-Allow-Private-Network"] == "true"
    assert "Access-Control-Allow-Methods" not in cors_headers({**asked, "Origin": "https://evil.example"}, LOOPBACK)


def test_a_token_comes_in_the_query_or_in_a_header():
    check = TokenCheck(WITH_TOKEN.tokens)

    def role(target, authorizations=(), tokens=check):
        return asyncio.run(check_token(target, authorizations, "a", {}, tokens))

    assert role("/nodes?token=full-token") is Role.FULL
    assert role("/nodes", ["Bearer watch-token"]) is Role.READ_ONLY
    assert role("/nodes", tokens=TokenCheck(LOOPBACK.tokens)) is Role.FULL
    with pytest.raises(RequestError) as caught:
        role("/nodes")
    assert caught.value.status == 401


def test_tokens_cannot_be_guessed():
    async def statuses():
        check = TokenCheck(WITH_TOKEN.tokens, now_s=lambda: 0.0)
        tries = [check_token("/nodes?token=wrong", [], "a", {}, check) for _ in range(40)]
        found = await asyncio.gather(*tries, return_exceptions=True)
        assert await check_token("/nodes?token=full-token", [], "b", {}, check) is Role.FULL
        return [error.status for error in found]

    assert asyncio.run(statuses()) == [401] * 35 + [429] * 5
