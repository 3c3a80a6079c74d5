"""Announces services by mDNS, so that tools find them without an address. Only for the thread of the event loop.

A server on loopback is announced on the loopback interface only, where programs of this computer may find it: elsewhere
its address would mean another computer. Without the package `zeroconf`, or without a network, one warning is
reported and the servers work as before.

Source: docs/spec/aseba-protocol.md sections 1.6 and 2.1.
"""

from __future__ import annotations

import asyncio
import importlib.util
import ipaddress
import socket
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from zeroconf.asyncio import AsyncServiceInfo, AsyncZeroconf

from aseba_vm.protocol import PROTOCOL_VERSION

__all__ = ["ASEBA", "DEVICE_MANAGER", "Announcement", "Announcer", "aseba_properties"]

ASEBA, DEVICE_MANAGER = "_aseba._tcp", "_mobsya._tcp"
"""Types of services."""

PRODUCT_ID = 8
"""The number of a Thymio II among the products."""

_MAX_NAME = 63
"""Bytes of a name, a limit of DNS."""


Properties = tuple[tuple[str, str | bytes], ...]
"""Names and values of the properties of a service."""


@dataclass(frozen=True, slots=True)
class Announcement:
    """A service: type such as `_aseba._tcp`, name shown to users, port, and properties."""

    type: str
    name: str
    port: int
    properties: Properties = ()


def aseba_properties(nodes: Sequence[int], version: int = PROTOCOL_VERSION) -> Properties:
    """The properties of an Aseba port with these nodes: simulated Thymios. Numbers are big-endian words."""
    return (
        ("txtvers", "1"),
        ("protovers", str(version)),
        ("type", "Thymio II"),
        ("ids", b"".join(node.to_bytes(2, "big") for node in nodes)),
        ("pids", PRODUCT_ID.to_bytes(2, "big") * len(nodes)),
    )


class Announcer:
    """Keeps the announcements of one address up to date. `report` takes a subject and a warning."""

    def __init__(self, address: str, report: Callable[[str, str], None]) -> None:
        """`address`: where the servers listen, `localhost` or an IPv4 address; nothing is sent before `announce`."""
        self._address = "127.0.0.1" if address == "localhost" else address
        self._report = report
        self._wanted: dict[str, tuple[Announcement, ...]] = {}
        self._known: dict[Announcement, AsyncServiceInfo] = {}
        self._zeroconf: AsyncZeroconf | None = None
        self._task: asyncio.Task[None] | None = None
        self._is_outdated = False
        self._is_broken = False

    def announce(self, server: str, announcements: Sequence[Announcement]) -> None:
        """Replace the announcements of one server; returns at once, the messages follow."""
        self._wanted[server] = tuple(announcements)
        self._is_outdated = True
        if self._task is None or self._task.done():
            self._task = asyncio.get_running_loop().create_task(self._update())

    async def close(self) -> None:
        """Withdraw all announcements."""
        for server in self._wanted:
            self.announce(server, ())
        if self._task is not None:
            await self._task
        if self._zeroconf is not None:
            await self._zeroconf.async_close()
            self._zeroconf = None

    async def _update(self) -> None:
        while self._is_outdated and not self._is_broken:
            self._is_outdated = False
            wanted = {announcement for group in self._wanted.values() for announcement in group}
            if not wanted and not self._known:
                return
            try:
                await self._change(wanted)
            except Exception as error:  # the network is not ours: whatever fails, the servers go on
                self._is_broken = True
                self._report("announcement", f"announcement by mDNS: {error!r}; tools need the address of the servers")

    async def _change(self, wanted: set[Announcement]) -> None:
        zeroconf = self._open()
        if zeroconf is None:
            return
        for announcement in [known for known in self._known if known not in wanted]:
            await (await zeroconf.async_unregister_service(self._known.pop(announcement)))
        for announcement in sorted(wanted - self._known.keys(), key=lambda entry: (entry.type, entry.port, entry.name)):
            info = self._info(announcement)
            await (await zeroconf.async_register_service(info, allow_name_change=True))
            self._known[announcement] = info

    def _open(self) -> AsyncZeroconf | None:
        if self._zeroconf is None:
            if importlib.util.find_spec("zeroconf") is None:
                self._is_broken = True
                self._report("announcement", "announcement by mDNS: off, as the package zeroconf is not installed")
                return None
            from zeroconf import InterfaceChoice, IPVersion
            from zeroconf.asyncio import AsyncZeroconf

            is_any = ipaddress.ip_address(self._address).is_unspecified
            interfaces = InterfaceChoice.All if is_any else [self._address]
            self._zeroconf = AsyncZeroconf(interfaces=interfaces, ip_version=IPVersion.V4Only)
        return self._zeroconf

    def _info(self, announcement: Announcement) -> AsyncServiceInfo:
        from zeroconf.asyncio import AsyncServiceInfo

        # A dot in a name would begin the next part of a domain name for some clients.
        name = announcement.name.replace(".", "-").encode()[:_MAX_NAME].decode(errors="ignore")
        kind = f"{announcement.type}.local."
        return AsyncServiceInfo(
            kind,
            f"{name}.{kind}",
            port=announcement.port,
            properties=dict(announcement.properties),
            server=f"{socket.gethostname().partition('.')[0]}.local.",
            addresses=[ipaddress.ip_address(address).packed for address in self._addresses()],
        )

    def _addresses(self) -> list[str]:
        if not ipaddress.ip_address(self._address).is_unspecified:
            return [self._address]
        from thymio_sim_ros.names.addresses import own_address

        try:
            return [str(ipaddress.ip_address(own_address()))]
        except ValueError:  # no network
            return ["127.0.0.1"]
