"""A robot behind a network, joined in memory with a device of ours: programs, events, variables, readings."""

from __future__ import annotations

import math

import pytest

from aseba_vm.protocol import Description, Disconnected, NodePresent, UserMessage
from aseba_vm.targets import THYMIO_II
from tests.device.remote.pair import Pair
from thymio_sim_ros.device.layout import LAYOUTS, target
from thymio_sim_ros.device.network_events import EmittedEvent
from thymio_sim_ros.device.programs.program import load_program
from thymio_sim_ros.device.programs.status import DeviceStatus
from thymio_sim_ros.device.remote.remote_device import RemoteHost
from thymio_sim_ros.device.remote.ros_handlers import served_natives
from thymio_sim_ros.sim.commands import (
    MotorTargets,
    ResetOdometry,
    SetLeds,
    StopSound,
)
from thymio_sim_ros.sim.model.readings import (
    AccelerometerReading,
    BatteryReading,
    GroundReading,
    PoseReading,
    ProximityReading,
    TapReading,
)

SECOND_NS = 1_000_000_000
TARGETS = ("motor.left.target", "motor.right.target")


def readings(pair: Pair) -> dict:
    return dict(pair.robot.pop_readings(pair.now_ns))


# -- connection


def test_a_robot_connects_with_its_own_layout(pair: Pair) -> None:
    assert (pair.robot.is_connected, pair.robot.connections, pair.remote.node_id) == (True, 1, 3)
    assert pair.robot.name == "thymio-II (node 3, protocol 9)"
    assert target(pair.remote.layout).addresses == target().addresses
    assert pair.remote.layout not in LAYOUTS


def test_before_it_connects_it_is_a_thymio_that_is_off() -> None:
    pair = Pair()
    assert target(pair.remote.layout) == THYMIO_II
    assert pair.remote.status == DeviceStatus("off", fault="not connected: not connected yet")
    with pytest.raises(ValueError, match=r"the robot is not connected \(not connected yet\)"):
        pair.robot.execute(MotorTargets(1, 1), 0)
    with pytest.raises(ValueError, match="_id: the robot is not connected"):
        pair.remote.variables.set("_id", [1])
    assert pair.robot.pop_messages() == []


def test_a_pulled_cable_is_noticed_and_the_program_starts_again(pair: Pair) -> None:
    pair.load("var n = 4")
    pair.pull()
    assert pair.remote.status.fault == "not connected: cable pulled"
    pair.tick(3)
    pair.plug_in()
    assert pair.robot.connections == 2
    assert pair.remote.status.state == "running"


def test_a_silent_robot_is_lost(pair: Pair) -> None:
    pair.is_plugged = False
    pair.tick(70)
    assert pair.remote.status.fault == "not connected: no answer for 3 s"


def test_a_robot_that_leaves_is_lost(pair: Pair) -> None:
    pair.robot.receive(Disconnected(3))
    assert not pair.robot.is_connected


def test_a_robot_that_crashes_while_it_describes_itself_is_reported() -> None:
    pair = Pair()
    pair.robot.start(0)
    pair.robot.receive(NodePresent(1, 5))
    pair.robot.receive(Description(1, "dummynode-0", 5, 512, 64, 1060, 0, 1, 30))
    pair.robot.end("the connection was closed")
    reason = "node 1: the connection was closed before its description was complete: 0 of 1 local events, 0 of 30 "
    assert pair.robot.problem == f"{reason}native functions"
    assert not pair.robot.is_connected


def test_a_second_node_is_not_used(pair: Pair) -> None:
    pair.robot.receive(NodePresent(8, 9))
    pair.robot.receive(Description(8, "other", 9, 8, 8, 8, 0, 0, 0))
    assert pair.remote.node_id == 3
    assert pair.remote.notices.pop() == ["node 8 is not used: the robot is node 3"]


# -- programs, events, variables


def test_a_program_runs_on_the_robot(pair: Pair) -> None:
    pair.load("var n = 4\nvar m[2] = [5, -6]\nmotor.left.target = 100")
    pair.tick()
    assert pair.value("motor.left.target") == (100,)
    assert (pair.remote.variables.get("n"), pair.remote.variables.get("m")) == ((4,), (5, -6))
    assert pair.remote.status == DeviceStatus("running")


def test_a_new_program_starts_with_wheels_at_rest(pair: Pair) -> None:
    pair.load("motor.left.target = 100")
    pair.load("var n")
    assert pair.value("motor.left.target") == (0,)


def test_events_go_both_ways(pair: Pair) -> None:
    pair.load("onevent ping\nemit pong [event.args[0] * 3, 7]", ("pong", 2), ("ping", 1))
    assert pair.remote.declares("ping")
    pair.remote.receive_event("ping", [5])
    pair.exchange()
    assert pair.remote.has_emitted
    assert pair.remote.pop_events() == [EmittedEvent("pong", (15, 7))]
    with pytest.raises(KeyError):
        pair.remote.receive_event("nothing", [])


def test_events_of_others_on_the_network_are_not_those_of_the_robot(pair: Pair) -> None:
    pair.load("onevent ping\n", ("ping", 1))
    pair.robot.receive(UserMessage(9, 0, (1,)))
    pair.robot.receive(UserMessage(3, 77, (1,)))
    assert pair.remote.pop_events() == []


def test_a_flood_of_events_is_limited(pair: Pair) -> None:
    pair.load("onevent ping\n", ("ping", 1))
    for _ in range(1000):
        pair.robot.receive(UserMessage(3, 0, (1,)))
    assert len(pair.remote.pop_events()) == 256
    assert pair.remote.notices.pop() == ["more events arrive than can be handled: ping is lost"]


def test_a_variable_is_written_and_read_back(pair: Pair) -> None:
    pair.load("var n = 4")
    pair.remote.variables.set("n", [9])
    pair.tick()
    assert pair.remote.variables.get("n") == (9,)
    address, _ = pair.remote.variables.addresses()["n"]
    assert pair.device.variables.read(address, 1) == (9,)
    assert pair.remote.variables.words()[-1] == 9
    with pytest.raises(ValueError, match="n: 2 words found, expected 1"):
        pair.remote.variables.set("n", [1, 2])
    with pytest.raises(ValueError, match="n: 40000 found"):
        pair.remote.variables.set("n", [40000])


def test_a_program_for_another_layout_is_refused(pair: Pair) -> None:
    with pytest.raises(ValueError, match=r"a program for the layout thymio found, expected thymio-II/"):
        pair.remote.load(load_program("", "none"))


def test_the_host_has_built_in_programs_and_hides_their_events(pair: Pair) -> None:
    host = RemoteHost(pair.remote)
    host.start("explorer")
    pair.exchange()
    assert host.program.name == "explorer.aesl"
    assert pair.remote.status.state == "running"
    host.restart()
    assert host.pop_events() == []


# -- run control


def test_pause_steps_and_run(pair: Pair) -> None:
    pair.load("var n = 0\nvar m = 0\nonevent ping\nn = 1\nm = 2\nn = 3\n", ("ping", 1))
    control = pair.remote.run_control
    control.pause()
    pair.exchange()
    assert pair.remote.status == DeviceStatus("paused")
    pair.remote.receive_event("ping", [])
    control.step_line()
    pair.exchange()
    assert (pair.remote.status.event, pair.remote.status.line) == ("ping", 4)
    control.step_line()
    pair.exchange()
    assert (pair.remote.status.state, pair.remote.status.line) == ("paused", 5)
    pair.tick()
    assert (pair.remote.variables.get("n"), pair.remote.variables.get("m")) == ((1,), (0,))
    control.step()
    pair.exchange()
    assert pair.remote.status.line == 5
    control.resume()
    pair.tick(2)
    assert pair.remote.status == DeviceStatus("running")
    assert pair.remote.variables.get("n") == (3,)


def test_a_breakpoint_pauses_and_moves_to_a_line_with_code(pair: Pair) -> None:
    pair.load("var n = 0\n\nonevent ping\n# nothing\nn++\n", ("ping", 1))
    points = pair.remote.run_control.set_breakpoints([4, 99])
    assert (points.lines, points.moved) == ((5,), {4: 5, 99: None})
    pair.remote.receive_event("ping", [])
    pair.exchange()
    assert (pair.remote.status.state, pair.remote.status.line) == ("paused", 5)
    pair.remote.run_control.resume()
    pair.tick(2)
    assert (pair.remote.status.state, pair.remote.variables.get("n")) == ("running", (1,))
    pair.remote.run_control.set_breakpoints([])
    pair.remote.receive_event("ping", [])
    pair.tick(2)
    assert pair.remote.variables.get("n") == (2,)


def test_at_most_sixteen_breakpoints_are_set(pair: Pair) -> None:
    pair.load("var n\n" + "n++\n" * 20)
    points = pair.remote.run_control.set_breakpoints(range(2, 22))
    assert len(points.lines) == 16
    assert [line for line, place in points.moved.items() if place is None] == [18, 19, 20, 21]


def test_stop_and_reset(pair: Pair) -> None:
    pair.load("var n = 5\nmotor.left.target = 100\nonevent ping\nn = 8", ("ping", 1))
    pair.remote.run_control.stop()
    pair.exchange()
    assert pair.remote.status == DeviceStatus("stopped")
    assert pair.value("motor.left.target") == (0,)
    pair.remote.run_control.reset()
    pair.exchange()
    assert (pair.remote.status.state, pair.remote.status.line) == ("paused", 1)
    pair.remote.run_control.resume()
    pair.tick(2)
    assert pair.remote.status == DeviceStatus("running")
    assert pair.value("motor.left.target") == (100,)


def test_a_robot_that_is_switched_off_still_obeys_ros_and_can_be_switched_on(pair: Pair) -> None:
    pair.load("var n = 5\nmotor.left.target = 100\nonevent ping\nn = 8", ("ping", 1))
    pair.robot.execute(SetLeds("top", (32, 0, 0)), 0)
    pair.exchange()
    pair.remote.run_control.switch_off()
    pair.exchange()
    assert pair.remote.status == DeviceStatus("off")
    assert pair.value("motor.left.target") == (0,)
    assert {SetLeds("top", (0, 0, 0)), StopSound()} <= set(pair.commands)
    pair.robot.execute(SetLeds("top", (1, 2, 3)), 0)
    pair.exchange()
    assert SetLeds("top", (1, 2, 3)) in pair.commands
    for control in (pair.remote.run_control.pause, pair.remote.run_control.step, pair.remote.run_control.stop):
        control()
    assert pair.remote.status == DeviceStatus("off")
    pair.remote.run_control.resume()
    pair.exchange()
    assert pair.remote.status == DeviceStatus("running")
    assert pair.value("motor.left.target") == (100,)


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ("n = n / event.args[1]", "division by zero"),
        ("n = list[event.args[0]]", "index"),
    ],
)
def test_a_fault_has_its_line_in_every_language_and_stops_the_wheels(pair: Pair, line: str, message: str) -> None:
    pair.load(f"var n = 1\nvar list[2]\nmotor.left.target = 90\nonevent ping\n{line}\n", ("ping", 2))
    pair.remote.receive_event("ping", [9, 0])
    pair.exchange()
    status = pair.remote.status
    assert (status.state, status.event, status.line) == ("fault", "ping", 5)
    assert message in status.fault.lower()
    assert set(status.faults) >= {"en", "de"}
    assert pair.value("motor.left.target") == (0,)
    pair.remote.run_control.resume()
    pair.exchange()
    assert pair.remote.status.state == "running"


# -- readings


def test_readings_have_the_integers_and_si_values(pair: Pair) -> None:
    pair.device.feed("proximity", (0, 4505, 2000, 0, 0, 0, 1226))
    pair.device.feed("ground", (1, 2, 900, 70, 899, 68))
    pair.device.feed("accelerometer", (0, 1, 23))
    pair.device.feed("battery", (796, 796, 1))
    pair.tick()
    found = readings(pair)
    proximity = found["proximity"]
    assert isinstance(proximity, ProximityReading)
    assert proximity.words == (0, 4505, 2000, 0, 0, 0, 1226)
    assert proximity.ranges_m[:2] == (math.inf, 0.0)
    assert proximity.ranges_m[2] == pytest.approx(0.0957, abs=0.001)
    assert proximity.ranges_m[6] == pytest.approx(0.14, abs=0.0001)
    ground = found["ground"]
    assert isinstance(ground, GroundReading)
    assert ground.reflectances == pytest.approx((0.772, 0.0), abs=0.04)
    assert isinstance(found["accelerometer"], AccelerometerReading)
    assert found["accelerometer"].acceleration_m_s2 == pytest.approx((0.4265, 0.0, 9.81), abs=0.001)
    battery = found["battery"]
    assert isinstance(battery, BatteryReading)
    assert battery.volts == pytest.approx(4.0, abs=0.01)
    assert 0.8 < battery.charge < 0.9


def test_a_sensor_is_reported_at_its_own_rate(pair: Pair) -> None:
    counts: dict[str, int] = {}
    for _ in range(20):
        pair.tick()
        for name in readings(pair):
            counts[name] = counts.get(name, 0) + 1
    assert (counts["proximity"], counts["motor"], counts["temperature"], counts["pose"]) == (10, 20, 2, 20)
    assert not {"tap", "remote", "comm"} & set(counts)


def test_events_of_sensors_are_changes_of_their_variables(pair: Pair) -> None:
    pair.tick()
    readings(pair)
    pair.device.feed("tap", (1,))
    pair.device.feed("remote", (0, 80))
    pair.tick()
    found = readings(pair)
    assert isinstance(found["tap"], TapReading)
    assert found["remote"].words == (0, 80)
    pair.tick()
    assert not {"tap", "remote"} & set(readings(pair))


def test_odometry_follows_the_speeds_of_the_wheels(pair: Pair) -> None:
    pair.tick()
    readings(pair)
    pair.device.feed("motor", (250, 250, 0, 0))
    for _ in range(20):
        pair.tick()
        found = readings(pair)
    pose = found["pose"]
    assert isinstance(pose, PoseReading)
    assert pose.odometry.x_m == pytest.approx(0.083 * 0.975, abs=0.001)
    assert (pose.odometry.y_m, pose.odometry.yaw_rad) == (0.0, 0.0)
    assert pose.odometry_twist.linear_m_s == pytest.approx(0.083)
    assert pair.robot.sensing.angles_rad[0] == pytest.approx(0.083 * 0.975 / 0.022, abs=0.05)
    pair.device.feed("motor", (-250, 250, 0, 0))
    pair.robot.execute(ResetOdometry(), 0)
    for _ in range(20):
        pair.tick()
        found = readings(pair)
    assert found["pose"].odometry.yaw_rad == pytest.approx(2 * 0.083 / 0.094 * 0.975, abs=0.01)


def test_odometry_goes_on_where_it_was_when_the_robot_returns(pair: Pair) -> None:
    pair.device.feed("motor", (250, 250, 0, 0))
    for _ in range(20):
        pair.tick()
        found = readings(pair)
    before = found["pose"].odometry.x_m
    assert before > 0.05
    pair.pull()
    pair.tick(20)
    pair.plug_in()
    pair.device.feed("motor", (0, 0, 0, 0))
    pair.tick(2)
    assert readings(pair)["pose"].odometry.x_m == pytest.approx(before)


def test_there_are_no_readings_without_values_of_the_robot() -> None:
    pair = Pair()
    assert readings(pair) == {}
    pair.plug_in()
    pair.pull()
    assert readings(pair) == {}


def test_a_robot_of_the_playground_lacks_some_sensors_and_native_functions() -> None:
    pair = Pair("playground")
    pair.plug_in()
    assert pair.robot.sensing.sensors == (
        *("accelerometer", "buttons", "comm", "ground", "motor", "proximity", "remote", "sound", "temperature", "pose"),
    )
    assert {"battery", "tap", "current", "button_counts"} <= set(pair.robot.sensing.missing)
    assert "_leds.set" not in served_natives(target(pair.remote.layout))
    pair.tick()
    assert {"proximity", "ground", "motor", "pose"} <= set(readings(pair))
