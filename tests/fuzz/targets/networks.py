"""Servers and links of the network: Thymio Device Manager, HTTP interface, addresses, tokens."""

from __future__ import annotations

import asyncio
import contextlib
import json
from collections.abc import Iterator
from pathlib import Path

from aseba_vm.targets import THYMIO_II
from tests.fuzz.target import Target, lines, text
from tests.fuzz.targets.aseba import WORDS, _files
from tests.network.tdm.machine_node import MachineNode
from tests.network.tdm.talk import Talk
from thymio_sim_ros.access import AccessCheck, AccessRules, HostNames, RefusedError, Tokens, TrustedProxies
from thymio_sim_ros.network.http.programs import NodeToLoad, compile_file
from thymio_sim_ros.network.http.requests import parse_request
from thymio_sim_ros.network.robot_target import TargetError, parse_target
from thymio_sim_ros.network.tdm.protocol.codec import StreamReader, decode, encode, framed
from thymio_sim_ros.network.tdm.protocol.errors import TdmFrameError, ValueTypeError
from thymio_sim_ros.network.tdm.protocol.values import decode_value, encode_value

REQUESTS = Path(__file__).parents[2] / "data" / "network" / "tdm_requests.json"


def _buffer(data: bytes) -> None:
    message = decode(data)
    assert repr(decode(encode(message))) == repr(message)  # NaN differs from itself


def _stream(data: bytes) -> None:
    """A client of the device manager: everything that it sends by TCP, after a handshake."""
    talk = Talk(MachineNode())
    talk.join(1)
    reader = StreamReader()
    for buffer in [*reader.feed(data[:7]), *reader.feed(data[7:])]:
        talk.send(1, decode(buffer))


def _value(data: bytes) -> None:
    words = decode_value(data)
    assert decode_value(encode_value(words)) == words


def _http_request(data: bytes) -> None:
    method, path, body = lines(data, 3)
    parse_request(method.decode("latin-1"), path.decode("latin-1"), body)


def _http_program(data: bytes) -> None:
    compile_file(data, [NodeToLoad((0, 1), 1, THYMIO_II, "")])


def _address(data: bytes) -> None:
    found = parse_target(text(data))
    assert parse_target(str(found)) == found


def _headers(data: bytes) -> None:
    """The headers of a web page that a browser has opened."""
    path, bearer, origin, host = (part.decode("latin-1") for part in lines(data, 4))
    sent = {"Authorization": bearer, "Origin": origin, "Host": host}
    sent |= {"X-Forwarded-For": bearer, "X-Forwarded-Host": host}
    visitor = TrustedProxies(["127.0.0.1"]).visitor("127.0.0.1", lambda name: [sent.get(name, "")], target=path)
    for rules in (AccessRules(host_names=HostNames.UNOWNED), AccessRules(Tokens("secret-token", "reader-token"))):
        with contextlib.suppress(RefusedError):
            asyncio.run(AccessCheck(rules, lambda about, text: None, now_s=lambda: 0.0).admit(visitor))


def _recorded() -> Iterator[bytes]:
    for buffers in json.loads(REQUESTS.read_text(encoding="utf-8")).values():
        yield from map(bytes.fromhex, buffers)


def _streams() -> Iterator[bytes]:
    for buffers in json.loads(REQUESTS.read_text(encoding="utf-8")).values():
        yield b"".join(framed(bytes.fromhex(buffer)) for buffer in buffers)[:4096]


def _values() -> Iterator[bytes]:
    yield from (encode_value(words) for words in ((), (1,), (-32768, 32767, 300), tuple(range(100))))
    yield b"\x05\x04\x01"


def _requests() -> Iterator[bytes]:
    yield b"GET\n/nodes/thymio-II/prox.horizontal?todo=3"
    yield b'POST\n/nodes/1/list\n[7, 8.5, "9"]'
    yield b"PUT\n/nodes/1\nfile=<!DOCTYPE aesl-source><network/>"
    yield b"GET\n/events/pong?todo=1"


TARGETS = (
    Target("tdm-message", _buffer, (TdmFrameError,), _recorded),
    Target("tdm-stream", _stream, (TdmFrameError,), _streams),
    Target("tdm-value", _value, (ValueTypeError,), _values),
    Target("http-request", _http_request, (RefusedError,), _requests, ("/nodes", "/events", "reset", "?todo=", "%2F")),
    Target("http-program", _http_program, (RefusedError,), _files, WORDS),
    Target("robot-address", _address, (TargetError,), lambda: [b"tcp:host=a;port=33333", b"ser:/dev/ttyACM0"]),
    Target("http-headers", _headers, (), lambda: [b"/?token=abcd\nBearer abcd\nhttp://[::1]:80\nlocalhost:80"]),
)
