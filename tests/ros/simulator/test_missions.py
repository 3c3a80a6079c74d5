"""A mission in the live world: started by a service, judged while programs run, published for pages."""

from __future__ import annotations

import base64
import hashlib
import io
import json
import zipfile
from pathlib import Path

import pytest
from rcl_interfaces.msg import Parameter, ParameterType, ParameterValue
from rcl_interfaces.srv import SetParameters
from rclpy.parameter import Parameter as RosParameter
from std_msgs.msg import String
from std_srvs.srv import Trigger

from tests.ros.aseba_tools import set_parameters
from thymio_sim_ros.engine.engine import Engine
from thymio_sim_ros.engine.replay import replay
from thymio_sim_ros.files.loading import load_playground, read_program
from thymio_sim_ros.missions import Judge, load_mission

COURSE = Path(__file__).parents[3] / "docs" / "course"
BUS = COURSE / "3-blocks" / "mission.json"
SOLUTION = COURSE / "3-blocks" / "programs" / "solution.aesl"


def ask(ros, service, name, file=None):
    """The result of a service for a shipped mission or a file."""
    value = ParameterValue()
    if file is not None:
        value.type = ParameterType.PARAMETER_STRING
        value.string_value = f"data:;name={name};base64,{base64.b64encode(file).decode()}"
    request = SetParameters.Request(parameters=[Parameter(name=name, value=value)])
    (result,) = ros.call(SetParameters, f"/simulator/{service}", request).results
    return result


def start(ros, name, file=None):
    """Start a mission; returns the reason of a refusal."""
    result = ask(ros, "start_mission", name, file)
    assert result.successful == (not result.reason)
    return result.reason


def latest(ros, topic):
    """The last message of a retained topic, as JSON."""
    received = ros.collect(String, topic)
    ros.until(lambda: received)
    return json.loads(received[-1].data)


def test_a_program_on_the_live_robot_gets_the_stars_of_the_command(ros, simulation, runtime, tmp_path):
    mission, program = load_mission(BUS), read_program(str(SOLUTION))
    engine = Engine(load_playground(mission.playground)[1], {"thymio": program})
    judge = Judge(mission, engine)
    while not judge.is_over:
        engine.step(())
        judge.tick()
    assert judge.verdict.is_passed

    sim = simulation(playground="base")
    runtime()
    sim.step(0.5)
    assert start(ros, str(BUS)) == ""
    found = latest(ros, "/simulator/_mission")
    assert (found["title"], found["robot"], found["languages"]) == ("One round by bus", "", list(mission.languages))
    tries = ros.collect(String, "/simulator/_mission/try")
    ros.until(lambda: len(tries))
    sim.step(0.5)
    assert json.loads(tries[-1].data)["state"] == "waiting"
    assert set_parameters(ros, {"script.source": SOLUTION.read_text()}).successful
    sim.until(lambda: json.loads(tries[-1].data)["state"] != "running" and len(tries) > 3, seconds=200)
    shown = json.loads(tries[-1].data)
    assert (shown["state"], shown["stars"], shown["at_s"]) == ("passed", list(judge.verdict.stars), judge.verdict.at_s)
    assert shown["trace"] == [[round(x, 3), round(y, 3)] for x, y in judge.trace]
    assert sim.simulator.missions.live.verdict == judge.verdict

    log = tmp_path / "run.jsonl.gz"  # what the mission does to the robot is in the log, and the log has no judge
    log.write_bytes(base64.b64decode(ros.call(Trigger, "/simulator/get_run_log").message))
    repeated = replay(log)
    assert (repeated.differs, repeated.is_complete) == (None, True)


def test_the_programs_before_do_not_drive_in_the_mission(ros, simulation, runtime):
    sim = simulation(playground="base")
    runtime(path="explorer")
    sim.step(1.0)
    assert start(ros, str(BUS)) == ""
    before = sim.world.robots["thymio"].pose
    sim.step(1.0)
    assert sim.world.robots["thymio"].pose == before


def test_another_playground_ends_the_mission(ros, simulation):
    sim = simulation(playground="base")
    assert start(ros, str(BUS)) == ""
    sim.simulator.parameter_callbacks.load_playground("desk")
    assert latest(ros, "/simulator/_mission") is None
    assert sim.simulator.missions.live is None


def test_another_seed_keeps_the_mission(ros, simulation):
    sim = simulation(playground="base")
    assert start(ros, str(BUS)) == ""
    assert sim.simulator.missions.live is not None
    assert sim.simulator.node.set_parameters([RosParameter("seed", value=4)])[0].successful
    sim.reset()
    sim.step(0.1)
    assert latest(ros, "/simulator/_mission/try")["state"] == "running"
    assert sim.simulator.missions.live.verdict.at_s == 0.1


def zipped(**members):
    """A mission in which the robot has to stand for a second, as a zip with solutions."""
    mission = {
        "format": 1, "title": "Wait", "playground": "base", "time_s": 2.0,
        "facts": {"a": {"kind": "still", "text": "It stands"}}, "success": {"hold": "a", "for_s": 1.0},
    }  # fmt: skip
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w") as archive:
        archive.writestr("mission.json", json.dumps(mission | members))
        archive.writestr("wait.aesl", "var a\n")
        archive.writestr("go.aesl", "motor.left.target = 200\nmotor.right.target = 200\n")
        archive.writestr("node.py", "raise SystemExit(1)\n")
    return packed.getvalue()


def test_solutions_that_do_not_pass_are_named_and_the_open_mission_goes_on(ros, simulation):
    sim = simulation(playground="base")
    assert start(ros, str(BUS)) == ""
    file = zipped(solutions={"text": "go.aesl", "vpl": "wait.aesl", "ros": "node.py"})
    result = ask(ros, "check_mission", "wait.zip", file)
    assert (result.successful, json.loads(result.reason)) == (True, {"text": [False]})
    result = ask(ros, "check_mission", "wait.zip", zipped(solutions={"text": "none.aesl"}))
    assert not result.successful
    assert "none.aesl" in result.reason
    assert sim.simulator.missions.live.mission.title == "One round by bus"


def test_a_mission_that_ends_is_not_judged_any_more(ros, simulation):
    sim = simulation(playground="base")
    assert start(ros, str(BUS)) == ""
    assert ros.call(Trigger, "/simulator/end_mission").success
    assert latest(ros, "/simulator/_mission") is None
    sim.step(0.1)
    assert sim.engine.recorders == [sim.engine.recorders[0]]  # that of the log


@pytest.mark.parametrize(
    ("members", "reason"),
    [
        (
            {"zones": {"z": {"kind": "disc", "x_m": 50, "y_m": 0, "radius_m": 0.1}}},
            "zones.z: found a zone without ground",
        ),
        ({"robot": "bert"}, "facts.bump.robot: found 'bert'"),
        ({"happens": [{"at_s": 1, "move": "moon", "x_m": 0, "y_m": 0}]}, "happens[0].move: found 'moon'"),
        ({"programs": {"text": "gone.aesl"}}, "programs.text: found no file 'gone.aesl'"),
    ],
)
def test_a_mission_that_does_not_fit_leaves_the_one_before(ros, simulation, members, reason):
    sim = simulation(playground="base")
    assert start(ros, str(BUS)) == ""
    before, world = sim.simulator.missions.live, sim.simulator.runner.engine
    file = {
        "format": 1,
        "title": "Mine",
        "playground": "desk",
        "success": "bump",
        "facts": {"bump": {"kind": "touches"}},
    }
    assert start(ros, "my.json", json.dumps(file | members).encode()).startswith(f"my.json: {reason}")
    assert sim.simulator.missions.live is before
    assert sim.simulator.runner.engine is world
    assert latest(ros, "/simulator/_mission")["title"] == "One round by bus"


def test_the_file_of_a_client_is_a_mission(ros, simulation):
    simulation(playground="base")
    file = {"format": 1, "title": "Mine", "playground": "desk", "success": "bump"}
    file["facts"] = {"bump": {"kind": "touches", "what": "moon"}}
    assert start(ros, "my.json", json.dumps(file).encode()).startswith("my.json: facts.bump.what: found 'moon'")
    file["facts"]["bump"].pop("what")
    assert start(ros, "my.json", json.dumps(file).encode()) == ""
    assert latest(ros, "/simulator/_mission")["name"] == "my"
    mine = json.dumps(file).encode()
    assert latest(ros, "/simulator/_mission/try")["file"] == hashlib.sha256(mine).hexdigest()
    assert start(ros, "forward.json", mine) == ""  # is not the shipped one, whose stars are others
    assert latest(ros, "/simulator/_mission")["name"] == "forward.json"
    assert start(ros, "forward") == ""
    assert latest(ros, "/simulator/_mission/try")["file"] == ""


@pytest.mark.parametrize(
    ("name", "file", "reason"),
    [
        ("nowhere", None, "no mission 'nowhere'"),
        ("my.json", b"{", "JSON"),
        ("my.json", b'{"format": 1, "title": "T", "playground": "desk"}', "success: found nothing"),
        ("my.json", b'{"format": 1, "title": "T", "playground": "desk", "facts": {"s": {"kind": "still"}}, '
                    b'"success": "s", "programs": {"text": "/etc/hostname.aesl"}}', "programs.text"),
        ("my.json", b'{"format": 1, "title": "T", "playground": "/etc/world.json", "facts": {"s": {"kind": "still"}}, '
                    b'"success": "s"}', "playground"),
    ],
)  # fmt: skip
def test_a_refused_mission_says_where_and_the_one_before_goes_on(ros, simulation, name, file, reason):
    sim = simulation(playground="base")
    assert start(ros, str(BUS)) == ""
    assert reason in start(ros, name, file)
    assert sim.simulator.missions.live is not None
    assert latest(ros, "/simulator/_mission")["title"] == "One round by bus"
