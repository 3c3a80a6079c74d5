"""Programs of the runtime: for all robots and for one, constants, shared files, robots that come and go."""

from __future__ import annotations

import re

import pytest
from std_srvs.srv import Trigger

from tests.ros.aseba_tools import Status, get_parameter, get_variables, set_parameters, set_variables, words
from thymio_sim_ros.ros.aseba.node import AsebaRuntime, RuntimeParams
from thymio_sim_ros.ros.rclpy_ext.node_runner import StartError
from thymio_sim_ros.sim.playground.reader import RobotStart

SAME = "has this value already, nothing changed: the services aseba/reset and aseba/run of a robot restart its program"
TWO = {"robots": ["anna", "bert"]}

NETWORK = """<network>
<constant name="K" value="1"/>
<node nodeId="2" name="thymio-II">var me = 2 * K</node>
<node nodeId="1" name="thymio-II">var me = 1 * K</node>
</network>
"""


def me(ros, robot):
    (found,) = get_variables(ros, "me", robot=f"/{robot}")
    return found


def test_a_robot_may_have_a_program_of_its_own_and_give_it_up(ros, runtime):
    runtime("var me = 1", **TWO)
    assert set_parameters(ros, {"robots.bert.script.source": "var me = 2", "robots.bert.script.name": "b"}).successful
    assert (me(ros, "anna"), me(ros, "bert")) == ([1], [2])
    assert set_parameters(ros, {"script.source": "var me = 3"}).successful
    assert (me(ros, "anna"), me(ros, "bert")) == ([3], [2])
    assert set_parameters(ros, {"robots.bert.script.source": ""}).successful
    assert me(ros, "bert") == [3]


def test_a_robot_s_own_program_that_does_not_compile_is_refused_and_all_go_on(ros, runtime):
    runtime("var me = 1", **TWO)
    result = set_parameters(
        ros, {"robots.anna.script.source": "var me = 2\nme = you", "robots.anna.script.name": "mine"}
    )
    assert not result.successful
    assert result.reason.startswith("mine: line 2, column 6: no variable is called 'you'")
    assert (me(ros, "anna"), me(ros, "bert")) == ([1], [1])


def test_a_name_waits_for_its_text_and_a_refused_text_leaves_the_old_program_alone(ros, runtime):
    runtime("var me = 1", **TWO)
    assert set_parameters(ros, {"script.name": "good.aesl", "script.source": "var me = 2"}).successful
    status = Status(ros, "/anna")
    ros.until(lambda: status["program"] == "good.aesl")
    (changed,) = set_variables(ros, {"me": words(7)}, robot="/anna")
    assert changed.successful
    assert set_parameters(ros, {"script.name": "bad.aesl"}).successful  # one by one, as Foxglove sets them
    refused = set_parameters(ros, {"script.source": "var me = = 3"})
    assert refused.reason.startswith("bad.aesl: line 1")
    assert set_parameters(ros, {"robots.bert.script.source": "var me = 4"}).successful
    assert (me(ros, "anna"), me(ros, "bert")) == ([7], [4])
    assert status["program"] == "good.aesl"
    assert set_parameters(ros, {"script.source": "var me = 5"}).successful
    ros.until(lambda: status["program"] == "bad.aesl")


def test_a_file_with_several_programs_gives_each_robot_its_own(ros, runtime):
    runtime(NETWORK, **TWO)
    assert (me(ros, "anna"), me(ros, "bert")) == ([1], [2])
    status = Status(ros, "/anna")
    ros.until(lambda: status["node"] == "thymio-II")
    assert status["first_line"] == "4"


def test_an_error_in_one_of_several_programs_names_its_node(ros, runtime):
    runtime("var me = 1", **TWO)
    result = set_parameters(ros, {"script.source": NETWORK.replace("1 * K", "1 * L"), "script.name": "two.aesl"})
    assert "two.aesl: line 4, column 48: node 'thymio-II' 1: no variable is called 'L'" in result.reason


def test_what_does_not_fit_is_reported_as_a_warning(ros, runtime):
    runtime(NETWORK.replace('nodeId="2"', 'nodeId="9"'), robots=["anna", "bert", "carl"])
    bert, carl = Status(ros, "/bert"), Status(ros, "/carl")
    ros.until(lambda: bert["state"] and carl["state"])
    assert [item["message"] for item in bert.data("warnings")] == [
        "node 'thymio-II' 9 runs here, on number 2, as it was next in order"
    ]
    assert "no program left for this robot" in carl.data("warnings")[0]["message"]
    assert carl["program"] == "none"


def test_constants_are_parameters_for_all_and_for_one(ros, runtime):
    runtime(NETWORK, **TWO)
    assert set_parameters(ros, {"script.constants.K": 10}).successful
    assert (me(ros, "anna"), me(ros, "bert")) == ([10], [20])
    assert set_parameters(ros, {"robots.bert.script.constants.K": 100}).successful
    assert (me(ros, "anna"), me(ros, "bert")) == ([10], [200])
    assert set_parameters(ros, {"script.constants.K": None}).successful
    assert (me(ros, "anna"), me(ros, "bert")) == ([1], [200])


@pytest.mark.parametrize(
    ("name", "value", "found"),
    [
        ("script.constants.K", 40000, "found 40000, expected a whole number from -32768 to 32767"),
        ("script.constants.K", "7", "found '7', expected a whole number"),
        ("script.constants.7up", 7, "a program cannot use the name '7up'"),
        ("breakpoints", [0], "found [0], expected lines from 1 on"),
        ("breakpoints", list(range(1, 18)), "found 17 breakpoints, expected at most 16"),
        ("breakpoints", 4, "found 4, expected a list of lines"),
        ("breakpoints", None, "breakpoints: found nothing, expected a value"),
        ("robots.anna.breakpoints", 4, "found 4, expected a list of lines"),
        ("watch", [3], "found [3], expected a list of names"),
        ("watch", "me", "found 'me', expected a list of names"),
        ("watch", None, "watch: found nothing, expected a value"),
        ("robots.anna.watch", "me", "found 'me', expected a list of names"),
        ("local_events", True, "found True, expected a list of names"),
        ("script.path", "~no-such-user/x.aesl", "~no-such-user/x.aesl"),
        ("robots.anna.script.source", 3, "robots.anna.script.source: found 3, expected text"),
        ("robots.absent.script.source", 3, "found 3, expected text"),
        ("robots.absent.script.source", "var 3", "line 1, column 5"),
        ("scrip.source", "var a", "unknown parameter scrip.source of /aseba_runtime (did you mean script.source?)"),
        ("emit_reaches", "all", "expected network or robot"),
        ("script.path", "no_such_program", "no_such_program"),
    ],
)
def test_an_invalid_value_is_rejected_with_a_reason(ros, runtime, name, value, found):
    runtime("var me = 1", **TWO)
    result = set_parameters(ros, {name: value})
    assert not result.successful
    assert found in result.reason


@pytest.mark.parametrize(
    ("name", "value", "found"),
    [
        ("watch", "me", "found 'me', expected a list"),
        ("breakpoints", 4, "found 4, expected a list"),
        ("robots", ["/anna"], "found '/anna', expected a namespace such as 'anna', or ''"),
        ("robots", ["an na"], "found 'an na', expected a namespace"),
    ],
)
def test_an_invalid_value_of_the_command_line_is_reported_in_one_line(ros, name, value, found):
    with pytest.raises(StartError, match=re.escape(found)):
        AsebaRuntime(ros.context, overrides={name: value})


def test_the_last_of_path_and_text_counts(ros, runtime):
    runtime(path="line_follower")
    assert set_parameters(ros, {"script.source": "var me = 5"}).successful
    assert get_parameter(ros, "script.path") == ""
    assert set_parameters(ros, {"script.path": "line_follower"}).successful
    assert get_parameter(ros, "script.source") == ""
    status = Status(ros)
    ros.until(lambda: status["program"] == "line_follower.aesl")


def test_the_same_text_again_changes_nothing_and_a_reset_restarts(ros, runtime):
    robot = runtime("var me = 1\nonevent button.left\nme = 7").robots[0]
    robot.device.variables.set("me", (9,))
    result = set_parameters(ros, {"script.source": "var me = 1\nonevent button.left\nme = 7"})
    assert (result.successful, result.reason) == (True, f"script.source {SAME}")
    assert get_variables(ros, "me") == [[9]]
    for verb in ("reset", "run"):
        assert ros.call(Trigger, f"/aseba/{verb}").success
    ros.until(lambda: get_variables(ros, "me") == [[1]])


def test_another_program_ends_a_behaviour_and_the_behaviour_can_come_back(ros, runtime):
    runtime("var me = 1")
    status = Status(ros)
    for _ in range(2):
        assert set_parameters(ros, {"behaviour": "menu"}).successful
        ros.until(lambda: status["program"].startswith("menu"))
        assert set_parameters(ros, {"script.source": "var me = 1"}).successful  # waits behind the behaviour
        assert get_parameter(ros, "behaviour") == "menu"
        assert set_parameters(ros, {"behaviour": ""}).successful
        ros.until(lambda: not status["program"].startswith("menu"))
    assert set_parameters(ros, {"behaviour": "menu"}).successful
    assert set_parameters(ros, {"script.source": "var me = 2"}).successful
    assert get_parameter(ros, "behaviour") == ""
    ros.until(lambda: get_variables(ros, "me") == [[2]])


def test_a_program_of_one_robot_does_not_end_the_behaviour_of_another(ros, runtime):
    runtime("var me = 1", **TWO)
    anna, bert = Status(ros, "/anna"), Status(ros, "/bert")
    assert set_parameters(ros, {"behaviour": "explorer"}).successful
    ros.until(lambda: anna["program"].startswith("explorer") and bert["program"].startswith("explorer"))
    assert set_parameters(ros, {"robots.anna.script.path": "friendly"}).successful
    ros.until(lambda: anna["program"].startswith("friendly"))
    assert set_parameters(ros, {"robots.anna.script.name": "waits"}).successful  # bert is asked after that
    assert bert["program"].startswith("explorer")


def test_a_changed_file_is_read_again(ros, runtime, tmp_path):
    path = tmp_path / "counts.aesl"
    path.write_text("var me = 1\nonevent button.left\nme = 7")
    robot = runtime(path=str(path)).robots[0]
    robot.device.variables.set("me", (9,))
    result = set_parameters(ros, {"script.path": str(path)})
    assert (result.successful, result.reason) == (True, f"script.path {SAME}")
    assert get_variables(ros, "me") == [[9]]
    path.write_text("var me = 2\nonevent button.left\nme = 7")
    result = set_parameters(ros, {"script.path": str(path)})
    assert (result.successful, result.reason) == (True, "")
    assert get_variables(ros, "me") == [[2]]


def test_free_parameters_may_be_given_at_the_start(ros):
    given = {
        "script.source": "var me = K",
        "script.constants.K": 4,
        "robots.bert.script.source": "var me = K + 1",
        "robots": ["anna", "bert"],
        "breakpoints": [1],
    }
    ros.live(AsebaRuntime(ros.context, RuntimeParams(), overrides=given))
    assert get_parameter(ros, "script.constants.K") == 4
    assert get_parameter(ros, "robots.bert.script.source") == "var me = K + 1"
    assert list(get_parameter(ros, "breakpoints")) == [1]
    status = Status(ros, "/bert")
    ros.until(lambda: status.place == ("paused", "init", "1"))


def test_a_program_that_does_not_compile_is_refused_at_the_start(ros):
    with pytest.raises(StartError, match="line 1, column 5"):
        AsebaRuntime(ros.context, RuntimeParams(source="var 3"))


def test_robots_that_stay_go_on_when_others_come_and_go(ros, simulation, runtime):
    sim = simulation(robot_names=["anna"])
    node = runtime("var me = 1")
    sim.thymio["me"] = 42
    sim.simulator.runner.spawn(RobotStart("bert", 0.3, 0.0, 0.0))
    sim.tick()
    assert (me(ros, "anna"), me(ros, "bert")) == ([42], [1])
    assert [endpoints.number for endpoints in node.robots] == [1, 2]
    sim.engine.remove("anna")
    sim.tick()
    assert me(ros, "bert") == [1]
    ros.until(lambda: ros.node.count_publishers("/anna/_aseba/status") == 0)
    sim.simulator.runner.spawn(RobotStart("carl", -0.3, 0.0, 0.0))
    sim.tick()
    assert sorted(endpoints.number for endpoints in node.robots) == [2, 3]


def test_a_robot_that_is_added_later_gets_its_program(ros, simulation, runtime):
    sim = simulation(robot_names=["anna"])
    runtime("var me = 1")
    assert set_parameters(ros, {"robots.bert.script.source": "var me = 2"}).successful
    for _ in range(2):
        sim.simulator.runner.spawn(RobotStart("bert", 0.3, 0.0, 0.0))
        sim.tick()
        assert me(ros, "bert") == [2]
        sim.engine.remove("bert")
        sim.tick()


def test_a_tick_while_a_new_robot_gets_its_machine_does_not_stop_the_world(simulation, runtime, monkeypatch):
    """A robot with many endpoints takes longer than a tick to add; its machine is the last of them."""
    sim = simulation(playground="two_robots")
    runtime()
    runner = sim.simulator.runner
    monkeypatch.setattr(runner, "catch_up", lambda: runner.advance(1))
    runner.spawn(RobotStart("late", 0.0, 0.0))
    runner.update_robots()
    assert "late" in sim.engine.hosts
