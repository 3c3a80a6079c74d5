"""Announcements by mDNS, on the loopback interface; without the package one warning."""

from __future__ import annotations

import asyncio
import importlib.util
import threading
import uuid

import pytest

from tests.patience import PATIENCE_S
from thymio_sim_ros.network import announcement
from thymio_sim_ros.network.announcement import ASEBA, Announcement, Announcer, aseba_properties

pytestmark = pytest.mark.process


class Browser:
    """What a client on this computer finds."""

    def __init__(self):
        self.found = {}
        self.changed = threading.Event()

    def add_service(self, zeroconf, kind, name):
        self.found[name] = zeroconf.get_service_info(kind, name)
        self.changed.set()

    update_service = add_service

    def remove_service(self, _zeroconf, _kind, name):
        self.found.pop(name, None)
        self.changed.set()

    def wait_for(self, name, *, is_there):
        while (name in self.found) != is_there:
            if not self.changed.wait(PATIENCE_S):
                return False
            self.changed.clear()
        return True


def test_a_service_is_found_with_its_properties_and_withdrawn():
    zeroconf = pytest.importorskip("zeroconf")
    kind = f"_t{uuid.uuid4().hex[:8]}._tcp"
    browser, warnings = Browser(), []
    try:
        client = zeroconf.Zeroconf(interfaces=["127.0.0.1"])
    except OSError as error:
        pytest.skip(f"no multicast on this computer: {error}")

    async def serve():
        announcer = Announcer("localhost", lambda about, text: warnings.append(text))
        announcer.announce("aseba", [Announcement(kind, "r2.d2 on here", 33333, aseba_properties([1, 300]))])
        name = f"r2-d2 on here.{kind}.local."
        assert await asyncio.to_thread(browser.wait_for, name, is_there=True)
        info = browser.found[name]
        await announcer.close()
        assert await asyncio.to_thread(browser.wait_for, name, is_there=False)
        return info

    zeroconf.ServiceBrowser(client, f"{kind}.local.", browser)
    try:
        info = asyncio.run(serve())
    finally:
        client.close()
    assert warnings == []
    assert (info.port, info.parsed_addresses()) == (33333, ["127.0.0.1"])
    assert info.properties == {
        b"txtvers": b"1",
        b"protovers": b"9",
        b"type": b"Thymio II",
        b"ids": b"\x00\x01\x01\x2c",
        b"pids": b"\x00\x08\x00\x08",
    }


@pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning")  # zeroconf leaves a socket open
@pytest.mark.parametrize("address", ["localhost", "203.0.113.9"])
def test_without_package_or_network_there_is_one_warning(monkeypatch, address):
    if address == "localhost":
        real = importlib.util.find_spec
        monkeypatch.setattr(
            announcement.importlib.util, "find_spec", lambda name: None if name == "zeroconf" else real(name)
        )
    else:
        pytest.importorskip("zeroconf")
    warnings = []

    async def serve():
        announcer = Announcer(address, lambda about, text: warnings.append(text))
        for port in (1, 2, 3):
            announcer.announce("aseba", [Announcement(ASEBA, "anna", port)])
            await announcer._task
        await announcer.close()

    asyncio.run(serve())
    assert len(warnings) == 1
    assert warnings[0].startswith("announcement by mDNS: ")
