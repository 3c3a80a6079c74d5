"""What a rosbridge server sends to the nodes of `thymio-sim node`."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache

from tests.fuzz.target import Target, text
from tests.portable_ros.rosbridge.memory_server import Program
from thymio_sim_ros.portable_ros.messages.message_class import message_type, service_type
from thymio_sim_ros.portable_ros.rosbridge.operations import OperationError, decode, encode
from thymio_sim_ros.portable_ros.rosbridge.session import Session
from thymio_sim_ros.ros.foxglove import json_messages

_GRAPH = {
    "op": "graph", "id": "graph", "nodes": [{
        "name": "robot", "namespace": "/",
        "publishers": [["/topic", "std_msgs/msg/String", {"reliability": "reliable", "depth": 10}]],
        "services": [["/add", "example_interfaces/srv/AddTwoInts"]],
    }],
}  # fmt: skip
_OPERATIONS = (
    {"op": "publish", "topic": "/topic", "id": "subscription1", "msg": {"bytes": b"\0\1\0\0\2\0\0\0x\0"}},
    {"op": "publish", "topic": "/topic", "msg": {"data": "x"}},
    {"op": "call_service", "id": "request1", "service": "/add", "args": {"a": 1, "b": 2}},
    {"op": "service_response", "service": "/add", "id": "call1", "values": {"sum": 3}, "result": True},
    {"op": "status", "level": "error", "msg": "no", "id": "call1"},
)


@cache
def _program() -> Program:
    """A program with a subscription, a service and a client."""
    program = Program()
    node = program.node("student")
    node.create_subscription(message_type("std_msgs/msg/String"), "topic", lambda message: None, 10)
    add = service_type("example_interfaces/srv/AddTwoInts")
    node.create_service(add, "add", lambda request, response: response)
    node.create_client(add, "add")
    return program


def _session(data: bytes) -> None:
    """Frames of a server after its graph. A program gets them all: wrong ones are reported."""
    program = _program()
    session = Session(program.graph, json_messages, lambda: None, lambda line: None)
    session.receive(encode(_GRAPH, is_binary=True))
    list(session.frames())
    for part in data.split(b"\n--\n"):
        session.receive(text(part) if part.startswith(b"{") else part)
        list(session.frames())
    session.end()
    decode(text(data) if data.startswith(b"{") else data)


def _frames() -> Iterator[bytes]:
    for operation in (_GRAPH, *_OPERATIONS):
        yield _bytes(encode(operation, is_binary=True))
        if "bytes" not in str(operation):
            yield _bytes(encode(operation, is_binary=False))


def _bytes(frame: str | bytes) -> bytes:
    return frame.encode() if isinstance(frame, str) else frame


TARGETS = (Target("rosbridge-server", _session, (OperationError,), _frames, ('"op"', '"graph"', '"publish"', '"id"')),)
