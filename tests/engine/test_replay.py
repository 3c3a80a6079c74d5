"""A run is replayed from its log bit for bit, and the first tick that differs is reported."""

from __future__ import annotations

import json
import random
from pathlib import Path

import pytest

from aseba_vm import protocol
from tests.sim.builders import FLOOR, ROBOT, box, make, shipped
from thymio_sim_ros.device.programs.program import load_program
from thymio_sim_ros.device.programs.status import PAUSED
from thymio_sim_ros.engine.compressed_text import CompressedText
from thymio_sim_ros.engine.engine import Engine
from thymio_sim_ros.engine.inputs import (
    BreakpointsSet,
    ClientConnected,
    ClientDisconnected,
    Controlled,
    DevicesAdded,
    DeviceStart,
    EventSent,
    Input,
    Loaded,
    MessagesReceived,
    Remembered,
    Removed,
    VariableSet,
)
from thymio_sim_ros.engine.replay import replay
from thymio_sim_ros.engine.run_log import RunLog, RunLogError
from thymio_sim_ros.files.loading import read_program
from thymio_sim_ros.sim.commands import (
    Clap,
    Command,
    ConnectCharger,
    Lift,
    MotorTargets,
    MoveObject,
    MoveRobot,
    PlayTone,
    PressButton,
    RemoteKey,
    SetAmbientLight,
    SetBattery,
    SetGround,
    SetMotorModel,
    SetNoiseLevel,
    SetPen,
    SetProximity,
    SetTemperature,
    Tap,
    Tilt,
)
from thymio_sim_ros.sim.playground.placement import PlacementError
from thymio_sim_ros.sim.playground.reader import RobotStart

CRATE = {**box(-0.5, 0.0, 0.06, 0.06), "name": "crate", "mass_kg": 0.1}


def log_to(path: Path) -> RunLog:
    return RunLog(path.open("w", encoding="utf-8"))


def test_an_eventful_run_is_replayed_bit_for_bit(tmp_path: Path) -> None:
    """Robots drive, push, draw, fall, are moved, come and go; the world is reset; then another follows."""
    path = tmp_path / "run.jsonl"
    log = log_to(path)
    dice = random.Random(3)
    for seed in (1, 2):
        engine = Engine(make([FLOOR, CRATE, {**box(0.6, 0.0, 0.05, 1.0), "name": "wall"}]), seed=seed)
        log.begin(f"world {seed}", engine)
        for tick in range(600):
            if tick == 300:
                engine.reset()
            if tick % 200 == 100:
                engine.spawn(RobotStart(f"late_{tick}", 1.5, -1.5 + tick / 400, 0.3))
            for robot in engine.world.robots:
                if dice.random() < 0.02:
                    engine.post(robot, MotorTargets(dice.randint(-500, 500), dice.randint(-500, 500)))
                if dice.random() < 0.005:
                    engine.post(robot, SetPen(down=True, color=(dice.random(), 0.0, 0.0)))
                if dice.random() < 0.01:
                    try:
                        engine.post(robot, MoveRobot(dice.uniform(-2.2, 2.2), dice.uniform(-2, 2), 0.0))
                        engine.post("crate", MoveObject(dice.uniform(-2, 2), dice.uniform(-2, 2), 1.0))
                    except PlacementError:
                        continue
            if tick % 200 == 190:
                engine.remove(next(reversed(engine.world.robots)))
            engine.step()
    log.close()
    found = replay(path)
    assert (found.runs, found.ticks, found.differs, found.is_complete) == (4, 1200, None, True)


def test_a_run_with_a_program_is_replayed_without_it(tmp_path: Path) -> None:
    path = tmp_path / "run.jsonl"
    log = log_to(path)
    engine = Engine(shipped("line"), read_program("line_follower"), seed=3)
    log.begin("line", engine)
    engine.run(5.0)
    log.close()
    assert replay(path).differs is None


@pytest.mark.parametrize("recorded", [pytest.param("plain", marks=pytest.mark.slow), "compiled"])
def test_a_class_with_operators_and_new_programs_is_replayed_by_either_engine(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, recorded: str
) -> None:
    """Twenty robots are a batch, compiled where wasmtime is installed; the log does not depend on that."""

    def choose(name: str) -> None:
        monkeypatch.undo()
        if name == "plain":
            monkeypatch.setattr("thymio_sim_ros.sim.kernel.memory.is_usable", lambda: False)

    path = tmp_path / "run.jsonl"
    choose(recorded)
    log = log_to(path)
    engine = Engine(shipped("classroom"), read_program("line_follower"), seed=5)
    log.begin("classroom", engine)
    names = list(engine.world.robots)
    whims: list[Command] = [
        Clap(200), Tap(), Lift(True), Lift(False),
        Tilt(0.3, -0.2), SetTemperature(31.5), RemoteKey(0, 80), SetBattery(3.5), SetAmbientLight(90),
        SetNoiseLevel(60), PressButton("center", True), PressButton("center", False), ConnectCharger(True),
        SetProximity((-1, 2000, 4505, -1, -1, -1, 0)), SetGround((77, -1)), SetPen(down=True, width_m=0.02),
        SetMotorModel("firmware"), PlayTone(440.0, None),
    ]  # fmt: skip
    dice = random.Random(5)
    for round_ in range(16):
        engine.run(0.1)
        engine.post(dice.choice(names), whims[round_ % len(whims)])
        if round_ == 5:
            engine.spawn(RobotStart("late", -1.9, -1.5, 0.3))
        if round_ % 4 == 3:
            engine.load(dice.choice(names), read_program(("explorer", "friendly", "fearful")[round_ % 3]))
        if round_ == 12:
            engine.remove("late")
    log.close()
    choose("plain" if recorded == "compiled" else "compiled")
    found = replay(path)
    assert (found.ticks, found.differs, found.is_complete) == (160, None, True)


def test_refused_places_leave_no_trace(tmp_path: Path) -> None:
    path = tmp_path / "run.jsonl"
    log = log_to(path)
    engine = Engine(make([FLOOR, CRATE], (ROBOT,)), seed=1)
    log.begin("world", engine)
    engine.post("thymio", MotorTargets(200, 210))
    for tick in range(400):
        if tick % 7 == 0:
            with pytest.raises(PlacementError):
                engine.spawn(RobotStart("late", engine.world.robots["thymio"].pose.x_m, 0.0))
        engine.step()
    log.close()
    assert replay(path).differs is None


@pytest.mark.parametrize("second", [1, 3, 5])
def test_the_first_second_that_differs_is_reported(tmp_path: Path, second: int) -> None:
    path = tmp_path / "run.jsonl"
    log = log_to(path)
    engine = Engine(make([FLOOR]), seed=1)
    log.begin("world", engine)
    engine.run(5.0)
    log.close()
    lines = path.read_text().splitlines()
    row = 1 + second
    data = json.loads(lines[row])
    data["state"] = "0" * 16
    path.write_text("\n".join([*lines[:row], json.dumps(data), *lines[row + 1 :]]) + "\n")
    found = replay(path)
    assert (found.differs, found.ticks) == ((1, 100 * second), 100 * second)


def test_another_command_makes_a_difference(tmp_path: Path) -> None:
    path = tmp_path / "run.jsonl"
    log = log_to(path)
    engine = Engine(make([FLOOR]), seed=1)
    log.begin("world", engine)
    engine.run(1.4)
    engine.post("thymio", MotorTargets(100, 100))
    engine.run(1.0)
    log.close()
    path.write_text(path.read_text().replace('"left": 100', '"left": 101'))
    assert replay(path).differs == (1, 200)


VERSION_1 = Path(__file__).parents[1] / "data" / "runlog" / "version-1.jsonl"


def test_a_log_of_version_1_is_replayed() -> None:
    """It has what the program commanded in place of the program, and a digest of each tick."""
    found = replay(VERSION_1)
    assert (found.runs, found.ticks, found.differs, found.is_complete) == (2, 570, None, True)


@pytest.mark.parametrize(("tick", "digits"), [(1, 0), (150, 49), (200, 99)])
def test_its_first_tick_that_differs_is_reported(tmp_path: Path, tick: int, digits: int) -> None:
    path = tmp_path / "run.jsonl"
    lines = VERSION_1.read_text().splitlines()
    rows = [row for row, line in enumerate(lines) if line.startswith('{"ticks"')]
    row = rows[(tick - 1) // 100]
    data = json.loads(lines[row])
    crc = data["crc"]
    data["crc"] = crc[: digits * 8] + ("0" if crc[digits * 8] != "0" else "1") + crc[digits * 8 + 1 :]
    path.write_text("\n".join([*lines[:row], json.dumps(data), *lines[row + 1 :]]) + "\n")
    found = replay(path)
    assert (found.differs, found.ticks) == ((1, tick), tick)


PROGRAM = """
var n = 0
timer.period[0] = 50
onevent timer0
n++
emit tick n
onevent prox
leds.top = [n % 32, 0, 0]
onevent hello
n = event.args[0]
"""
FILE = f"""<!DOCTYPE aesl-source><network><event size="1" name="tick"/><event size="1" name="hello"/>
<constant name="PART" value="7"/><node nodeId="1" name="thymio-II">{PROGRAM}</node></network>"""


def test_what_a_pupil_does_to_a_program_is_replayed(tmp_path: Path) -> None:
    """Loads, runs, steps, breakpoints, variables and events, on two robots, with a reset."""
    path = tmp_path / "run.jsonl"
    log = log_to(path)
    engine = Engine(shipped("two_robots"), load_program(FILE, "mine.aesl"), seed=7)
    log.begin("two_robots", engine)
    engine.run(0.53)
    first, second = engine.devices
    engine.apply(BreakpointsSet(first, (7,)))
    engine.run(0.5)
    assert engine.devices[first].status.state == PAUSED
    for action in ("step", "step_line", "run", "pause", "run"):
        engine.apply(Controlled(first, action))
        engine.run(0.07)
    engine.set_variable(second, "n", [500])
    engine.send_event("hello", [41], [second])
    engine.run(0.01)
    assert engine.devices[second].variables.get("n")[0] == 41
    engine.load(first, load_program("motor.left.target = 200\nmotor.right.target = 180", "drive"))
    engine.apply(BreakpointsSet(first, ()))
    engine.run(1.0)
    engine.apply(Controlled(second, "stop"))
    engine.run(0.5)
    engine.reset()
    engine.apply(Controlled(first, "switch_off"))
    engine.run(0.33)
    log.close()
    found = replay(path)
    assert (found.runs, found.differs, found.is_complete) == (2, None, True)
    for input_ in ("Controlled", "BreakpointsSet", "VariableSet", "EventSent"):
        assert any(input_ in line for line in path.read_text().splitlines())
    changed = path.read_text().replace('"words": [500]', '"words": [499]').replace('"args": [41]', '"args": [42]')
    path.write_text(changed)
    assert replay(path).differs is not None


def test_what_a_tool_on_the_network_does_is_replayed(tmp_path: Path) -> None:
    """A client loads bytecode of a text that it has sent, sets a breakpoint and variables, steps and runs."""
    path = tmp_path / "run.jsonl"
    log = log_to(path)
    engine = Engine(shipped("two_robots"))
    log.begin("two_robots", engine)
    engine.run(0.1)
    first, second = engine.world.robots
    starts = {first: DeviceStart(1, None, "menu"), second: DeviceStart(2, load_program(FILE, "mine.aesl"))}
    engine.apply(DevicesAdded(starts))
    engine.apply(ClientConnected(first, 5))
    program = load_program(FILE, "mine.aesl")
    engine.apply(Remembered(first, program))
    words = program.program.words
    sent = (protocol.SetBytecode(0, 1, 0, words), protocol.Reset(0, 1), protocol.Run(0, 1))
    engine.apply(MessagesReceived(first, 5, sent))
    engine.run(0.4)
    assert engine.hosts[first].program == program
    engine.apply(MessagesReceived(first, 5, (protocol.Pause(0, 1), protocol.Step(0, 1))))
    engine.run(0.1)
    engine.apply(MessagesReceived(first, 5, (protocol.GetVariables(0, 1, 0, 10),)))
    engine.apply(MessagesReceived(first, 5, (protocol.SetVariables(0, 1, 0, (3,)), protocol.Run(0, 1))))
    engine.run(0.2)
    replies = engine.pop_sent()
    assert any(isinstance(message, protocol.Variables) for sent in replies for message in sent.messages)
    assert any(sent.client is None for sent in replies)
    engine.apply(ClientDisconnected(first, 5))
    engine.apply(Loaded(second, None))
    engine.apply(Loaded(first, load_program("leds.top = [9, 9, 9]", "light"), "menu"))
    engine.run(1.0)
    engine.reset()
    engine.run(0.5)
    log.close()
    found = replay(path)
    assert (found.runs, found.differs, found.is_complete) == (2, None, True)
    lines = path.read_text().splitlines()
    assert sum('"receive"' in line for line in lines) == 3, "a question changes nothing"


def test_devices_that_are_added_run_as_from_the_start(tmp_path: Path) -> None:
    """The programs of an engine that starts with them, and of one that gets them before its first tick."""
    program = load_program(FILE, "mine.aesl")
    given = Engine(shipped("two_robots"), program, seed=2)
    added = Engine(shipped("two_robots"), seed=2)
    added.apply(DevicesAdded({name: DeviceStart(at, program) for at, name in enumerate(added.world.robots, start=1)}))
    for engine in (given, added):
        engine.run(1.0)
    assert given.digest() == added.digest()


@pytest.mark.parametrize(
    ("happened", "error"),
    [
        (Controlled("thymio", "fly"), ValueError),
        (EventSent(("thymio",), "ping", (1, 2, 3)), ValueError),
        (Controlled("ghost", "run"), KeyError),
        (VariableSet("thymio", "n", (1, 2)), ValueError),
        (VariableSet("thymio", "nothing", (1,)), KeyError),
        (EventSent(("thymio",), "nothing", ()), KeyError),
        (BreakpointsSet("ghost", (1,)), KeyError),
        (Removed("ghost"), KeyError),
    ],
)
def test_an_input_that_is_refused_is_not_in_the_log(tmp_path: Path, happened: Input, error: type[Exception]) -> None:
    path = tmp_path / "run.jsonl"
    log = log_to(path)
    engine = Engine(shipped("line"), load_program(FILE.replace("hello", "ping"), "n"))
    log.begin("line", engine)
    with pytest.raises(error):
        engine.apply(happened)
    log.close()
    assert len(path.read_text().splitlines()) == 4  # format, world, state, end


def test_a_log_without_its_end_is_replayed_as_far_as_it_goes(tmp_path: Path) -> None:
    path = tmp_path / "run.jsonl"
    log = log_to(path)
    engine = Engine(make([FLOOR]), seed=1)
    log.begin("world", engine)
    for _ in range(250):
        engine.step()
    log.close()
    path.write_text("".join(path.read_text().splitlines(keepends=True)[:-2]))
    found = replay(path)
    assert (found.ticks, found.differs, found.is_complete) == (200, None, False)


@pytest.mark.parametrize(
    ("change", "text"),
    [
        (lambda lines: [lines[0], *lines[2:]], "line 2: found what happened to no world, expected a world first"),
        (lambda lines: [*lines, lines[2]], "line 5: found a line after the end, expected nothing"),
        (lambda lines: [lines[0], lines[1].replace('"default"', '"sonar"'), *lines[2:]], "line 2: .*sonar"),
        (lambda lines: [*lines[:2], '{"tick": -5, "remove": "x"}', *lines[2:]], "line 3: found tick -5, expected 0"),
        (lambda lines: [*lines[:3], '{"tick": 0, "remove": "x"}', *lines[3:]], "line 4: found tick 0, expected 1 or"),
        (lambda lines: [*lines[:2], '{"tick": 5, "remove": "x"}', *lines[2:]], "line 4: found tick 1, expected 5"),
        (lambda lines: [*lines[:2], '{"tick": 999999, "state": ""}', *lines[2:]], "line 3: found tick 999999, "),
    ],
)
def test_a_log_in_disorder_is_refused(tmp_path: Path, change: object, text: str) -> None:
    path = tmp_path / "run.jsonl"
    log = log_to(path)
    engine = Engine(make([FLOOR]))
    log.begin("world", engine)
    engine.step()
    log.close()
    assert callable(change)
    path.write_text("".join(f"{line}\n" for line in change(path.read_text().splitlines())))
    with pytest.raises(RunLogError, match=text):
        replay(path)


def test_a_robot_with_a_device_that_was_added_is_gone_after_a_reset(tmp_path: Path) -> None:
    path = tmp_path / "run.jsonl"
    log = log_to(path)
    engine = Engine(shipped("base"), load_program("var n\nonevent prox\nn++", "n"), seed=2)
    log.begin("base", engine)
    engine.run(0.5)
    engine.spawn(RobotStart("late", 0.2, 0.2, 0.0))
    engine.apply(DevicesAdded({"late": DeviceStart(2, load_program("var m = 1", "m"))}))
    engine.run(0.5)
    engine.reset()
    assert engine.devices.keys() == engine.world.robots.keys() == {"thymio"}
    engine.run(1.0)
    log.close()
    found = replay(path)
    assert (found.runs, found.differs, found.is_complete) == (2, None, True)


def test_two_logs_of_one_engine_are_the_same_run(tmp_path: Path) -> None:
    engine = Engine(shipped("base"), load_program("motor.left.target = 100", "drive"))
    first, second = tmp_path / "first.jsonl", tmp_path / "second.jsonl"
    logs = [log_to(first), log_to(second)]
    for log in logs:
        log.begin("base", engine)
    engine.run(0.5)
    logs[0].close()
    engine.run(1.0)
    logs[1].close()
    assert [(replay(path).ticks, replay(path).differs) for path in (first, second)] == [(50, None), (150, None)]


@pytest.mark.parametrize("lost", [0, 30])
def test_a_compressed_log_is_replayed_as_far_as_it_goes(tmp_path: Path, lost: int) -> None:
    text = CompressedText(1_000_000)
    log = RunLog(text)
    engine = Engine(shipped("line"), read_program("line_follower"), seed=3)
    log.begin("line", engine)
    engine.run(30.0)
    path = tmp_path / "run.jsonl.gz"
    path.write_bytes(text.content()[: len(text.content()) - lost])
    found = replay(path)
    assert found.differs is None
    assert (found.ticks == 3000) == (not lost)
    log.close()
    path.write_bytes(text.content())
    assert replay(path).is_complete
