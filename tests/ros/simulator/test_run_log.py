"""The log of the present run, which the simulator always keeps."""

from __future__ import annotations

import base64
import random

from geometry_msgs.msg import Twist, Vector3
from std_srvs.srv import Trigger

from tests.ros.aseba_tools import set_parameters
from thymio_sim_ros.engine.replay import last_run, replay
from thymio_sim_ros.ros.simulator import recording
from thymio_sim_ros.sim.commands import MotorTargets


def saved(ros, folder):
    """Ask the simulator for the log, and save it as the page does."""
    answer = ros.call(Trigger, "/simulator/get_run_log")
    assert answer.success, answer.message
    path = folder / "run.jsonl.gz"
    path.write_bytes(base64.b64decode(answer.message))
    return path


def test_a_live_run_with_programs_and_commands_is_repeated_bit_for_bit(ros, simulation, runtime, tmp_path):
    sim = simulation(playground="two_robots")
    runtime(path="explorer")
    sim.step(1.0)
    drive = ros.publisher(Twist, "/red/cmd_vel")
    for _ in range(5):
        drive.publish(Twist(linear=Vector3(x=0.1), angular=Vector3(z=1.0)))
        sim.step(0.1)
    assert set_parameters(ros, {"robots.blue.script.source": "motor.left.target = 200"}).successful
    assert ros.call(Trigger, "/red/aseba/pause").success
    sim["blue"]["motor.right.target"] = 50
    sim.step(1.0)
    found = replay(saved(ros, tmp_path))
    assert (found.runs, found.differs, found.is_complete) == (1, None, True)
    assert found.ticks == 250


def test_a_run_goes_on_after_it_was_saved(ros, simulation, runtime, tmp_path):
    sim = simulation()
    runtime(path="explorer")
    for seconds in (1.23, 2.46):
        sim.step(1.23)
        found = replay(saved(ros, tmp_path))
        assert (found.seconds, found.differs, found.is_complete) == (seconds, None, True)


def test_the_log_begins_with_the_last_reset_or_world(ros, simulation, tmp_path):
    sim = simulation()
    sim.step(3.0)
    sim.reset()
    sim.step(2.0)
    assert last_run(saved(ros, tmp_path)).ticks == 200
    assert sim.simulator.parameter_callbacks.load_playground("desk") == ""
    sim.step(1.0)
    run = last_run(saved(ros, tmp_path))
    assert (run.name, run.ticks) == ("desk", 100)


def test_a_run_that_is_too_large_is_said_to_be_until_the_next_reset(ros, simulation, monkeypatch, tmp_path):
    sim, dice = simulation(), random.Random(1)
    monkeypatch.setattr(recording, "MAX_KEPT_BYTES", 10_000)
    sim.reset()
    for _ in range(20_000):
        sim.engine.post("thymio", MotorTargets(dice.randint(-500, 500), dice.randint(-500, 500)))
    sim.step(1.0)
    answer = ros.call(Trigger, "/simulator/get_run_log")
    assert (answer.success, answer.message[:22]) == (False, "the run is larger than")
    monkeypatch.undo()
    sim.reset()
    sim.step(1.0)
    assert last_run(saved(ros, tmp_path)).ticks == 100


def test_a_log_with_programs_is_shown_as_it_was(ros, simulation, runtime, tmp_path):
    sim = simulation(playground="two_robots")
    node = runtime(path="explorer")
    sim.step(1.0)
    assert set_parameters(ros, {"robots.blue.script.source": "motor.left.target = 200", "breakpoints": [1]}).successful
    sim.step(2.0)
    poses, status = sim.engine.world.snapshot().robots, [one.device.status for one in node.robots]
    path = saved(ros, tmp_path)
    ros.end(node)
    ros.end(sim.simulator)
    shown = simulation(replay=str(path), replay_from=0.5)
    seen = runtime()
    shown.step(2.5)
    assert shown.engine.world.snapshot().robots == poses
    assert [one.device.status for one in seen.robots] == status
    assert [one.program.name for one in seen.robots] == ["explorer.aesl", "program"]
