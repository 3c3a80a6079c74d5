"""Commands for a robot behind a network: they reach its actuators, and velocities end."""

from __future__ import annotations

import pytest

from aseba_vm.protocol import Description, NamedVariable, NodePresent, Variables
from aseba_vm.targets import THYMIO_II
from tests.device.remote.pair import Pair
from thymio_sim_ros.device.layout import described
from thymio_sim_ros.device.programs.program import load_program
from thymio_sim_ros.device.remote.remote_robot import RemoteRobot
from thymio_sim_ros.device.remote.ros_handlers import extended, served_natives
from thymio_sim_ros.sim.commands import (
    BodyTwist,
    EnableComm,
    MotorTargets,
    MoveRobot,
    PlaySystemSound,
    PlayTone,
    SetCommPayload,
    SetLed,
    SetLeds,
    SetSoundThreshold,
    StopSound,
    WheelVelocities,
)

SECOND_NS = 1_000_000_000
TARGETS = ("motor.left.target", "motor.right.target")


def test_appended_handlers_do_not_change_the_program() -> None:
    layout = described(THYMIO_II)
    own = load_program("var a\nonevent prox\na++", "own", layout)
    longer = extended(own, THYMIO_II)
    assert longer.problem == ""
    assert longer.program.addresses == own.program.addresses
    assert len(longer.program.words) - len(own.program.words) < 110
    assert {longer.line_of(pc) for pc in range(len(longer.program.words))} == {None, 3}
    assert set(longer.numbers) == set(served_natives(THYMIO_II))


def test_a_program_without_room_runs_without_them(pair: Pair) -> None:
    pair.load("var n\n" + "n = n + 1\n" * 360)
    assert pair.remote.status.state == "running"
    assert "ROS cannot set lights and sounds beside it" in pair.remote.notices.pop()[0]
    with pytest.raises(ValueError, match="the robot cannot do this"):
        pair.robot.execute(SetLeds("top", (1, 1, 1)), 0)


@pytest.mark.parametrize(
    ("command", "expected"),
    [
        (SetLeds("top", (32, 16, 0)), None),
        (SetLeds("circle", (1, 2, 3, 4, 5, 6, 7, 8)), None),
        (SetLeds("proximity", (1, 2, 3, 4, 5, 6, 7, 8)), None),
        (SetLeds("remote", (9,)), None),
        (SetLed(3, 20), None),
        (PlaySystemSound(4), None),
        (PlayTone(440.0, SECOND_NS), PlayTone(440, 983_040_000)),
        (PlayTone(440.0, None), PlayTone(440, None)),
        (StopSound(), None),
        (EnableComm(True), None),
        (SetCommPayload(99), None),
        (SetSoundThreshold(120), None),
        (MotorTargets(100, -200), None),
    ],
)
def test_a_command_reaches_the_actuators(pair: Pair, command: object, expected: object) -> None:
    pair.load("onevent other\n", ("other", 3))
    pair.commands.clear()
    pair.robot.execute(command, pair.now_ns)
    pair.exchange()
    assert (expected or command) in pair.commands


def test_a_command_that_a_robot_does_not_know_is_refused(pair: Pair) -> None:
    with pytest.raises(ValueError, match="MoveRobot: a real robot cannot do this"):
        pair.robot.execute(MoveRobot(0.0, 0.0, 0.0), 0)


@pytest.mark.parametrize("variables", [{"args": 4}, {"motor.left.target": 1}, {"motor.left.target": 2}])
@pytest.mark.parametrize("command", [BodyTwist(0.1, 0.0, 500_000_000), MotorTargets(1, 1)])
def test_a_robot_without_the_wheels_of_a_thymio_says_so_and_is_polled_on(
    variables: dict[str, int], command: BodyTwist | MotorTargets
) -> None:
    robot = RemoteRobot()
    robot.start(0)
    robot.receive(NodePresent(1, 5))
    robot.receive(Description(1, "arm", 5, 512, 64, 1060, len(variables), 0, 0))
    for name, size in variables.items():
        robot.receive(NamedVariable(1, size, name))
    assert robot.is_connected
    assert not robot.can_drive
    with pytest.raises(ValueError, match=r"the robot cannot drive: it has no variable motor\..*right\.target"):
        robot.execute(command, 0)
    robot.poll(SECOND_NS)
    robot.receive(Variables(1, 0, (5, 6)))
    robot.poll(2 * SECOND_NS)


def test_lights_of_the_robot_itself_cannot_be_set_but_switching_all_off_is_no_error(pair: Pair) -> None:
    pair.robot.execute(SetLeds("battery", (0, 0, 0)), 0)
    with pytest.raises(ValueError, match="SetLeds: a real robot cannot do this"):
        pair.robot.execute(SetLeds("battery", (1, 0, 0)), 0)


def test_a_velocity_ends_and_the_targets_of_the_program_hold_again(pair: Pair) -> None:
    pair.load("motor.left.target = 70\nmotor.right.target = 60")
    pair.tick()
    pair.robot.execute(BodyTwist(0.083, 0.0, SECOND_NS // 2), pair.now_ns)
    pair.tick(3)
    assert [pair.value(name) for name in TARGETS] == [(250,), (250,)]
    pair.robot.execute(WheelVelocities(1.0, -1.0, SECOND_NS // 2), pair.now_ns)
    pair.tick(3)
    assert [pair.value(name) for name in TARGETS] == [(66,), (-66,)]
    pair.tick(8)
    assert [pair.value(name) for name in TARGETS] == [(70,), (60,)]


def test_new_targets_of_the_program_end_a_velocity_at_once(pair: Pair) -> None:
    pair.load("onevent go\nmotor.left.target = 40", ("go", 0))
    pair.robot.execute(BodyTwist(0.083, 0.0, SECOND_NS), pair.now_ns)
    pair.tick()
    pair.remote.receive_event("go", [])
    pair.tick(40)
    assert [pair.value(name) for name in TARGETS] == [(40,), (0,)]


def test_a_velocity_ends_whatever_was_requested_before_it(pair: Pair) -> None:
    """Answers to a poll that was under way show the targets from before the command, in several messages."""
    pair.load("var many[400]\nmotor.left.target = 70")
    pair.tick()
    pair.robot.poll(pair.now_ns)
    pair.robot.execute(BodyTwist(0.083, 0.0, SECOND_NS // 2), pair.now_ns)
    pair.exchange()
    pair.tick()
    assert [pair.value(name) for name in TARGETS] == [(250,), (250,)]
    pair.tick(20)
    assert [pair.value(name) for name in TARGETS] == [(70,), (0,)]


def test_the_targets_that_hold_again_are_those_of_a_program_that_has_just_started(pair: Pair) -> None:
    """They were not read since: the start of a program stops the wheels, and then the program sets its targets."""
    pair.load("motor.left.target = 70\nmotor.right.target = 60")
    pair.robot.execute(BodyTwist(0.083, 0.0, SECOND_NS // 2), pair.now_ns)
    pair.exchange()
    assert [pair.value(name) for name in TARGETS] == [(250,), (250,)]
    pair.tick(11)
    assert [pair.value(name) for name in TARGETS] == [(70,), (60,)]


def test_a_velocity_ends_when_a_program_starts(pair: Pair) -> None:
    pair.load("motor.left.target = 70")
    pair.robot.execute(BodyTwist(0.083, 0.0, SECOND_NS // 2), pair.now_ns)
    pair.exchange()
    pair.now_ns += SECOND_NS
    pair.load("motor.left.target = 40")
    pair.tick(11)
    assert [pair.value(name) for name in TARGETS] == [(40,), (0,)]


def test_a_velocity_that_is_repeated_is_sent_once_and_again_when_the_program_has_set_others(pair: Pair) -> None:
    """A node may publish velocities faster than a network or a radio carries them."""
    pair.load("onevent go\nmotor.left.target = 40", ("go", 0))
    pair.tick()
    pair.robot.execute(BodyTwist(0.083, 0.0, SECOND_NS), pair.now_ns)
    pair.exchange()
    pair.robot.execute(BodyTwist(0.083, 0.0, SECOND_NS), pair.now_ns)
    assert pair.robot.pop_messages() == []
    pair.remote.receive_event("go", [])
    for _ in range(5):
        pair.robot.execute(BodyTwist(0.083, 0.0, SECOND_NS), pair.now_ns)
        pair.tick()
    assert [pair.value(name) for name in TARGETS] == [(250,), (250,)]


def test_a_velocity_without_time_out_holds(pair: Pair) -> None:
    pair.robot.execute(BodyTwist(0.083, 0.0), pair.now_ns)
    pair.tick(100)
    assert pair.value("motor.left.target") == (250,)


def test_a_velocity_beyond_the_wheels_keeps_its_curve(pair: Pair) -> None:
    pair.robot.execute(BodyTwist(1.0, 0.0, SECOND_NS), pair.now_ns)
    pair.tick()
    assert [pair.value(name) for name in TARGETS] == [(500,), (500,)]
