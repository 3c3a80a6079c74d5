"""The bridge: frames of clients, which reach the switchboard, and frames of servers."""

from __future__ import annotations

from collections.abc import Iterator

from tests.bridge.switchboard.boards import A, B, channel, switchboard
from tests.fuzz.target import Target, text
from thymio_sim_ros.bridge import Capability, ServerInfo
from thymio_sim_ros.bridge.protocol import messages as ms
from thymio_sim_ros.bridge.protocol.constants import StatusLevel
from thymio_sim_ros.bridge.protocol.errors import FrameError
from thymio_sim_ros.bridge.protocol.messages import CLIENT_JSON, SERVER_JSON
from thymio_sim_ros.bridge.protocol.wire import decode_client, decode_server, encode_client, encode_server
from thymio_sim_ros.bridge.rosbridge import frames
from thymio_sim_ros.bridge.rosbridge.fragments import Fragments, split
from thymio_sim_ros.bridge.rosbridge.operations import OPERATIONS, check

_MARK = b"{"
"""A frame that begins with it is text."""


def _frame(data: bytes) -> str | bytes:
    return text(data) if data.startswith(_MARK) else data


def _client(data: bytes) -> None:
    """Frames of a client one after the other, separated by four bytes."""
    board = switchboard(A, B)
    for part in data.split(b"\n--\n"):
        message = decode_client(_frame(part))
        assert decode_client(encode_client(message)) == message
        for delivery in board.receive(A, message).deliveries:
            encode_server(delivery.message)
    board.leave(A)


def _server(data: bytes) -> None:
    message = decode_server(_frame(data))
    assert decode_server(encode_server(message)) == message


def _rosbridge(data: bytes) -> None:
    """Messages of a client of rosbridge; fragments make further ones."""
    fragments = Fragments(1 << 16)
    waiting = [_frame(part) for part in data.split(b"\n--\n")]
    while waiting:
        operation = check(frames.decode(waiting.pop(0)))
        if operation["op"] == "fragment":
            whole = fragments.add(operation)
            waiting += [] if whole is None else [whole]


def _from_client() -> Iterator[bytes]:
    yield b"\n--\n".join((
        b'{"op":"subscribe","subscriptions":[{"id":1,"channelId":10}]}', b'{"op":"unsubscribe","subscriptionIds":[1]}',
    ))  # fmt: skip
    yield b"\n--\n".join((
        b'{"op":"advertise","channels":[{"id":1,"topic":"/cmd_vel","encoding":"cdr","schemaName":"geometry_msgs/Twist"}]}',
        b"\x01\x01\x00\x00\x00payload", b'{"op":"unadvertise","channelIds":[1]}',
    ))  # fmt: skip
    yield b'{"op":"setParameters","parameters":[{"name":"/a.b","value":[1,2.5],"type":"float64_array"}],"id":"x"}'
    yield b'{"op":"getParameters","parameterNames":["/a.b"],"id":"x"}'
    yield b'{"op":"subscribeConnectionGraph"}\n--\n{"op":"fetchAsset","uri":"package://a/b.stl","requestId":3}'
    yield encode_client(ms.ServiceRequest(5, 1, "cdr", b"\0\1\0\0"))  # type: ignore[misc]


def _from_ros() -> Iterator[bytes]:
    yield b'{"op":"subscribe","topic":"/a","throttle_rate":5,"compression":"cbor","qos":{"depth":1},"id":7}'
    yield b'{"op":"call_service","service":"/a","args":[1],"timeout":0.5}\n--\n{"op":"set_level","level":"none"}'
    publish = {"op": "publish", "topic": "/a", "msg": {"bytes": b"\0\1\0\0"}, "id": "p"}
    yield frames.as_cbor(publish)
    parts = split(frames.as_json({**publish, "msg": {"data": "x" * 200}}), 100, "f")
    yield b"\n--\n".join(frames.as_json(part).encode() for part in parts)


def _from_server() -> Iterator[bytes]:
    yield encode_server(ms.MessageData(1, 2, b"payload"))  # type: ignore[misc]
    yield encode_server(ms.AssetResponse(1, b"data", None))  # type: ignore[misc]
    side = ms.ServiceSide("cdr", "std_srvs/srv/Empty_Request", "ros2msg", "")
    for message in (
        ms.Advertise((channel(1),)), ms.Unadvertise((1,)), ms.Status(StatusLevel.ERROR, "no"), ms.Time(5),
        ms.AdvertiseServices((ms.Service(5, "/s", "std_srvs/srv/Empty", side, side),)),
        ms.ParameterValues((ms.Parameter("/a.b", (1, 2.5), "float64_array"),), "x"),
        ServerInfo("test", tuple(Capability), ("cdr", "json"), session_id="first"),
    ):  # fmt: skip
        frame = encode_server(message)
        yield frame if isinstance(frame, bytes) else frame.encode()


TARGETS = (
    Target("bridge-client", _client, (FrameError,), _from_client, tuple(f'"{shape.op}"' for shape in CLIENT_JSON)),
    Target("bridge-rosbridge", _rosbridge, (FrameError,), _from_ros, tuple(f'"{name}"' for name in OPERATIONS)),
    Target("bridge-server", _server, (FrameError,), _from_server, tuple(f'"{shape.op}"' for shape in SERVER_JSON)),
)
