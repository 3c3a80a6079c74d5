"""A remote robot as a node for other clients, which may load programs."""

from __future__ import annotations

import pytest

from aseba_vm import compile
from aseba_vm.protocol import (
    ExecutionStateChanged,
    GetVariables,
    ListNodes,
    NodePresent,
    Pause,
    Run,
    SetBytecode,
    SetVariables,
    UserMessage,
    Variables,
)
from aseba_vm.protocol.requests import set_bytecode
from tests.device.remote.pair import Pair
from thymio_sim_ros.device.layout import target
from thymio_sim_ros.device.network_events import EmittedEvent
from thymio_sim_ros.device.programs.foreign import FOREIGN
from thymio_sim_ros.sim.commands import SetLeds

CLIENT = 5


@pytest.fixture
def pair() -> Pair:
    """A robot that has connected and runs a program; another client is there."""
    pair = Pair()
    pair.plug_in()
    pair.robot.host.load(pair.load("var n = 4\nonevent ping\nemit pong n\n", ("ping", 0), ("pong", 1)))
    pair.exchange()
    pair.robot.gateway.connect(CLIENT)
    return pair


def ask(pair: Pair, *messages):
    """Send messages of the client; return what clients get."""
    for message in messages:
        assert pair.robot.gateway.handle(CLIENT, message) == []
    pair.robot.gateway.install_bytecode()
    pair.exchange()
    return pair.robot.gateway.pop_messages()


def test_questions_are_answered_by_the_robot(pair: Pair) -> None:
    assert ask(pair, ListNodes(0, 5)) == [NodePresent(3, 5)]
    address, _ = pair.remote.variables.addresses()["n"]
    assert ask(pair, GetVariables(0, 3, address, 1)) == [Variables(3, address, (4,))]


def test_events_of_the_robot_go_to_clients_too(pair: Pair) -> None:
    assert ask(pair, UserMessage(0, 0, ())) == [UserMessage(3, 1, (4,))]
    assert pair.remote.pop_events() == [EmittedEvent("pong", (4,))]


def test_variables_that_a_client_writes_are_seen(pair: Pair) -> None:
    address, _ = pair.remote.variables.addresses()["n"]
    ask(pair, SetVariables(0, 3, address, (77,)))
    pair.tick()
    assert pair.remote.variables.get("n") == (77,)


def test_a_client_controls_the_machine(pair: Pair) -> None:
    (answer,) = ask(pair, Pause(0, 3))
    assert isinstance(answer, ExecutionStateChanged)
    assert answer.flags == 2
    assert pair.remote.status.state == "paused"
    ask(pair, Run(0, 3))
    assert pair.remote.status.state == "running"
    pair.remote.run_control.stop()
    pair.exchange()
    ask(pair, Run(0, 3))
    assert pair.remote.status.state == "running"


def test_a_program_of_a_client_becomes_that_of_the_robot(pair: Pair) -> None:
    words = compile(
        "motor.left.target = 90\nonevent prox\nemit e 7", target(pair.remote.layout), events=[("e", 1)]
    ).words
    ask(pair, *set_bytecode(3, words), Run(0, 3))
    assert pair.value("motor.left.target") == (90,)
    program = pair.robot.host.program
    assert (program.name, program.is_foreign, program.events[0][0]) == (FOREIGN, True, "ping")
    with pytest.raises(ValueError, match="another client has loaded its program"):
        pair.robot.execute(SetLeds("top", (1, 2, 3)), 0)
    pair.robot.host.load(pair.load("var m = 1"))
    pair.exchange()
    pair.robot.execute(SetLeds("top", (1, 2, 3)), 0)
    pair.exchange()
    assert SetLeds("top", (1, 2, 3)) in pair.commands
    assert not pair.robot.host.program.is_foreign


def test_the_program_that_is_known_stays_when_a_client_loads_it_again(pair: Pair) -> None:
    program = pair.robot.host.program
    words = pair.remote._session.program.program.words
    ask(pair, *set_bytecode(3, words), Run(0, 3))
    assert pair.robot.host.program is program
    assert pair.remote.declares("ping")


def test_bytecode_beyond_the_memory_and_other_nodes_are_ignored(pair: Pair) -> None:
    program = pair.robot.host.program
    assert ask(pair, SetBytecode(0, 3, 65000, (1, 2)), SetBytecode(0, 9, 0, (1, 2)), Pause(0, 9)) == []
    assert pair.robot.host.program is program


def test_without_clients_nothing_is_kept(pair: Pair) -> None:
    pair.robot.gateway.disconnect(CLIENT)
    pair.tick(5)
    assert pair.robot.gateway.pop_messages() == []
    pair.pull()
    assert pair.robot.gateway.handle(CLIENT, ListNodes(0, 5)) == []
