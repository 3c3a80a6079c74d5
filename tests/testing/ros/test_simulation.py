"""The simulator in a test: stepped, seen through its robots, with programs and with nodes under test."""

from __future__ import annotations

import pytest
from geometry_msgs.msg import Twist, Vector3
from nav_msgs.msg import Odometry

from tests.testing.test_thymio import WALL
from thymio_sim_ros.sim.playground.reader import RobotStart
from thymio_sim_ros.suite_config import SuiteConfig
from thymio_sim_ros.testing import emitted, no_contact, reached, shows, slower_than

GREET = """<network><event size="1" name="hello"/><node name="thymio-II">var heard = 0
onevent hello
heard = event.args[0]
onevent button.center
if button.center == 1 then
    emit hello [7]
    call leds.top(0, 32, 0)
end
</node></network>
"""


def test_a_robot_is_seen_as_in_a_classroom(ros, simulation):
    sim = simulation(playground=WALL, cmd_vel_timeout=0.0)
    ros.publisher(Twist, "/cmd_vel").publish(Twist(linear=Vector3(x=0.1)))
    sim.until(~no_contact(sim.thymio), seconds=10)
    assert [touch.other for touch in sim.thymio.touches] == ["wall"]
    assert reached(sim.thymio, (0.17, 0.0), tolerance=0.02)
    assert slower_than(sim.thymio, 0.11)
    assert sim.thymio.path[-1].at_s == sim.now


def test_a_velocity_ends_as_under_thymio_sim(ros, simulation):
    """What is graded is what the student saw: a node that publishes once drives for half a second."""
    sim = simulation()
    ros.publisher(Twist, "/cmd_vel").publish(Twist(linear=Vector3(x=0.1)))
    sim.step(SuiteConfig().cmd_vel_timeout_s - 0.1)
    assert sim.thymio.speed > 0.05
    sim.step(1.0)
    assert abs(sim.thymio.speed) < 0.001


def test_a_velocity_is_valid_until_the_next_one_on_request(ros, simulation):
    sim = simulation(cmd_vel_timeout=0.0)
    ros.publisher(Twist, "/cmd_vel").publish(Twist(linear=Vector3(x=0.1)))
    sim.step(2.0)
    assert sim.thymio.speed > 0.05


def test_a_reset_begins_the_past_anew(ros, simulation, runtime):
    sim = simulation(playground=WALL, cmd_vel_timeout=0.0)
    runtime('<network><event size="0" name="begun"/><node name="thymio-II">emit begun</node></network>')
    ros.publisher(Twist, "/cmd_vel").publish(Twist(linear=Vector3(x=0.1)))
    sim.until(~no_contact(sim.thymio), seconds=10)
    sim.reset()
    sim.step(0.1)
    assert no_contact(sim.thymio)
    assert len(sim.thymio.path) == 10
    assert [event.name for event in sim.thymio.record.events] == ["begun"]


def test_a_program_is_asked_and_touched_as_in_a_classroom(simulation, runtime):
    sim = simulation()
    runtime(GREET)
    thymio = sim.thymio
    thymio.touch("center")
    sim.until(emitted(thymio, "hello", [7], times=1) & shows(thymio, "top", "green"), seconds=1)
    assert thymio["heard"] == 0
    thymio.emit("hello", 5)
    sim.until(lambda: thymio["heard"] == 5, seconds=1)
    thymio.load("var fresh = 3")
    assert thymio["fresh"] == 3
    assert thymio.status.state == "running"


def test_a_robot_of_another_name_and_one_that_comes_later_have_their_programs(simulation, runtime):
    sim = simulation(playground="base", robot_names=["anna"])
    runtime(GREET)
    assert sim["anna"]["heard"] == 0
    sim.world.spawn(RobotStart("bert", 0.3, 0.0))
    sim.until(lambda: sim.machine("bert"), seconds=1)
    sim["bert"].touch("center")
    sim.until(emitted(sim["bert"], "hello", [7], times=1), seconds=1)
    assert sim["anna"]["heard"] == 7


def test_robots_are_distinguished(ros, simulation, runtime):
    sim = simulation(playground="two_robots")
    with pytest.raises(LookupError, match="2 robots: take one by its name: "):
        sim.thymio  # noqa: B018  (a property)
    runtime(GREET)
    sim.step(0.1)
    first, second = sim
    first.touch("center")
    sim.until(lambda: second["heard"] == 7, seconds=1)
    assert emitted(first, "hello")
    assert not emitted(second, "hello")
    assert sim[first.name] is first


def test_a_robot_without_a_machine_is_an_error(simulation):
    sim = simulation()
    with pytest.raises(LookupError, match="start one with the fixture `runtime`"):
        sim.thymio["x"]
    with pytest.raises(LookupError, match="start one with the fixture `runtime`"):
        sim.thymio.load("var x")
    with pytest.raises(LookupError, match="start one with the fixture `runtime`"):
        sim.thymio.emit("hello")
    assert sim.thymio.program is None


def test_a_failure_reports_the_fault_of_the_program(simulation, runtime):
    sim = simulation()
    runtime("var a = 0\n\nonevent buttons\na = 1 / a")
    with pytest.raises(pytest.fail.Exception) as caught:
        sim.until(lambda: False, seconds=0.2)
    assert "  program program: fault in buttons, line 4: division by zero" in str(caught.value).splitlines()


def test_a_handler_longer_than_its_turn_goes_on_with_the_ticks(simulation, runtime):
    sim = simulation()
    runtime("var i = 0\nvar rounds = 0\nwhile rounds < 20 do\nfor i in 1:1000 do\nend\nrounds++\nend")
    sim.until(lambda: sim.thymio["rounds"] == 20, seconds=5)


def test_time_is_counted_by_the_simulation(ros, simulation):
    sim = simulation()
    odometry = ros.collect(Odometry, "/odom")
    sim.run(1.0)
    assert sim.now == 1.0
    assert len(odometry) == 20


def test_robots_that_come_later_are_seen_too(simulation):
    sim = simulation(playground="two_robots")
    gone = next(iter(sim)).name
    sim.world.remove(gone)
    sim.step(0.1)
    assert f"{gone}: no longer in the world" in sim.lines()
