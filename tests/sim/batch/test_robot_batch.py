"""Robots that are measured all at once; robot by robot is the oracle."""

from __future__ import annotations

import dataclasses
import json
import math
import random
from collections.abc import Iterator
from itertools import groupby
from typing import Any

import pytest

from tests.sim.builders import FLOOR, box, make, run, shipped
from thymio_sim_ros.sim.actuators import all_actuators
from thymio_sim_ros.sim.batch.robot_batch import MIN_BATCH_ROBOTS
from thymio_sim_ros.sim.commands import (
    BodyTwist,
    Clap,
    MotorTargets,
    MoveObject,
    MoveRobot,
    PlayTone,
    PressButton,
    SetMotorModel,
    SetPen,
    Tap,
    Tilt,
    WheelVelocities,
)
from thymio_sim_ros.sim.playground import reader
from thymio_sim_ros.sim.playground.reader import Playground, RobotStart
from thymio_sim_ros.sim.sensors import NEVER_NS, all_sensors
from thymio_sim_ros.sim.world import StepResult, World

ONE_BY_ONE, AT_ONCE = 10**9, 1


def busy(dice: random.Random, robots: int) -> Playground:
    """Robots, boxes and posts close together, on stripes that end before the world does."""
    places = [(column * 0.24, row * 0.24) for column in range(-3, 4) for row in range(-3, 4)]
    dice.shuffle(places)
    stripe: dict[str, Any] = {"kind": "track", "width_m": 0.03, "color": "#202020"}
    shapes: list[dict[str, Any]] = [{**FLOOR, "size_x_m": 1.5, "size_y_m": 1.7}]
    shapes += [{**stripe, "points_m": [[-1.0, y / 10], [1.0, y / 10 + 0.1]]} for y in range(-8, 8, 2)]
    for x, y in places[robots : robots + 10]:
        size = (dice.uniform(0.02, 0.08), dice.uniform(0.02, 0.08))
        if dice.random() < 0.5:
            shape = box(x, y, *size, yaw_rad=dice.uniform(-3, 3), height_m=dice.choice((0.03, 0.1)))
            shapes.append(shape | dice.choice(({}, {"mass_kg": 0.1})))
        else:
            shapes.append(
                {"kind": "cylinder", "x_m": x, "y_m": y, "radius_m": size[0], "height_m": 0.1, "color": "#808080"}
            )
    for shape in shapes[-10::2]:
        shape["mass_kg"] = dice.uniform(0.02, 0.5)
    starts = tuple(
        RobotStart(f"robot_{index}", x + dice.uniform(-0.03, 0.03), y + dice.uniform(-0.03, 0.03), dice.uniform(-3, 3))
        for index, (x, y) in enumerate(places[:robots])
    )
    data = {"format": 1, "title": "busy", "shapes": shapes, "robots": []}
    return dataclasses.replace(reader.loads(json.dumps(data), "busy"), robots=starts)


def play(monkeypatch: pytest.MonkeyPatch, batch: int, scene: Playground, **options: Any) -> list[StepResult]:
    """Two seconds in which robots drive and push, one falls off the edge, and one has a button pressed."""
    monkeypatch.setattr("thymio_sim_ros.sim.world.MIN_BATCH_ROBOTS", batch)
    world = World(scene, **options)
    dice = random.Random(1)
    steps = []
    for tick in range(200):
        for robot in world.robots:
            if dice.random() < 0.02:
                world.post(robot, MotorTargets(dice.randint(-500, 500), dice.randint(-500, 500)))
        if tick == 120:
            world.post("robot_0", MoveRobot(0.02, 0.95, 1.0))
            world.post("robot_1", PressButton("left", True))
        steps.append(world.step())
    return steps


def assert_same(one: list[StepResult], other: list[StepResult], *, within: float = 1e-9) -> None:
    for a, b in zip(one, other, strict=True):
        names = [[(robot, sensor) for robot, sensor, _ in step.readings] for step in (a, b)]
        assert names[0] == names[1]
        for (_, _, left), (_, _, right) in zip(a.readings, b.readings, strict=True):
            assert left.words == right.words
            assert list(numbers(left)) == pytest.approx(list(numbers(right)), abs=within)
        reported = [[(contact.robot, contact.other, contact.is_new) for contact in step.contacts] for step in (a, b)]
        assert reported[0] == reported[1]


def numbers(value: Any) -> Iterator[float]:
    """All numbers of a reading."""
    if isinstance(value, int | float):
        yield value
    elif not isinstance(value, str):
        parts = value if isinstance(value, tuple) else dataclasses.astuple(value)
        for part in parts:
            yield from numbers(part)


@pytest.mark.parametrize("model", ["default", "enki", "cone"])
@pytest.mark.parametrize("seed", range(4))
def test_all_at_once_reads_what_one_by_one_reads(monkeypatch: pytest.MonkeyPatch, seed: int, model: str) -> None:
    scene = busy(random.Random(seed), 12)
    options: dict[str, Any] = {"seed": seed, "proximity_model": model}
    one = play(monkeypatch, ONE_BY_ONE, scene, **options)
    assert_same(one, play(monkeypatch, AT_ONCE, scene, **options))
    counts = [max(reading.words) for step in one for _, name, reading in step.readings if name == "proximity"]
    assert 0 < sum(count > 0 for count in counts) < len(counts)


def test_one_robot_may_be_a_crowd(monkeypatch: pytest.MonkeyPatch) -> None:
    scene = shipped("obstacle")
    runs = []
    for batch in (ONE_BY_ONE, AT_ONCE):
        monkeypatch.setattr("thymio_sim_ros.sim.world.MIN_BATCH_ROBOTS", batch)
        world = World(scene, seed=4)
        world.post("thymio", MotorTargets(300, 250))
        runs.append(run(world, 5.0))
    assert_same(*runs)


def test_objects_that_are_pushed_moved_opened_or_gone_are_seen_where_they_are(monkeypatch: pytest.MonkeyPatch) -> None:
    door = {
        "kind": "door", "name": "gate", "closed_x_m": 0.14, "closed_y_m": -1.0, "opened_x_m": 0.14, "opened_y_m": -1.6,
        "move_s": 1.0, "size_x_m": 0.02, "size_y_m": 0.3, "height_m": 0.1, "color": "#808080",
    }  # fmt: skip
    area = {
        "kind": "activation", "x_m": -1.0, "y_m": 0.15, "size_x_m": 0.1, "size_y_m": 0.1, "door": "gate",
        "area_m": [[-0.2, -0.2], [0.2, -0.2], [0.2, 0.2], [-0.2, 0.2]],
    }  # fmt: skip
    light = {"mass_kg": 0.02}
    pushed, carried = box(0.14, 0.0, 0.05, 0.05) | light, box(0.14, 1.0, 0.05, 0.05) | light | {"name": "carried"}
    scene = make(
        [FLOOR, door, area, pushed, carried, box(1.95, 0.0, 0.05, 0.05) | light],
        [
            {"name": "pusher", "x_m": 0.0, "y_m": 0.0},
            {"name": "bystander", "x_m": 0.4, "y_m": 0.17, "yaw_rad": -math.pi / 2},
            {"name": "before_carried", "x_m": 0.0, "y_m": 1.0},
            {"name": "before_gate", "x_m": 0.0, "y_m": -1.0},
            {"name": "opener", "x_m": -1.0, "y_m": 0.0},
            {"name": "at_the_edge", "x_m": 1.82, "y_m": 0.0},
        ],
    )
    runs = []
    for batch in (ONE_BY_ONE, AT_ONCE):
        monkeypatch.setattr("thymio_sim_ros.sim.world.MIN_BATCH_ROBOTS", batch)
        world = World(scene)
        steps = []
        for tick in range(300):
            if tick == 0:
                world.post("pusher", MotorTargets(250, 250))
                world.post("at_the_edge", MotorTargets(250, 250))
            if tick == 110:
                world.post("at_the_edge", MotorTargets(0, 0))
            if tick in (100, 200):
                world.post("carried", MoveObject(1.2 if tick == 100 else 0.14, 1.0, 0.0))
            steps.append(world.step())
        runs.append(steps)
    assert_same(*runs, within=1e-7)  # who pushes for long adds up what is rounded
    expected = {"bystander": [0, 1], "before_carried": [1, 0, 1], "before_gate": [1, 0], "at_the_edge": [1, 0]}
    for robot, seen in expected.items():
        rows = (row for step in runs[1] for row in step.readings if row[:2] == (robot, "proximity"))
        counts = [max(reading.words) for _, _, reading in rows]
        assert [int(is_seen) for is_seen, _ in groupby(count > 0 for count in counts)] == seen, robot


def test_commands_of_a_crowd_time_out_and_motor_models_change_as_one_by_one(monkeypatch: pytest.MonkeyPatch) -> None:
    robots = [{"name": f"robot_{index}", "x_m": index * 0.4, "y_m": 0.0} for index in range(4)]
    runs = []
    for batch in (ONE_BY_ONE, AT_ONCE):
        monkeypatch.setattr("thymio_sim_ros.sim.world.MIN_BATCH_ROBOTS", batch)
        world = World(make([FLOOR], robots))
        steps = []
        for tick in range(100):
            if tick == 0:
                world.post("robot_0", MotorTargets(200, 100))
            if tick in (5, 30):
                world.post("robot_0", WheelVelocities(-2.0, 3.0, timeout_ns=200_000_000))
                world.post("robot_1", BodyTwist(0.1, 1.0, timeout_ns=150_000_000))
            if tick in (20, 60):
                world.post("robot_2", SetMotorModel("firmware" if tick == 20 else "ideal"))
                world.post("robot_2", MotorTargets(5 * tick, 300))
            steps.append(world.step())
        runs.append(steps)
    assert_same(*runs)


def test_a_crowd_repeats_itself_bit_for_bit(monkeypatch: pytest.MonkeyPatch) -> None:
    scene = busy(random.Random(9), 12)
    assert play(monkeypatch, AT_ONCE, scene, seed=2) == play(monkeypatch, AT_ONCE, scene, seed=2)


def test_readings_may_be_looked_at_much_later(monkeypatch: pytest.MonkeyPatch) -> None:
    scene = busy(random.Random(9), 12)
    late = play(monkeypatch, AT_ONCE, scene, seed=2)
    monkeypatch.setattr("thymio_sim_ros.sim.world.MIN_BATCH_ROBOTS", AT_ONCE)
    world = World(scene, seed=2)
    dice = random.Random(1)
    for tick, step in enumerate(late):
        for robot in world.robots:
            if dice.random() < 0.02:
                world.post(robot, MotorTargets(dice.randint(-500, 500), dice.randint(-500, 500)))
        if tick == 120:
            world.post("robot_0", MoveRobot(0.02, 0.95, 1.0))
            world.post("robot_1", PressButton("left", True))
        assert list(world.step().readings) == list(step.readings)


@pytest.mark.parametrize("batch", [AT_ONCE, 12])
def test_robots_that_come_and_go_take_along_what_their_sensors_remember(
    monkeypatch: pytest.MonkeyPatch, batch: int
) -> None:
    """With 12 as the limit they are sometimes a batch, sometimes updated one by one."""
    runs = [come_and_go(monkeypatch, limit, busy(random.Random(5), 12)) for limit in (ONE_BY_ONE, batch)]
    assert_same(*runs)
    reported = {name for step in runs[0] for _, name, _ in step.readings}
    assert {"tap", "current", "collision", "accelerometer", "sound", "buttons"} <= reported


def come_and_go(monkeypatch: pytest.MonkeyPatch, batch: int, scene: Playground) -> list[StepResult]:
    """Three seconds in which robots are taken away and put back, tapped, tilted, clapped at and driven in two ways."""
    monkeypatch.setattr("thymio_sim_ros.sim.world.MIN_BATCH_ROBOTS", batch)
    world = World(scene, seed=3)
    dice, steps, away = random.Random(2), [], list[RobotStart]()
    for tick in range(300):
        for start in scene.robots:
            if start.name in world.robots and dice.random() < 0.03:
                targets = MotorTargets(dice.choice((0, 200, 500)), dice.choice((0, 200, 500)))
                command = dice.choice((Tap(), Tilt(0.1, 0.2), Clap(200), SetMotorModel("firmware"), targets, targets))
                world.post(start.name, command)
        if tick % 41 == 20:
            away.append(next(start for start in scene.robots if start.name in world.robots))
            world.remove(away[-1].name)
        if tick % 41 == 40 and away:
            world.spawn(dataclasses.replace(away.pop(), x_m=4.0 + tick * 0.01, y_m=0.0))
        if tick == 150:
            world.post("robot_5", MoveRobot(0.02, 0.95, 1.0))
        steps.append(world.step())
    return steps


def test_a_sensor_that_is_woken_measures_on_its_robot_alone() -> None:
    robots = [{"name": f"robot_{index}", "x_m": index * 0.3, "y_m": 0.0} for index in range(6)]
    world = World(make([FLOOR], robots), periods_ns={"loudspeaker": NEVER_NS, "ground": 10_000_000})
    world.step()
    world.post("robot_2", PlayTone(440.0, None))
    found = [row[:2] for row in world.step().readings]
    expected = [(robot["name"], "ground") for robot in robots]
    assert found == [*expected[:3], ("robot_2", "loudspeaker"), *expected[3:]]


@pytest.mark.parametrize("batch", [ONE_BY_ONE, AT_ONCE])
def test_an_actuator_at_rest_is_left_alone_until_its_next_command(monkeypatch: pytest.MonkeyPatch, batch: int) -> None:
    monkeypatch.setattr("thymio_sim_ros.sim.world.MIN_BATCH_ROBOTS", batch)
    calls: list[Any] = []

    def update(state: Any, _view: Any, _dt_s: float) -> None:
        calls.append(state)

    actuators = [
        dataclasses.replace(actuator, update=update) if actuator.name == "pen" else actuator
        for actuator in all_actuators()
    ]
    monkeypatch.setattr("thymio_sim_ros.sim.world.all_actuators", lambda: actuators)
    world = World(make([FLOOR]))
    for command, expected in ((None, 0), (SetPen(down=True), 10), (SetPen(down=False), 1)):
        if command is not None:
            world.post("thymio", command)
        calls.clear()
        run(world, 0.1)
        assert len(calls) == expected


def test_only_the_chosen_sensors_measure_and_as_often_as_told() -> None:
    world = World(make([FLOOR]), periods_ns={"ground": 30_000_000, "buttons": 50_000_000})
    found = [(step.now_ns // 10_000_000, name) for step in run(world, 0.1) for _, name, _ in step.readings]
    assert [tick for tick, name in found if name == "ground"] == [3, 6, 9]
    assert [tick for tick, name in found if name == "buttons"] == [5, 10]
    assert {name for _, name in found} == {"ground", "buttons"}


@pytest.mark.parametrize("robots", [1, MIN_BATCH_ROBOTS])
def test_sensors_of_one_period_measure_in_the_same_tick_whatever_their_own_phase(robots: int) -> None:
    starts = [{"name": f"r{number}", "x_m": 0.3 * number, "y_m": 0.0} for number in range(robots)]
    regular = [sensor.name for sensor in all_sensors() if sensor.period_ns != NEVER_NS]
    world = World(make([FLOOR], starts), periods_ns=dict.fromkeys(regular, 100_000_000))
    found = [{name for _, name, _ in world.step().readings} for _ in range(20)]
    assert [bool(names) for names in found] == [tick % 10 == 9 for tick in range(20)]
    assert {"battery", "leds", "proximity"} <= found[9]


@pytest.mark.parametrize(("periods_ns", "found"), [({"sonar": 1}, "'sonar'"), ({"ground": 0}, "found 0 ns")])
def test_a_sensor_that_is_none_or_never_measures_is_refused(periods_ns: dict[str, int], found: str) -> None:
    with pytest.raises(ValueError, match=found):
        World(make([FLOOR]), periods_ns=periods_ns)


def test_noise_of_one_robot_does_not_depend_on_how_many_there_are(monkeypatch: pytest.MonkeyPatch) -> None:
    near, far = {"name": "near", "x_m": 0.0, "y_m": 0.0}, {"name": "far", "x_m": 1.5, "y_m": 1.5}
    monkeypatch.setattr("thymio_sim_ros.sim.world.MIN_BATCH_ROBOTS", 2)
    few, many = (World(make([FLOOR, box(0.15, 0.0, 0.02, 0.5)], robots)) for robots in ([near], [near, far]))
    for one, both in zip(run(few, 1.0), run(many, 1.0), strict=True):
        other = {name: reading for robot, name, reading in both.readings if robot == "near"}
        for _, name, reading in one.readings:
            assert reading.words == other[name].words
