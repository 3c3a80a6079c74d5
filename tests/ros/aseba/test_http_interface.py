"""The HTTP interface and the topics of the same robot: a program that is loaded by HTTP, events, variables, names."""

from __future__ import annotations

import http.client
import json
from concurrent.futures import ThreadPoolExecutor

import pytest
from std_msgs.msg import Int16MultiArray, String

from tests.patience import PATIENCE_S
from tests.processes import free_port
from tests.ros.aseba_tools import Status, event, get_variables, set_parameters
from thymio_sim_ros.ros.aseba.parameters import NetworkParams

FILE = '<network><event size="1" name="ping"/><event size="1" name="pong"/><node name="thymio-II">{}</node></network>'
OWN = FILE.format("var own = 5\nonevent ping\nown = event.args[0]\nemit pong own\n")
BY_HTTP = FILE.format("# doubled\nvar n = 3\nonevent ping\nn = event.args[0] * 2\nemit pong n\n")


@pytest.fixture
def ask(ros, runtime):
    """Start a runtime with an HTTP interface; return a function for requests, which spins the executor meanwhile."""
    port = free_port()
    runtime(OWN, network=NetworkParams(http_port=port, announce=False))
    pool = ThreadPoolExecutor(1)

    def request(method, target, body=None):
        connection = http.client.HTTPConnection("127.0.0.1", port, timeout=PATIENCE_S)
        try:
            connection.request(method, target, body)
            response = connection.getresponse()
            return response.status, response.read().decode()
        except ConnectionRefusedError:  # not yet
            return None, ""
        finally:
            connection.close()

    def begin(method, target, body=None):
        return pool.submit(request, method, target, body)

    def ask(method, target, body=None):
        future = begin(method, target, body)
        ros.until(future.done, what="the request is answered")
        return future.result()

    ask.begin = begin

    ros.until(lambda: len(ask("GET", "/nodes")[1]) > 2, what="the node is known")
    yield ask
    pool.shutdown()


def test_a_program_loaded_by_http_is_shown_with_its_text_and_its_topics_work(ros, ask):
    status = Status(ros)
    targets = ros.collect(String, "/_aseba/target", transient_local=True)
    assert ask("PUT", "/nodes/thymio-II", BY_HTTP) == (204, "")
    ros.until(lambda: status["program"] == "by HTTP")
    described = json.loads(targets[-1].data)["program"]
    assert "# doubled" in described["source"]
    assert not described["foreign"]
    assert get_variables(ros, "n") == [[3]]
    answers = ros.collect(Int16MultiArray, "/aseba/events/pong")
    assert ask("GET", "/nodes/1/ping/21") == (204, "")
    ros.until(lambda: [list(message.data) for message in answers] == [[42]])
    assert ask("GET", "/nodes/1/n") == (200, "[42]")


def test_the_names_of_a_program_of_ros_are_known(ros, ask):
    assert ask("GET", "/nodes/thymio-II/own") == (200, "[5]")
    assert ask("GET", "/nodes/thymio-II/ping/7") == (204, "")
    ros.until(lambda: ask("GET", "/nodes/thymio-II/own") == (200, "[7]"))
    assert ask("GET", "/reset") == (204, "")
    assert ask("GET", "/nodes/thymio-II/own") == (200, "[5]")
    assert set_parameters(ros, {"script.source": BY_HTTP}).successful
    ros.until(lambda: ask("GET", "/nodes/thymio-II/n") == (200, "[3]"))
    assert ask("GET", "/nodes/thymio-II/own")[0] == 404


def test_an_event_of_ros_is_answered_in_the_stream(ros, ask):
    emit = ros.publisher(Int16MultiArray, "/_aseba/emit")
    stream = ask.begin("GET", "/nodes/thymio-II/events/pong?todo=1")

    def sent():
        emit.publish(event("ping", 9))
        return stream.done()

    ros.until(sent, what="the stream has its event")
    assert stream.result() == (200, "data: pong 9\r\n\r\n")
