"""Run control, breakpoints and the status of the runtime."""

from __future__ import annotations

import pytest
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from std_msgs.msg import Bool, Empty
from std_srvs.srv import Trigger

from tests.ros.aseba_tools import Proximity, Status, get_variables, set_parameters

SOURCE = """var n = 0
var m

onevent prox
    n = n + 1
    # a comment
    m = n
"""


@pytest.fixture
def prox(ros):
    """Send readings of proximity to the only robot."""
    sensors = []

    def send():
        if not sensors:
            sensors.append(Proximity(ros))
        sensors[0].send(*[-1.0] * 7)

    return send


def call(ros, word, robot=""):
    answer = ros.call(Trigger, f"{robot}/aseba/{word}")
    return answer.success, answer.message


def test_a_breakpoint_stops_before_its_line_and_reports_the_position(ros, runtime, prox):
    runtime(SOURCE)
    status = Status(ros)
    assert set_parameters(ros, {"breakpoints": [6, 99]}).successful
    prox()
    ros.until(lambda: status.place == ("paused", "prox", "7"))
    assert status.data("breakpoints") == [7]
    assert status.data("breakpoints_moved") == {"6": 7, "99": None}
    assert int(status["pc"]) > 0
    assert get_variables(ros, "n", "m") == [[1], [0]]
    assert call(ros, "run") == (True, "running")
    ros.until(lambda: status.place == ("running", "", ""))
    assert get_variables(ros, "m") == [[1]]
    assert set_parameters(ros, {"breakpoints": []}).successful
    ros.until(lambda: status.data("breakpoints") == [])
    prox()
    ros.until(lambda: get_variables(ros, "m") == [[2]])


def test_steps_by_line(ros, runtime, prox):
    runtime(SOURCE)
    assert call(ros, "pause") == (True, "paused")
    assert call(ros, "step_line") == (True, "paused")
    prox()
    ros.until(lambda: call(ros, "step_line") == (True, "paused at line 5 in prox"))
    assert call(ros, "step_line") == (True, "paused at line 7 in prox")
    assert call(ros, "step_line") == (True, "paused")
    assert get_variables(ros, "n", "m") == [[1], [1]]


def test_steps_by_instruction(ros, runtime, prox):
    runtime(SOURCE)
    call(ros, "pause")
    prox()
    ros.until(lambda: call(ros, "step") == (True, "paused at line 5 in prox"))
    assert get_variables(ros, "n") == [[0]]
    ros.until(lambda: call(ros, "step")[1] == "paused at line 7 in prox")
    assert get_variables(ros, "n") == [[1]]


def test_reset_stands_before_the_first_line(ros, runtime):
    runtime(SOURCE)
    assert call(ros, "reset") == (True, "paused at line 1 in init")
    status = Status(ros)
    ros.until(lambda: status.place == ("paused", "init", "1"))


def test_a_robot_that_is_off_reports_it(ros, runtime):
    runtime(SOURCE)
    status = Status(ros)
    ros.publisher(Empty, "/shutdown").publish(Empty())
    ros.until(lambda: status["state"] == "off")
    success, message = call(ros, "step_line")
    assert not success
    assert "aseba/run switches it on" in message
    assert call(ros, "run") == (True, "running")


def test_breakpoints_hold_over_a_new_program_and_a_reset(ros, runtime, prox):
    node = runtime(SOURCE)
    set_parameters(ros, {"breakpoints": [5]})
    assert set_parameters(ros, {"script.source": SOURCE + "\n"}).successful
    status = Status(ros)
    prox()
    ros.until(lambda: status.place == ("paused", "prox", "5"))
    node.robots.restart()
    prox()
    ros.until(lambda: status.place == ("paused", "prox", "5"))


def test_breakpoints_do_not_stop_built_in_behaviours(ros, runtime):
    runtime(SOURCE, breakpoints=[5, 7, 48])  # the last one is a line of the menu
    status = Status(ros)
    ros.until(lambda: status["breakpoints"] == "[5, 7]")
    assert set_parameters(ros, {"behaviour": "menu"}).successful
    ros.until(lambda: status["program"] == "menu.aesl")
    assert status["breakpoints"] == "[]"


def test_each_robot_may_have_breakpoints_of_its_own(ros, runtime):
    runtime(SOURCE, robots=["anna", "bert"])
    anna, bert = Status(ros, "/anna"), Status(ros, "/bert")
    assert set_parameters(ros, {"breakpoints": [5], "robots.bert.breakpoints": [7]}).successful
    ros.until(lambda: anna["breakpoints"] == "[5]" and bert["breakpoints"] == "[7]")
    assert set_parameters(ros, {"robots.bert.breakpoints": []}).successful
    ros.until(lambda: bert["breakpoints"] == "[5]")


def test_the_status_has_memory_use_and_warnings(ros, runtime):
    runtime("var n\nonevent prox\nreturn\nsub never\nreturn")
    status = Status(ros)
    ros.until(lambda: status["state"] == "running")
    assert (status["variables_size"], status["bytecode_size"], status["stack_size"]) == ("640", "1534", "32")
    assert 0 < int(status["bytecode_used"]) < 30
    assert int(status["stack_used"]) <= 32
    assert int(status["variables_used"]) > 100
    (warning,) = status.data("warnings")
    assert (warning["line"], warning["column"]) == (4, 1)
    assert warning["message"] == "subroutine 'never' is never called"


def test_a_late_subscriber_gets_the_last_fault(ros, runtime, prox):
    runtime("var i = 9\nvar t[3]\nonevent prox\n t[i] = 1")
    diagnostics = ros.collect(DiagnosticArray, "/diagnostics")
    prox()
    ros.until(lambda: any(one.level == DiagnosticStatus.ERROR for message in diagnostics for one in message.status))
    status = Status(ros)
    ros.until(lambda: status.place == ("fault", "prox", "4"))
    assert status["fault"] == "index 9 is outside an array of 3"
    assert status.data("faults") == {
        "en": "index 9 is outside an array of 3",
        "de": "der Index 9 liegt außerhalb eines Feldes mit 3 Elementen",
        "fr": "l’indice 9 est hors d’un tableau de 3",
        "it": "l’indice 9 è fuori da un array di 3",
    }
    assert status.messages[-1].level == DiagnosticStatus.ERROR
    assert call(ros, "run") == (True, "running")


def test_a_fault_is_logged_with_its_line(ros, runtime, prox):
    from rcl_interfaces.msg import Log

    runtime("var i = 0\nonevent prox\n i = 1 / i", name="div.aesl")
    logs = ros.collect(Log, "/rosout")
    prox()
    ros.until(lambda: any("div.aesl: line 3: division by zero" in message.msg for message in logs))


def test_all_robots_are_on_diagnostics(ros, runtime):
    runtime(SOURCE, robots=["anna", "bert"])
    diagnostics = ros.collect(DiagnosticArray, "/diagnostics")
    ros.until(lambda: any(len(message.status) == 4 for message in diagnostics))
    names = next([one.name for one in message.status] for message in diagnostics if len(message.status) == 4)
    assert names == ["aseba: anna", "aseba: bert", "aseba_runtime: messages", "aseba_runtime: connections"]


def test_simulated_time_that_jumps_back_ends_a_pause(ros, simulation, runtime):
    sim = simulation()
    runtime("var n = 0\ntimer.period[0] = 100\nonevent timer0\nn = n + 1", breakpoints=[4])
    status = Status(ros)
    sim.until(lambda: status.place == ("paused", "timer0", "4"))
    ros.call(Trigger, "/simulator/reset")
    sim.until(lambda: status["state"] == "running")
    sim.until(lambda: status.place == ("paused", "timer0", "4"))
    assert get_variables(ros, "n") == [[0]]


def test_a_button_of_the_simulator_meets_a_breakpoint(ros, simulation, runtime):
    sim = simulation()
    runtime("onevent button.center\ncall leds.top(32, 0, 0)", breakpoints=[2])
    status = Status(ros)
    ros.publisher(Bool, "/_press/center").publish(Bool(data=True))
    sim.until(lambda: status.place == ("paused", "button.center", "2"))
