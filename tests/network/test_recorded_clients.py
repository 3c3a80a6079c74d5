"""What real clients sent, frame by frame, replayed to a robot: nothing is unknown, and it answers as they need it.

tests/data/network/: one frame per line, recorded between Debian's tools 1.6, thymiodirect 0.1.2 and a running suite.
Studio loaded a program, ran it, read variables automatically, paused and stepped.
"""

from __future__ import annotations

from collections import Counter
from pathlib import Path

import pytest

from aseba_vm.protocol import (
    Description,
    ExecutionStateChanged,
    FrameReader,
    GetNodeDescription,
    NativeFunctionDescription,
    NodePresent,
    Run,
    SetBytecode,
    Step,
    UnknownMessage,
    Variables,
    decode,
    encode,
)
from tests.device.test_network_node import Bench
from thymio_sim_ros.device.layout import target

FOLDER = Path(__file__).parent.parent / "data" / "network"


def recorded(name):
    return [bytes.fromhex(line) for line in (FOLDER / f"{name}.hex").read_text().split()]


def replayed(name):
    """The messages of the client and what it gets back, with a run of the machine after each."""
    bench, reader = Bench(node_id=1), FrameReader()
    sent, received = [], []
    for frame in recorded(name):
        for whole in reader.feed(frame):
            sent.append(decode(whole))
            received += bench.send(sent[-1])
            received += bench.run()
            bench.device.pop_commands()
    return bench, sent, received


@pytest.mark.parametrize("name", ["asebamassloader", "thymiodirect", "asebastudio"])
def test_every_frame_is_known_and_the_description_is_complete(name):
    _, sent, received = replayed(name)
    assert not [message for message in sent if isinstance(message, UnknownMessage)]
    assert [encode(message) for message in sent] == recorded(name)
    count = Counter(map(type, received))
    asked = sum(isinstance(message, GetNodeDescription) for message in sent)
    assert asked >= 1
    assert count[NodePresent] >= 1
    assert {message.version for message in received if isinstance(message, NodePresent | Description)} == {5}
    assert count[Description] == asked
    assert count[NativeFunctionDescription] == asked * len(target().natives)


@pytest.mark.parametrize("name", ["asebamassloader", "asebastudio"])
def test_a_loaded_program_runs(name):
    bench, sent, received = replayed(name)
    assert {SetBytecode, Run} <= set(map(type, sent))
    flags = [message.flags for message in received if isinstance(message, ExecutionStateChanged)]
    assert 3 in flags  # loaded, waits
    assert 1 in flags  # runs
    assert bench.host.program.is_foreign


def test_studio_steps_and_reads_all_variables():
    _, sent, received = replayed("asebastudio")
    assert any(isinstance(message, Step) for message in sent)
    longest = max(len(message.values) for message in received if isinstance(message, Variables))
    assert longest >= target().variables_end
