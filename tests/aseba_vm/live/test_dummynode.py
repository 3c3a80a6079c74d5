"""Bytecode of this package on the reference's machine: Debian's asebadummynode ends with the same variables."""

from __future__ import annotations

import re
import shutil
import socket
import struct
import subprocess
from collections.abc import Iterator

import pytest

from aseba_vm import TargetDescription, Variable, VirtualMachine, compile
from aseba_vm.targets import THYMIO_II
from tests.aseba_vm.live.wire import (
    GET_VARIABLES,
    LIST_NODES,
    PRESENT,
    RUN,
    SET_BYTECODE,
    STATE,
    VARIABLES,
    Wire,
)
from tests.patience import PATIENCE_S

pytestmark = [
    pytest.mark.process,
    pytest.mark.skipif(shutil.which("asebadummynode") is None, reason="Debian's package aseba is not installed"),
]

NATIVES = tuple(native for native in THYMIO_II.natives if native.name.startswith(("math.", "deque.")))
#: Sizes as the node announces them; its own variables, among the first words, are not named here.
DUMMY = TargetDescription("dummynode-0", 1060, 512, 64, (Variable("own", 100),), (), NATIVES)

PROGRAMS = {
    "arithmetic": "var a = 7  var b = -3  var c[6]  c = [a+b, a-b, a*b, a/b, a%b, -a]",
    "wrap": "var a = 32767  var b = -32768  var c  var d  a++  b--  c = b * b  d = a << 3",
    "bits": "var a = 0x0ff0  var b[6]  b = [a | 1, a & 0xff, a ^ -1, ~a, a >> 4, a << 4]",
    "comparisons": "var a = 3  var b = 0  if a > 2 and a != 4 or a == 9 then b = 1 else b = 2 end",
    "loops": "var i  var s = 0  for i in 1:10 do s += i end  while s > 3 do s -= 7 end",
    "arrays": "var a[4] = [1,2,3,4]  var i = 2  a[i] = a[i-1] * 5  a[0:1] = a[2:3] + [10, 20]",
    "subroutines": "var a = 1  callsub twice  callsub twice  sub twice  a = a * 2",
    "mathematics": "var a = 100  var r  var s[3] = [3,1,2]  call math.sqrt(r, a)  call math.sort(s)",
    "filling": "var a[4]  var b[4]  call math.fill(a, 7)  call math.copy(b, a)  call math.muldiv(b, a, a, [3,3,3,3])",
    "trigonometry": "var a[2]  call math.sin(a[0], 8192)  call math.atan2(a[1], 5, -7)",
    "a fault": "var a = 1  var b = 0  a = 5 / b  a = 9",
    "an index outside": "var a[2] = [1,2]  var i = 5  a[i] = 3  i = 9",
    "when": "var a = 1  var b = 0  when a > 0 do b = 1 end",
}


@pytest.fixture
def node() -> Iterator[tuple[Wire, int]]:
    """A new dummy node on a port of its choice. Its description is not requested: Debian's crashes on that message."""
    command = ["asebadummynode", "--port", "0", "0"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True, bufsize=1) as process:
        try:
            assert process.stdout is not None
            port = int(re.search(r"port=(\d+)", process.stdout.readline()).group(1))
            with socket.create_connection(("127.0.0.1", port), PATIENCE_S) as stream:
                wire = Wire(stream)
                wire.send_words(0, LIST_NODES, 5)
                yield wire, wire.wait_for(PRESENT).source
        finally:
            process.kill()


@pytest.mark.parametrize("name", PROGRAMS)
def test_the_reference_ends_with_our_variables(node, name):
    wire, number = node
    program = compile(PROGRAMS[name], DUMMY)
    machine = VirtualMachine(DUMMY, node_id=number)
    machine.load(program)
    machine.run()
    first, count = DUMMY.variables_end, program.allocated - DUMMY.variables_end

    wire.send_words(0, SET_BYTECODE, number, 0, *program.words)
    wire.wait_for(STATE)
    wire.send_words(0, RUN, number)
    wire.wait_for(STATE)

    expected = tuple(machine.variables[first : first + count])
    assert _settled(wire, number, first, count, expected) == expected


def _settled(wire, number, first, count, expected):
    """Request the variables until they are as expected, at most a fixed number of times."""
    for _ in range(200):
        wire.send_words(0, GET_VARIABLES, number, first, count)
        payload = wire.wait_for(VARIABLES).payload
        found = struct.unpack(f"<{len(payload) // 2 - 1}h", payload[2:])
        if found == expected:
            break
    return found
