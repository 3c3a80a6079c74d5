"""Aseba: programs, .aesl files, bytecode, messages of a network, target descriptions."""

from __future__ import annotations

import argparse
import array
import json
from collections.abc import Iterator
from pathlib import Path

from aseba_vm import AsebaError, VirtualMachine, aesl, compile
from aseba_vm.cli.main import _target
from aseba_vm.frontend.formatter import format_program
from aseba_vm.frontend.lexer import KEYWORDS, SYMBOLS, tokenize
from aseba_vm.jit.tiering import INTERPRETER
from aseba_vm.machine import reference
from aseba_vm.machine.interpreter import interpret
from aseba_vm.protocol import FrameReader, NodeClient, decode, encode
from aseba_vm.protocol.errors import ProtocolError
from aseba_vm.target import NativeFunction, Parameter, TargetDescription, Variable
from aseba_vm.targets import THYMIO_II
from tests.fuzz.target import FOLDER, Target, text
from thymio_sim_ros.device.behavior_host import BehaviorHost
from thymio_sim_ros.device.costs import COSTS
from thymio_sim_ros.device.device import AsebaDevice
from thymio_sim_ros.device.network_node import NetworkNode

DATA = Path(__file__).parents[2] / "data"
EVENTS = [("ping", 1), ("pair", 2)]
BUDGET = 300
"""Instructions of one run."""
WORDS = (*sorted(KEYWORDS), *SYMBOLS, "prox.horizontal", "event.args", "math.fill", "32767", "-32768", "0x", "#*", "*#")


_MACHINE = VirtualMachine(THYMIO_II, costs=COSTS, engine=INTERPRETER)
"""As in a robot, natives count by what they do. It takes long to make; a loaded program resets it."""


def _program(data: bytes) -> None:
    source = text(data)
    program = compile(source, THYMIO_II, EVENTS)
    _MACHINE.load(program)
    _MACHINE.run(BUDGET)
    _MACHINE.pop_messages()


def _format(data: bytes) -> None:
    source = text(data)
    once = format_program(source)
    assert format_program(once) == once
    assert [token.text for token in tokenize(once)] == [token.text for token in tokenize(source)]


def _aesl(data: bytes) -> None:
    network = aesl.loads(data)
    again = aesl.dumps(network)
    assert aesl.loads(again).nodes == network.nodes
    aesl.loads(data, strict=True)


def _bytecode(data: bytes) -> None:
    """The quick interpreter and the reference agree on any words."""
    code = array.array("H", data[: len(data) // 2 * 2])[: SMALL.bytecode_size]
    machines = [VirtualMachine(SMALL, engine=INTERPRETER) for _ in range(2)]
    for machine in machines:
        machine.set_bytecode(code)
        machine.resume()
    quick, slow = machines
    spent = interpret(quick, BUDGET) if quick.is_active else 0
    stepped = 0
    while stepped < spent and slow.is_active:
        stepped += reference.step(slow)
    if quick.fault is not None and slow.is_active:
        reference.step(slow)  # an instruction that fails costs nothing
    assert (quick.pc, quick.sp, quick.flags, quick.fault) == (slow.pc, slow.sp, slow.flags, slow.fault)
    assert list(quick.variables) == list(slow.variables)


SMALL = TargetDescription(
    "small", 24, 120, 32, (Variable("_id", 1), Variable("event.source", 1), Variable("event.args", 4)),
    natives=(NativeFunction("math.fill", (Parameter("dest", -1), Parameter("value", 1))),),
)  # fmt: skip


def _frames(data: bytes) -> None:
    reader = FrameReader()
    middle = len(data) // 2
    for frame in [*reader.feed(data[:middle]), *reader.feed(data[middle:])]:
        message = decode(frame)
        assert decode(encode(message)) == message


def _node_client(data: bytes) -> None:
    """What any robot or switch sends to a client."""
    client = NodeClient()
    client.start(0)
    for number, frame in enumerate(FrameReader().feed(data)):
        client.receive(decode(frame))
        client.advance(number * 700_000_000)
        for message in client.pop_messages():
            encode(message)


_HOST = BehaviorHost(AsebaDevice(node_id=3))
"""A device takes long to make; each input starts with its reset."""


def _network_node(data: bytes) -> None:
    """What any tool sends to a robot."""
    node = NetworkNode(_HOST, name="anna", uuid=bytes(range(16)))
    node.connect(1)
    for frame in FrameReader().feed(data):
        for answer in node.handle(1, decode(frame)):
            encode(answer)
        node.install_bytecode()
        _HOST.device.run(BUDGET)
        for answer in node.pop_messages():
            encode(answer)
    node.disconnect(1)


def _target_description(data: bytes) -> None:
    path = FOLDER / "target.json"
    path.write_bytes(data)
    _target(argparse.Namespace(target=str(path)))


def _programs() -> Iterator[bytes]:
    for path in [*sorted((DATA / "programs").rglob("*.aesl")), *sorted((DATA / "runaway").glob("*.aesl"))]:
        content = path.read_text(encoding="utf-8")
        yield (aesl.loads(content).nodes[0].code if aesl.is_aesl(content) else content).encode()


def _files() -> Iterator[bytes]:
    yield (DATA / "device" / "everything.aesl").read_bytes()
    yield (DATA / "network" / "http.aesl").read_bytes()
    yield b'<?xml version="1.0" encoding="latin-1"?><network><node name="thymio-II" nodeId="1">a = 1</node></network>'
    yield (
        '<!DOCTYPE aesl-source><network><keywords flag="true"/><event size="2" name="pair"/><constant value="7" '
        'name="C"/><node nodeId="1" name="thymio-II">var a = C\n<toolsPlugins><x/></toolsPlugins></node></network>'
    ).encode("utf-16")


def _code() -> Iterator[bytes]:
    for source in (
        "var a = 3 var b[4] = [1,2,3,4] while a > 0 do b[a] = -a * 2 / (a - 1) a -= 1 end",
        "var a callsub s sub s a++ onevent pair callsub s",
        "var b[3] call math.fill(b, 7) if b[0] == b[1] and b[2] != 0 then emit ping b[0] end",
        "var a when a == 0 do a = abs(a) | 3 << 2 end for a in 1:9 step 2 do emit pair [a, ~a] end",
    ):
        yield array.array("H", compile(source, SMALL, EVENTS).words).tobytes()


def _recorded() -> Iterator[bytes]:
    yield (DATA / "network" / "playground_description.bin").read_bytes()
    for name in ("asebamassloader", "asebastudio", "thymiodirect"):
        lines = (DATA / "network" / f"{name}.hex").read_text(encoding="ascii").splitlines()
        frames = [bytes.fromhex(line) for line in lines if line.strip() and not line.startswith("#")]
        yield from {frame[4:6]: frame for frame in frames}.values()  # one of each type
        yield b"".join(frames)[:4096]


def _descriptions() -> Iterator[bytes]:
    native = {"name": "beep", "params": [["hertz", 1], ["list", -1]]}
    sizes = {"variables_size": 64, "bytecode_size": 512, "stack_size": 16}
    yield json.dumps(
        {"name": "n", **sizes, "variables": [["a", 1]], "local_events": ["e"], "natives": [native]}
    ).encode()


TARGETS = (
    Target("aseba-program", _program, (AsebaError,), _programs, WORDS, 1024),
    Target("aseba-format", _format, (AsebaError,), _programs, WORDS, 1024),
    Target(
        "aesl", _aesl, (AsebaError,), _files, ("<!DOCTYPE", "<![CDATA[", "&lt;", "&#", "encoding=", "utf-16", "<node")
    ),
    Target("bytecode", _bytecode, (), _code, (), 1024),
    Target("aseba-frames", _frames, (ProtocolError,), _recorded),
    Target("aseba-client", _node_client, (ProtocolError,), _recorded),
    Target("aseba-robot", _network_node, (ProtocolError,), _recorded),
    Target("target-description", _target_description, (AsebaError,), _descriptions),
)
