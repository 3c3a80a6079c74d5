"""The simulator shows the last run of a run log: paused shortly before its end, with the inputs of the log."""

from __future__ import annotations

import pytest
from nav_msgs.msg import Odometry

from tests.sim.builders import shipped
from thymio_sim_ros.engine.engine import Engine
from thymio_sim_ros.engine.run_log import RunLog
from thymio_sim_ros.ros.rclpy_ext.node_runner import StartError
from thymio_sim_ros.sim.commands import MotorTargets
from thymio_sim_ros.sim.playground.reader import RobotStart

TICKS = 500


@pytest.fixture
def logged(tmp_path):
    """A log of two runs, and the poses after each tick of the second one."""
    path = tmp_path / "run.jsonl"
    engine = Engine(shipped("obstacle"), seed=4)
    log = RunLog(path.open("w", encoding="utf-8"))
    log.begin("obstacle", engine)
    for _ in range(50):
        engine.step()
    engine.reset()
    poses = []
    for tick in range(TICKS):
        if tick in (100, 400):
            engine.post("thymio", MotorTargets(tick, 200))
        engine.step()
        poses.append(engine.world.robots["thymio"].pose)
    log.close()
    return path, poses


def pose(sim):
    return sim.world.robots["thymio"].pose


def test_a_replay_begins_before_the_end_and_stops_at_it(simulation, logged):
    path, poses = logged
    sim = simulation(replay=str(path))
    runner = sim.simulator.runner
    assert (runner.paused, sim.world.now_ns) == (True, 2_000_000_000)
    assert pose(sim) == poses[199]
    runner.pause(False)
    while not runner.paused:
        runner.advance(1)
    assert (sim.world.now_ns, pose(sim)) == (5_000_000_000, poses[-1])
    runner.reset()
    runner.advance(450)
    assert pose(sim) == poses[449]


def test_another_time_and_another_playground(simulation, logged):
    path, poses = logged
    sim = simulation(replay=str(path), replay_from=4.5)
    assert pose(sim) == poses[449]
    runner = sim.simulator.runner
    runner.replace(runner.prepared, Engine(shipped("obstacle"), seed=4))
    runner.advance(300)
    assert pose(sim) == poses[0]  # it stands: the inputs of the log belong to the replay only


def test_robots_that_come_and_go_in_the_log_have_topics(simulation, ros, tmp_path):
    path = tmp_path / "run.jsonl"
    engine = Engine(shipped("two_robots"), seed=4)
    log = RunLog(path.open("w", encoding="utf-8"))
    log.begin("two_robots", engine)
    for tick in range(TICKS):
        if tick == 100:
            engine.spawn(RobotStart("late", 0.0, 0.0))
        if tick == 300:
            engine.remove("late")
        engine.step()
    log.close()
    sim = simulation(replay=str(path), replay_from=0.0)
    runner, robots = sim.simulator.runner, sim.simulator.endpoints.robots
    ros.collect(Odometry, "/red/odom")
    runner.advance(150)  # the robot comes within these ticks
    assert list(robots.names) == ["red", "blue", "late"]
    late = ros.collect(Odometry, "/late/odom")
    runner.advance(100)
    ros.until(lambda: late)
    runner.advance(100)
    assert list(robots.names) == ["red", "blue"]


@pytest.mark.parametrize("content", ["no log", None])
def test_a_file_that_is_no_log_is_refused(simulation, tmp_path, content):
    path = tmp_path / "run.jsonl"
    if content is not None:
        path.write_text(content)
    with pytest.raises(StartError, match=r"run\.jsonl"):
        simulation(replay=str(path))
