"""Ticks without a visible result are deferred and executed together; messages see the world as if they were not.

Wall time is simulated: the executor of these tests advances it and calls events of the test on the way.
"""

from __future__ import annotations

import types

import pytest
from geometry_msgs.msg import TransformStamped, Twist, Vector3
from nav_msgs.msg import Odometry
from rclpy.parameter import Parameter
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import Range
from std_msgs.msg import Bool
from std_srvs.srv import SetBool

from thymio_sim_ros.ros.simulator import clock_publisher, endpoints, world_endpoints, world_runner
from thymio_sim_ros.ros.simulator import node as simulator_node
from thymio_sim_ros.ros.simulator.robot_endpoints import RobotEndpoints
from thymio_sim_ros.ros.simulator.tick_scheduler import MAX_DEFERRED_TICKS
from thymio_sim_ros.sim.commands import BodyTwist
from thymio_sim_ros.sim.model.clock import TICK_NS
from thymio_sim_ros.sim.playground.reader import RobotStart
from thymio_sim_ros.sim.world import World

MS = 1_000_000


class Sleeper:
    """An executor that sleeps in simulated wall time, until the next event added with `at`."""

    def __init__(self) -> None:
        self.now_ns = 1_000 * MS
        self.slept_ms: list[int] = []
        self._events: list[tuple[int, object]] = []

    def at(self, ms: int, act) -> None:
        """Call `act` in `ms` of wall time."""
        self._events.append((self.now_ns + ms * MS, act))

    def monotonic_ns(self) -> int:
        return self.now_ns

    def spin_once(self, timeout_sec: float) -> None:
        begin, end = self.now_ns, self.now_ns + round(timeout_sec * 1e9)
        due = min((event for event in self._events if event[0] <= end), default=None, key=lambda event: event[0])
        self.now_ns = end if due is None else due[0]
        if due is not None:
            self._events.remove(due)
            due[1]()
        self.slept_ms.append(round((self.now_ns - begin) / MS))


@pytest.fixture
def sleeper(monkeypatch):
    """Simulated wall time in all modules of the simulator that read it."""
    sleeper = Sleeper()
    for module in (simulator_node, world_runner, endpoints, clock_publisher, world_endpoints):
        monkeypatch.setattr(module, "time", types.SimpleNamespace(monotonic_ns=sleeper.monotonic_ns))
    return sleeper


@pytest.fixture
def driven(simulation, sleeper):
    """Start a simulator; the returned function runs it for some ms of wall time and returns its world."""

    def turn(milliseconds: int) -> World:
        end = sleeper.now_ns + milliseconds * MS
        while sleeper.now_ns < end:
            turn.sim.simulator.run_once(sleeper)
        return turn.sim.world

    def start(**parameters):
        turn.sim = simulation(playground="base", **parameters)
        turn.sim.simulator.runner.pause(False)
        turn.sim.simulator._publish_heartbeat(sleeper.now_ns)
        sleeper.slept_ms.clear()
        return turn

    return start


def test_without_subscribers_ticks_are_executed_together(driven, sleeper):
    world = driven()(1000)
    assert world.now_ns == pytest.approx(1000 * MS, abs=MAX_DEFERRED_TICKS * TICK_NS)
    assert max(sleeper.slept_ms) == MAX_DEFERRED_TICKS * TICK_NS // MS
    assert len(sleeper.slept_ms) < 15


@pytest.mark.parametrize(
    ("kind", "topic", "rate_hz"), [(Odometry, "/odom", 20), (Range, "/proximity/center", 10), (Clock, "/clock", 50)]
)
def test_a_topic_with_subscribers_is_published_on_time(ros, driven, sleeper, kind, topic, rate_hz):
    turn = driven()
    messages = ros.collect(kind, topic)
    turn(1005)
    ros.until(lambda: len(messages) >= rate_hz)
    assert len(sleeper.slept_ms) <= rate_hz + 15


def test_a_command_takes_effect_in_the_tick_after_it_came(driven, sleeper):
    turn = driven()
    command, done = BodyTwist(0.1, 0.5), []
    post = turn.sim.simulator.endpoints.robots["thymio"]._owner.post
    sleeper.at(34, lambda: (post(command), done.append(turn.sim.world.now_ns)))
    world = turn(500)
    assert done == [30 * MS]

    alone = World(world.playground)
    while alone.now_ns < world.now_ns:
        if alone.now_ns == 30 * MS:
            alone.post("thymio", command)
        alone.step()
    assert alone.robots["thymio"].pose == world.robots["thymio"].pose
    assert alone.robots["thymio"].wheels.odometry == world.robots["thymio"].wheels.odometry


def test_a_drag_sees_the_present_world(driven, sleeper):
    turn, done = driven(), []
    place = TransformStamped(child_frame_id="thymio")
    place.transform.translation.x = 0.2
    services = turn.sim.simulator._services
    sleeper.at(34, lambda: (services._place(place), done.append(turn.sim.world.now_ns)))
    world = turn(41)
    assert done == [30 * MS]
    assert world.robots["thymio"].pose.x_m == 0.2


def test_the_effect_of_a_command_is_published_one_tick_later(ros, driven, sleeper):
    turn = driven()
    velocity = ros.publisher(Twist, "/cmd_vel")
    velocity.publish(Twist(linear=Vector3(x=0.1)))
    sleeper.at(31, lambda: ros.until(lambda: turn.sim.simulator.runner.scheduler._prompt_until_ns))
    turn(31)
    assert turn.sim.world.now_ns == 30 * MS
    sleeper.slept_ms.clear()
    turn(9)
    assert sleeper.slept_ms == [9]
    assert turn.sim.world.now_ns == 30 * MS
    turn(1)
    assert turn.sim.world.now_ns == 40 * MS


def test_services_see_the_present_world(ros, driven, sleeper):
    turn = driven()
    found = []
    request = SetBool.Request(data=True)
    sleeper.at(57, lambda: found.append(ros.call(SetBool, "/simulator/pause", request)))
    turn(57)
    assert found[0].success
    assert turn.sim.world.now_ns == 50 * MS


def test_a_change_of_pace_drops_no_tick(driven, sleeper):
    turn = driven()
    factor = Parameter("real_time_factor", value=2.0)
    sleeper.at(75, lambda: turn.sim.simulator.node.set_parameters([factor]))
    turn(75)
    assert turn.sim.world.now_ns == 70 * MS


def test_a_robot_whose_topics_take_time_is_created_once(simulator_with, sleeper, monkeypatch):
    """A QoS override declares parameters while the topics of the robot are created."""
    made = []

    def slow_endpoints(node, names, *arguments, **options):
        made.append(names.name)
        sleeper.now_ns += 30 * MS if len(made) < 4 else 0
        return RobotEndpoints(node, names, *arguments, **options)

    override = "qos_overrides./later/odom.publisher.reliability:=best_effort"
    simulator = simulator_with("-p", override, playground="base")
    monkeypatch.setattr(simulator_node, "RobotEndpoints", slow_endpoints)
    sleeper.at(30, lambda: (simulator.runner.spawn(RobotStart("later", 0.3, 0.0)), simulator.runner.update_robots()))
    simulator.run_once(sleeper)
    assert made == ["later"]


def test_without_a_runner_no_tick_is_executed(ros, simulation):
    sim = simulation(playground="base")
    pressed = ros.publisher(Bool, "/_press/center")
    pressed.publish(Bool(data=True))
    ros.deliver()
    assert sim.world.now_ns == 0


def test_the_ticks_of_a_busy_machine_are_caught_up_or_counted(driven, sleeper):
    turn = driven()
    turn(300)
    sleeper.now_ns += 150 * MS
    world = turn(50)
    assert world.now_ns == pytest.approx(500 * MS, abs=MAX_DEFERRED_TICKS * TICK_NS)
    assert turn.sim.simulator.runner.scheduler.late_ticks > 0
    sleeper.now_ns += 1000 * MS
    turn(50)
    assert turn.sim.simulator.runner.scheduler.dropped_ticks > 50
