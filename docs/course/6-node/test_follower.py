"""Lesson 6: a ROS node follows the line, at the speed of its parameter, and stops in front of things."""

import pytest
from geometry_msgs.msg import Twist

from thymio_sim_ros.sim.commands import SetGround, SetProximity
from thymio_sim_ros.testing import followed_line, no_contact

pytestmark = pytest.mark.thymio(playground="town.json")

BLACK, WHITE = 80, 930
NOTHING, HAND = (0,) * 7, (0, 0, 4200, 0, 0, 0, 0)


@pytest.fixture
def follow(ros, simulation):
    """Start the simulation and the node; return the simulation and the list of its commands."""

    def follow(**parameters):
        sim = simulation()
        ros.start("follower.py", parameters=parameters)
        return sim, ros.collect(Twist, "/cmd_vel")

    return follow


def test_it_publishes_commands(follow):
    _, commands = follow()
    assert commands.next(sim_time=1).linear.x > 0


@pytest.mark.parametrize("lighter", ["left", "right"])
def test_it_turns_to_the_darker_side(follow, lighter):
    sim, commands = follow()
    sim.thymio.post(SetGround((WHITE, BLACK) if lighter == "left" else (BLACK, WHITE)))
    sim.step(0.5)
    turn = commands.latest.angular.z
    assert turn < 0 if lighter == "left" else turn > 0


@pytest.mark.points(4)
@pytest.mark.parametrize("seed", range(2))
def test_it_follows_the_line_for_a_lap(follow, seed):
    sim, _ = follow()
    lap = followed_line(sim.thymio)
    sim.until(lap | ~no_contact(sim.thymio), seconds=45)
    assert lap & no_contact(sim.thymio)


@pytest.mark.points(2)
@pytest.mark.parametrize("speed", [0.03, 0.06])
def test_its_speed_is_a_parameter(follow, speed):
    sim, commands = follow(speed=speed)
    sim.step(1)
    assert commands.latest.linear.x == pytest.approx(speed)


@pytest.mark.points(2)
def test_it_stops_in_front_of_a_hand_and_goes_on(follow):
    sim, _ = follow()
    sim.step(1)
    sim.thymio.post(SetProximity(HAND))
    sim.step(1)
    assert sim.thymio.speed == 0
    sim.thymio.post(SetProximity(NOTHING))
    sim.until(lambda: sim.thymio.speed > 0.02, seconds=2)
