"""The banner: URLs for this computer and for others, access, start time."""

from __future__ import annotations

import io
import ipaddress
import re
import socket
import sys

import pytest
import segno

from thymio_sim_ros.bridge import Tokens
from thymio_sim_ros.cli import banner
from thymio_sim_ros.names import addresses
from thymio_sim_ros.network.settings import OFF
from thymio_sim_ros.suite_config import SuiteConfig


@pytest.mark.process
@pytest.mark.parametrize("address", ["localhost", "127.0.0.1"])
def test_on_this_computer_only(address):
    text = banner.banner(SuiteConfig(address=address), ["thymio"]).splitlines()
    assert text[:2] == ["Page      http://localhost:8080/", "Foxglove  ws://localhost:8765"]


def test_a_computer_without_a_network_interface_says_so(monkeypatch):
    monkeypatch.setattr(banner, "loopback_problem", lambda: "Network is unreachable")
    first = banner.banner(SuiteConfig(), ["thymio"]).splitlines()[0]
    assert first == ("Network   this computer cannot reach itself (Network is unreachable): switch its interface lo on")


@pytest.mark.process
def test_for_the_whole_network(monkeypatch):
    monkeypatch.setattr(addresses, "own_address", lambda: "10.1.2.3")
    text = banner.banner(SuiteConfig(address="0.0.0.0", port=80, foxglove_port=81), ["thymio"]).splitlines()
    assert text[0] == "Page      http://localhost:80/, from other computers http://10.1.2.3:80/"
    assert text[1] == "Foxglove  ws://localhost:81, from other computers ws://10.1.2.3:81"


@pytest.mark.process
def test_a_bridge_without_a_port_of_its_own_has_that_of_the_page():
    text = banner.banner(SuiteConfig(foxglove_port=OFF, tokens=TOKENS), ["thymio"])
    assert f"Foxglove  ws://localhost:8080/?token={TOKENS.full}" in text
    assert f"Read only ws://localhost:8080/?token={TOKENS.read_only}" in text


@pytest.mark.process
def test_with_a_certificate():
    text = banner.banner(SuiteConfig(certificate="cert.pem", tokens=TOKENS), ["thymio"])
    assert f"Page      https://localhost:8080/#token={TOKENS.full}" in text
    assert f"Foxglove  wss://localhost:8765/?token={TOKENS.full}" in text


@pytest.mark.process
def test_on_one_address():
    assert "Page      http://10.1.2.3:8080/\n" in banner.banner(SuiteConfig(address="10.1.2.3"), ["thymio"])


@pytest.mark.parametrize(
    ("address", "text"),
    [
        ("::1", "ws://localhost:8765"),
        ("::", "ws://localhost:8765, from other computers ws://10.1.2.3:8765"),
        ("fd00::7", "ws://[fd00::7]:8765"),
        ("class-pc", "ws://class-pc:8765"),
    ],
)
def test_other_addresses(monkeypatch, address, text):
    monkeypatch.setattr(addresses, "own_address", lambda: "10.1.2.3")
    assert addresses.describe_urls("ws", address, 8765) == text


@pytest.mark.process
def test_without_page_and_bridge():
    text = banner.banner(SuiteConfig(web=False, foxglove=False), ["thymio"])
    assert text.splitlines() == [
        "Page      none (started without it)",
        "Foxglove  none (started without it)",
        "Stop      Ctrl-C",
    ]


TOKENS = Tokens("fulltoken", "looktoken")


@pytest.mark.process
def test_tokens_are_in_the_addresses_and_the_read_only_ones_apart(monkeypatch):
    monkeypatch.setattr(addresses, "own_address", lambda: "10.1.2.3")
    text = banner.banner(SuiteConfig(address="0.0.0.0", port=80, foxglove_port=81, tokens=TOKENS), ["thymio"])
    lines = text.splitlines()
    full = "http://localhost:80/#token=fulltoken, from other computers http://10.1.2.3:80/#token=fulltoken"
    assert lines[0] == f"Page      {full}"
    assert lines[1].endswith("from other computers ws://10.1.2.3:81/?token=fulltoken")
    assert lines[2:4] == [
        "Read only http://10.1.2.3:80/#token=looktoken",
        "Read only ws://10.1.2.3:81/?token=looktoken",
    ]


@pytest.mark.process
@pytest.mark.parametrize(
    ("address", "tokens", "expected"),
    [
        ("localhost", Tokens(), "this computer only"),
        ("127.0.0.1", TOKENS, "this computer only, with the token"),
        ("0.0.0.0", Tokens(), "everyone in your network, without a token: drive, program, load, add robots"),
        (
            "0.0.0.0",
            TOKENS,
            "everyone in your network with a full address: drive, program, load, add robots; "
            "with a read-only address: watch",
        ),
    ],
)
def test_one_line_describes_the_access(address, tokens, expected):
    assert (
        f"Access    {expected}" in banner.banner(SuiteConfig(address=address, tokens=tokens), ["thymio"]).splitlines()
    )


@pytest.mark.process
def test_the_access_behind_a_proxy_is_that_of_its_visitors():
    suite = SuiteConfig(tokens=TOKENS, trusted_proxies=("127.0.0.1",))
    assert "Access    everyone who reaches the proxy with a full address: drive" in banner.banner(suite, ["thymio"])


def test_the_qr_code_holds_the_address_for_other_computers(monkeypatch):
    monkeypatch.setattr(addresses, "own_address", lambda: "10.1.2.3")
    suite = SuiteConfig(address="0.0.0.0", port=80, tokens=TOKENS)
    expected = io.StringIO()
    segno.make_qr("http://10.1.2.3:80/#token=fulltoken", error="l").terminal(expected, border=2, compact=True)
    drawn = banner.qr_code(suite)
    assert drawn == expected.getvalue().rstrip("\n")
    assert max(map(len, re.sub(r"\x1b\[[0-9;]*m", "", drawn).splitlines())) < 80


@pytest.mark.parametrize("suite", [SuiteConfig(), SuiteConfig(address="0.0.0.0", web=False)])
def test_there_is_no_qr_code_where_there_is_no_page_for_others(suite):
    assert banner.qr_code(suite) == ""


def test_without_the_package_there_is_no_qr_code(monkeypatch):
    monkeypatch.setitem(sys.modules, "segno", None)
    assert banner.qr_code(SuiteConfig(address="0.0.0.0")) == ""


@pytest.mark.process
def test_this_computer_has_a_number_or_a_name(monkeypatch):
    found = addresses.own_address()
    assert found == socket.gethostname() or ipaddress.IPv4Address(found)

    def unreachable(*_arguments):
        raise OSError("Network is unreachable")

    monkeypatch.setattr(addresses.socket.socket, "connect", unreachable)
    assert addresses.own_address() == socket.gethostname()


@pytest.mark.parametrize(("robots", "text"), [(1, None), (20, None), (80, "Start     80 robots: this takes about 8 s")])
def test_a_long_start_is_announced_with_its_duration(robots: int, text: str | None) -> None:
    assert banner.startup_notice(robots) == text
