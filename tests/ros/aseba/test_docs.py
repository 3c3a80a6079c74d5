"""docs/aseba_ros.md: everything named in its tables exists, and the commands of its examples work."""

from __future__ import annotations

import json
import re
import shlex
from pathlib import Path

import pytest
import yaml
from rcl_interfaces.srv import DescribeParameters, GetParameters, SetParameters, SetParametersAtomically
from std_msgs.msg import Int16MultiArray
from std_srvs.srv import Trigger

from tests.ros.aseba_tools import set_parameters
from thymio_sim_ros.ros.aseba.node import AsebaRuntime, RuntimeParams
from thymio_sim_ros.ros.foxglove import json_messages

DOC = (Path(__file__).parents[3] / "docs" / "aseba_ros.md").read_text(encoding="utf-8")
MAZE = """<network>
<event name="ping" size="1"/>
<event name="pong" size="1"/>
<node name="thymio-II">var counter = 1
onevent ping
  counter = event.args[0]
  emit pong counter
</node></network>
"""
SERVICES = (SetParameters, GetParameters, SetParametersAtomically, DescribeParameters, Trigger)
TYPES = {f"{kind.__module__.split('.')[0]}/srv/{kind.__name__}": kind for kind in SERVICES}
ROWS = [line.split("|") for line in DOC.splitlines() if line.startswith("| `")]
COMMANDS = [shlex.split(line) for line in re.findall(r"^ros2 .+$", DOC, re.MULTILINE)]


def names(*, where):
    """Return the names in the first cells of table rows whose second cell matches."""
    found = [re.findall(r"`([^`]+)`", row[1]) for row in ROWS if re.search(where, row[2])]
    return sorted({name.replace("<event>", "ping").replace("<name>", "counter") for cell in found for name in cell})


def commands(*words):
    found = [command for command in COMMANDS if command[1 : 1 + len(words)] == list(words)]
    assert found
    return found


@pytest.fixture
def maze(tmp_path, monkeypatch):
    path = tmp_path / "maze.aesl"
    path.write_text(MAZE, encoding="utf-8")
    monkeypatch.setenv("HOME", str(tmp_path))
    return path


def test_topics_of_the_tables_are_there(ros, runtime):
    runtime(MAZE, watch=["counter"])
    wanted = [f"/{name}" for name in names(where=r"Int16MultiArray") if name.startswith(("aseba/", "_aseba/"))]
    assert len(wanted) >= 6
    ros.until(lambda: set(wanted) <= {name for name, _ in ros.node.get_topic_names_and_types()})
    headings = re.findall(r"^### `(_aseba/\w+)` \(`([\w/]+)`", DOC, re.MULTILINE)
    found = dict(ros.node.get_topic_names_and_types())
    assert {f"/{name}": [kind] for name, kind in headings} == {f"/{name}": found[f"/{name}"] for name, _ in headings}


def test_services_of_the_tables_are_there(ros, runtime):
    runtime(MAZE)
    wanted = [f"/{name}" for name in names(where=r"Trigger|srv/") if name.startswith(("aseba/", "_aseba/"))]
    assert len(wanted) == 10
    ros.until(
        lambda: (
            {*wanted, "/aseba_runtime/check", "/aseba_runtime/load"}
            <= {name for name, _ in ros.node.get_service_names_and_types()}
        )
    )


def test_parameters_of_the_tables_are_there_and_none_is_missing(ros, runtime):
    node = runtime(MAZE, robots=["counter"]).node
    wanted = {name for name in names(where=r"string|integer|double|bool|read-only|`raw`|`network`") if "/" not in name}
    wanted = {name for name in wanted if "." in name or node.has_parameter(name)}
    free = {"script.constants.<NAME>", "robots.counter.script.…"}
    assert {name for name in wanted - free if not node.has_parameter(name)} == set()
    ours = {name for name in node.get_parameters_by_prefix("") if not re.match(r"robots\.|qos|start_type", name)}
    assert ours - wanted - {"robots"} == set()


def test_the_parameters_of_the_examples_can_be_set(ros, runtime, maze):
    runtime(MAZE, robots=["anna"])
    for _, _, _, node, name, value in commands("param", "set"):
        result = set_parameters(ros, {name: yaml.safe_load(value.replace("~", str(maze.parent)))}, node)
        assert result.successful, result.reason


def test_the_service_calls_of_the_examples_are_answered(ros, runtime):
    runtime(MAZE)
    for _, _, _, name, kind, *text in commands("service", "call"):
        service = TYPES[kind]
        request = json_messages.from_json(_json(text[0] if text else "{}"), service.Request)
        answer = ros.call(service, name, request)
        results = [answer.result] if hasattr(answer, "result") else getattr(answer, "results", [])
        expected = name != "/aseba_runtime/check"  # the example has a mistake to be reported
        assert all(result.successful is expected for result in results)


def test_the_messages_of_the_examples_arrive(ros, runtime):
    runtime(MAZE)
    pongs = ros.collect(Int16MultiArray, "/aseba/events/pong")
    published = commands("topic", "pub")
    for *_, name, kind, text in published:
        assert kind == "std_msgs/msg/Int16MultiArray"
        message = json_messages.from_json(_json(text), Int16MultiArray)
        ros.publisher(Int16MultiArray, name).publish(message)
    ros.until(lambda: len(pongs) == len(published))


def test_the_topics_of_the_examples_exist(ros, runtime):
    runtime(MAZE, watch=["prox.horizontal"])
    wanted = {command[-1] for command in commands("topic", "echo")}
    ros.until(lambda: all(ros.node.count_publishers(name) for name in wanted))


@pytest.mark.parametrize("command", [command for command in COMMANDS if command[1] == "run"], ids=" ".join)
def test_the_node_starts_as_in_the_examples(ros, command, maze):
    given = [text.split(":=") for text in command[command.index("--ros-args") + 2 :: 2]]
    overrides = {name: yaml.safe_load(value) for name, value in given}
    life = ros.live(AsebaRuntime(ros.context, RuntimeParams(), overrides=overrides))
    assert life.robots[0].program.name in {"maze.aesl", "line_follower.aesl"}


def test_the_refusal_of_the_text_is_ours(ros, runtime):
    runtime("var me = 1")
    (reported,) = re.findall(r"`(maze\.aesl: line [^`]+)`", DOC)
    nodes = '<node name="thymio-II" nodeId="1">\n\n\n\n</node><node name="thymio-II" nodeId="2">\n\n\n\n      '
    text = f"<network>\n\n\n{nodes}motor.left.targt = 1</node></network>"
    result = set_parameters(ros, {"script.name": "maze.aesl", "script.source": text})
    assert result.reason == reported


def _json(text):
    return json.dumps(yaml.safe_load(text)).encode()
