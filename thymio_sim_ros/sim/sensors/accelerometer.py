"""The accelerometer, 16 times a second the mean of the time since: proper acceleration.

Source: docs/spec/thymio-robot.md section 7.3.

At rest it is g upwards. For a robot whose left side is lifted by the roll r and whose front is lowered by the pitch p,
with g seen in its frame: forward -g sin p, left g sin r cos p, up g cos r cos p. To this comes what its motion
adds: forward dv / dt, left v * w (on a curve), and, when something hits it, the speed lost or won sidewards over dt.
In free fall it is nothing, and the landing adds, upwards, the speed of the fall over dt.
acc[0] is the part to the right, acc[1] forward, acc[2] upwards, 23 for each g, even noise of ±0.2 before rounding,
within ±32.
"""

from __future__ import annotations

import math
from collections.abc import Callable

from aseba_vm.kernel.record import Record
from aseba_vm.kernel.types import Floats, Ints, kernel
from thymio_sim_ros.sim.mechanics.fall import FALL_NS
from thymio_sim_ros.sim.model.clock import TICK_NS
from thymio_sim_ros.sim.model.geometry import LEVEL, Pose, Tilt
from thymio_sim_ros.sim.model.noise import NoiseKeys, uniform
from thymio_sim_ros.sim.model.readings import AccelerometerReading
from thymio_sim_ros.sim.model.robot_constants import ACC_LIMIT, ACC_NOISE, ACC_PER_G, GRAVITY_M_S2
from thymio_sim_ros.sim.model.robot_state import RobotState
from thymio_sim_ros.sim.model.units import acceleration_to_units
from thymio_sim_ros.sim.physics import Contact
from thymio_sim_ros.sim.plugin_api.aseba_binding import AsebaFace
from thymio_sim_ros.sim.plugin_api.display import DisplayedValue
from thymio_sim_ros.sim.plugin_api.reading_table import LazyReadings
from thymio_sim_ros.sim.plugin_api.view import BatchSensorView, SensorView
from thymio_sim_ros.sim.sensors import Sensor

__all__ = ["SENSOR", "gravity"]

_PERIOD_NS = 62_500_000
_PERIOD_S = _PERIOD_NS * 1e-9
_TICK_S = TICK_NS * 1e-9
_LANDING_M_S = GRAVITY_M_S2 * FALL_NS * 1e-9
_NOISE_M_S2 = ACC_NOISE * GRAVITY_M_S2 / ACC_PER_G


def gravity(tilt: Tilt) -> tuple[float, float, float]:
    """The reading of a tilted robot at rest in m/s²: forward, left, up."""
    if tilt == LEVEL:
        return (0.0, 0.0, GRAVITY_M_S2)
    level = GRAVITY_M_S2 * math.cos(tilt.pitch_rad)
    return (-GRAVITY_M_S2 * math.sin(tilt.pitch_rad), level * math.sin(tilt.roll_rad), level * math.cos(tilt.roll_rad))


def sideways(pose: Pose, contact: Contact) -> float:
    """The speed in m/s to the left that a robot gains when a contact begins, away from the point of contact."""
    dx, dy = pose.x_m - contact.x_m, pose.y_m - contact.y_m
    distance = math.hypot(dx, dy)
    if distance == 0.0:
        return 0.0
    return contact.speed_m_s * (dy * math.cos(pose.yaw_rad) - dx * math.sin(pose.yaw_rad)) / distance


def _feel(view: SensorView) -> None:
    hits = sum(sideways(view.pose, contact) for contact in view.contacts if contact.is_new)
    view.memory["hit_m_s"] = view.memory.get("hit_m_s", 0.0) + hits


class Felt(Record):
    """Motion of the robots as the accelerometer measures it, now and in the last measurement."""

    hit: Floats
    """Speed in m/s to the left that contacts gave it since."""
    gravity_forward: Floats
    """See `gravity`."""
    gravity_left: Floats
    gravity_up: Floats
    is_falling: Ints
    was_falling: Ints
    speed: Floats
    """Speed in the last measurement, m/s."""
    since_tick: Ints
    """Tick of the last measurement; 0 before the first."""
    right: Ints
    """Result: the words of acc."""
    ahead: Ints
    up: Ints


@kernel
def measure_all(robots: RobotState, felt: Felt, keys: NoiseKeys, tick: Ints) -> None:
    """Write the words of all robots; `tick[0]` is the number of the tick, `keys` are those of the noise."""
    for robot in range(felt.count):
        ticks = float(tick[0] - felt.since_tick[robot])
        dt_s = ticks * _TICK_S if felt.since_tick[robot] > 0 else _PERIOD_S
        speed = robots.speed[robot]
        forward = 0.0
        left = 0.0
        up = 0.0
        if felt.is_falling[robot] == 0:
            forward = felt.gravity_forward[robot] + (speed - felt.speed[robot]) / dt_s
            left = felt.gravity_left[robot] + speed * robots.turn_rate[robot] + felt.hit[robot] / dt_s
            up = felt.gravity_up[robot]
            felt.hit[robot] = 0.0
            if felt.was_falling[robot] == 1 and robots.is_standing[robot] == 0:
                up += _LANDING_M_S / dt_s
        felt.was_falling[robot] = felt.is_falling[robot]
        felt.speed[robot] = speed
        felt.since_tick[robot] = tick[0]
        if keys.is_on[robot] == 1:
            key_1 = keys.key_1[robot]
            key_2 = keys.key_2[robot]
            left -= _NOISE_M_S2 * (2.0 * uniform(key_1, key_2, tick[0], 0) - 1.0)
            forward += _NOISE_M_S2 * (2.0 * uniform(key_1, key_2, tick[0], 1) - 1.0)
            up += _NOISE_M_S2 * (2.0 * uniform(key_1, key_2, tick[0], 2) - 1.0)
        felt.right[robot] = acceleration_to_units(-left)
        felt.ahead[robot] = acceleration_to_units(forward)
        felt.up[robot] = acceleration_to_units(up)


def _prepare(batch: BatchSensorView) -> Callable[[], LazyReadings]:
    felt = batch.record(Felt)
    measure = batch.bind(measure_all, batch.robots, felt, batch.noise_keys, batch.tick)
    gravities, memories = (felt.gravity_forward, felt.gravity_left, felt.gravity_up), batch.memories

    def measure_robots() -> LazyReadings:
        tilts = batch.tilts
        for gravity_part, values in zip(gravities, zip(*map(gravity, tilts), strict=True), strict=True):
            gravity_part[:] = values
        felt.is_falling[:] = 0
        felt.is_falling[batch.falling] = 1
        for robot, memory in enumerate(memories):
            if memory:
                felt.view.hit[robot] += memory.pop("hit_m_s")
        measure()
        now_ns, right, ahead, up = batch.now_ns, felt.right.tolist(), felt.ahead.tolist(), felt.up.tolist()
        return LazyReadings(
            len(batch), lambda robot: AccelerometerReading(now_ns, (right[robot], ahead[robot], up[robot]))
        )

    return measure_robots


SENSOR = Sensor(
    name="accelerometer",
    period_ns=_PERIOD_NS,
    prepare_all=_prepare,
    wakes_on=(Contact,),
    on_wake=_feel,
    aseba=AsebaFace(variables=(("acc", 3),), event="acc"),
    label="acceleration",
    values=tuple(
        DisplayedValue(axis, "m/s²", GRAVITY_M_S2 / ACC_PER_G, digits=1, full_scale=ACC_LIMIT) for axis in "xyz"
    ),
)
