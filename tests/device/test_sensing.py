"""What programs see of the senses: events and their rates, variables, infrared communication. World and devices run."""

from __future__ import annotations

import json
import math
from unittest.mock import ANY

import pytest

from aseba_vm.targets import THYMIO_II
from thymio_sim_ros.device.programs.program import load_program
from thymio_sim_ros.engine.engine import Engine
from thymio_sim_ros.files.loading import load_playground
from thymio_sim_ros.sim.actuators.leds import LedState
from thymio_sim_ros.sim.commands import (
    Clap,
    ConnectCharger,
    PressButton,
    RemoteKey,
    SetBattery,
    SetNoiseLevel,
    SetTemperature,
    Tap,
    Tilt,
)
from thymio_sim_ros.sim.playground import reader as playground

EVENTS = [event.name for event in THYMIO_II.local_events]


def pair(gap_m=0.2, names=("anna", "bert")):
    """Two robots whose front sensors face each other across a gap."""
    floor = {"kind": "rectangle", "name": "floor", "size_x_m": 4.0, "size_y_m": 4.0, "color": "#ffffff"}
    robots = [
        {"name": name, "x_m": x_m, "y_m": 0.0, "yaw_rad": yaw_rad}
        for name, x_m, yaw_rad in zip(names, (0.0, 0.159 + gap_m), (0.0, math.pi), strict=False)
    ]
    return playground.loads(json.dumps({"format": 1, "title": "pair", "shapes": [floor], "robots": robots}), "pair")


def alone(source, **options):
    """A runner of one robot with a program, and its device."""
    engine = Engine(pair(names=("anna",)), load_program(source, "test"), **options)
    return engine, engine.devices["anna"]


def counting(events):
    """A program that counts each of these events."""
    handlers = "\n".join(f"onevent {event}\nn[{number}]++" for number, event in enumerate(events))
    return f"var n[{len(events)}]\n{{}}\n{handlers}"


def test_every_event_comes_as_often_as_on_the_robot():
    start = "call prox.comm.enable(1)\nmic.threshold = 50\ntimer.period = [100, 250]\ncall sound.freq(440, 6)"
    engine = Engine(pair(), load_program(counting(EVENTS).format(start), "test"), seed=3)
    engine.post("anna", SetNoiseLevel(51))
    for second in range(10):
        if second < 3:
            engine.post("anna", Tap())
        if second < 4:
            engine.post("anna", RemoteKey(0, 80))
        for pressed in (True, False):
            for button in ("backward", "left", "center", "forward", "right"):
                engine.post("anna", PressButton(button, pressed))
            engine.run(0.5)
    counts = dict(zip(EVENTS, engine.devices["anna"].variables.get("n"), strict=True))
    buttons = {name: 20 for name in EVENTS if name.startswith("button.")}
    assert counts == {
        **buttons,
        "buttons": 500,
        "prox": 100,
        "prox.comm": 100,
        "tap": 3,
        "acc": 160,
        "mic": 610,
        "sound.finished": counts["sound.finished"],
        "temperature": 10,
        "rc5": 4,
        "motor": 1000,
        "timer0": 100,
        "timer1": 40,
    }
    assert counts["sound.finished"] >= 1


def test_events_of_one_moment_come_in_the_order_of_their_numbers():
    names = ["motor", "acc", "prox", "buttons", "tap", "rc5", "mic"]
    handlers = "\n".join(f"onevent {name}\nif n < 8 then\norder[n] = {EVENTS.index(name)}\nn++\nend" for name in names)
    engine, device = alone(f"var order[8]\nvar n = 8\nmic.threshold = 10\n{handlers}")
    engine.run(0.99)
    device.variables.set("n", (0,))
    for command in (Tap(), RemoteKey(1, 2), SetNoiseLevel(100)):
        engine.post("anna", command)
    engine.run(0.01)
    assert engine.now_ns == 1_000_000_000
    words = device.variables.get("order")[: device.variables.get("n")[0]]
    assert [EVENTS[number] for number in words] == ["buttons", "prox", "tap", "acc", "mic", "rc5", "motor"]


@pytest.mark.parametrize(("threshold", "events"), [(0, 0), (100, 0), (99, 61), (32767, 0)])
def test_mic_needs_a_threshold_and_more_than_it(threshold, events):
    engine, device = alone(counting(["mic"]).format(f"mic.threshold = {threshold}"))
    engine.post("anna", SetNoiseLevel(100))
    engine.run(1.0)
    assert device.variables.get("n") == (events,)
    assert device.variables.get("mic.intensity") == (100,)


def test_a_clap_is_one_or_two_events():
    engine, device = alone(counting(["mic"]).format("mic.threshold = 246"))
    engine.run(1.0)
    engine.post("anna", Clap(255))
    engine.run(1.0)
    assert device.variables.get("n")[0] in (1, 2)


def test_a_tap_stays_until_the_program_clears_it():
    engine, device = alone("var n = 0\nonevent timer0\nacc._tap = 0\nonevent tap\nn++")
    engine.post("anna", Tap())
    engine.run(0.5)
    assert (device.variables.get("acc._tap"), device.variables.get("n")) == ((1,), (1,))
    device.variables.set("acc._tap", (0,))
    engine.run(1.0)
    assert device.variables.get("acc._tap") == (0,)


WRITTEN = {
    "prox.comm.tx", "motor.left.target", "motor.right.target", "leds.top", "leds.bottom.left", "leds.bottom.right",
    "leds.circle", "mic.threshold", "timer.period",
}  # fmt: skip
"""What programs write; they read everything else (docs/spec/thymio-robot.md section 4)."""


def test_a_program_reads_every_variable_that_is_there_to_be_read():
    expected = {
        "_id": [1],
        "event.source": [1],
        "event.args": [0] * 32,
        "_fwversion": [14, 1],
        "_productId": [8],
        "buttons._raw": [2000, 2000, 1600, 2000, 2000],
        "button.backward": [0],
        "button.left": [0],
        "button.center": [1],
        "button.forward": [0],
        "button.right": [0],
        "buttons._mean": [2000] * 5,
        "buttons._noise": [20] * 5,
        "prox.horizontal": [0] * 7,
        "prox.comm.rx._payloads": [0, 9, 9, 9, 0, 0, 0],
        "prox.comm.rx._intensities": [0, ANY, ANY, ANY, 0, 0, 0],
        "prox.comm.rx": [9],
        "prox.ground.ambiant": [0, 0],
        "prox.ground.reflected": [938, 938],
        "prox.ground.delta": [938, 938],
        "_vbat": [716, 716],
        "_imot": [0, 0],
        "motor.left.speed": [100],
        "motor.right.speed": [-100],
        "motor.left.pwm": [-160],
        "motor.right.pwm": [160],
        "_integrator": [-480, 480],
        "acc": [10, -11, 18],
        "temperature": [-35],
        "rc5.address": [31],
        "rc5.command": [127],
        "mic.intensity": [77],
        "mic._mean": [255],
        "acc._tap": [1],
        "sd.present": [0],
    }
    names = [name for name in THYMIO_II.addresses if name not in WRITTEN]
    assert names == list(expected)
    copies, place = [], 0
    for name, words in expected.items():
        copies.append(f"seen[{place}:{place + len(words) - 1}] = {name}[0:{len(words) - 1}]")
        place += len(words)
    start = "call prox.comm.enable(1)\nprox.comm.tx = -1\ntimer.period[0] = 1500\nonevent timer0\n"
    reader = load_program(f"var seen[{place}]\n{start}" + "\n".join(copies), "test")
    sender = load_program("call prox.comm.enable(1)\nprox.comm.tx = 9", "test")
    engine = Engine(pair(), {"anna": reader, "bert": sender}, noise=False)
    for command in (
        PressButton("center", True), SetBattery(3.6), Tilt(-0.5, 0.5), SetTemperature(-3.5), RemoteKey(31, 127),
        SetNoiseLevel(77), Tap(),
    ):  # fmt: skip
        engine.post("anna", command)
    engine.run(1.45)
    anna = engine.devices["anna"]
    anna.variables.set("motor.left.target", (100,))
    anna.variables.set("motor.right.target", (-100,))
    engine.run(0.15)
    words = list(anna.variables.get("seen"))
    seen = {}
    for name, value in expected.items():
        seen[name], words = words[: len(value)], words[len(value) :]
    assert seen == expected
    _, left, center, right, *_ = seen["prox.comm.rx._intensities"]
    assert center > left > right >= 1400  # the robot has begun to turn right


def test_what_stays_the_same_is_read_again_after_a_reset():
    engine, device = alone("", noise=False)
    engine.post("anna", SetNoiseLevel(50))
    engine.run(0.5)
    device.run_control.reset()
    device.run_control.resume()
    assert device.variables.get("_vbat") == (0, 0)
    engine.run(1.1)
    assert device.variables.get("_vbat") == (796, 796)
    assert device.variables.get("mic.intensity") == (50,)
    assert device.variables.get("buttons._mean") == (2000,) * 5


def test_the_lights_of_the_battery_move_while_a_charger_is_connected():
    engine, device = alone("", noise=False)

    def shown(seconds):
        found = []
        for _ in range(round(seconds / 0.02)):
            engine.run(0.02)
            found.append(engine.world.robots["anna"].state(LedState).levels["battery"])
        return dict.fromkeys(found)

    engine.run(0.5)
    engine.post("anna", ConnectCharger(True))
    engine.run(0.1)
    assert len(shown(2.0)) == 4
    device.run_control.reset()
    device.run_control.resume()
    engine.run(1.1)
    assert len(shown(2.0)) == 4
    engine.post("anna", ConnectCharger(False))
    engine.run(0.1)
    assert list(shown(2.0)) == [(32, 32, 32)]


def test_zero_degrees_are_shown_by_a_program_that_was_loaded_in_the_cold():
    engine, _ = alone("", noise=False)
    engine.post("anna", SetTemperature(0.0))
    engine.run(1.1)
    engine.load("anna", load_program("var a", "another"))
    engine.run(0.1)
    lights = engine.world.robots["anna"].state(LedState).levels
    assert lights["temperature"] == (0, 0)  # nothing was measured yet
    engine.run(1.0)
    assert engine.world.robots["anna"].state(LedState).levels["temperature"] == (0, 32)


TALKER = "var n = 0\ncall prox.comm.enable(1)\nprox.comm.tx = 100 * _id\nonevent prox.comm\nn++"


def test_two_robots_talk_by_infrared():
    engine = Engine(pair(), load_program(TALKER, "test"))
    engine.run(1.0)
    anna, bert = engine.devices.values()
    assert (anna.variables.get("prox.comm.rx"), bert.variables.get("prox.comm.rx")) == ((200,), (100,))
    assert (anna.variables.get("n"), bert.variables.get("n")) == ((10,), (10,))
    assert anna.variables.get("prox.comm.rx._payloads")[2] == 200
    assert anna.variables.get("prox.comm.rx._intensities")[2] > 2000
    assert anna.variables.get("prox.comm.rx._intensities")[5:] == (0, 0)


def test_out_of_range_nothing_changes_any_more():
    engine = Engine(pair(gap_m=1.0), load_program(TALKER, "test"))
    engine.run(1.0)
    assert engine.devices["anna"].variables.get("n") == (0,)


def test_a_negative_value_is_not_received():
    engine = Engine(pair(), load_program(TALKER.replace("100 *", "-1 *"), "test"))
    engine.run(1.0)
    assert engine.devices["anna"].variables.get("n") == (0,)


def test_intensities_that_a_program_clears_stay_so_until_the_next_frame():
    source = TALKER + "\nonevent button.center\ncall math.fill(prox.comm.rx._intensities, 0)"
    engine = Engine(pair(), {"anna": load_program(source, "test"), "bert": load_program(TALKER, "test")})
    engine.run(1.0)
    engine.devices["bert"].variables.set("prox.comm.tx", (-1,))
    engine.run(0.2)
    engine.press("anna", "center")
    engine.run(1.0)
    anna = engine.devices["anna"]
    assert anna.variables.get("prox.comm.rx._intensities") == (0,) * 7
    assert anna.variables.get("prox.comm.rx") == (200,)


def test_switching_off_zeroes_what_was_sent_and_received():
    source = TALKER + "\nonevent button.center\ncall prox.comm.enable(0)"
    engine = Engine(pair(), load_program(source, "test"))
    engine.run(1.0)
    engine.press("anna", "center")
    engine.run(0.1)
    anna, bert = engine.devices.values()
    heard = bert.variables.get("n")
    assert (anna.variables.get("prox.comm.rx"), anna.variables.get("prox.comm.tx")) == ((0,), (0,))
    engine.run(1.0)
    assert bert.variables.get("n") == heard
    assert anna.variables.get("prox.comm.rx") == (0,)


def test_a_value_set_while_off_is_sent_once_it_is_switched_on():
    source = "prox.comm.tx = 7\nonevent button.center\ncall prox.comm.enable(1)"
    engine = Engine(pair(), {"anna": load_program(source, "test"), "bert": load_program(TALKER, "test")})
    engine.run(0.5)
    assert engine.devices["bert"].variables.get("n") == (0,)
    engine.press("anna", "center")
    engine.run(0.5)
    assert engine.devices["bert"].variables.get("prox.comm.rx") == (7,)


def test_a_reset_switches_communication_off():
    engine = Engine(pair(), load_program(TALKER, "test"))
    engine.run(1.0)
    engine.devices["anna"].run_control.reset()
    engine.run(0.2)
    heard = engine.devices["bert"].variables.get("n")
    engine.run(1.0)
    assert engine.devices["bert"].variables.get("n") == heard


def test_the_same_seed_and_commands_give_the_same_variables():
    def play():
        engine = Engine(pair(), load_program(TALKER + "\nmotor.left.target = 40", "test"), seed=8)
        seen = []
        for step in range(200):
            if step % 30 == 0:
                engine.post("bert", Tilt(0.01 * step, 0.0))
                engine.post("anna", Clap(step))
            engine.step()
            device = engine.devices["anna"]
            seen.append([device.variables.get(name) for name in ("acc", "mic.intensity", "prox.comm.rx._intensities")])
        return seen

    assert play() == play()


def test_in_the_shipped_world_of_two_robots_they_hear_each_other_at_once():
    engine = Engine(load_playground("two_robots")[1], load_program(TALKER, "test"))
    engine.run(1.0)
    assert [device.variables.get("n") for device in engine.devices.values()] == [(10,), (10,)]
