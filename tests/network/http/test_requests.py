"""Paths, queries and bodies of the HTTP interface become actions, or errors that say what was expected."""

from __future__ import annotations

import contextlib

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from thymio_sim_ros.access import RefusedError
from thymio_sim_ros.network.http.requests import (
    METHODS,
    DescribeNode,
    ListNodes,
    LoadProgram,
    ReadOrSend,
    ResetAll,
    Send,
    StreamEvents,
    is_path,
    parse_request,
)

XML = b"<!DOCTYPE aesl-source><network/>"


@pytest.mark.parametrize(
    ("method", "target", "body", "action"),
    [
        ("GET", "/nodes", b"", ListNodes()),
        ("GET", "/nodes/", b"", ListNodes()),
        ("GET", "/nodes?token=abcd", b"", ListNodes()),
        ("GET", "/nodes/thymio-II", b"", DescribeNode("thymio-II")),
        ("GET", "//nodes//thymio-II/", b"", DescribeNode("thymio-II")),
        ("PUT", "/nodes/thymio-II", XML, LoadProgram("thymio-II", XML)),
        ("PUT", "/nodes/thymio-II", b"file=" + XML, LoadProgram("thymio-II", XML)),
        ("PUT", "/nodes/1", b"file=1", LoadProgram("1", b"file=1")),
        ("PUT", "/nodes", XML, LoadProgram(None, XML)),
        ("GET", "/nodes/1/prox.horizontal", b"", ReadOrSend("1", "prox.horizontal")),
        ("GET", "/nodes/1%2Facc", b"", ReadOrSend("1", "acc")),
        ("GET", "/nodes/1/acc?x=1", b"", ReadOrSend("1", "acc")),
        ("GET", "/nodes/1/motor.left.target/100", b"", Send("1", "motor.left.target", (100,))),
        ("GET", "/nodes/1/list/1/-2/+3", b"", Send("1", "list", (1, -2, 3))),
        ("GET", "/nodes/1/speed/12.75", b"", Send("1", "speed", (12,))),
        ("GET", "/nodes/1/speed/40000", b"", Send("1", "speed", (-25536,))),
        ("POST", "/nodes/1/list", b"[7, 8.5, \"9\"]", Send("1", "list", (7, 8, 9))),
        ("POST", "/nodes/1/list/6/6", b"[2]", Send("1", "list", (6, 6))),
        ("POST", "/nodes/1/bare", b"", Send("1", "bare", ())),
        ("GET", "/events", b"", StreamEvents(None, None, None)),
        ("GET", "/events?todo=3", b"", StreamEvents(None, None, 3)),
        ("GET", "/events?todo=0", b"", StreamEvents(None, None, None)),
        ("GET", "/events/pong?todo=1", b"", StreamEvents(None, "pong", 1)),
        ("GET", "/nodes/2/events", b"", StreamEvents("2", None, None)),
        ("GET", "/nodes/2/events/pong", b"", StreamEvents("2", "pong", None)),
        ("GET", "/reset", b"", ResetAll()),
        ("POST", "/reset_all", b"", ResetAll()),
    ],
)  # fmt: skip
def test_a_request_becomes_an_action(method, target, body, action):
    assert parse_request(method, target, body) == action


@pytest.mark.parametrize(
    ("method", "target", "body", "status", "reason"),
    [
        ("GET", "/", b"", 404, "no such path; expected /nodes, /events or /reset"),
        ("GET", "/other", b"", 404, "no such path; expected /nodes, /events or /reset"),
        ("GET", "/events/a/b", b"", 404, "no such path; expected /nodes, /events or /reset"),
        ("POST", "/nodes", b"[1]", 405, "POST is not possible here; expected GET or PUT"),
        ("POST", "/nodes/1", b"[1]", 405, "POST is not possible here; expected GET or PUT"),
        ("PUT", "/nodes/1/acc", b"[1]", 405, "PUT is not possible here; expected POST or GET"),
        ("PUT", "/reset", b"", 405, "PUT is not possible here; expected GET or POST"),
        ("POST", "/events", b"", 405, "POST is not possible here; expected GET"),
        ("GET", "/nodes/1/list/x", b"", 400, "found 'x' among the values, expected numbers"),
        ("GET", "/nodes/1/list/1e3", b"", 400, "found '1e3' among the values, expected numbers"),
        ("GET", "/nodes/1/list/٣", b"", 400, "found '٣' among the values, expected numbers"),
        ("GET", "/nodes/1/list/65536", b"", 400, "found 65536, expected a number of 16 bits, -32768..32767"),
        ("POST", "/nodes/1/list", b"[1,", 400, "the body is not JSON; expected an array of numbers, as in [100, -100]"),
        ("POST", "/nodes/1/list", b"[" * 40_000, 400,
         "the body is not JSON; expected an array of numbers, as in [100, -100]"),
        ("POST", "/nodes/1/list", b"\xff", 400,
         "the body is not JSON; expected an array of numbers, as in [100, -100]"),
        ("POST", "/nodes/1/list", b"7", 400, "expected an array of numbers, as in [100, -100]"),
        ("POST", "/nodes/1/list", b"[[1]]", 400, "found [1] among the values, expected numbers"),
        ("POST", "/nodes/1/list", b"[true]", 400, "found true among the values, expected numbers"),
        ("POST", "/nodes/1/list", b"[NaN]", 400, "found nan, expected numbers of 16 bits"),
        ("POST", "/nodes/1/list", b"[-1e999]", 400, "found -inf, expected numbers of 16 bits"),
        ("POST", "/nodes/1/list", b"[-32769]", 400, "found -32769, expected a number of 16 bits, -32768..32767"),
        ("POST", "/nodes/1/list", b"[" + b"1," * 258 + b"1]", 400, "found 259 values, expected at most 258"),
        ("POST", "/nodes/1/list", b"[" + b"1," * 20_000 + b"1]", 413,
         "found 40003 bytes of values, expected at most 40000"),
        ("GET", "/events?todo=-1", b"", 400, "todo: expected a number of events, as in ?todo=5"),
        ("GET", "/nodes/" + "a" * 5000, b"", 414, "path of 5007 characters, expected at most 4096"),
    ],
)  # fmt: skip
def test_an_error_says_what_was_expected(method, target, body, status, reason):
    with pytest.raises(RefusedError) as caught:
        parse_request(method, target, body)
    assert (caught.value.status, str(caught.value)) == (status, reason)


@given(
    st.sampled_from(METHODS),
    st.lists(st.sampled_from(["nodes", "events", "reset", "1", "%2F", "%", "-", "?", "todo=", "\x00"]) | st.text()),
    st.binary() | st.from_regex(rb"\A[\[\]{}0-9,.eE+\-\" ]*\Z"),
)
@example("POST", ["nodes", "1", "a"], b"[1e400]")
@example("POST", ["nodes", "1", "a"], b"[" + b"9" * 5000 + b"]")
def test_any_request_is_an_action_or_an_error(method, parts, body):
    with contextlib.suppress(RefusedError):
        action = parse_request(method, "/" + "/".join(parts), body)
        if isinstance(action, Send):
            assert all(-0x8000 <= value <= 0x7FFF for value in action.values)


@pytest.mark.parametrize("path", ["/nodes", "//nodes/1", "/%6eodes", "/events/run", "/reset", "/reset_all"])
def test_paths_of_the_interface_are_known(path: str) -> None:
    assert is_path(path)


@pytest.mark.parametrize("path", ["/", "", "/index.html", "/nodes.js", "/assets/nodes", "/playgrounds/line.json"])
def test_other_paths_are_left_to_the_page(path: str) -> None:
    assert not is_path(path)
