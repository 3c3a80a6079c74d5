"""All robots of a world: kernels give the bits of Python, robots come and go, readings keep."""

from __future__ import annotations

import dataclasses
import json
import math
import random
from itertools import groupby
from typing import Any

import pytest

from tests.sim.builders import FLOOR, box, make, run
from thymio_sim_ros.sim.actuators import all_actuators
from thymio_sim_ros.sim.commands import (
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
)
from thymio_sim_ros.sim.model.lidar import LIDAR
from thymio_sim_ros.sim.playground import reader
from thymio_sim_ros.sim.playground.reader import Playground, RobotStart
from thymio_sim_ros.sim.sensors import NEVER_NS, all_sensors
from thymio_sim_ros.sim.world import StepResult, World


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


def play(scene: Playground, ticks: int = 200, **options: Any) -> list[StepResult]:
    """Two seconds in which robots drive and push, one falls off the edge, and one has a button pressed."""
    world = World(scene, **options)
    dice = random.Random(1)
    steps = []
    for tick in range(ticks):
        for robot in world.robots:
            if dice.random() < 0.02:
                world.post(robot, MotorTargets(dice.randint(-500, 500), dice.randint(-500, 500)))
        if tick == ticks * 3 // 5:
            world.post("robot_0", MoveRobot(0.02, 0.95, 1.0))
            world.post("robot_1", PressButton("left", True))
        steps.append(world.step())
    return steps


@pytest.mark.parametrize("model", ["default", "enki", "cone"])
@pytest.mark.parametrize("motor_model", ["ideal", "firmware"])
def test_kernels_that_python_runs_give_the_same_bits(
    monkeypatch: pytest.MonkeyPatch, model: str, motor_model: str
) -> None:
    """Python also reports an index beyond an array, which a compiled kernel does not."""
    scene = busy(random.Random(3), 4)
    options: dict[str, Any] = {"seed": 3, "proximity_model": model, "motor_model": motor_model}
    compiled = play(scene, 60, **options)
    list(map(list, (step.readings for step in compiled)))
    monkeypatch.setattr("thymio_sim_ros.sim.kernel.memory.is_usable", lambda: False)
    assert play(scene, 60, **options) == compiled
    counts = [max(reading.words) for step in compiled for _, name, reading in step.readings if name == "proximity"]
    assert 0 < sum(count > 0 for count in counts) < len(counts)


def test_kernels_that_python_runs_push_with_the_same_bits(monkeypatch: pytest.MonkeyPatch) -> None:
    scene = make([FLOOR, box(0.14, 0.02, 0.05, 0.05) | {"mass_kg": 0.3}], [{"name": "robot_0", "x_m": 0.0, "y_m": 0.0}])

    def push() -> list[StepResult]:
        world = World(scene)
        world.post("robot_0", MotorTargets(400, 300))
        return [world.step() for _ in range(80)]

    compiled = push()
    monkeypatch.setattr("thymio_sim_ros.sim.kernel.memory.is_usable", lambda: False)
    assert push() == compiled
    assert any(step.contacts for step in compiled)


def test_objects_that_are_pushed_moved_opened_or_gone_are_seen_where_they_are() -> None:
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
    world, steps = World(scene), []
    for tick in range(300):
        if tick == 0:
            world.post("pusher", MotorTargets(250, 250))
            world.post("at_the_edge", MotorTargets(250, 250))
        if tick == 110:
            world.post("at_the_edge", MotorTargets(0, 0))
        if tick in (100, 200):
            world.post("carried", MoveObject(1.2 if tick == 100 else 0.14, 1.0, 0.0))
        steps.append(world.step())
    expected = {"bystander": [0, 1], "before_carried": [1, 0, 1], "before_gate": [1, 0], "at_the_edge": [1, 0]}
    for robot, seen in expected.items():
        rows = (row for step in steps for row in step.readings if row[:2] == (robot, "proximity"))
        counts = [max(reading.words) for _, _, reading in rows]
        assert [int(is_seen) for is_seen, _ in groupby(count > 0 for count in counts)] == seen, robot


def test_robots_repeat_themselves_bit_for_bit() -> None:
    scene = busy(random.Random(9), 12)
    assert play(scene, seed=2) == play(scene, seed=2)


def test_readings_may_be_looked_at_much_later() -> None:
    scene = busy(random.Random(9), 12)
    late, now = play(scene, seed=2), World(scene, seed=2)
    dice = random.Random(1)
    for tick, step in enumerate(late):
        for robot in now.robots:
            if dice.random() < 0.02:
                now.post(robot, MotorTargets(dice.randint(-500, 500), dice.randint(-500, 500)))
        if tick == 120:
            now.post("robot_0", MoveRobot(0.02, 0.95, 1.0))
            now.post("robot_1", PressButton("left", True))
        assert list(now.step().readings) == list(step.readings)


def test_robots_that_stay_do_not_notice_that_others_come_and_go() -> None:
    """Those that come and go are far away; more come than there is room for at first."""
    stays = {"name": "stays", "x_m": 0.0, "y_m": 0.0}
    scene = make([FLOOR, box(0.3, 0.0, 0.02, 0.5)], [stays])
    alone, visited = World(scene, seed=4), World(scene, seed=4)
    dice, seen, guests = random.Random(2), set(), []
    for tick in range(300):
        if tick % 20 == 0:
            command = dice.choice((Tap(), Tilt(0.1, 0.2), Clap(200), SetMotorModel("firmware")))
            for world in (alone, visited):
                world.post("stays", MotorTargets(tick, 150))
                world.post("stays", command)
        if tick % 15 == 7:
            guests.append(f"guest_{tick}")
            visited.spawn(RobotStart(guests[-1], -1.8 + 0.18 * (tick // 15), 1.5, 0.0))
        if tick % 31 == 30:
            visited.remove(guests.pop(0))
        expected = list(alone.step().readings)
        found = [row for row in visited.step().readings if row[0] == "stays"]
        assert found == expected, tick
        seen.update(name for _, name, _ in found)
    assert {"tap", "current", "collision", "accelerometer", "sound", "buttons", "proximity"} <= seen


def test_a_robot_that_returns_under_its_name_is_a_new_one() -> None:
    world = World(make([FLOOR]), seed=3)
    world.post("thymio", MotorTargets(500, 500))
    run(world, 0.5)
    world.remove("thymio")
    world.spawn(RobotStart("thymio", 0.0, 0.0, 0.0))
    robot = world.robots["thymio"]
    run(world, 0.2)
    assert (robot.pose.x_m, robot.wheels.odometry.x_m, robot.wheels.angles_rad) == (0.0, 0.0, (0.0, 0.0))


def test_a_sensor_that_is_woken_measures_on_its_robot_alone() -> None:
    robots = [{"name": f"robot_{index}", "x_m": index * 0.3, "y_m": 0.0} for index in range(6)]
    world = World(make([FLOOR], robots), periods_ns={"loudspeaker": NEVER_NS, "ground": 10_000_000})
    world.step()
    world.post("robot_2", PlayTone(440.0, None))
    found = [row[:2] for row in world.step().readings]
    expected = [(robot["name"], "ground") for robot in robots]
    assert found == [*expected[:3], ("robot_2", "loudspeaker"), *expected[3:]]


def test_an_actuator_at_rest_is_left_alone_until_its_next_command(monkeypatch: pytest.MonkeyPatch) -> None:
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


@pytest.mark.parametrize("robots", [1, 14])
def test_sensors_of_one_period_measure_in_the_same_tick_whatever_their_own_phase(robots: int) -> None:
    starts = [{"name": f"r{number}", "x_m": 0.3 * number, "y_m": 0.0} for number in range(robots)]
    own = [sensor for sensor in all_sensors() if sensor.name != LIDAR]  # robots have one only if a world says so
    regular = [sensor.name for sensor in own if sensor.period_ns != NEVER_NS]
    world = World(make([FLOOR], starts), periods_ns=dict.fromkeys(regular, 100_000_000))
    found = [{name for _, name, _ in world.step().readings} for _ in range(20)]
    assert [bool(names) for names in found] == [tick % 10 == 9 for tick in range(20)]
    assert {"battery", "leds", "proximity"} <= found[9]


@pytest.mark.parametrize(("periods_ns", "found"), [({"sonar": 1}, "'sonar'"), ({"ground": 0}, "found 0 ns")])
def test_a_sensor_that_is_none_or_never_measures_is_refused(periods_ns: dict[str, int], found: str) -> None:
    with pytest.raises(ValueError, match=found):
        World(make([FLOOR]), periods_ns=periods_ns)


def test_noise_of_one_robot_does_not_depend_on_how_many_there_are() -> None:
    near, far = {"name": "near", "x_m": 0.0, "y_m": 0.0}, {"name": "far", "x_m": 1.5, "y_m": 1.5}
    few, many = (World(make([FLOOR, box(0.15, 0.0, 0.02, 0.5)], robots)) for robots in ([near], [near, far]))
    for one, both in zip(run(few, 1.0), run(many, 1.0), strict=True):
        other = {name: reading for robot, name, reading in both.readings if robot == "near"}
        for _, name, reading in one.readings:
            assert reading.words == other[name].words
