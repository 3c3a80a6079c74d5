"""Parameters of all nodes in one process: each reaches the nodes it is meant for, and no other."""

from __future__ import annotations

import itertools

import pytest
import rclpy
from rclpy.context import Context
from rclpy.node import Node

from thymio_sim_ros.ros.combined_parameters import BRIDGE, PAGE, RUNTIME, SIMULATOR, assigned, defaults
from thymio_sim_ros.ros.rclpy_ext import parameters
from thymio_sim_ros.suite_config import SuiteConfig

NODES = (SIMULATOR, RUNTIME, BRIDGE, PAGE)
SHARED = {
    *("address", "cmd_vel_timeout", "foxglove_port", "port", "robot_names"),
    *("certfile", "keyfile", "tls", "trusted_proxies"),
}
"""Parameters of more than one node."""


@pytest.fixture
def given(ros_domain):
    """What each node of the suite is started with by these arguments of ROS, and the warnings."""

    def read(*words):
        context = Context()
        with assigned(["--ros-args", *words]) as (arguments, warnings):
            rclpy.init(args=arguments, context=context)
        found = {}
        for name in NODES:
            node = Node(name, context=context)
            found[name] = {key: one.value for key, one in node._parameter_overrides.items()}
            node.destroy_node()
        context.try_shutdown()
        return found, warnings

    return read


@pytest.mark.parametrize("namespace", [(), ("-r", "__ns:=/lab1")])
def test_each_part_gets_its_port(given, namespace):
    found, warnings = given("-p", "port:=9001", "-p", "foxglove_port:=9002", *namespace)
    assert found == {SIMULATOR: {}, RUNTIME: {}, BRIDGE: {"port": 9002}, PAGE: {"port": 9001, "foxglove_port": 9002}}
    assert warnings == []


@pytest.mark.parametrize("namespace", [(), ("-r", "__ns:=/lab1")])
def test_a_parameter_with_a_node_name_reaches_only_that_node_and_has_priority(given, namespace):
    found, _ = given("-p", "foxglove_bridge:port:=9003", "-p", "port:=9001", "-p", "foxglove_port:=9002", *namespace)
    assert found[BRIDGE] == {"port": 9003}
    assert found[PAGE] == {"port": 9001, "foxglove_port": 9002}


def test_the_process_is_named_as_the_executable(given):
    found, warnings = given("--param", "thymio:port:=9001", "-p", "thymio:seed:=3")
    assert (found[PAGE], found[SIMULATOR], warnings) == ({"port": 9001}, {"seed": 3}, [])


@pytest.mark.parametrize(
    ("rule", "node", "name", "value"),
    [
        ("playground:=maze", SIMULATOR, "playground", "maze"),
        ("robot_names:=[anna, bert]", SIMULATOR, "robot_names", ["anna", "bert"]),
        ("real_time_factor:=1e-1", SIMULATOR, "real_time_factor", 0.1),
        ("noise:=false", SIMULATOR, "noise", False),
        ("qos_overrides./odom.publisher.depth:=5", SIMULATOR, "qos_overrides./odom.publisher.depth", 5),
        ("script.path:=~/maze.aesl", RUNTIME, "script.path", "~/maze.aesl"),
        ("script.source:=# go: fast\nvar a = 1", RUNTIME, "script.source", "# go: fast\nvar a = 1"),
        ("script.constants.SPEED:=200", RUNTIME, "script.constants.SPEED", 200),
        ("robots.anna.watch:=['acc']", RUNTIME, "robots.anna.watch", ["acc"]),
        ("card:=", RUNTIME, "card", ""),
        ("include_hidden:=true", BRIDGE, "include_hidden", True),
    ],
)
def test_a_parameter_reaches_the_node_that_has_it_with_its_value(given, rule, node, name, value):
    found, warnings = given("-p", rule)
    assert found == {one: {name: value} if one == node else {} for one in NODES}
    assert warnings == []


def test_an_address_is_that_of_page_and_bridge(given):
    found, _ = given("-p", "address:=0.0.0.0")
    assert found == {SIMULATOR: {}, RUNTIME: {}, BRIDGE: {"address": "0.0.0.0"}, PAGE: {"address": "0.0.0.0"}}


def test_simulated_time_is_not_for_the_simulator(given):
    found, _ = given("-p", "use_sim_time:=false")
    assert found == {SIMULATOR: {}} | {node: {"use_sim_time": False} for node in (RUNTIME, BRIDGE, PAGE)}


@pytest.mark.parametrize(
    ("rule", "warning"),
    [
        (
            "playgroud:=maze",
            "parameter playgroud is not a parameter of the suite and has no effect (did you mean playground?)",
        ),
        ("qqqqq:=1", "parameter qqqqq is not a parameter of the suite and has no effect"),
        ("simulato:seed:=1", "parameter seed: the suite has no node simulato (did you mean simulator?)"),
    ],
)
def test_an_unknown_parameter_causes_a_warning_with_the_nearest_name(given, rule, warning):
    found, warnings = given("-p", rule)
    assert (found, warnings) == ({node: {} for node in NODES}, [warning])


def test_other_arguments_stay_as_they_are(given):
    words = ["x", "--ros-args", "-r", "__ns:=/lab1", "--", "-p", "y:=1"]
    with assigned(words) as (arguments, warnings):
        assert (arguments, warnings) == (words, [])
    with assigned([*words[:2], "-p", "seed:=1", *words[2:]]) as (arguments, _):
        assert [*arguments[:2], *arguments[4:]] == words
        assert arguments[2] == "--params-file"


def test_of_two_values_of_a_parameter_the_last_one_counts(given, tmp_path):
    file = tmp_path / "mine.yaml"
    file.write_text("/**/simulator:\n  ros__parameters: {seed: 7}\n")
    of_file, of_rule = ("--params-file", str(file)), ("-p", "seed:=8")
    assert given(*of_file, *of_rule)[0][SIMULATOR]["seed"] == 8
    assert given(*of_rule, *of_file)[0][SIMULATOR]["seed"] == 7


def test_parameters_with_one_name_in_several_nodes_have_a_rule():
    names = {node: set(parameters.by_name(values)) for node, values in defaults(SuiteConfig()).items()}
    shared = set().union(*(names[one] & names[other] for one, other in itertools.combinations(names, 2)))
    assert shared <= SHARED


def test_ranges_of_the_driver_are_an_option_of_the_suite():
    assert defaults(SuiteConfig(out_of_range="driver"))[SIMULATOR].out_of_range == "driver"


def test_a_file_that_the_nodes_cannot_read_is_not_a_fault_of_the_parameters():
    with pytest.raises(FileNotFoundError), assigned(["--ros-args", "-p", "seed:=3"]):
        raise FileNotFoundError("another file")
