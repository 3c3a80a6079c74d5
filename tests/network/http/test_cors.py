"""The pages that get the answers of the HTTP interface."""

from __future__ import annotations

from collections.abc import Mapping

from thymio_sim_ros.access import NO_PROXIES, AccessCheck, AccessRules, HostNames, Tokens
from thymio_sim_ros.network.http.cors import cors_headers

LOOPBACK = AccessRules(host_names=HostNames.LOOPBACK)
WITH_TOKEN = AccessRules(Tokens("full-token", "watch-token"))


def headers(asked: Mapping[str, str], rules: AccessRules) -> dict[str, str]:
    visitor = NO_PROXIES.visitor("127.0.0.1", lambda name: [asked[name]] if name in asked else [])
    return cors_headers(asked, visitor, AccessCheck(rules, lambda about, text: None))


def test_only_allowed_pages_get_the_answer():
    local = {"Host": "localhost", "Origin": "http://localhost:8080"}
    assert headers(local, LOOPBACK) == {"Vary": "Origin", "Access-Control-Allow-Origin": "http://localhost:8080"}
    assert headers({"Origin": "https://evil.example"}, LOOPBACK) == {"Vary": "Origin"}
    assert headers({}, LOOPBACK) == {"Vary": "Origin"}
    # with a token, the token decides
    assert headers({"Origin": "https://a.example"}, WITH_TOKEN)["Access-Control-Allow-Origin"] == "https://a.example"


def test_a_preflight_request_names_methods_and_headers():
    asked = {"Origin": "http://localhost", "Access-Control-Request-Method": "PUT"}
    found = headers(asked, LOOPBACK)
    assert found["Access-Control-Allow-Methods"] == "GET, POST, PUT, OPTIONS"
    assert found["Access-Control-Allow-Headers"] == "Authorization, Content-Type"
    private = {**asked, "Access-Control-Request-Private-Network": "true"}
    assert headers(private, LOOPBACK)["Access-Control-Allow-Private-Network"] == "true"
    assert "Access-Control-Allow-Methods" not in headers({**asked, "Origin": "https://evil.example"}, LOOPBACK)
