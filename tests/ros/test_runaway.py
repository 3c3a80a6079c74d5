"""Programs without an end: the node answers, the robot stops, and the status says what is too fast."""

from __future__ import annotations

import json
import threading
import time
from functools import partial
from pathlib import Path

import pytest
from diagnostic_msgs.msg import DiagnosticStatus
from std_srvs.srv import Trigger

from tests.patience import PATIENCE_S
from tests.ros.aseba_tools import Status, get_variables, set_parameters
from thymio_sim_ros.ros.aseba.node import AsebaRuntime, RuntimeParams
from thymio_sim_ros.ros.rclpy_ext.node_runner import run_node
from thymio_sim_ros.ros.simulator.node import Simulator, SimulatorParams

PROGRAMS = sorted((Path(__file__).parent.parent / "data" / "runaway").glob("*.aesl"))
ANSWER_CPU_S = 1.0
"""Processor time of the node's thread until it has answered six requests: the programs take all that it gets."""
FLOOD = "var i\nvar k = 0\nwhile k == 0 do\ni = (i + 1) % 32\ncall leds.top(i, 0, 0)\nend"


@pytest.fixture
def threaded(ros):
    """Make a simulator with a runtime and a thread of its own, as in a process of ours; ended with the test."""
    stop, threads = threading.Event(), []

    def make(*names, **parameters):
        runnable = Simulator(ros.context, SimulatorParams(playground=playground(names)))
        runnable.attached = (AsebaRuntime(ros.context, RuntimeParams(**parameters), simulator=runnable),)
        thread = threading.Thread(target=run_node, args=(runnable, ros.context, stop.is_set))
        threads.append((runnable, thread))
        thread.start()
        runnable.processor_s = partial(time.clock_gettime, time.pthread_getcpuclockid(thread.ident))
        return runnable

    yield make
    stop.set()
    for runnable, thread in threads:
        thread.join(PATIENCE_S)
        assert not thread.is_alive()
        runnable.close()


def playground(names):
    """A floor with robots of these names in a row."""
    floor = {"kind": "rectangle", "size_x_m": 4.0, "size_y_m": 4.0, "color": "#ffffff"}
    robots = [{"name": name, "x_m": 0.3 * place, "y_m": 0.0} for place, name in enumerate(names)]
    return json.dumps({"format": 1, "title": "row", "shapes": [floor], "robots": robots})


def test_there_are_twenty_programs():
    assert len(PROGRAMS) == 20


@pytest.mark.parametrize("program", PROGRAMS, ids=lambda path: path.stem)
def test_a_program_can_always_be_stopped(ros, threaded, tmp_path, program):
    robots = ["anna", "bert"]
    folders = {"card": str(tmp_path / "card"), "settings": str(tmp_path / "settings")}
    node = threaded(*robots, path=str(program), **folders)
    status = Status(ros, "/anna")
    ros.until(lambda: status.messages)
    began_s = node.processor_s()
    for robot in robots:
        assert get_variables(ros, "motor.left.target", robot=f"/{robot}") != [None]
    assert set_parameters(ros, {"robots.bert.script.source": "motor.left.target = 7"}).successful
    answer = ros.call(Trigger, "/anna/aseba/stop", Trigger.Request())
    assert answer.success
    ros.until(lambda: status["state"] == "stopped")
    assert get_variables(ros, "motor.left.target", robot="/anna") == [[0]]
    assert node.processor_s() - began_s < ANSWER_CPU_S
    assert all(path.name.startswith(("u", "r")) for path in (tmp_path / "card").rglob("*") if path.is_file())


def test_an_overload_is_reported_until_it_ends(ros, threaded):
    threaded("thymio", source=FLOOD)
    status = Status(ros)
    diagnostics = ros.collect(DiagnosticStatus, "/_aseba/status", transient_local=True)
    ros.until(lambda: diagnostics and diagnostics[-1].level == DiagnosticStatus.WARN)
    assert "call leds.top" in status["overload"]
    assert "slowed down" in diagnostics[-1].message
    assert status["state"] == "running"
    assert set_parameters(ros, {"script.source": "var a = 1"}).successful
    ros.until(lambda: diagnostics[-1].level == DiagnosticStatus.OK)
    assert status["overload"] == ""


def test_robots_share_the_node_in_turn(ros, threaded):
    names = ("anna", "bert", "carl", "dora")
    threaded(*names, source="var i\nvar k = 0\nwhile k == 0 do\ni++\nend")

    def counts():
        return [get_variables(ros, "i", robot=f"/{name}")[0][0] for name in names]

    first = counts()
    ros.until(lambda: all(now != before for now, before in zip(counts(), first, strict=True)))
