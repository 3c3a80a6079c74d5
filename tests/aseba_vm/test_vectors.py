"""Word by word and record by record, as the reference answers."""

from __future__ import annotations

import pytest

from aseba_vm import CompileError, aesl
from tests.aseba_vm.vectors import Replay, as_answer, as_list, compiled, families, load, targets


@pytest.mark.parametrize("family", families("aseba-compile"))
def test_programs_become_the_words_of_the_reference(family):
    for vector in families("aseba-compile")[family]:
        answer = as_answer(compiled(vector))
        assert {key: answer[key] for key in vector["expect"]} == vector["expect"], vector["id"]


@pytest.mark.parametrize("family", sorted(families("aseba-errors").keys() - {"reference-crash"}))
def test_errors_are_those_of_the_reference(family):
    for vector in families("aseba-errors")[family]:
        expected = vector["expect"]
        with pytest.raises(CompileError) as caught:
            compiled(vector)
        error = caught.value
        place = error.pos and {"offset": error.pos.offset, "row": error.pos.row, "col": error.pos.col}
        found = (error.kind, as_list(error.arguments), place)
        assert found == (expected["kind"], expected["args"], expected["pos"]), vector["id"]
        assert str(error) == expected["message"], vector["id"]


def test_what_stops_the_reference_is_an_error_with_a_place():
    for vector in families("aseba-errors")["reference-crash"]:
        with pytest.raises(CompileError) as caught:
            compiled(vector)
        assert caught.value.pos is not None, vector["id"]


@pytest.mark.parametrize("is_traced", [False, True], ids=["at full speed", "one by one"])
@pytest.mark.parametrize("family", families("aseba-execution"))
def test_programs_run_as_on_the_reference(family, is_traced):
    for vector in families("aseba-execution")[family]:
        _replay(vector, kills_long_events=False, is_traced=is_traced)


@pytest.mark.parametrize("is_traced", [False, True], ids=["at full speed", "one by one"])
def test_long_events_are_killed_as_in_the_fork(is_traced):
    for vector in load("aseba-execution-2x"):
        _replay(vector, kills_long_events=True, is_traced=is_traced)


def _replay(vector, *, kills_long_events, is_traced):
    replay = Replay(vector, kills_long_events=kills_long_events, is_traced=is_traced)
    for number, (operation, expected) in enumerate(zip(vector["script"], vector["expect"], strict=False)):
        record = replay.record(operation)
        shown = expected if is_traced else {key: expected[key] for key in expected.keys() - {"trace", "trace_crc"}}
        assert record == shown, (vector["id"], number, operation)


@pytest.mark.parametrize("vector", load("aseba-aesl"), ids=lambda vector: vector["id"])
def test_files_are_read_compiled_and_written_without_loss(vector):
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
        {"source": node.code, "target": "thymio2", "events": network.events, "constants": network.constants}
    )
    assert list(program.words) == vector["expect"]["bytecode"]
    assert aesl.loads(aesl.dumps(network)) == network


def test_the_target_in_the_package_is_that_of_the_vectors():
    from aseba_vm.targets import THYMIO_II

    described = targets()["thymio2"]
    assert THYMIO_II.variables == described.variables
    assert THYMIO_II.natives == described.natives
    assert [event.name for event in THYMIO_II.local_events] == [event.name for event in described.local_events]
