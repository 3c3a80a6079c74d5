"""Addresses of robots: `tcp:host:port` or `ser:device`, also in the notation of Aseba's tools."""

from __future__ import annotations

import re
from dataclasses import dataclass

from thymio_sim_ros.errors import ThymioSimError

__all__ = ["SerialTarget", "Target", "TargetError", "TcpTarget", "parse_target"]

_HOST = re.compile(r"[^][\s;=/\0-\x1f]+")
_PORT = re.compile("[0-9]{1,5}")
ASEBA_PORT = 33333
"""Port of the first robot (docs/spec/aseba-protocol.md section 1.1)."""


class TargetError(ThymioSimError, ValueError):
    """A text that is no address of a robot."""


@dataclass(frozen=True, slots=True)
class TcpTarget:
    """A robot, switch or playground behind a TCP port."""

    host: str
    port: int

    def __str__(self) -> str:
        host = f"[{self.host}]" if ":" in self.host else self.host
        return f"tcp:{host}:{self.port}"


@dataclass(frozen=True, slots=True)
class SerialTarget:
    """A robot or a wireless dongle on a serial port; an empty device is the first that looks like a Thymio."""

    device: str = ""

    def __str__(self) -> str:
        return f"ser:{self.device}"


Target = TcpTarget | SerialTarget


def parse_target(text: str) -> Target:
    """The address of a robot. Raises TargetError."""
    kind, colon, rest = text.strip().partition(":")
    if kind == "tcp" and colon:
        return _tcp(text, rest)
    if kind == "ser":
        return SerialTarget(rest.removeprefix("device=").strip())
    raise TargetError(
        f"robot '{text}': expected tcp:host:port, such as tcp:localhost:{ASEBA_PORT}, or ser:device, such as "
        "ser:/dev/ttyACM0"
    )


def _tcp(text: str, rest: str) -> TcpTarget:
    host, port = "", ""
    if ";" in rest or "=" in rest:  # host=H;port=P, H;P, H;port=P, port=P
        for place, part in enumerate(rest.split(";")):
            name, equals, value = part.partition("=")
            if not equals:
                name, value = ("host", "port")[min(place, 1)], part
            if name == "host":
                host = value
            elif name == "port":
                port = value
    else:
        host, colon, port = rest.rpartition(":")
        if not colon or rest.endswith("]"):
            host, port = rest, ""
    host = host.strip().removeprefix("[").removesuffix("]") or "localhost"
    if not _HOST.fullmatch(host):
        raise TargetError(f"robot '{text}': found host '{host}', expected a name or an address, as in tcp:[::1]:33333")
    if port and not (_PORT.fullmatch(port) and 1 <= int(port) <= 65535):
        raise TargetError(f"robot '{text}': found port '{port}', expected a number from 1 to 65535")
    return TcpTarget(host, int(port or ASEBA_PORT))
