"""Lesson 5: the courier measures its floor, obeys topics, and reports on a topic that it has arrived."""

import pytest
from std_msgs.msg import Bool, Int16MultiArray

from thymio_sim_ros.testing import no_contact

pytestmark = pytest.mark.thymio(playground="depot.json", program="courier.aesl")


@pytest.fixture
def sim(ros, simulation, runtime):
    """The depot, with the program in the robot."""
    sim = simulation()
    runtime()
    return sim


@pytest.fixture
def send(ros, sim):
    """Send an event to the program, as `ros2 topic pub` does."""

    def send(event, *args):
        ros.publisher(Int16MultiArray, f"/aseba/emit/{event}").publish(Int16MultiArray(data=args))
        sim.step(0.3)

    return send


def measure(ros, sim):
    """Press the round button, and wait for the topic that says what the robot has measured."""
    measured = ros.collect(Int16MultiArray, "/aseba/events/measured")
    button = ros.publisher(Bool, "/_press/center")
    for pressed in (True, False):
        button.publish(Bool(data=pressed))
        sim.step(0.1)
    return measured.next(sim_time=15).data


def test_it_measures_and_says_so(ros, sim):
    black, white = measure(ros, sim)
    assert white > black + 200


@pytest.mark.points(2)
def test_it_waits_for_go(ros, sim, send):
    measure(ros, sim)
    sim.step(2)
    assert sim.thymio.speed == 0
    send("go", 150)
    sim.until(lambda: sim.thymio.speed > 0.02, seconds=2)


@pytest.mark.points(2)
@pytest.mark.parametrize(("speed", "m_s"), [(100, 0.033), (250, 0.083)])
def test_it_drives_as_fast_as_go_says(ros, sim, send, speed, m_s):
    measure(ros, sim)
    send("go", speed)
    sim.step(3)
    assert sim.thymio.speed == pytest.approx(m_s, rel=0.1)


@pytest.mark.points(2)
def test_halt_stops_it(ros, sim, send):
    measure(ros, sim)
    send("go", 150)
    sim.step(1)
    assert sim.thymio.speed > 0.02
    send("halt")
    sim.step(0.5)
    assert sim.thymio.speed == 0


def test_go_before_measuring_is_ignored(sim, send):
    send("go", 150)
    sim.step(2)
    assert (sim.thymio["motor.left.target"], sim.thymio["motor.right.target"]) == (0, 0)
    assert sim.thymio["speed"] != 0


def test_it_stops_at_the_gate(ros, sim, send):
    measure(ros, sim)
    send("go", 250)
    sim.until(lambda: sim.thymio.pose.x_m > 0.45, seconds=25)
    sim.step(2)
    assert sim.thymio.speed == 0
    assert no_contact(sim.thymio)


def test_it_says_once_that_it_has_arrived(ros, sim, send):
    arrived = ros.collect(Int16MultiArray, "/aseba/events/arrived")
    measure(ros, sim)
    send("go", 250)
    arrived.next(sim_time=25)
    sim.step(3)
    assert len(arrived) == 1
