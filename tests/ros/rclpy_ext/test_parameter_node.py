"""Parameters that are dumped and loaded again change nothing; a value that is rejected has a reason for a user."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path

import pytest
import rclpy
import yaml
from rcl_interfaces.msg import ParameterDescriptor
from rcl_interfaces.srv import GetParameters, ListParameters, SetParameters, SetParametersAtomically
from rclpy.context import Context
from rclpy.parameter import Parameter, parameter_dict_from_yaml_file, parameter_value_to_python

from tests.ros.aseba_tools import get_variables
from thymio_sim_ros.ros.aseba.node import AsebaRuntime, RuntimeParams
from thymio_sim_ros.ros.foxglove.node import FoxgloveBridge
from thymio_sim_ros.ros.foxglove.options import FoxgloveParams
from thymio_sim_ros.ros.rclpy_ext import parameters
from thymio_sim_ros.ros.rclpy_ext.node_runner import StartError
from thymio_sim_ros.ros.rclpy_ext.parameter_node import ParameterNode
from thymio_sim_ros.ros.rclpy_ext.parameters import param
from thymio_sim_ros.ros.simulator.node import Simulator, SimulatorParams
from thymio_sim_ros.ros.web.node import WebPage, WebParams

PROGRAM = "var count = 0 # how often\ntimer.period[0] = 100\n\nonevent timer0\n  count = count + 1\n"

MAKERS = {
    "simulator": lambda context: Simulator(
        context,
        SimulatorParams(playground="two_robots", start_paused=True, twist_covariance_diagonal=[1e-5, 2e-7] + [0.0] * 4),
    ),
    "aseba_runtime": lambda context: AsebaRuntime(
        context, RuntimeParams(source=PROGRAM, robots=["anna", "bert"], watch=["count"])
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


NUMBER = "a number with a decimal point, such as 2.0"
NUMBERS = "a list of numbers with a decimal point, such as [2.0, 0.5]"


@pytest.mark.parametrize(
    ("present", "wanted", "found", "expected"),
    [
        (0.5, "fast", "'fast'", NUMBER),
        (0.5, 2, "2", NUMBER),
        ([0.5], "[fast]", "'[fast]'", NUMBERS),
        ([0.5], ["fast"], "['fast']", NUMBERS),
        ([0.5], "{}", "'{}'", NUMBERS),
        ([0.5], [2], "[2]", NUMBERS),
        (1, "1", "'1'", "an integer"),
        (1, 1.5, "1.5", "an integer"),
        ("text", 3, "3", "text"),
        ("text", None, "nothing", "text"),
        (True, "yes", "'yes'", "true or false"),
        (["a"], "a", "'a'", "a list of texts"),
        (1, "x" * 1000, f"'{'x' * 58}…", "an integer"),
    ],
)
def test_a_value_of_another_type_is_rejected_in_the_words_of_a_terminal(ros, present, wanted, found, expected):
    node = ros.add(ParameterNode("numbers", context=ros.context))
    node.declare_parameter("value", present)
    result = node.set_parameters_atomically([Parameter("value", value=wanted)])
    assert (result.successful, result.reason) == (False, f"value: found {found}, expected {expected}")


@dataclass(frozen=True)
class Limited:
    """Parameters with limits."""

    count: int = param(1, "a count", low=0, high=2**31 - 1)
    factor: float = param(1.0, "a factor", low=0.5)


@pytest.mark.parametrize(
    ("name", "value", "sentence"),
    [
        ("count", -1, "found -1, expected 0 to 2147483647"),
        ("count", 1.0, "found 1.0, expected an integer"),
        ("factor", 0.25, "found 0.25, expected at least 0.5"),
        ("factor", math.nan, "found nan, expected at least 0.5"),
        ("factor", 2, f"found 2, expected {NUMBER}"),
    ],
)
def test_a_wrong_value_has_the_same_sentence_at_the_start_and_later(ros, name, value, sentence):
    node = ros.add(ParameterNode("limited", context=ros.context))
    parameters.declare(node, Limited())
    wanted = Parameter(name, value=value)
    result = node.set_parameters_atomically([wanted])
    assert (result.successful, result.reason) == (False, f"{name}: {sentence}")
    started = ros.add(ParameterNode("started", context=ros.context, parameter_overrides=[wanted]))
    with pytest.raises(StartError) as failed:
        parameters.declare(started, Limited())
    assert str(failed.value) == f"parameter {name} of started: {sentence}"


@pytest.mark.parametrize("name", ["use_sim_time", "start_type_description_service"])
def test_a_start_value_of_a_parameter_of_rclpy_has_the_same_sentence(ros, name):
    with pytest.raises(StartError) as failed:
        ParameterNode("started", context=ros.context, parameter_overrides=[Parameter(name, value=5)])
    assert str(failed.value) == f"parameter {name} of started: found 5, expected true or false"


@pytest.mark.parametrize(
    ("name", "near"),
    [
        ("plaground", " (did you mean playground?)"),
        ("cmd_vel_time_out", " (did you mean cmd_vel_timeout?)"),
        ("timeout", " (did you mean cmd_vel_timeout?)"),
        ("nothing.like.it", "; `ros2 param list /lab/some` lists them"),
    ],
)
@pytest.mark.parametrize("service", ["set_parameters", "set_parameters_atomically"])
def test_an_unknown_parameter_is_named_with_the_nearest_one(ros, name, near, service):
    node = ros.add(ParameterNode("some", context=ros.context, namespace="lab"))
    for known in ("playground", "cmd_vel_timeout", "seed"):
        node.declare_parameter(known, 1)
    given = [Parameter("seed", value=2).to_parameter_msg(), Parameter(name, value="maze").to_parameter_msg()]
    kind = SetParameters if service == "set_parameters" else SetParametersAtomically
    answer = ros.call(kind, f"/lab/some/{service}", kind.Request(parameters=given))
    result = answer.results[1] if service == "set_parameters" else answer.result
    assert (result.successful, result.reason) == (False, f"found unknown parameter {name} of /lab/some{near}")
    assert node.get_parameter("seed").value == (2 if service == "set_parameters" else 1)


def test_a_name_of_any_length_is_unknown_and_shortened(ros):
    node = ros.add(ParameterNode("some", context=ros.context))
    reason = node.set_parameters_atomically([Parameter("a" * 100_000, value=1)]).reason
    assert reason.startswith("found unknown parameter aaaa")
    assert len(reason) < 200


def test_a_fixed_parameter_accepts_only_its_current_value(ros):
    node = ros.add(ParameterNode("fixed", context=ros.context))
    node.declare_parameter("value", 4, ParameterDescriptor(read_only=True))
    assert node.set_parameters_atomically([Parameter("value", value=4)]).successful
    refused = node.set_parameters_atomically([Parameter("value", value=5)])
    assert not refused.successful
    assert refused.reason == "value is read-only while the node runs: start it with --ros-args -p value:=…"


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


def test_the_present_value_of_a_parameter_that_acts_says_how_to_get_its_effect_again(ros):
    """`ros2 param set` prints the reason of a success: without it, the user would not know that nothing happened."""
    acted = [False]
    node = ros.add(
        ParameterNode(
            "few",
            context=ros.context,
            is_set_again=lambda name: name == "path",
            repeat=lambda name: "" if name == "speed" else "reset it",
            has_acted=lambda: acted[0],
        )
    )
    for name in ("path", "seed", "speed"):
        node.declare_parameter(name, 1)
    node.declare_parameter("text", "")

    def reason(*names):
        result = node.set_parameters_atomically([Parameter(name, value=1) for name in names])
        assert result.successful
        return result.reason

    same = "has this value already, nothing changed: reset it"
    assert reason("speed") == ""
    assert node.set_parameters_atomically([Parameter("text", value="")]).reason == ""
    assert reason("seed", "speed") == f"seed {same}"
    assert reason("path", "seed") == f"path {same}; seed {same}"
    acted[0] = True
    assert reason("path") == ""
    assert reason("seed") == f"seed {same}"


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
