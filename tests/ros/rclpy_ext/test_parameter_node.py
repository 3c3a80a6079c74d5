"""Parameters that were dumped and are loaded again change nothing, at the start and while the nodes run."""

from __future__ import annotations

from pathlib import Path

import pytest
import rclpy
import yaml
from rcl_interfaces.msg import ParameterDescriptor
from rcl_interfaces.srv import GetParameters, ListParameters, SetParameters
from rclpy.context import Context
from rclpy.parameter import Parameter, parameter_dict_from_yaml_file, parameter_value_to_python

from tests.ros.aseba_tools import get_variables
from thymio_sim_ros.ros.aseba.node import AsebaRuntime, RuntimeParams
from thymio_sim_ros.ros.foxglove.node import FoxgloveBridge
from thymio_sim_ros.ros.foxglove.options import FoxgloveParams
from thymio_sim_ros.ros.rclpy_ext.parameter_node import ParameterNode
from thymio_sim_ros.ros.simulator.node import Simulator, SimulatorParams
from thymio_sim_ros.ros.web.node import WebPage, WebParams

PROGRAM = "var count = 0 # how often\ntimer.period[0] = 100\n\nonevent timer0\n  count = count + 1\n"

MAKERS = {
    "simulator": lambda context: Simulator(
        context,
        SimulatorParams(playground="two_robots", start_paused=True, twist_covariance_diagonal=[1e-5, 2e-7] + [0.0] * 4),
    ),
    "aseba_runtime": lambda context: AsebaRuntime(
        context, RuntimeParams(source=PROGRAM, robots=["anna", "bert"], watch=["count"], follow_simulator=False)
    ),
    "foxglove_bridge": lambda context: FoxgloveBridge(context=context, defaults=FoxgloveParams(port=0)),
    "web_ui": lambda context: WebPage(context, WebParams(port=0)),
}


def values_of(ros, node):
    """All parameters of a node by the services that `ros2 param dump` calls."""
    names = ros.call(ListParameters, f"/{node}/list_parameters").result.names
    found = ros.call(GetParameters, f"/{node}/get_parameters", GetParameters.Request(names=names)).values
    return dict(zip(names, found, strict=True))


def dumped(values, node, path: Path) -> Path:
    """The file that `ros2 param dump` writes: nested by the dots of names."""
    tree: dict = {}
    for name, value in sorted(values.items()):
        plain = parameter_value_to_python(value)
        *folders, last = name.split(".")
        branch = tree
        for folder in folders:
            branch = branch.setdefault(folder, {})
        branch[last] = plain if isinstance(plain, str | bool | int | float) or plain is None else list(plain)
    path.write_text(yaml.dump({f"/{node}": {"ros__parameters": tree}}, default_flow_style=False))
    return path


def loaded(ros, node, path):
    """What the node answers to `ros2 param load`, by name."""
    found = parameter_dict_from_yaml_file(str(path))
    request = SetParameters.Request(parameters=list(found.values()))
    results = ros.call(SetParameters, f"/{node}/set_parameters", request).results
    return dict(zip(found, results, strict=True))


@pytest.mark.parametrize("node", MAKERS)
def test_dumped_parameters_load_without_a_change(ros, node, tmp_path):
    life = ros.live(MAKERS[node](ros.context))
    before = values_of(ros, node)
    changes = []
    life.node.add_post_set_parameters_callback(changes.extend)
    results = loaded(ros, node, dumped(before, node, tmp_path / "dump.yaml"))
    assert {name: result.reason for name, result in results.items() if not result.successful} == {}
    assert values_of(ros, node) == before
    assert [one.name for one in changes if not one.name.endswith(("playground", "script.path"))] == []


@pytest.mark.parametrize("node", MAKERS)
def test_dumped_parameters_start_a_node_with_the_same_values(ros, node, tmp_path):
    life = ros.live(MAKERS[node](ros.context))
    before = values_of(ros, node)
    path = dumped(before, node, tmp_path / "dump.yaml")
    context = Context()
    rclpy.init(args=["--ros-args", "--params-file", str(path)], context=context, domain_id=ros.domain)
    if hasattr(life, "port"):
        life.stop()
    second = {
        "simulator": Simulator,
        "aseba_runtime": AsebaRuntime,
        "foxglove_bridge": lambda context: FoxgloveBridge(context=context),
        "web_ui": WebPage,
    }[node](context)
    try:
        after = {name: one.get_parameter_value() for name, one in second.node._parameters.items()}
    finally:
        second.close()
        context.try_shutdown()
    assert {name: (one, after.get(name)) for name, one in before.items() if one != after.get(name)} == {}


def test_loading_restarts_no_program_and_no_world(ros, simulation, tmp_path):
    sim = simulation(playground="two_robots")
    runtime = ros.live(MAKERS["aseba_runtime"](ros.context))
    runtime.robots[0].device.variables.set("count", (42,))
    sim.step(0.5)
    world = sim.world
    for node in ("simulator", "aseba_runtime"):
        loaded(ros, node, dumped(values_of(ros, node), node, tmp_path / f"{node}.yaml"))
    assert sim.world is world
    assert sim.world.now_ns == 500_000_000
    ((count,),) = get_variables(ros, "count", robot="/anna")
    assert count >= 42


@pytest.mark.parametrize(
    ("present", "wanted", "found"),
    [
        (0.5, "1e-05", 1e-5),
        (0.5, "1e+22", 1e22),
        ([0.5, 0.5], "[1e-05, 0.25]", [1e-5, 0.25]),
        ([0.5, 0.5], ["1e-05", "2e-7"], [1e-5, 2e-7]),
    ],
)
def test_a_number_given_as_text_is_converted(ros, present, wanted, found):
    node = ros.add(ParameterNode("numbers", context=ros.context))
    node.declare_parameter("value", present)
    assert node.set_parameters_atomically([Parameter("value", value=wanted)]).successful
    value = node.get_parameter("value").value
    assert (list(value) if isinstance(found, list) else value) == found


@pytest.mark.parametrize(
    ("present", "wanted"), [(0.5, "fast"), ([0.5], "[fast]"), ([0.5], ["fast"]), ([0.5], "{}"), (1, "1"), ("text", 3)]
)
def test_text_without_a_number_is_rejected(ros, present, wanted):
    node = ros.add(ParameterNode("numbers", context=ros.context))
    node.declare_parameter("value", present)
    assert "Wrong parameter type" in node.set_parameters_atomically([Parameter("value", value=wanted)]).reason


def test_a_fixed_parameter_accepts_only_its_current_value(ros):
    node = ros.add(ParameterNode("fixed", context=ros.context))
    node.declare_parameter("value", 4, ParameterDescriptor(read_only=True))
    assert node.set_parameters_atomically([Parameter("value", value=4)]).successful
    refused = node.set_parameters_atomically([Parameter("value", value=5)])
    assert not refused.successful
    assert "read-only" in refused.reason


def test_only_what_differs_reaches_the_callbacks(ros):
    node = ros.add(ParameterNode("few", context=ros.context, is_set_again=lambda name: name == "path"))
    seen = []
    for name in ("one", "two", "path"):
        node.declare_parameter(name, name)
    node.add_post_set_parameters_callback(lambda parameters: seen.append([one.name for one in parameters]))
    wanted = [Parameter("one", value="one"), Parameter("two", value="three"), Parameter("path", value="path")]
    assert node.set_parameters_atomically(wanted).successful
    assert node.set_parameters_atomically(wanted[:1]).successful
    assert seen == [["two", "path"]]


def test_lines_that_were_joined_are_the_present_text_but_other_words_are_not(ros):
    node = ros.add(ParameterNode("text", context=ros.context))
    node.declare_parameter("source", "var a = 1\nonevent prox\n\na = 2\n")
    seen = []
    node.add_post_set_parameters_callback(seen.extend)
    for text in ("var a = 1 onevent prox\na = 2", "var a = 1\nonevent prox\n\na = 2\n"):
        assert node.set_parameters_atomically([Parameter("source", value=text)]).successful
    assert seen == []
    assert node.set_parameters_atomically([Parameter("source", value="var a = 1\nonevent prox\na = 2")]).successful
    assert [one.value for one in seen] == ["var a = 1\nonevent prox\na = 2"]
