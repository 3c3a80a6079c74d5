"""What real clients sent, recorded on a run of the live tests, and our answers: these tests need no client.

`tests/data/network/tdm_requests.json` has the messages of `tests/data/network/tdm_client.js` with the JavaScript client
0.11.1, and of the script in `test_tdmclient` with tdmclient 0.1.21, as hexadecimal bytes.
"""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from tests.network.tdm.machine_node import MachineNode
from tests.network.tdm.talk import Talk, values
from thymio_sim_ros.network.tdm.protocol import messages as m
from thymio_sim_ros.network.tdm.protocol.codec import decode

RECORDED = Path(__file__).parents[3] / "data" / "network" / "tdm_requests.json"


def _replay(client: str) -> tuple[Talk, list[str]]:
    """Send the messages; return the types of the answers to requests, in order."""
    talk = Talk()
    talk.is_silent = True  # so that the ids are those of the run: both groups, then both nodes
    talk.add_network([MachineNode()])
    talk.add_network([MachineNode()])
    talk.is_silent = False
    talk.advance(1500)
    talk.manager.join(1, is_local=True)
    for buffer in json.loads(RECORDED.read_text())[client]:
        talk.send(1, decode(bytes.fromhex(buffer)))
        for network in talk.networks:
            talk.run(network)
    talk.advance(200)
    answers = [type(message).__name__ for message in talk.received[1] if getattr(message, "request_id", 0)]
    return talk, answers


DONE = "RequestCompleted"


@pytest.mark.parametrize(
    ("client", "expected"),
    [
        (
            "javascript",
            [*[DONE] * 5, "CompilationResultFailure", "CompilationResultSuccess", *[DONE] * 8],
        ),
        (
            "tdmclient",
            [
                *(DONE, DONE, "NodeAsebaVMDescription", DONE, "CompilationResultFailure", DONE),
                *("CompilationResultSuccess", DONE, DONE, DONE, "Error", DONE, DONE),
            ],
        ),
    ],
)
def test_each_recorded_request_has_its_answer(client: str, expected: list[str]) -> None:
    _, answers = _replay(client)
    assert answers == expected


def test_the_recorded_events_are_answered_by_the_programs() -> None:
    javascript, _ = _replay("javascript")
    assert values(javascript.take(1, m.EventsEmitted)[0]) == {"doubled": (42,)}
    assert javascript.networks[0][0].name == "mine"
    python, _ = _replay("tdmclient")
    assert values(python.take(1, m.EventsEmitted)[0]) == {"seen": (7, -20)}
    assert python.networks[1][0].value("acc") == (1, 2, 3)
