"""The world as a whole: commands, order, repeatability, symmetry, and a frozen minute."""

from __future__ import annotations

import dataclasses
import hashlib
import math
import random
from collections.abc import Iterator

import pytest

from tests.sim.builders import FLOOR, GRAY, ROBOT, box, make, readings, run, send, shipped
from thymio_sim_ros.sim.commands import (
    BodyTwist,
    Clap,
    Command,
    EnableComm,
    MotorTargets,
    MoveRobot,
    PressButton,
    RemoteKey,
    SetBattery,
    SetCommPayload,
    SetLeds,
    SetNoiseLevel,
    SetSoundThreshold,
    SetTemperature,
    Tap,
    Tilt,
)
from thymio_sim_ros.sim.model.geometry import LEVEL, Pose
from thymio_sim_ros.sim.playground.placement import PlacementError
from thymio_sim_ros.sim.playground.reader import Playground, RobotStart
from thymio_sim_ros.sim.sensors import all_sensors
from thymio_sim_ros.sim.world import StepResult, World

FROZEN = "26a3235b051c9e9a"
"""Hash of `minute()`. It changes only when the simulation is meant to change; say so in the commit."""

FROZEN_PUSHING = "011d6feba55b08d4"
"""Hash of `pushing()`, likewise."""

RATES = {
    "accelerometer": 16,
    "battery": 1,
    "button_counts": 1,
    "buttons": 50,
    "collision": 1,
    "current": 1,
    "ground": 10,
    "leds": 1,
    "motor": 100,
    "pose": 20,
    "proximity": 10,
    "sound": 1,
    "temperature": 1,
}
"""Readings in the first second of the sensors of a Thymio that measure regularly."""

HASHED = {*RATES, "tap"}
"""Sensors of which the hash of `minute()` consists, so that an added sensor does not change it."""

SENSED = ("ground", "motor", "proximity")

TWO = ({**ROBOT, "name": "a"}, {**ROBOT, "name": "b", "y_m": 0.3})


def minute(seed: int) -> Iterator[tuple[StepResult, World]]:
    """60 s among obstacles: every second new targets from a generator of the test's own."""
    dice = random.Random(7)
    world = World(shipped("obstacle"), seed=seed)
    for tick in range(6000):
        if tick % 100 == 0:
            send(world, MotorTargets(dice.randint(-100, 500), dice.randint(-100, 500)))
        yield world.step(), world


def digest(seed: int) -> str:
    """All words that the sensors in HASHED read, and the poses to a micrometer, of that minute."""
    found = hashlib.sha256()
    for step, world in minute(seed):
        for _, name, reading in step.readings:
            if name in HASHED:
                found.update(f"{name}{reading.words}".encode())
        pose = world.robots["thymio"].pose
        found.update(f"{pose.x_m:.6f} {pose.y_m:.6f} {pose.yaw_rad:.6f}".encode())
    return found.hexdigest()[:16]


def pushing(seed: int) -> str:
    """Hash of 30 s in which robots push things, open a door, fall, are put back, come and go."""
    gate = {"closed_x_m": 0.0, "closed_y_m": 1.0, "opened_x_m": 0.5, "opened_y_m": 1.0, "move_s": 1.5}
    things = [
        {"kind": "door", "name": "gate", **gate, "size_x_m": 0.4, "size_y_m": 0.02, "height_m": 0.1, "color": GRAY},
        {"kind": "activation", "x_m": 0.0, "y_m": -1.0, "size_x_m": 0.1, "size_y_m": 0.1, "door": "gate",
         "area_m": [[-1, 0], [1, 0], [1, 2], [-1, 2]]},
        *({**box(-0.6 + 0.3 * index, 0.5, 0.06, 0.06), "name": f"crate_{index}", "mass_kg": 0.05 * (index + 1)}
          for index in range(5)),
    ]  # fmt: skip
    dice = random.Random(11)
    world = World(make([{**FLOOR, "size_x_m": 1.6, "size_y_m": 2.2}, *things], TWO), seed=seed)
    found = hashlib.sha256()
    for tick in range(3000):
        if tick % 50 == 0:
            for robot in world.robots:
                world.post(robot, MotorTargets(dice.randint(100, 500), dice.randint(100, 500)))
        if tick == 1000:
            world.spawn(RobotStart("late", -0.6, -1.0))
        if tick == 2000:
            world.remove("late")
        for name, robot in world.robots.items():
            if robot.tilt != LEVEL and not robot.is_falling:
                world.post(name, MoveRobot(dice.uniform(-0.3, 0.3), dice.uniform(-0.3, 0.0), 0.0))
        step = world.step()
        found.update(repr([reading.words for _, name, reading in step.readings if name in SENSED]).encode())
        found.update(repr([(thing.name, f"{thing.pose.x_m:.6f}", thing.is_fallen) for thing in world.objects]).encode())
    return found.hexdigest()[:16]


def line_follower(world: World, seconds: float) -> list[Pose]:
    """Follow the black line with two thresholds; where the robot was at every ground reading."""
    black = [True, True]
    poses = []
    robot = next(iter(world.robots.values()))
    for _ in range(round(seconds * 100)):
        for _, name, reading in world.step().readings:
            if name != "ground":
                continue
            for side, count in enumerate(reading.words[4:]):
                if count < 400 or count > 450:
                    black[side] = count < 400
            send(world, MotorTargets(*((300, 300) if black == [True, True] else (300 * black[1], 300 * black[0]))))
            poses.append(robot.pose)
    return poses


def test_the_same_seed_gives_the_same_minute_bit_for_bit() -> None:
    one, two = (list(minute(5)) for _ in range(2))
    assert [step for step, _ in one] == [step for step, _ in two]
    assert one[-1][1].snapshot() == two[-1][1].snapshot()


def test_another_seed_gives_another_minute() -> None:
    assert digest(5) != digest(6)


def test_the_minute_is_the_frozen_one() -> None:
    assert digest(5) == FROZEN


def test_pushing_falling_and_opening_are_the_frozen_ones() -> None:
    assert pushing(5) == FROZEN_PUSHING


def test_a_log_of_commands_replays_a_run() -> None:
    dice = random.Random(2)
    kinds = (
        lambda: MotorTargets(dice.randint(-500, 500), dice.randint(-500, 500)),
        lambda: BodyTwist(dice.uniform(-0.2, 0.2), dice.uniform(-2, 2), timeout_ns=300_000_000),
        lambda: SetLeds("top", (dice.randint(0, 32), 0, 0)),
        lambda: PressButton("center", pressed=dice.random() < 0.5),
        lambda: MoveRobot(dice.uniform(-1.9, 0), dice.uniform(0.8, 1.9), dice.uniform(-3, 3)),
        lambda: Tilt(dice.uniform(-1, 1), dice.uniform(-1, 1)),
        lambda: Tap(),
        lambda: Clap(dice.randint(0, 255)),
        lambda: SetNoiseLevel(dice.randint(0, 255)),
        lambda: SetTemperature(dice.uniform(0, 40)),
        lambda: RemoteKey(dice.randint(0, 31), dice.randint(0, 127)),
        lambda: SetBattery(dice.uniform(3, 4.2)),
        lambda: EnableComm(dice.random() < 0.8),
        lambda: SetCommPayload(dice.randint(0, 2047)),
        lambda: SetSoundThreshold(dice.randint(0, 255)),
    )
    log: list[tuple[int, str, Command]] = [
        (tick, dice.choice("ab"), dice.choice(kinds)()) for tick in range(500) if dice.random() < 0.1
    ]

    def play() -> list[StepResult]:
        world = World(make([FLOOR, box(0.3, 0.0, 0.1, 1.0)], TWO), seed=9)
        steps = []
        for tick in range(500):
            for when, robot, command in log:
                if when == tick:
                    world.post(robot, command)
            steps.append(world.step())
        return steps

    assert play() == play()


def test_reset_starts_the_same_run_again() -> None:
    world = World(shipped("line"), seed=3)
    send(world, MotorTargets(300, 250))
    first = run(world, 1.0)
    send(world, MotorTargets(-500, 500))
    world.reset()
    assert (world.now_ns, world.robots["thymio"].pose) == (0, Pose(-0.15, -0.38, 0.0))
    send(world, MotorTargets(300, 250))
    assert run(world, 1.0) == first


def test_mirroring_the_world_mirrors_motion_and_readings() -> None:
    def go(sign: int) -> tuple[Pose, list[tuple[int, ...]], list[tuple[int, ...]]]:
        things = [box(0.4, sign * 0.2, 0.1, 0.3, yaw_rad=sign * 0.5), box(0.5, -sign * 0.3, 0.3, 0.1)]
        named = [{**thing, "name": f"box{index}"} for index, thing in enumerate(things)]
        paint = {"kind": "track", "points_m": [[0, 0], [1, sign * 0.2]], "width_m": 0.05, "color": "#000000"}
        world = World(make([FLOOR, paint, *named]), noise=False)
        targets = (300, 280) if sign > 0 else (280, 300)
        send(world, MotorTargets(*targets))
        steps = run(world, 5.0)
        proximity = [reading.words for reading in readings(steps, "proximity")]
        ground = [reading.words for reading in readings(steps, "ground")]
        return world.robots["thymio"].pose, proximity, ground

    pose, proximity, ground = go(1)
    mirrored, mirrored_proximity, mirrored_ground = go(-1)
    assert (pose.x_m, pose.y_m, pose.yaw_rad) == pytest.approx(
        (mirrored.x_m, -mirrored.y_m, -mirrored.yaw_rad), abs=1e-6
    )
    order = (4, 3, 2, 1, 0, 6, 5)
    assert max(count for words in proximity for count in words) > 1000
    for words, other in zip(proximity, mirrored_proximity, strict=True):
        assert words == pytest.approx([other[index] for index in order], abs=1)
    for words, other in zip(ground, mirrored_ground, strict=True):
        assert words == pytest.approx([other[index] for index in (1, 0, 3, 2, 5, 4)], abs=12)


def test_a_line_follower_stays_on_the_line_for_whole_laps() -> None:
    world = World(shipped("line"), seed=1)
    poses = line_follower(world, 90.0)
    turned = poses[-1].yaw_rad - poses[0].yaw_rad
    assert turned > 2 * math.tau
    assert all(abs(pose.x_m) < 0.65 and abs(pose.y_m) < 0.45 for pose in poses)
    assert any(math.dist((pose.x_m, pose.y_m), (-0.15, -0.38)) < 0.03 for pose in poses[300:])


def test_sensors_keep_their_rates() -> None:
    names = [name for step in run(World(make([FLOOR])), 1.0) for _, name, _ in step.readings]
    assert {name: names.count(name) for name in RATES} == RATES
    assert not {"comm", "remote", "sound_finished", "tap"} & set(names)


@pytest.mark.parametrize("wanted", [set(), {"motor"}, {"proximity", "buttons"}, {"pose", "ground", "leds"}])
def test_readings_are_the_same_whatever_is_wanted(wanted: set[str]) -> None:
    everything, some = (World(make([FLOOR, box(0.3, 0.0, 0.02, 0.4)], TWO), seed=4) for _ in range(2))
    for world in (everything, some):
        for robot in world.robots:
            world.post(robot, MotorTargets(200, 180))
    stateless = {sensor.name for sensor in all_sensors() if sensor.is_stateless}
    left_out = set()
    for tick in range(300):
        names = frozenset(wanted) if tick < 200 else frozenset({"pose"})
        found, expected = some.step(names), everything.step()
        assert found[::2] == expected[::2]
        assert list(found.readings) == [row for row in expected.readings if row[1] in names or row[1] not in stateless]
        left_out |= {row[1] for row in expected.readings} - {row[1] for row in found.readings}
    assert left_out >= {"motor", "buttons", "proximity"} - wanted
    assert everything.snapshot() == some.snapshot()


def test_a_stateless_sensor_can_be_read_at_any_time() -> None:
    world = World(make([FLOOR]), noise=False)
    (name,) = world.robots
    world.post(name, MotorTargets(100, -100))
    world.step(frozenset())
    reading = world.read(name, "motor")
    assert reading is not None
    assert reading.words[:2] == (100, -100)
    with pytest.raises(KeyError):
        world.read(name, "nothing")


def test_readings_come_by_robot_and_then_by_sensor_name() -> None:
    step = run(World(make([FLOOR], TWO)), 0.1)[-1]
    order = [(robot, name) for robot, name, _ in step.readings]
    assert order == sorted(order)
    assert set(order) >= {(robot, name) for robot in "ab" for name in ("ground", "motor", "pose", "proximity")}


def test_readings_carry_the_time_of_their_tick() -> None:
    steps = run(World(make([FLOOR])), 0.2)
    assert all(reading.stamp_ns == step.now_ns for step in steps for _, _, reading in step.readings)


def test_commands_take_effect_in_the_next_step_only() -> None:
    world = World(make([FLOOR]), noise=False)
    before = world.robots["thymio"].pose
    send(world, MotorTargets(500, 500))
    assert world.robots["thymio"].pose == before
    world.step()
    assert world.robots["thymio"].pose.x_m == pytest.approx(0.00166)


def test_one_robot_more_does_not_change_the_noise_of_the_others() -> None:
    def path(robots: tuple[dict[str, object], ...]) -> Pose:
        world = World(make([FLOOR], robots), seed=4)
        world.post("a", MotorTargets(100, 300))
        run(world, 2.0)
        return world.robots["a"].pose

    assert path(TWO[:1]) == path(({**ROBOT, "name": "b", "y_m": 1.5}, TWO[0]))


def test_robots_stand_in_the_order_of_the_playground() -> None:
    assert list(World(make([FLOOR], TWO[::-1])).robots) == ["b", "a"]


def test_a_command_for_an_unknown_robot_is_refused() -> None:
    with pytest.raises(KeyError):
        World(make([FLOOR])).post("unknown", MotorTargets(0, 0))


def test_what_is_no_command_is_refused() -> None:
    with pytest.raises(TypeError, match="no actuator or stimulus accepts a str"):
        World(make([FLOOR])).post("thymio", "forward")  # type: ignore[arg-type]  # the mistake under test


def test_an_unknown_proximity_model_is_refused() -> None:
    with pytest.raises(ValueError, match="expected one of default, enki"):
        World(make([FLOOR]), proximity_model="sonar")


def test_a_world_without_robots_lets_time_pass() -> None:
    assert World(make([FLOOR], [])).step() == StepResult(10_000_000, (), ())


def test_a_snapshot_is_a_value_that_later_steps_do_not_change() -> None:
    world = World(make([FLOOR]))
    send(world, SetLeds("top", (32, 0, 0)))
    send(world, PressButton("center", pressed=True))
    send(world, MotorTargets(300, 300))
    world.step()
    snapshot = world.snapshot()
    copy = dataclasses.replace(snapshot)
    run(world, 1.0)
    (robot,) = snapshot.robots
    assert snapshot == copy
    assert (snapshot.now_ns, robot.name, robot.pressed, dict(robot.leds)["top"]) == (
        10_000_000, "thymio", ("center",), (32, 0, 0)
    )  # fmt: skip
    assert robot.wheel_angles_rad[0] == pytest.approx(0.0996 * 0.01 / 0.022)


def test_the_scene_holds_the_primitives_of_the_playground() -> None:
    playground: Playground = shipped("obstacle")
    scene = World(playground).scene
    assert (scene.solids, scene.floors, scene.paints) == (playground.solids, playground.floors, playground.paints)


def test_robots_that_are_not_solid_drive_through_each_other_and_stand_where_others_are() -> None:
    wall = box(0.5, 0.0, 0.02, 0.4)
    names = ({"name": "there", "x_m": 0.0, "y_m": 0.0}, {"name": "through", "x_m": -0.2, "y_m": 0.0})
    world = World(make([FLOOR, wall], names), solid_robots=False, noise=False)
    world.post("through", BodyTwist(0.1, 0.0))
    steps = run(world, 5.0)
    assert not any(step.contacts for step in steps)
    assert world.robots["there"].pose == Pose(0.0, 0.0, 0.0)
    assert world.robots["through"].pose.x_m == pytest.approx(0.3, abs=0.01)
    run(world, 3.0)
    assert world.robots["through"].pose.x_m < 0.45
    world.spawn(RobotStart("beside", 0.02, 0.0))
    world.post("beside", MoveRobot(0.0, 0.0, 1.0))
    with pytest.raises(PlacementError, match="occupied"):
        world.spawn(RobotStart("inside", 0.5, 0.0))
