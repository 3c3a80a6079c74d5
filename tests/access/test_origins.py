"""Which web pages may connect."""

from __future__ import annotations

import pytest

from thymio_sim_ros.access.origins import FOXGLOVE_APPS, is_allowed

HOST = "localhost:8765"


@pytest.mark.parametrize(
    "origin",
    [
        None,
        "http://localhost:8080",
        "http://127.0.0.1:3000",
        "http://[::1]:8080",
        "https://localhost",
        "https://app.foxglove.dev",
        "file://",
    ],
)
def test_native_clients_this_machine_and_the_foxglove_app_may_connect(origin: str | None) -> None:
    assert is_allowed(origin, HOST, FOXGLOVE_APPS)


@pytest.mark.parametrize(
    "origin",
    [
        "https://evil.example",
        "http://localhost.evil.example",
        "http://evil.example:8080",
        "https://app.foxglove.dev.evil.example",
        "null",
        "",
        "http://",
        "http://[::1",
        "javascript://localhost",
    ],
)
def test_other_pages_may_not(origin: str) -> None:
    assert not is_allowed(origin, HOST, FOXGLOVE_APPS)


def test_a_page_from_the_robots_own_address_may_connect() -> None:
    assert is_allowed("http://192.168.1.5:8080", "192.168.1.5:8765")


def test_a_page_from_another_address_may_not() -> None:
    assert not is_allowed("http://192.168.1.6:8080", "192.168.1.5:8765")


def test_a_name_that_was_rebound_to_this_machine_may_not() -> None:
    assert not is_allowed("http://evil.example:8765", "evil.example:8765")


def test_the_user_can_allow_an_origin() -> None:
    assert is_allowed("https://school.example", HOST, ["https://school.example"])
    assert not is_allowed("https://school.example:444", HOST, ["https://school.example"])


def test_a_star_allows_all() -> None:
    assert is_allowed("https://evil.example", None, ["*"])
