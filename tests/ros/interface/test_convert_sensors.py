"""Readings of the senses as messages, and the way of both faces through the graph."""

from __future__ import annotations

import json
import math

import pytest
from sensor_msgs.msg import BatteryState, Imu, Temperature
from std_msgs.msg import Bool, Empty, Float32, Float32MultiArray, Int8, Int16, Int16MultiArray

from thymio_sim_ros.ros.interface import sensor_topics
from thymio_sim_ros.ros.interface.convert_readings import ConvertOptions
from thymio_sim_ros.ros.interface.names import RobotNames
from thymio_sim_ros.sim.model import readings
from thymio_sim_ros.sim.sensors import all_sensors

ROWS = {row.topic: row for sensor in all_sensors() for row in sensor_topics.rows_of(sensor)}

TWO = json.dumps(
    {
        "format": 1,
        "title": "Two that face each other",
        "shapes": [{"kind": "rectangle", "name": "ground", "size_x_m": 2.0, "size_y_m": 2.0, "color": "#ffffff"}],
        "robots": [
            {"name": "anna", "x_m": 0.0, "y_m": 0.0, "yaw_rad": 0.0},
            {"name": "bert", "x_m": 0.3, "y_m": 0.0, "yaw_rad": math.pi},
        ],
    }
)


def encode(topic, reading, name=""):
    message = ROWS[topic].encode(reading, RobotNames(name), ConvertOptions())
    assert message is None or isinstance(message, ROWS[topic].type)
    return message


def test_the_imu_is_the_driver_s():
    reading = readings.AccelerometerReading(1_250_000_000, (2, -3, 23))
    message = encode("imu", reading, "anna")
    vector = message.linear_acceleration
    assert (vector.x, vector.y, vector.z) == pytest.approx((-3 / 23 * 9.81, -2 / 23 * 9.81, 9.81))
    assert (message.orientation_covariance[0], message.angular_velocity_covariance[0]) == (-1.0, -1.0)
    assert list(message.linear_acceleration_covariance) == [0.07, 0, 0, 0, 0.07, 0, 0, 0, 0.07]
    assert (message.header.frame_id, message.header.stamp.nanosec) == ("anna/base_link", 250_000_000)


def test_temperature_has_tenths_and_a_variance():
    message = encode("_temperature", readings.TemperatureReading(0, (184,), 18.44))
    assert (message.temperature, message.variance) == (18.4, 0.01)


@pytest.mark.parametrize("is_charging", [False, True])
def test_the_battery_publishes_voltage_and_charge(is_charging):
    message = encode("_battery", readings.BatteryReading(0, (796, 796, 0), 4.0, 0.75, is_charging))
    assert (message.voltage, message.percentage, message.present) == (4.0, 0.75, True)
    assert (message.power_supply_status == BatteryState.POWER_SUPPLY_STATUS_CHARGING) == is_charging
    assert math.isnan(message.current)


def test_events_carry_their_values():
    assert encode("_tap", readings.TapReading(0, (1,))) == Empty()
    assert encode("_remote", readings.RemoteReading(0, (5, 127))) == Int8(data=127)
    assert encode("_comm/received", readings.CommReading(0, (2047, *[0] * 14))) == Int16(data=2047)
    assert encode("_collision", readings.CollisionReading(0, (), True)) == Bool(data=True)


def test_only_loud_sounds_are_published():
    assert encode("_sound", readings.SoundReading(0, (51, 256), True)) == Float32(data=0.2)
    assert encode("_sound", readings.SoundReading(0, (51, 256), False)) is None


def test_stimuli_of_an_operator_reach_the_topics(ros, simulation):
    sim = simulation()
    imu, taps, keys = ros.collect(Imu, "/imu"), ros.collect(Empty, "/_tap"), ros.collect(Int8, "/_remote")
    sounds, warm = ros.collect(Float32, "/_sound"), ros.collect(Temperature, "/_temperature")
    power, sent = ros.collect(BatteryState, "/_battery"), ros.publisher
    sent(Float32, "/_sound_threshold").publish(Float32(data=0.5))
    sent(Float32MultiArray, "/_press/tilt").publish(Float32MultiArray(data=[0.0, -math.pi / 2]))
    sent(Empty, "/_press/tap").publish(Empty())
    sent(Int8, "/_press/remote").publish(Int8(data=80))
    sent(Float32, "/_press/temperature").publish(Float32(data=30.5))
    sent(Float32, "/_press/battery").publish(Float32(data=3.5))
    sent(Float32, "/_press/sound").publish(Float32(data=0.75))
    sim.until(lambda: imu and imu[-1].linear_acceleration.x == pytest.approx(9.81))
    sim.until(lambda: taps and keys and sounds and warm and power)
    sim.until(lambda: (round(warm[-1].temperature, 1), round(power[-1].voltage, 1)) == (30.5, 3.5))
    assert keys[-1].data == 80
    assert sounds[-1].data == pytest.approx(191 / 255)


def test_a_program_gets_the_words_of_the_sensors(ros, simulation, runtime):
    sim = simulation()
    runtime(
        "mic.threshold = 100\nonevent rc5\ncall leds.rc(rc5.command)\n"
        "onevent tap\nacc._tap = 0\ncall leds.sound(7)\n"
        "onevent acc\nif acc[1] > 20 then\ncall leds.prox.v(5, 6)\nend\n"
        "onevent mic\ncall leds.temperature(mic.intensity / 10, 1)"
    )
    state = ros.collect(Float32MultiArray, "/_led/state", transient_local=True)
    ros.publisher(Int16MultiArray, "/_press/rc5").publish(Int16MultiArray(data=[3, 11]))
    ros.publisher(Empty, "/_press/tap").publish(Empty())
    ros.publisher(Float32MultiArray, "/_press/tilt").publish(Float32MultiArray(data=[0.0, -1.5]))
    sim.step(0.2)
    ros.publisher(Float32, "/_press/clap").publish(Float32(data=1.0))

    def shown(group):
        begin = 0
        for dimension in state[-1].layout.dim:
            if dimension.label == group:
                return [round(32 * level) for level in state[-1].data[begin : begin + dimension.size]]
            begin += dimension.size
        return []

    sim.until(lambda: state and shown("remote") == [11], what="rc5")
    sim.until(lambda: shown("microphone") == [7], what="tap")
    sim.until(lambda: shown("ground") == [5, 6], what="acc")
    sim.until(lambda: shown("temperature") == [25, 1], what="mic")


def test_programs_of_two_robots_talk_by_infrared(ros, simulation, runtime):
    sim = simulation(playground=TWO)
    sim.step(0.1)
    runtime(
        "call prox.comm.enable(1)\nprox.comm.tx = 100 + _id\n"
        "onevent prox.comm\ncall leds.top(prox.comm.rx - 100, 0, 0)",
        robots=["anna", "bert"],
    )
    states = [ros.collect(Float32MultiArray, f"/{name}/_led/state", transient_local=True) for name in ("anna", "bert")]
    sim.until(lambda: all(states) and [round(32 * state[-1].data[0]) for state in states] == [2, 1])


def test_a_wall_is_a_collision(ros, simulation):
    sim = simulation(playground="obstacle")
    touching = ros.collect(Bool, "/_collision")
    sim.step(0.1)
    ros.publisher(Int16MultiArray, "/_motor/target").publish(Int16MultiArray(data=[500, 500]))
    sim.until(lambda: touching and touching[-1].data)
