"""Who has sent a request, behind proxies that are trusted and others."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

import pytest

from thymio_sim_ros.access.visitor import NO_PROXIES, ProxyError, TrustedProxies, Visitor

PROXY, PUPIL = "10.0.0.1", "192.0.2.7"
PROXIES = TrustedProxies([PROXY, "fd00::/8"])


def headers(given: Mapping[str, str | list[str]]) -> Callable[[str], Sequence[str]]:
    values = {name: [value] if isinstance(value, str) else value for name, value in given.items()}
    return lambda name: values.get(name, [])


FORWARDED = {
    "Host": "127.0.0.1:8080",
    "X-Forwarded-For": PUPIL,
    "X-Forwarded-Proto": "https",
    "X-Forwarded-Host": "school.example",
    "X-Forwarded-Prefix": "/thymio/",
}


def test_a_trusted_proxy_reports_the_visitor() -> None:
    visitor = PROXIES.visitor(PROXY, headers(FORWARDED))
    assert visitor == Visitor(PUPIL, "school.example", "https", "/thymio", is_proxied=True, is_forwarded=True)
    assert visitor.url == "https://school.example/thymio/"


def test_the_name_of_a_page_can_be_quoted_whatever_its_bytes_are() -> None:
    origin = b"http://local\x84ost".decode("utf-8", "surrogateescape")  # as aiohttp reads headers
    assert NO_PROXIES.visitor(PUPIL, headers({"Origin": origin})).origin == "http://local\ufffdost"


@pytest.mark.parametrize("proxies", [TrustedProxies(), PROXIES])
def test_headers_of_others_do_not_count(proxies: TrustedProxies) -> None:
    visitor = proxies.visitor("10.0.0.2", headers(FORWARDED))
    assert visitor == Visitor("10.0.0.2", "127.0.0.1:8080", is_forwarded=True)
    assert visitor.url == "http://127.0.0.1:8080/"


@pytest.mark.parametrize(
    ("chain", "address"),
    [
        ("198.51.100.1, 192.0.2.7", PUPIL),  # the first one is a claim of the visitor
        ("192.0.2.7, 10.0.0.1", PUPIL),  # through two proxies
        (["192.0.2.7", "fd00::1"], PUPIL),
        ("192.0.2.7:51234", PUPIL),
        ("[2001:db8::7]:51234", "2001:db8::7"),
        ("::ffff:192.0.2.7", PUPIL),
        ("192.0.2.7, unknown", PROXY),
        ("", PROXY),
    ],
)
def test_the_visitor_is_the_nearest_address_that_is_no_proxy(chain: str | list[str], address: str) -> None:
    assert PROXIES.visitor(PROXY, headers({"X-Forwarded-For": chain})).address == address


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("X-Forwarded-Proto", "javascript"),
        ("X-Forwarded-Host", "school.example/path"),
        ("X-Forwarded-Host", "a b"),
        ("X-Forwarded-Prefix", "thymio"),
        ("X-Forwarded-Prefix", "//evil.example"),
        ("X-Forwarded-Prefix", "/a/../b"),
        ("X-Forwarded-Prefix", "/<script>"),
    ],
)
def test_values_that_are_no_part_of_a_url_are_ignored(name: str, value: str) -> None:
    assert PROXIES.visitor(PROXY, headers({"Host": "h:1", name: value})).url == "http://h:1/"


def test_a_request_without_a_host_has_no_url() -> None:
    assert PROXIES.visitor(PUPIL, headers({})).url is None


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("proxy.example", "expected the numeric address or network"),
        ("10.0.0.5/8", "has host bits set"),
        ("0.0.0.0/0", "every computer"),
        ("", "expected the numeric address or network"),
    ],
)
def test_what_names_no_proxy_is_refused(text: str, reason: str) -> None:
    with pytest.raises(ProxyError, match=reason):
        TrustedProxies([text])


@pytest.mark.parametrize(
    ("target", "authorizations", "tokens"),
    [
        ("/?token=abcd", [], ("abcd", None)),
        ("/?x=1&token=abcd", ["Bearer other"], ("abcd", "other")),
        ("/", ["Bearer abcd"], (None, "abcd")),
        ("/", ["Basic xyz", "bearer  abcd "], (None, "abcd")),
        ("/?token=", [], (None, None)),
        ("/token=abcd", ["Basic abcd"], (None, None)),
        ("/?token=%ff", [], ("\ufffd", None)),
    ],
)
def test_a_token_is_found_in_the_address_and_in_a_header(
    target: str, authorizations: list[str], tokens: tuple[str | None, str | None]
) -> None:
    visitor = NO_PROXIES.visitor(PUPIL, headers({"Authorization": authorizations}), target=target)
    assert (visitor.page_token, visitor.bearer_token) == tokens
    assert "abcd" not in repr(visitor)


@pytest.mark.parametrize(
    ("target", "offers", "token"),
    [
        ("/", "foxglove.sdk.v1, token.ab.c~d-", "ab.c~d-"),
        ("/", ["foxglove.sdk.v1", " token.abcd"], "abcd"),
        ("/?token=abcd", "token.other", "abcd"),
        ("/", "token.a%28b+c", "a(b c"),
        ("/", "token.", None),
        ("/", "token, x.token.abcd", None),
    ],
)
def test_a_token_is_found_in_a_sub_protocol(target: str, offers: str | list[str], token: str | None) -> None:
    visitor = NO_PROXIES.visitor(PUPIL, headers({"Sec-WebSocket-Protocol": offers}), target=target)
    assert visitor.page_token == token
    assert "abcd" not in repr(visitor)


@pytest.mark.parametrize(
    ("sent", "host", "origin"),
    [
        ({}, None, None),
        ({"Host": "local host"}, "", None),
        ({"Host": ["a.example", "b.example"], "Origin": ["null", "http://a.example"]}, "b.example", "http://a.example"),
    ],
)
def test_host_and_origin_are_those_of_the_last_header(sent, host: str | None, origin: str | None) -> None:
    visitor = NO_PROXIES.visitor(PUPIL, headers(sent))
    assert (visitor.host, visitor.origin) == (host, origin)
    assert visitor.url == (f"http://{host}/" if host else None)
