"""The reference vectors, word by word and record by record."""

from __future__ import annotations

import pytest

from aseba_vm import CompileError, aesl
from aseba_vm.jit.tiering import INTERPRETER
from aseba_vm.targets import THYMIO_II
from tests.aseba_vm.engines import AVAILABLE
from tests.aseba_vm.vectors import Replay, as_answer, as_list, compiled, targets

TRACED = "one by one"


@pytest.mark.vectors("aseba-compile")
def test_a_program_becomes_the_words_of_the_reference(vector):
    answer = as_answer(compiled(vector))
    assert {key: answer[key] for key in vector["expect"]} == vector["expect"]


@pytest.mark.vectors("aseba-errors", crashes=False)
def test_an_error_is_that_of_the_reference(vector):
    expected = vector["expect"]
    with pytest.raises(CompileError) as caught:
        compiled(vector)
    error = caught.value
    place = error.pos and {"offset": error.pos.offset, "row": error.pos.row, "col": error.pos.col}
    assert (error.kind, as_list(error.arguments), place) == (expected["kind"], expected["args"], expected["pos"])
    assert str(error)


@pytest.mark.vectors("aseba-errors", crashes=True)
def test_what_stops_the_reference_is_an_error_with_a_place(vector):
    with pytest.raises(CompileError) as caught:
        compiled(vector)
    assert caught.value.pos is not None


@pytest.mark.parametrize("engine", [*AVAILABLE, TRACED])
@pytest.mark.vectors("aseba-execution")
def test_a_program_runs_as_on_the_reference(vector, engine):
    _replay(vector, kills_long_events=False, engine=engine)


@pytest.mark.parametrize("engine", [*AVAILABLE, TRACED])
@pytest.mark.vectors("aseba-execution-2x")
def test_long_events_are_killed_as_in_the_fork(vector, engine):
    _replay(vector, kills_long_events=True, engine=engine)


def _replay(vector, *, kills_long_events, engine):
    is_traced = engine == TRACED
    replay = Replay(vector, kills_long_events=kills_long_events, is_traced=is_traced)
    replay.machine.use_engine(INTERPRETER if is_traced else engine)
    for number, (operation, expected) in enumerate(zip(vector["script"], vector["expect"], strict=False)):
        record = replay.record(operation)
        shown = expected if is_traced else {key: expected[key] for key in expected.keys() - {"trace", "trace_crc"}}
        assert record == shown, (number, operation)


@pytest.mark.vectors("aseba-aesl")
def test_a_file_is_read_compiled_and_written_without_loss(vector):
    network = aesl.loads(vector["file"])
    flags = {None: None, True: "true", False: "false"}
    found = {
        "events": as_list(network.events),
        "constants": as_list(network.constants),
        "keywords": flags[network.keywords],
        "nodes": [
            {
                "name": node.name,
                "nodeId": node.node_id,
                "code": node.code,
                "plugins": [[plugin.name, plugin.element] for plugin in node.plugins],
            }
            for node in network.nodes
        ],
    }
    assert found == vector["expect"]["parsed"]
    node = network.node(vector["node"], 1)
    program = compiled(
        vector | {"source": node.code, "target": "thymio2", "events": network.events, "constants": network.constants}
    )
    assert list(program.words) == vector["expect"]["bytecode"]
    assert aesl.loads(aesl.dumps(network)) == network


def test_the_target_in_the_package_is_that_of_the_vectors():
    described = targets()["thymio2"]
    assert THYMIO_II.variables == described.variables
    assert THYMIO_II.natives == described.natives
    assert [event.name for event in THYMIO_II.local_events] == [event.name for event in described.local_events]
