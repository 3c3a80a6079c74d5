"""World and devices in lock-step without ROS: laps, repeatability, robots that talk."""

from __future__ import annotations

import itertools
import json
import math
from pathlib import Path

import pytest

from aseba_vm.jit.tiering import INTERPRETER
from tests.aseba_vm.engines import TRANSLATORS
from tests.tracks import farthest_in_laps
from thymio_sim_ros.device.costs import PROGRAM_START
from thymio_sim_ros.device.device import AsebaDevice
from thymio_sim_ros.device.firmware.settings import SettingsError
from thymio_sim_ros.device.options import DeviceOptions
from thymio_sim_ros.device.programs.program import load_program
from thymio_sim_ros.engine.devices import BUDGET, TICK_BUDGET
from thymio_sim_ros.engine.engine import Engine
from thymio_sim_ros.engine.inputs import DevicesAdded, DeviceStart
from thymio_sim_ros.files.loading import load_playground, read_program
from thymio_sim_ros.sim.commands import BodyTwist, MoveRobot, WheelVelocities
from thymio_sim_ros.sim.playground import reader as playgrounds
from thymio_sim_ros.sim.playground.reader import RobotStart

RUNAWAYS = sorted((Path(__file__).parents[1] / "data" / "runaway").glob("*.aesl"))

TALK = """<network><event size="1" name="hello"/><node name="thymio-II">
var heard[2]
onevent button.center
    if button.center == 1 then
        emit hello 42
    end
onevent hello
    heard = [event.source, event.args[0]]
</node></network>"""

TWO = json.dumps(
    {
        "format": 1,
        "title": "Two",
        "shapes": [{"kind": "rectangle", "size_x_m": 2.0, "size_y_m": 2.0, "color": "#ffffff"}],
        "robots": [{"name": "anna", "x_m": 0.0, "y_m": 0.5}, {"name": "bert", "x_m": 0.0, "y_m": -0.5}],
    }
)


def line_follower_engine(seed):
    return Engine(load_playground("line")[1], read_program("line_follower"), seed=seed)


@pytest.mark.parametrize("seed", range(10))
def test_the_line_program_goes_round_without_leaving_the_line(seed):
    assert farthest_in_laps(line_follower_engine(seed), 1) < 0.02


@pytest.mark.parametrize("speed", [300, 500])
def test_the_line_program_goes_round_five_times_at_any_speed(speed):
    engine = line_follower_engine(0)
    engine.devices["thymio"].receive_event("speed", (speed,))
    assert farthest_in_laps(engine, 5) < 0.02


def test_the_line_program_emits_an_event_when_it_turns():
    engine = line_follower_engine(0)
    reported = []
    for _ in range(1000):
        engine.step()
        reported += [(robot, event.name, event.args) for robot, event in engine.emitted]
    assert reported[0] == ("thymio", "line", (0,))
    assert {args for _, _, args in reported} >= {(0,), (-1,)}
    assert all(before != after for before, after in itertools.pairwise(reported))


def test_the_same_seed_gives_the_same_poses_bit_for_bit():
    poses = []
    for seed in (5, 5, 6):
        engine = line_follower_engine(seed)
        track = []
        for _ in range(100):
            engine.run(0.2)
            track.append(engine.world.robots["thymio"].pose)
        poses.append(track)
    assert poses[0] == poses[1]
    assert poses[0] != poses[2]


READER = """var n = 0
var sum = 0
timer.period[0] = 30
motor.left.target = 200
onevent prox
sum += motor.left.speed / 10 + _imot[0] + prox.horizontal[2] / 100
onevent timer0
n++
motor.right.target = 200 - n % 200
call leds.top(n % 32, 0, 0)
onevent button.center
motor.left.target = 0
"""


def test_the_same_seed_gives_the_same_run_whatever_is_read():
    found = []
    for is_read in (False, True):
        engine = Engine(playgrounds.loads(TWO, "two"), load_program(READER, "reader"), seed=3)
        for second in range(4):
            engine.press("anna", "center", pressed=second == 2)
            for _ in range(100):
                if is_read:
                    assert engine.step().readings
                    _ = [device.variables.words() for device in engine.devices.values()]
                else:
                    engine.run(0.01)
        words = [device.variables.words() for device in engine.devices.values()]
        found.append((words, engine.world.snapshot()))
    assert found[0] == found[1]


def test_a_variable_is_measured_when_it_is_read():
    engine = Engine(load_playground("base")[1], load_program("motor.left.target = 100", "left"), noise=False)
    variables = engine.devices["thymio"].variables
    for target in (100, 250):
        variables.set("motor.left.target", (target,))
        engine.run(0.03)
        assert variables.get("motor.left.speed") == (target,)


def test_a_value_written_to_a_measured_variable_stays_until_the_next_tick():
    engine = Engine(load_playground("base")[1], load_program("", "none"), noise=False)
    variables = engine.devices["thymio"].variables
    engine.run(0.1)
    variables.set("motor.left.speed", (7,))
    assert variables.get("motor.left.speed") == (7,)
    engine.run(0.01)
    assert variables.get("motor.left.speed") == (0,)


def test_the_event_of_a_sensor_that_measures_on_demand_comes_once_it_is_handled():
    engine = Engine(load_playground("base")[1], load_program("var n = 0", "none"))
    engine.run(0.5)
    engine.load("thymio", load_program("var n = 0\nonevent motor\nn++", "motor"))
    engine.run(0.5)
    assert engine.devices["thymio"].variables.get("n") == (50,)


def test_a_device_without_work_is_not_run(monkeypatch):
    engine = Engine(load_playground("base")[1], load_program("timer.period[0] = 500\nonevent timer0", "t"), noise=False)
    engine.run(1.0)
    runs = []
    run = AsebaDevice.run
    monkeypatch.setattr(AsebaDevice, "run", lambda device, budget: runs.append(engine.now_ns) or run(device, budget))
    engine.run(1.0)
    ticks = {now_ns // 10_000_000 for now_ns in runs}
    assert {150, 200} <= ticks
    assert len(ticks) < 30


def test_reset_repeats_the_run():
    engine = line_follower_engine(1)
    engine.run(5.0)
    first = engine.world.robots["thymio"].pose
    engine.reset()
    assert engine.now_ns == 0
    engine.run(5.0)
    assert engine.world.robots["thymio"].pose == first


def test_robots_hear_each_other_s_events_but_not_their_own():
    engine = Engine(playgrounds.loads(TWO, "two"), load_program(TALK, "talk.aesl"))
    engine.press("anna", "center")
    assert engine.until(lambda: engine.devices["bert"].variables.get("heard") == (1, 42), 1.0)
    assert engine.devices["anna"].variables.get("heard") == (0, 0)


def test_every_event_of_one_handler_is_heard_in_the_same_tick():
    source = TALK.replace("emit hello 42", "emit hello 4\n        emit hello 2").replace("heard = [", "heard += [")
    engine = Engine(playgrounds.loads(TWO, "two"), load_program(source, "talk.aesl"))
    engine.press("bert", "center")
    assert engine.until(lambda: engine.devices["bert"].variables.get("button.center") == (1,), 1.0)
    assert engine.devices["anna"].variables.get("heard") == (4, 6)


def test_robots_that_answer_each_other_for_ever_do_not_hold_the_world_up():
    source = """<network><event size="0" name="ball"/><node name="thymio-II">
    var n = 0
    onevent button.center
    emit ball
    onevent ball
    n = n + 1
    emit ball
    </node></network>"""
    engine = Engine(playgrounds.loads(TWO, "two"), load_program(source, "ball.aesl"))
    engine.press("anna", "center")
    engine.run(1.0)
    assert engine.devices["bert"].variables.get("n")[0] > 50


def test_a_timer_started_at_the_beginning_fires_on_time():
    program = load_program("var n = 0\ntimer.period[0] = 100\nonevent timer0\nn++", "timer")
    engine = Engine(load_playground("base")[1], program)
    engine.run(0.09)
    assert engine.devices["thymio"].variables.get("n") == (0,)
    engine.run(0.01)
    assert engine.devices["thymio"].variables.get("n") == (1,)


def test_a_program_can_be_given_to_some_robots_only():
    engine = Engine(playgrounds.loads(TWO, "two"), {"bert": load_program("motor.left.target = 100", "a")})
    engine.run(1.0)
    assert engine.world.robots["anna"].pose.yaw_rad == 0.0
    assert engine.world.robots["bert"].pose.yaw_rad < -0.1


def test_a_program_for_a_robot_that_is_not_there_is_an_error():
    with pytest.raises(KeyError, match="no robot 'carl', only anna, bert"):
        Engine(playgrounds.loads(TWO, "two"), {"carl": load_program("", "a")})


def test_a_button_stops_the_line_program_and_lets_it_go_again():
    engine = line_follower_engine(0)
    robot = engine.world.robots["thymio"]
    engine.run(1.0)
    engine.press("thymio", "center")
    engine.run(0.3)
    stopped = robot.pose
    engine.press("thymio", "center", pressed=False)
    engine.run(1.0)
    assert robot.pose == stopped
    engine.press("thymio", "center")
    engine.run(1.0)
    assert robot.pose.x_m > stopped.x_m + 0.05


def test_an_event_sets_the_speed_of_the_line_program():
    engine = line_follower_engine(0)
    engine.run(1.0)
    engine.devices["thymio"].receive_event("speed", (9999,))
    engine.run(0.5)
    assert engine.devices["thymio"].variables.get("cruise") == (500,)


def test_a_ros_command_takes_over_for_its_time():
    engine = Engine(
        load_playground("base")[1], load_program("motor.left.target = 100\nmotor.right.target = 100", "a"), noise=False
    )
    robot = engine.world.robots["thymio"]
    engine.run(1.0)
    before = robot.pose.x_m
    engine.post("thymio", BodyTwist(-0.1, 0.0, 500_000_000))
    engine.run(0.51)
    assert robot.pose.x_m == pytest.approx(before - 0.05, abs=0.002)
    engine.run(1.0)
    assert robot.pose.x_m == pytest.approx(before - 0.05 + 0.0332, abs=0.002)


NOTE = """<network><node name="thymio-II">
var status
var n
call sd.open(1, status)
call sd.write([_id], n)
</node></network>"""


def test_each_of_several_robots_has_a_card_of_its_own(tmp_path):
    options = DeviceOptions(card=tmp_path)
    Engine(playgrounds.loads(TWO, "two"), load_program(NOTE, "note"), options=options)
    found = {path.parent.name: path.read_bytes() for path in tmp_path.glob("*/u1.dat")}
    assert found == {"anna": b"\x01\x00", "bert": b"\x02\x00"}


@pytest.mark.parametrize(("network", "heard"), [(0, (1, 42)), (5, (0, 0))])
def test_robots_of_different_radio_networks_do_not_hear_each_other(network, heard):
    setup = f"call _rf.setup(0, {network} * (_id - 1))\nonevent button.center"
    engine = Engine(playgrounds.loads(TWO, "two"), load_program(TALK.replace("onevent button.center", setup), "talk"))
    engine.press("anna", "center")
    engine.run(0.5)
    assert engine.devices["bert"].variables.get("heard") == heard


def test_a_sound_that_ends_raises_its_event_in_simulated_time():
    source = "var n = 0\ncall sound.freq(440, 30)\nonevent sound.finished\nn = n + 1"
    engine = Engine(playgrounds.loads(TWO, "two"), load_program(source, "sound"))
    device = engine.devices["anna"]
    assert engine.until(lambda: device.variables.get("n") == (1,), 1.0)
    assert engine.now_ns == pytest.approx(30 * 16_384_000, abs=20_000_000)
    engine.run(2.0)
    assert device.variables.get("n") == (1,)


def test_the_robot_s_lights_show_an_obstacle_until_the_program_takes_them():
    wall = {"kind": "box", "x_m": 0.14, "y_m": 0.5, "size_x_m": 0.02, "size_y_m": 0.3, "height_m": 0.1}
    world = json.loads(TWO)
    world["shapes"].append(wall | {"color": "#ffffff"})
    playground = playgrounds.loads(json.dumps(world), "two")
    source = "onevent button.center\ncall leds.prox.h(1, 2, 3, 4, 5, 6, 7, 8)"
    engine = Engine(playground, load_program(source, "lights"))
    engine.run(0.5)
    lights = dict(engine.world.snapshot().robots[0].leds)
    assert lights["proximity"][2] == lights["proximity"][3] > 10
    assert lights["battery"] == (32, 32, 32)
    engine.press("anna", "center")
    engine.run(0.5)
    assert dict(engine.world.snapshot().robots[0].leds)["proximity"] == (1, 2, 3, 4, 5, 6, 7, 8)


def test_a_reset_forgets_settings_and_radio():
    source = "var was\ncall _system.settings.read(0, was)\ncall _system.settings.write(0, 5)\ncall _rf.nodeid(77)"
    source += "\nonevent button.center\ncall _rf.setup(3, 4)"
    engine = Engine(playgrounds.loads(TWO, "two"), load_program(source, "test"))
    assert engine.devices["bert"].node_id == 77
    engine.press("bert", "center")
    engine.run(0.1)
    assert engine.devices["bert"].services.network == (3, 4)
    engine.reset()
    assert engine.devices["bert"].services.network == (0, 0)
    assert engine.devices["bert"].variables.get("was") == (0,)
    assert engine.devices["bert"].variables.get("_id") == (2,)


def test_the_program_of_a_robot_that_left_rests_and_begins_anew_when_it_is_back():
    code = "var n = 0\ntimer.period[0] = 20\nonevent timer0\nn++\nmotor.left.target = n\nemit tick n"
    program = load_program(f'<network><event size="1" name="tick"/><node name="thymio-II">{code}</node></network>', "t")
    engine = Engine(playgrounds.loads(TWO, "two"), program)
    engine.run(0.5)
    engine.world.remove("anna")
    speakers = set()
    for _ in range(50):
        engine.step()
        speakers.update(robot for robot, _ in engine.emitted)
    assert speakers == {"bert"}
    engine.world.spawn(RobotStart("anna", 0.0, 0.5))
    engine.run(0.5)
    assert engine.devices["anna"].variables.get("n") == (24,)
    assert engine.devices["bert"].variables.get("n") == (75,)


def test_a_world_that_is_reset_has_the_programs_of_robots_that_had_left():
    engine = Engine(playgrounds.loads(TWO, "two"), load_program("var n = 0\nonevent motor\nn++", "t"))
    engine.run(0.5)
    engine.world.remove("anna")
    engine.run(0.5)
    engine.reset()
    engine.run(0.5)
    assert [device.variables.get("n") for device in engine.devices.values()] == [(50,), (50,)]


def test_a_robot_follows_the_line_that_another_one_draws():
    shapes = [{"kind": "rectangle", "size_x_m": 2.0, "size_y_m": 2.0, "color": "#ffffff"}]
    pen = {"color": "#000000", "width_m": 0.03}
    robots = [
        {"name": "painter", "x_m": 0.0, "y_m": -0.4, "pen": pen},
        {"name": "follower", "x_m": 0.0, "y_m": 0.0, "yaw_rad": 0.0},
    ]
    world = {"format": 1, "title": "Drawing", "shapes": shapes, "robots": robots}
    playground = playgrounds.loads(json.dumps(world), "drawing")
    engine = Engine(playground, {"follower": read_program("line_follower")}, noise=False)
    hold = WheelVelocities(0.0, 0.0)
    for _ in range(1800):
        engine.post("painter", BodyTwist(0.1, 0.25))
        engine.post("follower", hold)
        engine.step()
    painter, follower = (engine.world.robots[name] for name in ("painter", "follower"))
    engine.post("painter", MoveRobot(0.9, 0.9, 0.0))
    engine.post("follower", MoveRobot(0.0, -0.4, 0.0))
    engine.devices["follower"].run_control.reset()
    engine.devices["follower"].run_control.resume()
    way = []
    for _ in range(1500):
        engine.step()
        way.append(math.hypot(follower.pose.x_m, follower.pose.y_m))
    assert painter.pose.x_m > 0.8
    assert all(0.35 < radius < 0.45 for radius in way)
    assert follower.pose.y_m > -0.3


LONGEST_CALL = 2 * 0x10000 + BUDGET
"""Instructions that a robot may execute beyond its share: a deque is moved around its ring."""


def runaway(path, translator, card):
    options = DeviceOptions(card=card, settings=card.with_name(f"{card.name}-settings"))
    engine = Engine(playgrounds.loads(TWO, "two"), load_program(path.read_text(), path.name), options=options)
    reported = []
    for device in engine.devices.values():
        device._vm.use_engine(translator)
    for _ in range(4):
        engine.step()
        spent = [device._vm.instructions for device in engine.devices.values()]
        reported.append((spent, [device.variables.words() for device in engine.devices.values()], list(engine.emitted)))
    return reported


@pytest.mark.parametrize("path", RUNAWAYS, ids=lambda path: path.stem)
def test_a_program_without_an_end_gets_its_budget_whatever_runs_it(path, tmp_path):
    wanted = runaway(path, INTERPRETER, tmp_path / INTERPRETER)
    for tick, (spent, _, _) in enumerate(wanted, start=2):  # devices also run before the first tick
        assert 0 < sum(spent) <= tick * TICK_BUDGET + len(spent) * LONGEST_CALL
    for translator in TRANSLATORS:
        assert runaway(path, translator, tmp_path / translator) == wanted


def test_a_robot_whose_calls_are_longer_than_its_share_pays_for_them_and_no_other_robot_waits():
    deques, counter = read_runaway("deques"), load_program("var n\nonevent motor\nn++", "counter")
    engine = Engine(playgrounds.loads(TWO, "two"), {"anna": deques, "bert": counter})
    engine.run(2)
    assert 0 < engine.devices["anna"]._vm.instructions <= 201 * TICK_BUDGET + LONGEST_CALL
    assert engine.devices["bert"].variables.get("n") == (200,)


def test_a_new_program_does_not_pay_for_the_calls_of_the_one_before_it():
    counter = load_program("var n = 1", "counter")
    engine = Engine(playgrounds.loads(TWO, "two"), {"anna": read_runaway("deques")})
    engine.load("anna", counter)
    engine.step()
    assert engine.devices["anna"].variables.get("n") == (1,)


@pytest.mark.parametrize("name", ["menu", "reboot"])
def test_a_robot_that_starts_its_program_all_the_time_pays_for_each_start(name):
    engine = Engine(playgrounds.loads(TWO, "two"), read_runaway(name))
    resets = 0

    def count_reset(vm: object) -> None:
        nonlocal resets
        resets += 1

    for device in engine.devices.values():
        reset = device._vm._on_reset
        device._vm._on_reset = lambda vm, reset=reset: (count_reset(vm), reset(vm))
    engine.run(1)
    assert 20 < resets <= 101 * TICK_BUDGET / PROGRAM_START + 2


def read_runaway(name):
    path = RUNAWAYS[0].with_name(f"{name}.aesl")
    return load_program(path.read_text(), path.name)


def test_devices_that_cannot_be_created_leave_the_options_as_they_were(tmp_path: Path) -> None:
    engine = Engine(load_playground("two_robots")[1])
    before = engine.start
    folder = tmp_path / "red"
    folder.mkdir()
    (folder / "settings.json").write_text("no JSON", encoding="utf-8")
    with pytest.raises(SettingsError):
        engine.apply(DevicesAdded({"red": DeviceStart(1, None)}, DeviceOptions(settings=tmp_path)))
    assert (engine.start, engine.devices) == (before, {})
