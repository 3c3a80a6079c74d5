"""Requests against robots in memory, and against what Debian's asebahttp has answered.

`tests/data/network/asebahttp.json` and `asebahttp2.json` are exchanges with asebahttp 1.6 and asebahttp2, connected to
Aseba Playground; each group begins with a fresh playground.
"""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from aseba_vm import compile
from aseba_vm.protocol import Disconnected, NodeClient, UserMessage, Variables
from tests.network.http.robots import Robot
from thymio_sim_ros.access import RefusedError
from thymio_sim_ros.device.layout import target
from thymio_sim_ros.network.http import gateway as limits
from thymio_sim_ros.network.http import streams
from thymio_sim_ros.network.http.gateway import Gateway
from thymio_sim_ros.network.http.programs import compile_file
from thymio_sim_ros.network.http.replies import Definitions, Reply, refusal
from thymio_sim_ros.network.http.requests import LoadProgram, StreamEvents, parse_request

DATA = Path(__file__).parents[2] / "data" / "network"
PROGRAM = (DATA / "http.aesl").read_bytes()
RECORDED = json.loads((DATA / "asebahttp.json").read_text())
OTHER = compile("", target())
"""A program without names."""
SECOND_NS = 10**9
N = "/nodes/thymio-II"


class Bench:
    """A gateway with robots, each on a network of its own."""

    def __init__(self, *names: str, ids: tuple[int, ...] = ()) -> None:
        self.gateway = Gateway()
        self.now_ns = 0
        self.robots, self.clients = [], []
        for index, name in enumerate(names):
            node_id = ids[index] if ids else 1
            self.robots.append(Robot(node_id))
            self.clients.append(NodeClient())
            self.gateway.add_network(self.clients[-1], name)
        for client in self.clients:
            client.start(0)
        self.run()

    def run(self, rounds: int = 4) -> None:
        """Exchange messages until nothing is left to say."""
        for _ in range(rounds):
            for index, (robot, client) in enumerate(zip(self.robots, self.clients, strict=True)):
                robot.inbox.extend(client.pop_messages())
                for message in robot.run():
                    self.gateway.receive(index, message)

    def advance(self, seconds: float) -> None:
        self.now_ns += int(seconds * SECOND_NS)
        self.gateway.advance(self.now_ns)

    def ask(self, method: str, target: str, body: bytes = b"") -> Reply:
        """The reply to a request; the robots run until it is there."""
        found: list[Reply] = []
        try:
            self.begin(method, target, body, found)
        except RefusedError as error:
            return refusal(error)
        self.run()
        assert len(found) == 1
        return found[0]

    def begin(self, method: str, target: str, body: bytes, found: list[Reply]) -> None:
        action = parse_request(method, target, body)
        if isinstance(action, LoadProgram):
            self.gateway.load(compile_file(action.text, self.gateway.nodes_to_load(action)), found.append)
        else:
            self.gateway.start(action, found.append)

    def open(self, target: str) -> list[bytes | None]:
        """The events of a stream from now on."""
        action = parse_request("GET", target, b"")
        assert isinstance(action, StreamEvents)
        found: list[bytes | None] = []
        self.gateway.subscribe(action, found.append)
        return found


@pytest.fixture
def one():
    return Bench("")


@pytest.fixture
def two():
    return Bench("anna", "bert")


NOT_NUMBERS = "expected an array of numbers, as in [100, -100]\n"
NO_NODE = "no node 'nope'; expected 1 (thymio-II)\n"
NO_NAME = "no variable and no event 'nope' on this node\n"

DIFFERENCES = {
    # What the reference carries out in part, carries out wrongly, or ignores while it says 204, is an error.
    ("set", 5): (400, "found 'x' among the values, expected numbers\n"),
    ("set", 6): (200, "[-6,5,3]"),
    ("set", 13): (400, NOT_NUMBERS),
    ("set", 15): (400, f"the body is not JSON; {NOT_NUMBERS}"),
    ("set", 19): (400, NOT_NUMBERS),
    ("set", 21): (400, "list: found 0 values, expected 1 to 3\n"),
    ("set", 23): (204, ""),
    ("set", 24): (200, "[1,-2,3]"),
    ("set", 25): (400, "found 70000, expected a number of 16 bits, -32768..32767\n"),
    ("set", 26): (200, "[1,-2,3]"),
    ("set", 28): (200, "[6,6,3]"),
    ("set", 30): (200, "[3,3,3]"),
    ("set_long", 1): (400, "list: found 4 values, expected 1 to 3\n"),
    ("set_long_post", 1): (400, "list: found 6 values, expected 1 to 3\n"),
    ("set_unknown", 1): (404, NO_NAME),
    ("set_unknown", 2): (404, NO_NAME),
    ("put_other", 0): (404, NO_NODE),
    # A file for all nodes is loaded, as by asebahttp2.
    ("put_all", 1): (200, "[1,2,3]"),
    # The reference does not answer.
    ("unknown", 0): (404, NO_NODE),
    ("unknown", 1): (404, NO_NODE),
    ("unknown", 2): (404, NO_NODE),
    # Queries are allowed everywhere (?token=), and a method is an error where it means nothing.
    ("read", 8): (200, "[0,0,0]"),
    ("nodes", 12): (405, "POST is not possible here; expected GET or PUT\n"),
    # The firmware that is simulated.
    ("read", 0): (200, "[14,1]"),
}
"""Status and body, by group and place in it, where they differ from those of the reference on purpose."""

BODIES = {"(program)": PROGRAM, "(program with an error)": PROGRAM.replace(b"counter = ", b"counter == ")}
REPLAYED = [
    (group, [exchange for exchange in exchanges if exchange["method"] in ("GET", "POST", "PUT")])
    for group, exchanges in RECORDED.items()
    if group != "streams"
]


def answered(bench, exchange):
    """The reply to a recorded request; that of a stream is empty."""
    body = exchange.get("body", "")
    if "/events" not in exchange["target"]:
        return bench.ask(exchange["method"], exchange["target"], BODIES.get(body, body.encode()))
    try:
        bench.open(exchange["target"])
    except RefusedError as error:
        return refusal(error)
    return Reply(200)


def comparable(reply):
    """A JSON value without what depends on the robot: its version, and names that the playground does not have."""
    if isinstance(reply, dict):
        named = {**reply, "namedVariables": None, "localEvents": None, "variablesSize": None, "protocolVersion": None}
        return {name: named[name] for name in reply}
    return [comparable(item) if isinstance(item, dict) else item for item in reply]


@pytest.mark.parametrize(("group", "exchanges"), REPLAYED, ids=[group for group, _ in REPLAYED])
def test_requests_are_answered_as_by_the_reference(one, group, exchanges):
    for place, exchange in enumerate(exchanges):
        reply = answered(one, exchange)
        if (group, place) in DIFFERENCES:
            assert (reply.status, reply.body.decode()) == DIFFERENCES[group, place], exchange
            continue
        assert reply.status == exchange["status"], exchange
        if exchange["reply"].startswith(("[", "{")):
            assert comparable(json.loads(reply.body)) == comparable(json.loads(exchange["reply"])), exchange


def test_a_description_has_at_least_the_names_of_the_reference(one):
    one.ask("PUT", N, PROGRAM)
    theirs = json.loads(RECORDED["put"][1]["reply"])
    ours = json.loads(one.ask("GET", N).body)
    assert theirs["namedVariables"].items() <= ours["namedVariables"].items()
    assert list(theirs["localEvents"]) == list(ours["localEvents"])[: len(theirs["localEvents"])]
    assert list(ours["namedVariables"]) == sorted(ours["namedVariables"])
    assert list(ours) == list(theirs)


def test_streams_have_the_bytes_of_the_reference(one):
    recorded = {exchange["target"]: exchange for exchange in RECORDED["streams"] if exchange["method"] == "STREAM"}
    one.ask("PUT", N, PROGRAM)
    found = {target: one.open(target) for target in recorded}
    for exchange in RECORDED["streams"]:
        if exchange["method"] == "GET":
            assert one.ask("GET", exchange["target"]).status == exchange["status"]
    # the reference ignores a name that has a query behind it
    assert found.pop("/events/pong?todo=1") == [b"data: pong 1 2\r\n\r\n", None]
    for name, events in found.items():
        assert b"".join(event for event in events if event is not None).decode() == recorded[name]["reply"], name
        assert (None in events) == recorded[name]["ends"], name


def test_robots_with_the_same_id_get_numbers_of_their_own(two):
    assert [(node["node"], node["robot"]) for node in json.loads(two.ask("GET", "/nodes").body)] == [
        (1, "anna"),
        (21, "bert"),
    ]
    for name, number in (("anna", 1), ("bert", 21), ("21", 21), ("thymio-II", 1), ("thym", 1)):
        assert json.loads(two.ask("GET", f"/nodes/{name}").body)["node"] == number


def test_robots_with_ids_of_their_own_keep_them():
    bench = Bench("anna", "bert", ids=(1, 2))
    assert [node["node"] for node in json.loads(bench.ask("GET", "/nodes").body)] == [1, 2]


def test_a_file_is_loaded_on_the_robots_that_it_names(two):
    nodes = "".join(f'<node name="{name}">var own = {value}</node>' for name, value in (("bert", 2), ("anna", 1)))
    assert two.ask("PUT", "/nodes", f"<network>{nodes}</network>".encode()).status == 204
    assert two.ask("GET", "/nodes/anna/own").body == b"[1]"
    assert two.ask("GET", "/nodes/bert/own").body == b"[2]"


def test_the_programs_of_a_file_go_to_robots_as_everywhere_else():
    """By name, then by number, then in order; a robot without one runs nothing, and the reply says so."""
    bench = Bench("anna", "bert", "carl", ids=(1, 2, 3))
    nodes = [("Thymio on LAPTOP", 0, 1), ("thymio-II", 2, 2)]
    file = "".join(f'<node name="{name}" nodeId="{number}">var own = {value}</node>' for name, number, value in nodes)
    bench.ask("PUT", "/nodes/carl", b"var own = 9")
    reply = bench.ask("PUT", "/nodes", f"<network>{file}</network>".encode())
    assert reply.status == 200
    assert "carl: the file has no program left for this robot: it runs nothing\n" in reply.body.decode()
    assert [bench.ask("GET", f"/nodes/{name}/own").body for name in ("anna", "bert")] == [b"[1]", b"[2]"]
    assert bench.ask("GET", "/nodes/carl/own").status == 404


def test_a_program_that_no_robot_runs_is_a_note_of_the_reply(two):
    nodes = "".join(f'<node name="{name}">var own = 1</node>' for name in ("anna", "bert", "emma", "e-puck"))
    reply = two.ask("PUT", "/nodes", f"<network>{nodes}</network>".encode())
    assert (reply.status, reply.media_type) == (200, "text/plain; charset=utf-8")
    lines = reply.body.decode().splitlines()
    assert "anna, bert: no robot is left for node 'emma'" in lines
    assert "anna, bert: not for a Thymio, left out: node 'e-puck'" in lines


def test_bare_text_is_a_program(one):
    assert one.ask("PUT", N, b"var a = 7").status == 204
    assert one.ask("GET", f"{N}/a").body == b"[7]"


@pytest.mark.parametrize(
    ("program", "reason"),
    [
        (b"", "the body is empty; expected an .aesl file or the text of a program\n"),
        (b"var a\na = b", "line 2, column 5: "),
        (b"<network>\n<node name='thymio-II'>\nvar a\na = b</node></network>", "line 4, column 5: "),
        (b"<network>\n<nod", "line 2, column "),
        (b"\xff\xfe\x00", "line 1, column 1: "),
    ],
)
def test_a_program_with_an_error_leaves_the_old_one_running(one, program, reason):
    one.ask("PUT", N, PROGRAM)
    reply = one.ask("PUT", N, program)
    assert reply.status == 400
    assert reply.body.decode().startswith(reason)
    assert one.ask("GET", f"{N}/counter").body == b"[5]"


def test_an_event_goes_to_one_robot_and_its_answer_says_which(two):
    two.ask("PUT", "/nodes", PROGRAM)
    anna, bert, both = two.open("/nodes/anna/events"), two.open("/nodes/bert/events"), two.open("/events")
    two.ask("POST", "/nodes/bert/ping", b"[8,9]")
    assert (anna, bert, both) == ([], [b"data: pong 8 9\r\n\r\n"], [b"data: pong 8 9\r\n\r\n"])


def test_missing_arguments_of_an_event_are_zero(one):
    one.ask("PUT", N, PROGRAM)
    events = one.open("/events")
    one.ask("GET", f"{N}/ping/1/2")
    one.ask("GET", f"{N}/ping/3")
    assert events == [b"data: pong 1 2\r\n\r\n", b"data: pong 3 0\r\n\r\n"]


def test_events_and_variables_of_a_program_that_another_client_has_loaded(one):
    compiled = compile_file(PROGRAM, one.gateway.nodes_to_load(LoadProgram(None, b"")))
    one.clients[0].load(1, compiled.programs[0][1].program)
    one.run()
    one.gateway.set_program(0, compiled.programs[0][1].program, compiled.definitions)
    assert one.ask("GET", "/reset").status == 204
    assert one.ask("GET", f"{N}/counter").body == b"[5]"
    events = one.open("/events/pong")
    assert one.ask("GET", f"{N}/ping/1/2").status == 204
    assert events == [b"data: pong 1 2\r\n\r\n"]
    one.gateway.set_program(0, OTHER, Definitions())
    assert one.ask("GET", f"{N}/counter").status == 404


def test_what_is_known_of_a_program_is_out_of_date_while_another_is_loaded(one):
    found = []
    one.begin("PUT", N, PROGRAM, found)
    one.gateway.set_program(0, OTHER, Definitions())
    one.run()
    assert [reply.status for reply in found] == [204]
    assert one.ask("GET", f"{N}/counter").body == b"[5]"


def test_a_node_that_starts_again_has_the_names_of_its_program():
    bench = Bench()
    program = compile("var own = 3", target())
    robot, client = Robot(), NodeClient()
    bench.gateway.add_network(client, "")
    bench.gateway.set_program(0, program, Definitions((("ping", 2),)))
    bench.robots.append(robot)
    bench.clients.append(client)
    client.start(0)
    bench.run()
    found = json.loads(bench.ask("GET", N).body)
    assert (found["namedVariables"]["own"], found["events"]) == (1, {"ping": 2})


def test_an_event_without_a_name_is_a_number(one):
    events = one.open("/events/event_3")
    one.gateway.receive(0, UserMessage(1, 3, (4,)))
    assert events == [b"data: event_3 4\r\n\r\n"]


def test_get_changes_something_if_the_name_is_an_event(one):
    one.ask("PUT", N, PROGRAM)
    changes = {
        target: one.gateway.is_change(parse_request("GET", target, b""))
        for target in ("/nodes", N, f"{N}/counter", f"{N}/ping", f"{N}/counter/1", "/reset", "/events")
    }
    assert [target for target, is_change in changes.items() if is_change] == [f"{N}/ping", f"{N}/counter/1", "/reset"]


def test_values_that_arrive_in_pieces_are_one_answer(one):
    found = []
    one.begin("GET", f"{N}/prox.horizontal", b"", found)
    address, size = one.clients[0].nodes[1].addresses["prox.horizontal"]
    one.gateway.receive(0, Variables(1, address, (1, 2, 3)))
    one.gateway.receive(0, Variables(1, 0, (9,)))
    assert found == []
    one.gateway.receive(0, Variables(1, address + 3, (4, 5, 6, 7)))
    assert size == 7
    assert [reply.body for reply in found] == [b"[1,2,3,4,5,6,7]"]


def test_each_answer_of_a_node_completes_one_request(one):
    found = []
    one.begin("GET", f"{N}/acc", b"", found)
    one.begin("GET", f"{N}/acc", b"", found)
    address, _ = one.clients[0].nodes[1].addresses["acc"]
    one.gateway.receive(0, Variables(1, address, (1, 1, 1)))
    assert [reply.body for reply in found] == [b"[1,1,1]"]
    one.gateway.receive(0, Variables(1, address, (2, 2, 2)))
    assert [reply.body for reply in found] == [b"[1,1,1]", b"[2,2,2]"]


def test_a_node_that_does_not_answer_is_a_time_out(one):
    found = []
    one.begin("GET", f"{N}/acc", b"", found)
    one.begin("PUT", N, PROGRAM, found)
    one.advance(limits.TIMEOUT_NS / SECOND_NS - 0.1)
    assert found == []
    one.advance(0.2)
    assert [reply.status for reply in found] == [504, 504]
    assert one.gateway.waiting == 0


def unplug(bench):
    bench.gateway.remove_network(0)
    bench.robots.clear()
    bench.clients.clear()


@pytest.mark.parametrize("leave", [lambda bench: bench.gateway.receive(0, Disconnected(1)), unplug])
def test_requests_end_when_the_node_leaves(one, leave):
    found = []
    one.begin("GET", f"{N}/acc", b"", found)
    one.begin("PUT", N, PROGRAM, found)
    leave(one)
    assert [reply.status for reply in found] == [504, 504]
    assert one.gateway.waiting == 0
    assert one.ask("GET", "/nodes").body == b"[]"
    assert one.ask("PUT", "/nodes", PROGRAM).body == b"no node is connected\n"


def test_a_stream_of_a_robot_ends_with_its_network(two):
    anna, bert, both = two.open("/nodes/anna/events"), two.open("/nodes/bert/events"), two.open("/events")
    two.gateway.remove_network(1)
    assert (anna, bert, both) == ([], [None], [])


def test_a_node_that_leaves_while_its_program_is_compiled(one):
    compiled = compile_file(PROGRAM, one.gateway.nodes_to_load(LoadProgram(None, b"")))
    one.gateway.remove_network(0)
    with pytest.raises(RefusedError, match="has left the network") as caught:
        one.gateway.load(compiled, [].append)
    assert caught.value.status == 409


def test_a_variable_of_a_program_that_is_replaced_meanwhile(one):
    one.ask("PUT", N, PROGRAM)
    found = []
    one.begin("GET", f"{N}/counter", b"", found)
    address, _ = one.clients[0].nodes[1].addresses["counter"]
    one.gateway.set_program(0, OTHER, Definitions())
    one.gateway.receive(0, Variables(1, address, (1,)))
    assert [reply.status for reply in found] == [409]


def test_requests_and_streams_are_limited(one):
    found = []
    for _ in range(limits.MAX_WAITING):
        one.begin("GET", f"{N}/acc", b"", found)
    assert one.ask("GET", f"{N}/acc").status == 503
    assert one.ask("PUT", N, PROGRAM).status == 503
    assert one.ask("GET", "/nodes").status == 200
    one.run()
    assert len(found) == limits.MAX_WAITING
    opened = [one.gateway.subscribe(StreamEvents(None, None, None), [].append) for _ in range(streams.MAX_STREAMS)]
    with pytest.raises(RefusedError, match="64 streams are open already"):
        one.open("/events")
    one.gateway.unsubscribe(opened[0])
    one.gateway.unsubscribe(opened[0])
    assert one.open("/events") == []
    assert one.gateway.stream_count == streams.MAX_STREAMS
